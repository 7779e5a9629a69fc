//! Dots in braille characters, eight per cell. A cell has the style of the dot that was set last.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::write;

/// A grid of dots.
pub struct Braille {
    width: usize,
    cells: Vec<(u8, Style)>,
}

impl Braille {
    /// An empty grid of so many cells.
    pub fn new(width: usize, height: usize) -> Self {
        Braille { width, cells: vec![(0, Style::new()); width * height] }
    }

    /// Sets a dot; dots beyond the grid are ignored.
    pub fn set(&mut self, x: usize, y: usize, style: Style) {
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        if let (true, Some(cell)) = (x / 2 < self.width, self.cells.get_mut(y / 4 * self.width + x / 2)) {
            *cell = (cell.0 | BITS[y % 4][x % 2], style);
        }
    }

    /// Draws the cells that have dots.
    pub fn draw(&self, area: Rect, buffer: &mut Buffer) {
        for (i, &(bits, style)) in self.cells.iter().enumerate().filter(|(_, cell)| cell.0 != 0) {
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
        [(0, 0), (3, 3), (9, 9)].into_iter().for_each(|(x, y)| braille.set(x, y, Style::new()));
        let mut buffer = Buffer::empty(Rect::new(0, 0, 2, 1));
        braille.draw(buffer.area, &mut buffer);
        assert_eq!(buffer.content()[0].symbol(), "⠁");
        assert_eq!(buffer.content()[1].symbol(), "⢀");
    }
}
