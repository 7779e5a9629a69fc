//! The picture: as pixels if the terminal takes them, else in half-blocks (two dots per cell) under outlines, regions, anchors
//! and the cursor. Without colors each cell is a character of some darkness.

use crate::tui::layout;
use kurbo::Point;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};

use super::marks::{self, Canvas, Kept};
use super::write;
use crate::base::number::rounded;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::Legend;
use crate::layers::parts::picking::Subject;
use crate::render::overlay;
use crate::render::part::Part;
use crate::tui::graphics::{Protocol, TerminalPicture, viewport};
use crate::tui::layout::picture;
use crate::tui::state::painting::{self, Painting, Sees};
use crate::tui::state::{Pane, State};
use crate::tui::text::color;
use crate::tui::text::color::Depth;
use crate::tui::text::numbers::{polar, short};
use crate::tui::text::plain;

/// The title: the cursor's coordinates, the scale, and the protocol.
pub fn title(state: &State) -> String {
    let at = state.picture.cursor;
    let part = picture::part(state);
    let scale = part.map(|part| format!("  {}", viewport::words(part.scale))).unwrap_or_default();
    let fit = if state.picture.viewport.zoom.is_none() { " fit" } else { "" };
    let reduced = state.picture.latest.as_ref().filter(|shown| shown.by > 1).map(|shown| format!(" /{}", shown.by));
    let protocol = picture::protocol(state).name();
    let pass = state
        .picture
        .pass
        .as_ref()
        .map(|asked| format!(" {}", asked.words(state.document().scene())))
        .unwrap_or_default();
    let what = match state.picture.looking.map(|looking| (looking.sight(), looking.frames)) {
        Some((Subject::Frame(frame), frames)) => format!("clip {frame} of {frames}"),
        Some((Subject::Cut(frame), frames)) => format!("cut out of {frame} of {frames}"),
        Some((Subject::Sheet, _)) => "all that is cut out".into(),
        None => match (state.picture.painting, painting::current(state)) {
            (Some(Painting { sees: Sees::Painting, share, .. }), Some((.., name))) => {
                format!("painting {}, {:.0} % of it", plain(&name), share * 100.0)
            }
            (Some(Painting { sees: Sees::Select, .. }), _) => match painting::degrees(state) {
                Some([right, up]) => format!("select  {}° right {}° up", short(right), short(up)),
                None => "select".into(),
            },
            (Some(_), _) => format!("results{pass}"),
            (None, _) => format!("picture{pass}{}", lying(state)),
        },
    };
    format!("{what}  x {} y {}{scale}{fit}  {protocol}{}", short(at.x), short(at.y), reduced.unwrap_or_default())
}

/// What is said where the editor's cursor is in a layer that is only seen on others, which has no marks in the frame.
fn lying(state: &State) -> String {
    let scene = state.document().scene();
    let layer = Pointer(&state.cursor.node).item_of("/layers").map(|(layer, _)| layer);
    let lying = layer.filter(|layer| scene.textures().contains(layer)).and_then(|layer| scene.layers.get(layer));
    lying.map(|layer| format!(", {} lies on another layer", plain(layer.technique().name()))).unwrap_or_default()
}

/// Draws the picture; the terminal's cursor is on the picture's cursor if the picture has the focus.
pub fn draw(state: &State, kept: &mut Kept, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let Some(part) = picture::part(state).filter(|_| area.width > 0 && area.height > 0) else {
        write(buffer, area, 1, 0, "no picture yet", color::faint());
        return (state.cursor.focus == Pane::Picture).then(|| area.as_position());
    };
    match pixels(state, area) {
        Some(cells) => {
            for (at, cell) in area.positions().zip(cells.content()) {
                buffer.cell_mut(at).into_iter().for_each(|there| there.clone_from(cell));
            }
        }
        None => draw_blocks(state, kept, &part, area, buffer),
    }
    let cursor = picture::cursor_cell(state, &part);
    let within = |cell: f64, cells: u16| cell.clamp(0.0, f64::from(cells - 1)) as u16;
    let cursor = Position::new(area.x + within(cursor.x, area.width), area.y + within(cursor.y, area.height));
    (state.cursor.focus == Pane::Picture).then_some(cursor)
}

/// What the arrows and colors of the vector field mean, and the jump vector under the cursor; nothing where none of it is shown
/// or legends are hidden.
pub fn legend(state: &State) -> Option<String> {
    let shown = state.picture.latest.as_ref().filter(|_| state.picture.switches.is_on("view-legends"))?;
    let (view, reach) = (&shown.wanted.over, shown.reach);
    let has = |legend| overlay::overlays().any(|overlay| overlay.legend == Some(legend) && view.shows(overlay.name));
    let [arrows, lines, colors] = [Legend::Arrows, Legend::Lines, Legend::Colors].map(has);
    let (longest, every) = (short(rounded(reach.longest_px, 2)), short(view.spacing_px));
    let mut parts = Vec::new();
    if arrows {
        let how = if view.vectors.equal { "equal".into() } else { format!("to {longest} px") };
        parts.push(format!("arrows {how} every {every}"));
    }
    match view.vectors.scale(reach) {
        Some((_, [least, most])) if arrows || lines || colors => {
            parts.push(format!("{} {least} to {most}", view.vectors.color.name()));
        }
        None if colors => parts.push(format!("directions to {longest} px")),
        _ => {}
    }
    let jump = state.picture.synth.as_ref().and_then(|synth| overlay::jump_at(synth, state.picture.cursor));
    if let Some(jump) = jump.filter(|_| arrows || lines || colors) {
        let (length, degrees) = polar(jump);
        let [x, y, length] = [jump.x, jump.y, length].map(|number| short(rounded(number, 2)));
        parts.push(format!("here {x}, {y}  {length} px {}°", short(rounded(degrees, 1))));
    }
    (!parts.is_empty()).then(|| format!(" {} ", parts.join("  ")))
}

/// The cells with the picture as pixels, if there are such cells for a pane of this size.
fn pixels(state: &State, area: Rect) -> Option<&Buffer> {
    let shown = state.picture.latest.as_ref()?;
    let fits = shown.wanted.cells == (area.width, area.height) && shown.wanted.protocol == picture::protocol(state);
    shown.cells.as_ref().filter(|_| fits)
}

/// Replaces the pixels by half-blocks if something was drawn over them, because a picture that is sent as a whole would hide
/// it. Kitty's placeholders are characters like others and can stay.
pub fn give_way(state: &State, kept: &mut Kept, buffer: &mut Buffer) {
    let Some(area) = layout::picture_area(state).filter(|_| picture::protocol(state) != Protocol::Kitty) else {
        return;
    };
    let (Some(cells), Some(part)) = (pixels(state, area), picture::part(state)) else { return };
    let free = |(at, cell): &(Position, &_)| buffer.cell(*at) == Some(*cell);
    let free: Vec<Position> = area.positions().zip(cells.content()).filter(free).map(|(at, _)| at).collect();
    if free.len() == cells.content().len() {
        return;
    }
    let mut blocks = Buffer::empty(area);
    draw_blocks(state, kept, &part, area, &mut blocks);
    for at in free {
        if let (Some(there), Some(cell)) = (buffer.cell_mut(at), blocks.cell(at)) {
            there.clone_from(cell);
        }
    }
}

fn draw_blocks(state: &State, kept: &mut Kept, part: &Part, area: Rect, buffer: &mut Buffer) {
    // In half-blocks, whatever the protocol in use.
    let scale = part.scale * part.dots.0 as f64 / f64::from(area.width);
    let part = Part { scale, dots: (area.width.into(), usize::from(area.height) * 2), ..*part };
    if let Some(shown) = &state.picture.latest {
        draw_pixels(shown, &part, state.depth, area, buffer);
    }
    let canvas = Canvas { part, area, depth: state.depth };
    marks::draw(state, kept, &canvas, buffer);
    let (x, half) = canvas.cell(state.picture.cursor);
    let style = Style::new().fg(Color::Reset).bg(Color::Reset).add_modifier(Modifier::REVERSED);
    write(buffer, area, x as i32, half.div_euclid(2).max(0) as u16, "┼", style);
}

fn draw_pixels(shown: &TerminalPicture, part: &Part, depth: Depth, area: Rect, buffer: &mut Buffer) {
    for (x, y) in (0..area.height).flat_map(|y| (0..area.width).map(move |x| (x, y))) {
        let dot = |lower: f64| Point::new(f64::from(x) + 0.5, f64::from(y) * 2.0 + lower + 0.5);
        let half = |lower: f64| shown.color_at(part.place_of(dot(lower)));
        let Some(cell) = buffer.cell_mut(Position::new(area.x + x, area.y + y)) else { continue };
        let paint = |rgb: Option<[u8; 3]>| rgb.and_then(|rgb| depth.color(rgb)).unwrap_or(Color::Reset);
        match (half(0.0), half(1.0)) {
            (None, None) => {}
            (upper, lower) if depth == Depth::None => {
                cell.set_char(color::shade(both(upper, lower)));
            }
            (None, lower) => {
                cell.set_symbol("▄").set_style(Style::new().fg(paint(lower)));
            }
            (upper, None) => {
                cell.set_symbol("▀").set_style(Style::new().fg(paint(upper)));
            }
            (upper, lower) => {
                cell.set_symbol("▀").set_style(Style::new().fg(paint(upper)).bg(paint(lower)));
            }
        }
    }
}

fn both(upper: Option<[u8; 3]>, lower: Option<[u8; 3]>) -> [u8; 3] {
    match (upper, lower) {
        (Some(a), Some(b)) => std::array::from_fn(|i| ((u16::from(a[i]) + u16::from(b[i])) / 2) as u8),
        (one, other) => one.or(other).unwrap_or_default(),
    }
}
