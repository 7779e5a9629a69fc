//! Draws the screen, at every size from 60 x 20 on. Drawing changes nothing.

use crate::tui::layout;
use crate::tui::layout::{areas_of, middle, picture_in_middle};
use crate::tui::state::{LEAST, fits};
use ratatui::Frame;
use ratatui::layout::{Alignment, Position, Rect};
use ratatui::symbols::merge::MergeStrategy;
use ratatui::text::{Line, Text};
use ratatui::widgets::{Block, Paragraph, Widget};

use crate::tui::panes;
use crate::tui::panes::marks::Kept;
use crate::tui::state::{Mode, Pane, State};
use crate::tui::text::color;

/// Draws the screen, with what is kept from one drawing to the next.
pub fn draw(frame: &mut Frame, state: &State, kept: &mut Kept) {
    let screen = frame.area();
    if !fits((screen.width, screen.height)) {
        return too_small(frame, state, screen);
    }
    // The terminal has another size by now, and the event that tells it is on its way.
    if (screen.width, screen.height) != state.size {
        return;
    }
    if let Some(tutor) = &state.tutor {
        panes::lesson::draw(tutor, &state.keymap, screen, frame.buffer_mut());
    }
    let screen = layout::lesson::above(state, screen);
    let areas = areas_of(state);
    let mut cursor = None;
    if !areas.tree.is_empty() {
        cursor = panes::tree::draw(state, pane(frame, state, areas.tree, Pane::Tree, "scene"), frame.buffer_mut());
    }
    if areas.table.is_empty() {
        // The tree has the whole screen.
    } else if picture_in_middle(state, &areas) {
        let inner = pane(frame, state, middle(state, &areas), Pane::Picture, &panes::picture::title(state));
        cursor = panes::picture::draw(state, kept, inner, frame.buffer_mut()).or(cursor);
    } else {
        let inner = pane(frame, state, areas.table, Pane::Table, &panes::table::title(state));
        cursor = panes::table::draw(state, inner, frame.buffer_mut()).or(cursor);
        if !state.picture.probing {
            let inner = block(frame, areas.detail, "");
            panes::detail::draw(state, inner, frame.buffer_mut());
        }
    }
    if state.picture.probing && !areas.detail.is_empty() {
        let inner = block(frame, areas.detail, "probe");
        panes::probe::draw(state, inner, frame.buffer_mut());
    }
    if let Some([field, position]) = areas.plots {
        let inner = block(frame, field, "field");
        panes::field::draw(state, inner, frame.buffer_mut());
        let inner = block(frame, position, "position");
        panes::position::draw(state, inner, frame.buffer_mut());
    }
    if let Some(sketch) = areas.sketch {
        let inner = block(frame, sketch, "sketch");
        panes::sketch::draw(state, inner, frame.buffer_mut());
    }
    if let Some(picture) = areas.picture {
        let inner = pane(frame, state, picture, Pane::Picture, &panes::picture::title(state));
        cursor = panes::picture::draw(state, kept, inner, frame.buffer_mut()).or(cursor);
    }
    legend(frame, state);
    panes::status::draw(state, areas.status, frame.buffer_mut());
    cursor = panes::line::draw(state, areas.line, frame.buffer_mut()).or(cursor);
    cursor = panes::popup::draw(state, screen, frame.buffer_mut()).or(cursor);
    panes::picture::give_way(state, kept, frame.buffer_mut());
    if let Some(cursor) = cursor {
        frame.set_cursor_position(cursor);
    }
}

/// The frame of a pane that can have the focus; the one that has it shows `>` and a bold title.
fn pane(frame: &mut Frame, state: &State, area: Rect, which: Pane, title: &str) -> Rect {
    let focused = state.cursor.focus == which;
    let title = Line::from(format!("{}{title} ", if focused { ">" } else { " " }));
    let title = if focused { title.style(color::strong()) } else { title };
    bordered(frame, area, title)
}

/// The legend of the vector field, in the border below the picture.
fn legend(frame: &mut Frame, state: &State) {
    if let (Some(area), Some(legend)) = (layout::picture_area(state), panes::picture::legend(state)) {
        let border = Rect { y: area.bottom(), height: 1, ..area };
        panes::write(frame.buffer_mut(), border, 0, 0, &legend, color::faint());
    }
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

/// Draws what is shown on a terminal that is too small, with the line in which `:q` can be typed.
fn too_small(frame: &mut Frame, state: &State, screen: Rect) {
    let text = format!("Plica needs {} x {}\nthis is {} x {}", LEAST.0, LEAST.1, screen.width, screen.height);
    let middle = Rect { y: screen.y + screen.height.saturating_sub(3) / 2, height: screen.height.min(2), ..screen };
    frame.render_widget(Paragraph::new(Text::from(text)).alignment(Alignment::Center), middle);
    let below = screen.height.min(1);
    let line = Rect { y: screen.bottom() - below, height: below, ..screen };
    let said = screen.height > 2 || matches!(state.typing.mode, Mode::Line(_));
    let cursor = if said { panes::line::draw(state, line, frame.buffer_mut()) } else { None };
    frame.set_cursor_position(cursor.unwrap_or(Position::new(screen.x, screen.y)));
}
