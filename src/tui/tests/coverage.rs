//! Checks that every command has a case (scene, keys, scene). To add one, write a row into a table of `check` in a test
//! function, and name that function in [`TABLES`]. Which commands the rows run is recorded by `obey`.

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::tui::commands;

/// The tests that are tables of (scene, keys, scene).
const TABLES: &[fn()] = &[
    super::numbers_are_entered_in_place,
    super::polar_and_cartesian_columns_edit_the_same_jump,
    super::numbers_step_and_counts_multiply,
    super::rows_and_nodes_come_and_go,
    super::kinds_and_optional_nodes_are_chosen,
    super::points_are_placed_on_the_picture,
    super::commands_set_and_say,
    super::leaving_is_refused_with_unsaved_edits_only,
    super::time_goes_by_frames,
    super::escape_ends_one_thing_after_the_other,
    super::apart::what_is_locked_is_not_edited,
    super::apart::what_is_drawn_is_compared_here_and_in_the_window,
    super::macros::macros_play_what_was_asked_for,
    super::macros::the_last_change_is_repeated_here,
    super::counts::every_command_repeats_by_its_count_or_uses_it_or_refuses_it,
    super::told::tables_are_pasted_over_a_selection,
    super::told::what_was_said_and_what_is_wrong_can_be_read_again,
    super::images::a_picture_of_the_scene_is_opened_and_nothing_else,
    super::conflicts::unsaved_edits_that_were_left_behind_are_told_in_words_and_offered,
    super::conflicts::what_another_program_writes_is_taken_in_merged_or_asked_about,
    super::finding::what_is_found_is_edited,
    super::rows::rows_are_selected_one_by_one_and_by_what_holds,
    super::rows::rows_are_sorted,
    super::looks::columns_are_chosen_ordered_and_left_out,
    super::looks::registers_hold_what_was_yanked_into_them,
    super::looks::one_pane_has_the_whole_screen,
    super::looks::the_help_is_searched,
    super::rows::names_texts_and_numbers_are_replaced,
    super::piping::rows_go_through_a_program_or_nothing_changes,
    super::sharing::outlines_and_curves_are_made_of_shapes_and_get_them_back,
    super::sharing::shapes_are_laid_and_what_moves_follows_them,
    super::rowing::rows_and_nodes_are_made_anew,
    super::rowing::the_cursor_goes_to_what_is_near,
    super::transforming::what_is_selected_is_transformed_in_one_step,
    super::tutor::lessons_are_gone_through_by_command,
    super::lines::lines_say_what_keys_do,
    super::lines::nodes_are_reached_by_collapsing_and_going_up,
    super::lines::what_is_outside_is_asked_for,
    super::lines::the_pointer_of_a_window_is_kept_as_a_place,
    super::pasting::what_is_yanked_is_pasted_where_it_fits,
    super::windows::speed_is_shared,
    super::undoing::edits_apply_to_the_selection_which_stays,
    super::undoing::undo_says_what_it_undid,
    super::items::pictures_and_names_come_and_go,
    super::profiles::a_preset_is_applied_in_one_step_to_the_layer_that_is_shown,
    super::profiles::strokes_are_turned_in_the_picture_and_fixed_to_the_next_thing,
    super::lines::what_lasts_of_no_key_changes_no_scene,
    super::picking::sprites_are_picked_from_frames_of_the_clip,
    super::picture::zooming_keeps_the_cursor_and_panning_takes_it_along,
    super::picture::graphics_are_told_and_set,
    super::picture::a_pass_is_shown_in_place_of_the_picture,
    super::picture::the_read_out_opens_follows_and_closes,
    super::views::one_paints_in_three_views,
];

thread_local! {
    static RAN: RefCell<BTreeSet<String>> = const { RefCell::new(BTreeSet::new()) };
}

/// Notes that a command was run on this thread.
pub fn ran(name: &str) {
    RAN.with_borrow_mut(|ran| ran.insert(name.to_owned()));
}

#[test]
fn every_command_has_a_case() {
    TABLES.iter().for_each(|table| table());
    let ran = RAN.take();
    let without: Vec<_> = commands::all().map(|command| command.name).filter(|name| !ran.contains(*name)).collect();
    assert!(without.is_empty(), "no case for {without:?}: see the first lines of this file");
}
