//! The picture in half-blocks, two pixels a cell, with outlines, anchors and the placing cursor over it. Without colours
//! each cell is a shade.

use kurbo::Point;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};

use super::write;
use crate::base::pixels::Frame;
use crate::render::overlay::{self, Dot, Mark, Shape, View};
use crate::tui::app::{Mode, Pane, State};
use crate::tui::colour::{self, Depth};
use crate::tui::numbers::short;
use crate::tui::place::{self, Placing};

/// What of the picture is in sight: image pixels of the top left corner, and image pixels a half-block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The corner.
    pub corner: Point,
    /// Image pixels a half-block, both ways.
    pub scale: f64,
}

impl Sight {
    /// All of the picture in the middle; zoomed in, the part around the cursor.
    pub fn of(placing: &Placing, (width, height): (usize, usize), columns: u16, rows: u16) -> Sight {
        let (columns, halves) = (f64::from(columns.max(1)), f64::from(rows.max(1)) * 2.0);
        let fit = (width as f64 / columns).max(height as f64 / halves).max(1e-6);
        let scale = fit / f64::from(1u32 << placing.zoom.clamp(0, 20));
        let edge = |cursor: f64, size: f64, cells: f64| {
            let seen = cells * scale;
            if seen >= size { (size - seen) / 2.0 } else { (cursor - seen / 2.0).clamp(0.0, size - seen) }
        };
        let x = edge(placing.cursor.x, width as f64, columns);
        Sight { corner: Point::new(x, edge(placing.cursor.y, height as f64, halves)), scale }
    }

    /// The column and the half-row of a place in the picture.
    fn cell(&self, at: Point) -> (i64, i64) {
        let of = |v: f64| (v / self.scale).floor().clamp(-1e9, 1e9) as i64;
        (of(at.x - self.corner.x), of(at.y - self.corner.y))
    }
}

/// The cursor's coordinates, and the zoom.
pub fn title(state: &State) -> String {
    let at = state.placing.cursor;
    let zoom = if state.placing.zoom > 0 { format!("  {}x", 1u64 << state.placing.zoom) } else { String::new() };
    format!("picture  x {} y {}{zoom}", short(at.x), short(at.y))
}

/// Draws it; the real cursor is on the placing cursor where the picture has the focus.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let Some(size) = state.picture_size.filter(|_| area.width > 0 && area.height > 0) else {
        write(buffer, area, 1, 0, "no picture yet", colour::faint());
        return (state.focus == Pane::Picture).then(|| area.as_position());
    };
    let sight = Sight::of(&state.placing, size, area.width, area.height);
    if let Some(frame) = &state.seen.frame {
        draw_pixels(frame, sight, state.depth, area, buffer);
    }
    draw_marks(state, sight, area, buffer);
    let (x, half) = sight.cell(state.placing.cursor);
    let (x, y) = (x.clamp(0, i64::from(area.width) - 1), (half / 2).clamp(0, i64::from(area.height) - 1));
    let style = Style::new().fg(Color::Reset).bg(Color::Reset).add_modifier(Modifier::REVERSED);
    write(buffer, area, x as i32, y as u16, "┼", style);
    (state.focus == Pane::Picture).then(|| Position::new(area.x + x as u16, area.y + y as u16))
}

fn draw_pixels(frame: &Frame, sight: Sight, depth: Depth, area: Rect, buffer: &mut Buffer) {
    for y in 0..area.height {
        for x in 0..area.width {
            let half = |lower: u16| mean(frame, sight, f64::from(x), f64::from(y * 2 + lower));
            let Some(cell) = buffer.cell_mut(Position::new(area.x + x, area.y + y)) else { continue };
            match (half(0), half(1)) {
                (None, None) => {}
                (upper, lower) if depth == Depth::None => {
                    cell.set_char(colour::shade(both(upper, lower)));
                }
                (upper, lower) => {
                    let paint = |rgb: Option<[u8; 3]>| rgb.and_then(|rgb| depth.colour(rgb)).unwrap_or(Color::Reset);
                    let (symbol, style) = match (upper, lower) {
                        (None, lower) => ("▄", Style::new().fg(paint(lower))),
                        (upper, None) => ("▀", Style::new().fg(paint(upper))),
                        (upper, lower) => ("▀", Style::new().fg(paint(upper)).bg(paint(lower))),
                    };
                    cell.set_symbol(symbol).set_style(style);
                }
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

/// The mean colour of a half-block over a few of its pixels, on a checkerboard where it is transparent; none beyond the
/// picture.
fn mean(frame: &Frame, sight: Sight, x: f64, y: f64) -> Option<[u8; 3]> {
    const PLACES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
    let at = |v: f64, corner: f64, size: usize| {
        let pixel = (corner + v * sight.scale).floor();
        (pixel >= 0.0 && pixel < size as f64).then_some(pixel as usize)
    };
    let (mut sum, mut count) = ([0u32; 3], 0);
    for dy in PLACES {
        for dx in PLACES {
            let i = at(x + dx, sight.corner.x, frame.width());
            let j = at(y + dy, sight.corner.y, frame.height());
            let (Some(i), Some(j)) = (i, j) else { continue };
            let [r, g, b, a] = frame.get(i, j).map(u32::from);
            let ground = if (i / 8 + j / 8) % 2 == 0 { 96 } else { 160 };
            for (sum, code) in sum.iter_mut().zip([r, g, b]) {
                *sum += (code * a + ground * (255 - a)) / 255;
            }
            count += 1;
        }
    }
    (count > 0).then(|| sum.map(|v| (v / count) as u8))
}

/// Outlines, curves, anchors and their jumps, the selected ones on top.
fn draw_marks(state: &State, sight: Sight, area: Rect, buffer: &mut Buffer) {
    let selection = Some(state.focused());
    let view = View { outlines: true, regions: true, anchors: true, curves: true, selection, ..View::default() };
    let mut marks = overlay::overlay(state.document().scene(), state.seen.synth.as_deref(), &view);
    marks.sort_by_key(|mark| mark.selected);
    for mark in &marks {
        draw_mark(mark, state.depth, sight, area, buffer);
    }
    if let (Mode::Aim, Some(from)) = (&state.mode, place::selected(state)) {
        let style = Style::new().add_modifier(Modifier::BOLD);
        line(from, state.placing.cursor, sight, |x, half| put(buffer, area, x, half, "•", style));
    }
}

fn draw_mark(mark: &Mark, depth: Depth, sight: Sight, area: Rect, buffer: &mut Buffer) {
    let [r, g, b, _] = if mark.selected { overlay::SELECTED } else { mark.kind.style().color };
    let style = depth.colour([r, g, b]).map_or(Style::new(), |ink| Style::new().fg(ink));
    let style = if mark.selected { style.add_modifier(Modifier::BOLD) } else { style };
    match &mark.shape {
        Shape::Line { points, closed } => {
            let last = points.last().filter(|_| *closed);
            let from = last.into_iter().chain(points);
            let to = points.iter().skip(usize::from(!closed));
            for (&from, &to) in from.zip(to) {
                line(from, to, sight, |x, half| put(buffer, area, x, half, "·", style));
            }
        }
        Shape::Dot(at) => {
            let glyph = match (mark.kind.style().dot, mark.selected) {
                (Dot::Disc, false) => "o",
                (Dot::Disc, true) => "●",
                (Dot::Square, false) => "□",
                (Dot::Square, true) => "■",
                (Dot::Diamond, false) => "◇",
                (Dot::Diamond, true) => "◆",
            };
            let (x, half) = sight.cell(*at);
            put(buffer, area, x, half, glyph, style);
        }
        Shape::Arrow(from, to) => {
            line(*from, *to, sight, |x, half| put(buffer, area, x, half, "·", style));
            let (x, half) = sight.cell(*to);
            put(buffer, area, x, half, "*", style);
        }
        Shape::Fill(_) | Shape::Label(..) => {}
    }
}

/// Writes a glyph over the picture, on the colour that is there.
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

/// Every half-block that a line meets, within reason.
fn line(from: Point, to: Point, sight: Sight, mut each: impl FnMut(i64, i64)) {
    let steps = ((to - from).hypot2().sqrt() / sight.scale).ceil().clamp(1.0, 4000.0);
    for i in 0..=steps as u32 {
        let (x, half) = sight.cell(from.lerp(to, f64::from(i) / steps));
        each(x, half);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_picture_fits_and_the_zoom_follows_the_cursor() {
        let mut placing = Placing::new(Point::new(390.0, 290.0));
        let sight = Sight::of(&placing, (400, 300), 40, 20);
        assert_eq!((sight.scale, sight.corner), (10.0, Point::new(0.0, -50.0)));
        placing.zoom = 2;
        let sight = Sight::of(&placing, (400, 300), 40, 20);
        assert_eq!((sight.scale, sight.corner), (2.5, Point::new(300.0, 200.0)));
        assert_eq!(sight.cell(placing.cursor), (36, 36));
    }

    #[test]
    fn a_transparent_picture_shows_a_ground() {
        let frame = Frame::filled(8, 8, [255, 0, 0, 0]);
        let sight = Sight { corner: Point::ZERO, scale: 8.0 };
        assert_eq!(mean(&frame, sight, 0.0, 0.0), Some([96; 3]));
        assert_eq!(mean(&frame, sight, 1.0, 0.0), None);
    }
}
