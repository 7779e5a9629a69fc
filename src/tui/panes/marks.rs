//! Marks over the picture in half-blocks. Those of the document are kept as the glyphs that they come to, at most one a cell, so
//! that a key that moves the cursor draws what is selected and not ten thousand anchors.

use std::sync::Arc;

use kurbo::{Point, Vec2};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::arrow;
use crate::layers::parts::marks::{Dot, Mark, Shape, View};
use crate::render::overlay;
use crate::render::part::Part;
use crate::scene::Scene;
use crate::tui::graphics::clip::square;
use crate::tui::graphics::viewport;
use crate::tui::layout::picture;
use crate::tui::state::painting::Sees;
use crate::tui::state::{Mode, State, place};
use crate::tui::text::color::Depth;

/// Which part of the picture is seen, in which cells of the screen, in how many colors.
#[derive(Clone, Copy, PartialEq)]
pub struct Canvas {
    /// The part, in half-blocks.
    pub part: Part,
    /// The cells.
    pub area: Rect,
    /// The colors.
    pub depth: Depth,
}

/// A character over the picture: its column and its half row in the pane.
#[derive(Clone, Copy)]
struct Glyph {
    at: (i64, i64),
    symbol: &'static str,
    style: Style,
}

/// The marks of the document as they were drawn last.
#[derive(Default)]
pub struct Kept {
    made_for: Option<(Arc<Scene>, View, Canvas)>,
    /// None of them selected.
    marks: Vec<Mark>,
    /// What is seen of them.
    glyphs: Vec<Glyph>,
}

impl Kept {
    /// Makes them again if something that they show has changed.
    fn follow(&mut self, scene: &Arc<Scene>, view: View, canvas: &Canvas) {
        let is_made =
            |(of, seen, on): &(Arc<Scene>, View, Canvas)| Arc::ptr_eq(of, scene) && *seen == view && on == canvas;
        if !self.made_for.as_ref().is_some_and(is_made) {
            self.marks = overlay::overlay(scene, None, &view);
            self.glyphs = canvas.seen(&self.marks);
            self.made_for = Some((scene.clone(), view, *canvas));
        }
    }
}

/// Draws outlines, regions, curves, anchors and their jumps, the selected ones on top.
pub fn draw(state: &State, kept: &mut Kept, canvas: &Canvas, buffer: &mut Buffer) {
    let over = state.picture.latest.iter().flat_map(|shown| &shown.over);
    over.for_each(|mark| canvas.draw(mark, buffer));
    match state.picture.looking {
        Some(looking) => canvas.draw(&square(state.picture.cursor, looking.side), buffer),
        None if picture::sees(state) != Sees::Results => {}
        None => {
            let view = View { selection: None, ..picture::overlays(state) };
            kept.follow(state.document().scene(), view, canvas);
            kept.glyphs.iter().for_each(|glyph| canvas.put(*glyph, buffer));
            let selection = state.focused();
            let belongs = overlay::belongs(&selection);
            let selected = kept.marks.iter().filter(|mark| belongs(mark));
            selected.for_each(|mark| canvas.draw(&Mark { selected: true, ..mark.clone() }, buffer));
        }
    }
    if let (Mode::Aim, Some(from)) = (&state.typing.mode, place::selected(state)) {
        let style = Style::new().add_modifier(Modifier::BOLD);
        canvas.line(from, state.picture.cursor, |at| canvas.put(Glyph { at, symbol: "•", style }, buffer));
    }
}

impl Canvas {
    /// The column and the half row of a place in the picture.
    pub fn cell(&self, at: Point) -> (i64, i64) {
        let dot = self.part.dot_of(at);
        let whole = |v: f64| v.floor().clamp(-1e9, 1e9) as i64;
        (whole(dot.x), whole(dot.y))
    }

    /// What is seen of marks: in each cell the last glyph, over the half that the first one was over.
    fn seen(&self, marks: &[Mark]) -> Vec<Glyph> {
        let (width, height) = (usize::from(self.area.width), usize::from(self.area.height));
        let mut cells: Vec<Option<Glyph>> = vec![None; width * height];
        for mark in marks {
            self.glyphs(mark, &mut |glyph| {
                let Some((x, y)) = self.place(glyph.at) else { return };
                let cell = &mut cells[usize::from(y) * width + usize::from(x)];
                let at = cell.map_or(glyph.at, |first| first.at);
                *cell = Some(Glyph { at, ..glyph });
            });
        }
        cells.into_iter().flatten().collect()
    }

    fn draw(&self, mark: &Mark, buffer: &mut Buffer) {
        self.glyphs(mark, &mut |glyph| self.put(glyph, buffer));
    }

    /// Calls `each` for every glyph of a mark, also beyond the pane.
    fn glyphs(&self, mark: &Mark, each: &mut impl FnMut(Glyph)) {
        let [r, g, b, _] = mark.color();
        let style = self.depth.color([r, g, b]).map_or(Style::new(), |ink| Style::new().fg(ink));
        let style = if mark.selected { style.add_modifier(Modifier::BOLD) } else { style };
        let mut put = |at, symbol| each(Glyph { at, symbol, style });
        let stroke = mark.look.stroke;
        match &mark.shape {
            Shape::Cell(at, ..) => put(self.cell(*at), stroke),
            Shape::Line { points, closed } => {
                let last = points.last().filter(|_| *closed);
                let from = last.into_iter().chain(points);
                let to = points.iter().skip(usize::from(!closed));
                from.zip(to).for_each(|(&from, &to)| self.line(from, to, |at| put(at, stroke)));
            }
            Shape::Dot(at) => {
                let symbol = match (mark.look.dot, mark.selected) {
                    (Dot::Disc, false) => "o",
                    (Dot::Disc, true) => "●",
                    (Dot::Square, false) => "□",
                    (Dot::Square, true) => "■",
                    (Dot::Diamond, false) => "◇",
                    (Dot::Diamond, true) => "◆",
                };
                put(self.cell(*at), symbol);
            }
            Shape::Arrow(from, to) => {
                self.line(*from, *to, |at| put(at, stroke));
                put(self.cell(*to), arrow(Vec2::new(to.x - from.x, to.y - from.y)));
            }
            Shape::Fill(_) | Shape::Label(..) => {}
        }
    }

    /// Calls `each` for every half-block on a line.
    fn line(&self, from: Point, to: Point, mut each: impl FnMut((i64, i64))) {
        let [from, to] = [from, to].map(|at| self.part.dot_of(at));
        let Some((a, b)) = viewport::clipped(from, to, self.part.dots) else { return };
        let steps = (b - a).hypot2().sqrt().ceil().max(1.0);
        for i in 0..=steps as u32 {
            let dot = a.lerp(b, f64::from(i) / steps);
            each((dot.x.floor() as i64, dot.y.floor() as i64));
        }
    }

    /// The column and the row of a half-block in the pane; `None` beyond it.
    fn place(&self, (x, half): (i64, i64)) -> Option<(u16, u16)> {
        let within = |at: i64, cells: u16| u16::try_from(at).ok().filter(|at| *at < cells);
        Some((within(x, self.area.width)?, within(half.div_euclid(2), self.area.height)?))
    }

    /// Writes a glyph over the picture, keeping the color behind it.
    fn put(&self, glyph: Glyph, buffer: &mut Buffer) {
        let place = self.place(glyph.at).map(|(x, y)| Position::new(self.area.x + x, self.area.y + y));
        if let Some(cell) = place.and_then(|at| buffer.cell_mut(at)) {
            let ground = if cell.symbol() == "▀" && glyph.at.1.rem_euclid(2) == 0 { cell.fg } else { cell.bg };
            cell.set_symbol(glyph.symbol).set_style(glyph.style.bg(ground));
        }
    }
}

#[cfg(test)]
mod tests {
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    use super::*;
    use crate::tui::panes::view;
    use crate::tui::tests::screens::{opened, see};
    use crate::tui::tests::support::press;

    fn cells(state: &State, kept: &mut Kept) -> Buffer {
        let mut terminal = Terminal::new(TestBackend::new(state.size.0, state.size.1)).unwrap();
        terminal.draw(|frame| view::draw(frame, state, kept)).unwrap().buffer.clone()
    }

    #[test]
    fn what_is_kept_is_what_would_be_drawn() {
        let mut state = opened((160, 48));
        let (mut kept, mut before) = (Kept::default(), Buffer::default());
        for keys in ["/ \"motion\" Enter Enter", "j", "l +", "u", "z a", "z a", "g i l", "z +", "z f", "Esc g t"] {
            press(&mut state, keys);
            see(&mut state);
            let drawn = cells(&state, &mut kept);
            assert_eq!(drawn, cells(&state, &mut Kept::default()), "{keys}");
            assert_ne!(drawn, before, "{keys}");
            before = drawn;
        }
    }

    #[test]
    fn moving_the_cursor_makes_no_marks() {
        let mut state = opened((160, 48));
        press(&mut state, "/ \"motion\" Enter Enter");
        let mut kept = Kept::default();
        for (keys, makes) in [("", true), ("j", false), ("l", false), ("+", true), ("g i", false), ("z +", true)] {
            press(&mut state, keys);
            kept.marks.clear();
            cells(&state, &mut kept);
            assert_eq!(!kept.marks.is_empty(), makes, "{keys}");
        }
    }
}
