//! The picture: as pixels if the terminal takes them, else in half-blocks (two dots per cell) under outlines, regions, anchors
//! and the cursor. Without colors each cell is a character of some darkness.

use crate::tui::layout;
use kurbo::{Point, Vec2};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};

use super::{arrow, write};
use crate::base::number::rounded;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Dot, Legend, Mark, Shape};
use crate::layers::parts::picking::Subject;
use crate::render::overlay;
use crate::render::part::Part;
use crate::tui::graphics::clip::square;
use crate::tui::graphics::{Protocol, TerminalPicture, viewport};
use crate::tui::layout::picture;
use crate::tui::state::painting::{self, Painting, Sees};
use crate::tui::state::{Mode, Pane, State, place};
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
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
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
        None => draw_blocks(state, &part, area, buffer),
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
pub fn give_way(state: &State, buffer: &mut Buffer) {
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
    draw_blocks(state, &part, area, &mut blocks);
    for at in free {
        if let (Some(there), Some(cell)) = (buffer.cell_mut(at), blocks.cell(at)) {
            there.clone_from(cell);
        }
    }
}

fn draw_blocks(state: &State, part: &Part, area: Rect, buffer: &mut Buffer) {
    // In half-blocks, whatever the protocol in use.
    let scale = part.scale * part.dots.0 as f64 / f64::from(area.width);
    let part = Part { scale, dots: (area.width.into(), usize::from(area.height) * 2), ..*part };
    if let Some(shown) = &state.picture.latest {
        draw_pixels(shown, &part, state.depth, area, buffer);
    }
    draw_marks(state, &part, area, buffer);
    let (x, half) = cell(&part, state.picture.cursor);
    let style = Style::new().fg(Color::Reset).bg(Color::Reset).add_modifier(Modifier::REVERSED);
    write(buffer, area, x as i32, half.div_euclid(2).max(0) as u16, "┼", style);
}

/// The column and the half row of a place in the picture.
fn cell(part: &Part, at: Point) -> (i64, i64) {
    let dot = part.dot_of(at);
    let whole = |v: f64| v.floor().clamp(-1e9, 1e9) as i64;
    (whole(dot.x), whole(dot.y))
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

/// Draws outlines, regions, curves, anchors and their jumps, the selected ones on top.
fn draw_marks(state: &State, part: &Part, area: Rect, buffer: &mut Buffer) {
    let synth = state.picture.synth.as_deref();
    let mut marks = match state.picture.looking {
        Some(looking) => vec![square(state.picture.cursor, looking.side)],
        None if picture::sees(state) != Sees::Results => Vec::new(),
        None => overlay::overlay(state.document().scene(), synth, &picture::overlays(state)),
    };
    marks.sort_by_key(|mark| mark.selected);
    let over = state.picture.latest.iter().flat_map(|shown| &shown.over);
    for mark in over.chain(&marks) {
        draw_mark(mark, state.depth, part, area, buffer);
    }
    if let (Mode::Aim, Some(from)) = (&state.typing.mode, place::selected(state)) {
        let style = Style::new().add_modifier(Modifier::BOLD);
        line(from, state.picture.cursor, part, |x, half| put(buffer, area, x, half, "•", style));
    }
}

fn draw_mark(mark: &Mark, depth: Depth, part: &Part, area: Rect, buffer: &mut Buffer) {
    let [r, g, b, _] = mark.color();
    let style = depth.color([r, g, b]).map_or(Style::new(), |ink| Style::new().fg(ink));
    let style = if mark.selected { style.add_modifier(Modifier::BOLD) } else { style };
    let glyph = mark.look.stroke;
    match &mark.shape {
        Shape::Cell(at, ..) => {
            let (x, half) = cell(part, *at);
            put(buffer, area, x, half, glyph, style);
        }
        Shape::Line { points, closed } => {
            let last = points.last().filter(|_| *closed);
            let from = last.into_iter().chain(points);
            let to = points.iter().skip(usize::from(!closed));
            for (&from, &to) in from.zip(to) {
                line(from, to, part, |x, half| put(buffer, area, x, half, glyph, style));
            }
        }
        Shape::Dot(at) => {
            let glyph = match (mark.look.dot, mark.selected) {
                (Dot::Disc, false) => "o",
                (Dot::Disc, true) => "●",
                (Dot::Square, false) => "□",
                (Dot::Square, true) => "■",
                (Dot::Diamond, false) => "◇",
                (Dot::Diamond, true) => "◆",
            };
            let (x, half) = cell(part, *at);
            put(buffer, area, x, half, glyph, style);
        }
        Shape::Arrow(from, to) => {
            line(*from, *to, part, |x, half| put(buffer, area, x, half, glyph, style));
            let (x, half) = cell(part, *to);
            put(buffer, area, x, half, arrow(Vec2::new(to.x - from.x, to.y - from.y)), style);
        }
        Shape::Fill(_) | Shape::Label(..) => {}
    }
}

/// Writes a glyph over the picture, keeping the color behind it.
fn put(buffer: &mut Buffer, area: Rect, x: i64, half: i64, glyph: &str, style: Style) {
    let y = half.div_euclid(2);
    if (0..i64::from(area.width)).contains(&x) && (0..i64::from(area.height)).contains(&y) {
        let at = Position::new(area.x + x as u16, area.y + y as u16);
        if let Some(cell) = buffer.cell_mut(at) {
            let ground = if cell.symbol() == "▀" && half.rem_euclid(2) == 0 { cell.fg } else { cell.bg };
            cell.set_symbol(glyph).set_style(style.bg(ground));
        }
    }
}

/// Calls `put` for every half-block on a line.
fn line(from: Point, to: Point, part: &Part, mut each: impl FnMut(i64, i64)) {
    let Some((a, b)) = viewport::clipped(part.dot_of(from), part.dot_of(to), part.dots) else { return };
    let steps = (b - a).hypot2().sqrt().ceil().max(1.0);
    for i in 0..=steps as u32 {
        let dot = a.lerp(b, f64::from(i) / steps);
        each(dot.x.floor() as i64, dot.y.floor() as i64);
    }
}
