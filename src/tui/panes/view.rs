//! The screen: where the panes stand, at every size from 60 x 20 on. Draws the state and changes nothing.

use ratatui::Frame;
use ratatui::layout::{Alignment, Constraint, Layout, Margin, Position, Rect, Spacing};
use ratatui::symbols::merge::MergeStrategy;
use ratatui::text::{Line, Text};
use ratatui::widgets::{Block, Clear, Paragraph, Widget};

use crate::tui::panes;
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::colour;

/// The least terminal that the editor draws on: a split of a window, less the lines that a multiplexer takes.
pub const LEAST: (u16, u16) = (60, 20);
/// The terminal that is meant where there is none.
pub const USUAL: (u16, u16) = (80, 24);
/// From this width on there are panes at the right.
const WIDE: u16 = 112;

/// Where the panes stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Areas {
    /// The tree of the scene.
    pub tree: Rect,
    /// The form or table.
    pub table: Rect,
    /// What is told about the field under the cursor.
    pub detail: Rect,
    /// The field, the position function and the picture, where there is room.
    pub right: Option<[Rect; 3]>,
    /// The status line.
    pub status: Rect,
    /// The command line.
    pub line: Rect,
}

/// Rows of what is told about a field, and of the read-out of a pixel that takes its place, with their frames.
const DETAIL: u16 = 5;
const PROBE: u16 = 9;

/// Whether the editor draws on a terminal of this size; on a smaller one nothing can be edited, for nothing is seen of it.
pub fn fits((width, height): (u16, u16)) -> bool {
    width >= LEAST.0 && height >= LEAST.1
}

/// The areas of a screen, with the read-out of a pixel or without.
pub fn areas(screen: Rect, probing: bool) -> Areas {
    let [body, status, line] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(1), Constraint::Length(1)]).areas(screen);
    let right = if screen.width >= WIDE { screen.width * 2 / 5 } else { 0 };
    let tree = (screen.width / 5).clamp(24, 30).min(screen.width / 3);
    let columns = [Constraint::Length(tree), Constraint::Fill(1), Constraint::Length(right)];
    let columns = &columns[..if right > 0 { 3 } else { 2 }];
    let columns = Layout::horizontal(columns).spacing(Spacing::Overlap(1)).split(body);
    let (tree, middle, right) = (columns[0], columns[1], columns.get(2).copied().unwrap_or_default());
    let [table, detail] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(if probing { PROBE } else { DETAIL })])
            .spacing(Spacing::Overlap(1))
            .areas(middle);
    let stack = [Constraint::Fill(3), Constraint::Length((body.height / 5).max(6)), Constraint::Fill(5)];
    let right = (right.width > 0).then(|| Layout::vertical(stack).spacing(Spacing::Overlap(1)).areas(right));
    Areas { tree, table, detail, right, status, line }
}

/// The screen without the lesson below.
pub fn screen(state: &State) -> Rect {
    panes::lesson::above(state, Rect::new(0, 0, state.size.0, state.size.1))
}

/// Whether the picture stands in the middle, for want of room at the right.
fn picture_in_middle(state: &State, areas: &Areas) -> bool {
    areas.right.is_none() && (state.focus == Pane::Picture || matches!(state.mode, Mode::Aim))
}

/// The middle column, as far as the read-out leaves it.
fn middle(state: &State, areas: &Areas) -> Rect {
    if state.seeing.probing { areas.table } else { areas.table.union(areas.detail) }
}

/// The inside of the picture's pane, where it is on the screen.
pub fn picture(state: &State) -> Option<Rect> {
    if !fits(state.size) {
        return None;
    }
    let areas = areas(screen(state), state.seeing.probing);
    let middle = picture_in_middle(state, &areas).then(|| middle(state, &areas));
    areas.right.map(|[.., picture]| picture).or(middle).map(|area| area.inner(Margin::new(1, 1)))
}

/// Draws the screen.
pub fn draw(frame: &mut Frame, state: &State) {
    let screen = frame.area();
    if !fits((screen.width, screen.height)) {
        return too_small(frame, state, screen);
    }
    if let Some(tutor) = &state.tutor {
        panes::lesson::draw(tutor, &state.keymap, screen, frame.buffer_mut());
    }
    let screen = panes::lesson::above(state, screen);
    let areas = areas(screen, state.seeing.probing);
    let mut cursor = panes::tree::draw(state, pane(frame, state, areas.tree, Pane::Tree, "scene"), frame.buffer_mut());
    if picture_in_middle(state, &areas) {
        let inner = pane(frame, state, middle(state, &areas), Pane::Picture, &panes::picture::title(state));
        cursor = panes::picture::draw(state, inner, frame.buffer_mut()).or(cursor);
    } else {
        let inner = pane(frame, state, areas.table, Pane::Table, &panes::table::title(state));
        cursor = panes::table::draw(state, inner, frame.buffer_mut()).or(cursor);
        if !state.seeing.probing {
            let inner = block(frame, areas.detail, "");
            panes::detail::draw(state, inner, frame.buffer_mut());
        }
    }
    if state.seeing.probing {
        let inner = block(frame, areas.detail, "probe");
        panes::probe::draw(state, inner, frame.buffer_mut());
    }
    if let Some([field, position, picture]) = areas.right {
        let inner = block(frame, field, "field");
        panes::field::draw(state, inner, frame.buffer_mut());
        let inner = block(frame, position, "position");
        panes::position::draw(state, inner, frame.buffer_mut());
        let inner = pane(frame, state, picture, Pane::Picture, &panes::picture::title(state));
        cursor = panes::picture::draw(state, inner, frame.buffer_mut()).or(cursor);
    }
    panes::status::draw(state, areas.status, frame.buffer_mut());
    cursor = panes::line::draw(state, areas.line, frame.buffer_mut()).or(cursor);
    cursor = panes::popup::draw(state, screen, frame.buffer_mut()).or(cursor);
    panes::picture::give_way(state, frame.buffer_mut());
    if let Some(cursor) = cursor {
        frame.set_cursor_position(cursor);
    }
}

/// The frame of a pane that can have the focus; the one that has it shows `>` and a bold title.
fn pane(frame: &mut Frame, state: &State, area: Rect, which: Pane, title: &str) -> Rect {
    let focused = state.focus == which;
    let title = Line::from(format!("{}{title} ", if focused { ">" } else { " " }));
    let title = if focused { title.style(colour::strong()) } else { title };
    bordered(frame, area, title)
}

fn block(frame: &mut Frame, area: Rect, title: &str) -> Rect {
    let title = if title.is_empty() { String::new() } else { format!(" {title} ") };
    bordered(frame, area, Line::from(title))
}

fn bordered(frame: &mut Frame, area: Rect, title: Line) -> Rect {
    let block = Block::bordered().title(title).merge_borders(MergeStrategy::Exact);
    let inner = block.inner(area);
    block.render(area, frame.buffer_mut());
    inner
}

/// Clears a rectangle in the middle of the screen and frames it.
pub fn window(screen: Rect, width: u16, height: u16, title: &str, buffer: &mut ratatui::buffer::Buffer) -> Rect {
    let area =
        screen.centered(Constraint::Length(width.min(screen.width)), Constraint::Length(height.min(screen.height)));
    Clear.render(area, buffer);
    let block = Block::bordered().title(format!(" {title} "));
    let inner = block.inner(area);
    block.render(area, buffer);
    inner
}

/// What stands there instead, and below it the line in which `:q` is typed.
fn too_small(frame: &mut Frame, state: &State, screen: Rect) {
    let text = format!("Plica needs {} x {}\nthis is {} x {}", LEAST.0, LEAST.1, screen.width, screen.height);
    let middle = Rect { y: screen.y + screen.height.saturating_sub(3) / 2, height: screen.height.min(2), ..screen };
    frame.render_widget(Paragraph::new(Text::from(text)).alignment(Alignment::Center), middle);
    let below = screen.height.min(1);
    let line = Rect { y: screen.bottom() - below, height: below, ..screen };
    let said = screen.height > 2 || matches!(state.mode, Mode::Line(_));
    let cursor = if said { panes::line::draw(state, line, frame.buffer_mut()) } else { None };
    frame.set_cursor_position(cursor.unwrap_or(Position::new(screen.x, screen.y)));
}
