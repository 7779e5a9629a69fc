//! The position function of the zone that is shown: s over the whole timeline as a curve in braille, the present marked.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};

use super::status::clock;
use super::write;
use crate::tui::app::State;
use crate::tui::colour;
use crate::tui::numbers::short;

/// Draws it: the greatest s at the top left, the least at the bottom left, a line and a dot at t.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let Some(clock) = clock(state) else {
        write(buffer, area, 1, 0, "select a zone", colour::faint());
        return;
    };
    if area.width < 4 || area.height < 2 {
        return;
    }
    let columns = usize::from(area.width) * 2;
    let curve: Vec<f64> = (0..columns).map(|x| clock.s(x as f64 / (columns - 1) as f64)).collect();
    let (mut low, mut high) = curve.iter().fold((0.0f64, 0.0f64), |(low, high), &s| (low.min(s), high.max(s)));
    if low == high {
        (low, high) = (low - 0.5, high + 0.5);
    }
    let dots = usize::from(area.height) * 4;
    let row = |s: f64| ((high - s) / (high - low) * (dots - 1) as f64).round().clamp(0.0, (dots - 1) as f64) as usize;
    let mut braille = Braille::new(area.width.into(), area.height.into());
    for (x, pair) in curve.windows(2).enumerate() {
        let (from, to) = (row(pair[0]), row(pair[1]));
        // A jump in s is left open; a steep stretch is drawn through.
        if from.abs_diff(to) * 3 < dots * 2 {
            (from.min(to)..=from.max(to)).for_each(|y| braille.set(x + 1, y));
        }
        braille.set(x, from);
    }
    let zero = row(0.0);
    (0..columns).step_by(4).for_each(|x| braille.set(x, zero));
    let style = state.depth.ink(Style::new(), Color::Cyan);
    braille.draw(area, style, buffer);
    let now = (state.time.clamp(0.0, 1.0) * f64::from(area.width - 1)).round() as i32;
    for y in 0..area.height {
        write(buffer, area, now, y, "┊", colour::faint());
    }
    let s = clock.s(state.time);
    write(buffer, area, now, (row(s) / 4) as u16, "●", colour::strong());
    write(buffer, area, 0, 0, &short(high), colour::faint());
    write(buffer, area, 0, area.height - 1, &short(low), colour::faint());
}

/// Dots, eight a cell.
struct Braille {
    width: usize,
    cells: Vec<u8>,
}

impl Braille {
    fn new(width: usize, height: usize) -> Self {
        Braille { width, cells: vec![0; width * height] }
    }

    fn set(&mut self, x: usize, y: usize) {
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        if let (true, Some(cell)) = (x / 2 < self.width, self.cells.get_mut(y / 4 * self.width + x / 2)) {
            *cell |= BITS[y % 4][x % 2];
        }
    }

    fn draw(&self, area: Rect, style: Style, buffer: &mut Buffer) {
        for (i, &bits) in self.cells.iter().enumerate().filter(|&(_, &bits)| bits != 0) {
            let glyph = char::from_u32(0x2800 + u32::from(bits)).unwrap_or(' ').to_string();
            write(buffer, area, (i % self.width) as i32, (i / self.width) as u16, &glyph, style);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_stand_where_they_are_set() {
        let mut braille = Braille::new(2, 1);
        braille.set(0, 0);
        braille.set(3, 3);
        braille.set(9, 9);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 2, 1));
        braille.draw(buffer.area, Style::new(), &mut buffer);
        assert_eq!(buffer.content()[0].symbol(), "⠁");
        assert_eq!(buffer.content()[1].symbol(), "⢀");
    }
}
