//! Where everything is on the screen: functions of its size and of the state, used for drawing and for clicks.

use super::state::fits;
use ratatui::layout::{Constraint, Layout, Margin, Position, Rect, Spacing};

use super::state::{Mode, Pane, State};

pub mod lesson;
pub mod picture;
pub mod sketch;

/// From this width on there are panes on the right.
const WIDE: u16 = 112;

/// The areas of the panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Areas {
    /// The tree of the scene.
    pub tree: Rect,
    /// The form or table.
    pub table: Rect,
    /// The description of the field under the cursor.
    pub detail: Rect,
    /// The vector field and the position functions, if there is room for them and the scene has any.
    pub plots: Option<[Rect; 2]>,
    /// The small drawing of what is selected, if there is room and the scene has any; in place of the plots if both would be shown.
    pub sketch: Option<Rect>,
    /// The picture, if there is room for it on the right.
    pub picture: Option<Rect>,
    /// The status line.
    pub status: Rect,
    /// The command line.
    pub line: Rect,
}

/// Rows of the description of a field, with its frame.
const DETAIL: u16 = 5;

/// Rows of the read-out of a pixel, which replaces the description.
const PROBE: u16 = 9;

/// The areas of a screen.
pub fn areas(screen: Rect, state: &State) -> Areas {
    let [body, status, line] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(1), Constraint::Length(1)]).areas(screen);
    let right = if screen.width >= WIDE { screen.width * 2 / 5 } else { 0 };
    let tree = (screen.width / 5).clamp(24, 30).min(screen.width / 3);
    let columns = [Constraint::Length(tree), Constraint::Fill(1), Constraint::Length(right)];
    let columns = &columns[..if right > 0 { 3 } else { 2 }];
    let columns = Layout::horizontal(columns).spacing(Spacing::Overlap(1)).split(body);
    let (tree, middle, right) = (columns[0], columns[1], columns.get(2).copied().unwrap_or_default());
    let [table, detail] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(if state.picture.probing { PROBE } else { DETAIL })])
            .spacing(Spacing::Overlap(1))
            .areas(middle);
    let right = Some(right).filter(|right| right.width > 0);
    let stack = [Constraint::Fill(3), Constraint::Length((body.height / 5).max(6)), Constraint::Fill(5)];
    let stacked = right.filter(|_| has_curves(state));
    let stacked = stacked.map(|right| Layout::vertical(stack).spacing(Spacing::Overlap(1)).areas(right));
    let plots = stacked.map(|[field, position, _]| [field, position]);
    let Some([field, position]) = plots else {
        let halves = right.filter(|_| has_sketches(state));
        let halves = halves.map(|right| Layout::vertical(HALVES).spacing(Spacing::Overlap(1)).areas(right));
        let (sketch, picture) = halves.map_or((None, right), |[sketch, picture]| (Some(sketch), Some(picture)));
        return Areas { tree, table, detail, plots: None, sketch, picture, status, line };
    };
    let sketch = sketch::sketch(state).map(|_| field.union(position));
    let picture = stacked.map(|[.., picture]| picture);
    Areas { tree, table, detail, plots: plots.filter(|_| sketch.is_none()), sketch, picture, status, line }
}

/// A small drawing, and the picture.
const HALVES: [Constraint; 2] = [Constraint::Fill(2), Constraint::Fill(3)];

/// Whether something in the scene has small drawings, as [`has_curves`].
fn has_sketches(state: &State) -> bool {
    state.document().scene().layers.iter().any(|layer| !layer.technique().sketched().is_empty())
}

/// Whether something in the scene moves along curves, which have vectors too: whatever is shown of it just now, so that panes
/// do not come and go with the cursor.
fn has_curves(state: &State) -> bool {
    let wrap = state.timeline().wrap;
    state.document().scene().layers.iter().any(|layer| !layer.technique().curves(wrap).is_empty())
}

/// The areas of the screen as it is: without the lesson, and the pane that has the focus alone where it is enlarged, as the picture is while one paints. Panes
/// that are not shown have an empty area.
pub fn areas_of(state: &State) -> Areas {
    let screen = screen(state);
    let all = areas(screen, state);
    let paints = state.picture.painting.is_some() && state.cursor.focus == Pane::Picture;
    if !state.cursor.enlarged && !paints {
        return all;
    }
    let body = Rect { height: screen.height.saturating_sub(2), ..screen };
    let none = Rect::ZERO;
    if state.cursor.focus == Pane::Tree && !matches!(state.typing.mode, Mode::Aim) {
        return Areas { tree: body, table: none, detail: none, plots: None, sketch: None, picture: None, ..all };
    }
    let detail = Constraint::Length(if state.picture.probing { PROBE } else { DETAIL });
    let [table, detail] = Layout::vertical([Constraint::Fill(1), detail]).spacing(Spacing::Overlap(1)).areas(body);
    Areas { tree: none, table, detail, plots: None, sketch: None, picture: None, ..all }
}

/// The screen without the lesson at its bottom.
pub fn screen(state: &State) -> Rect {
    lesson::above(state, Rect::new(0, 0, state.size.0, state.size.1))
}

/// Whether the picture is in the middle column, because there is no room on the right.
pub fn picture_in_middle(state: &State, areas: &Areas) -> bool {
    areas.picture.is_none() && (state.cursor.focus == Pane::Picture || matches!(state.typing.mode, Mode::Aim))
}

/// The pane at a place of the screen, of those that can have the focus.
pub fn pane_at(state: &State, at: Position) -> Option<Pane> {
    let areas = areas_of(state);
    let in_middle = picture_in_middle(state, &areas).then(|| middle(state, &areas));
    let picture = areas.picture.or(in_middle);
    let panes = [(Pane::Tree, Some(areas.tree)), (Pane::Picture, picture), (Pane::Table, Some(areas.table))];
    panes.into_iter().find(|(_, area)| area.is_some_and(|area| area.contains(at))).map(|(pane, _)| pane)
}

/// The middle column without the read-out.
pub fn middle(state: &State, areas: &Areas) -> Rect {
    if state.picture.probing { areas.table } else { areas.table.union(areas.detail) }
}

/// The inside of the picture's pane; `None` if it is not on the screen.
pub fn picture_area(state: &State) -> Option<Rect> {
    if !fits(state.size) {
        return None;
    }
    let areas = areas_of(state);
    let middle = picture_in_middle(state, &areas).then(|| middle(state, &areas));
    areas.picture.or(middle).map(|area| area.inner(Margin::new(1, 1)))
}

/// The first of `count` rows to show in `height` lines, so that row `at` is in the middle if possible.
pub fn first_row(at: usize, count: usize, height: u16) -> usize {
    let height = usize::from(height);
    at.saturating_sub(height / 2).min(count.saturating_sub(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_scroll_around_the_cursor() {
        for (at, count, height, first) in [(0, 100, 10, 0), (50, 100, 10, 45), (99, 100, 10, 90), (3, 5, 10, 0)] {
            assert_eq!(first_row(at, count, height), first);
        }
    }
}
