//! Which lines wait, in a script, until what is shown is that of the scene as it is: a person would see that it is not yet.

use std::sync::Arc;

use super::TABLE;
use crate::tui::state::State;
use crate::tui::text::said::Said;

/// Whether a line depends on pictures that are not read yet.
pub fn awaits_pictures(state: &State, line: &str) -> bool {
    let Said { name, text, .. } = Said::parse(line, None);
    let depends = TABLE.find(name).is_some_and(|command| (command.awaits)(state, text));
    let is_made = state.picture.made.as_ref().is_some_and(|made| Arc::ptr_eq(made, state.document().scene()));
    depends && !is_made
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::commands::obey;
    use crate::tui::commands::update::update;
    use crate::tui::events::Event;
    use crate::tui::tests::support;

    #[test]
    fn a_line_waits_until_the_scene_as_it_is_was_made() {
        let mut state = support::state();
        let awaits = |state: &State| {
            ["sprites take", "pick add", ":clip show", "views add a"].map(|line| awaits_pictures(state, line))
        };
        assert_eq!(awaits(&state), [true; 4]);
        assert!(!awaits_pictures(&state, "sprites -o out") && !awaits_pictures(&state, "undo"));
        assert!(!awaits_pictures(&state, "place next"), "the size of the picture is known");
        let scene = state.document().scene().clone();
        update(&mut state, Event::Made(scene));
        assert_eq!(awaits(&state), [false; 4]);
        obey(&mut state, "set title=x", None).unwrap();
        assert_eq!(awaits(&state), [true; 4]);
    }
}
