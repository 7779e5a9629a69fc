//! The picture that holds every glyph once, as large as it is drawn: premultiplied, white where the text's color counts, so
//! that glyphs with colors of their own are drawn in the same way.

use cosmic_text::{SwashContent, SwashImage};

/// Pixels in a row.
pub const WIDTH: u32 = 1024;
const FIRST_HEIGHT: u32 = 256;
const MOST_HEIGHT: u32 = 4096;

/// Where a glyph stands in the atlas, and how it lies on its base line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    /// Its corner in the atlas.
    pub texel: [u16; 2],
    /// Its size.
    pub size: [u16; 2],
    /// From the pen to its left edge, in pixels.
    pub left: i32,
    /// From the base line up to its top, in pixels.
    pub top: i32,
}

/// See the top of the file.
pub struct Atlas {
    height: u32,
    /// RGBA.
    pixels: Vec<u8>,
    /// The shelf that is being filled: where it goes on, its top and its height.
    shelf: [u32; 3],
    full: bool,
    /// Rows that changed since they were shown.
    changed: std::ops::Range<u32>,
}

impl Default for Atlas {
    fn default() -> Atlas {
        let pixels = vec![0; (WIDTH * FIRST_HEIGHT * 4) as usize];
        Atlas { height: FIRST_HEIGHT, pixels, shelf: [0; 3], full: false, changed: 0..0 }
    }
}

impl Atlas {
    /// Rows of pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Whether a glyph found no room.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Rows `from..to`, RGBA.
    pub fn rows(&self, rows: &std::ops::Range<u32>) -> &[u8] {
        let at = |row: u32| (row * WIDTH * 4) as usize;
        &self.pixels[at(rows.start)..at(rows.end)]
    }

    /// The rows that changed since this was asked last.
    pub fn take_changed(&mut self) -> std::ops::Range<u32> {
        std::mem::take(&mut self.changed)
    }

    /// Takes a glyph; `None` if it is empty or finds no room.
    pub fn put(&mut self, image: &SwashImage) -> Option<Spot> {
        let (width, height) = (image.placement.width, image.placement.height);
        let [x, y] = self.place(width, height)?;
        let each = match image.content {
            SwashContent::Mask => 1,
            SwashContent::SubpixelMask | SwashContent::Color => 4,
        };
        let whole = image.data.chunks_exact((width as usize * each).max(1));
        for (row, line) in (y..y + height).zip(whole) {
            let at = ((row * WIDTH + x) * 4) as usize;
            let to = self.pixels[at..at + width as usize * 4].chunks_exact_mut(4);
            for (pixel, from) in to.zip(line.chunks_exact(each)) {
                pixel.copy_from_slice(&premultiplied(from));
            }
        }
        self.changed = match self.changed.is_empty() {
            true => y..y + height,
            false => self.changed.start.min(y)..self.changed.end.max(y + height),
        };
        let [texel, size] = [[x, y], [width, height]].map(|pair| pair.map(|n| n as u16));
        Some(Spot { texel, size, left: image.placement.left, top: image.placement.top })
    }

    /// Room for a glyph: on the present shelf, else on a new one.
    fn place(&mut self, width: u32, height: u32) -> Option<[u32; 2]> {
        if width == 0 || height == 0 || width > WIDTH {
            return None;
        }
        let [mut x, mut y, mut high] = self.shelf;
        if x + width > WIDTH {
            (x, y, high) = (0, y + high, 0);
        }
        if y + height > MOST_HEIGHT {
            self.full = true;
            return None;
        }
        while y + height > self.height {
            self.height *= 2;
            self.pixels.resize((WIDTH * self.height * 4) as usize, 0);
        }
        self.shelf = [x + width, y, high.max(height)];
        Some([x, y])
    }
}

fn premultiplied(from: &[u8]) -> [u8; 4] {
    match *from {
        [r, g, b, a] => {
            let times = |code: u8| (u16::from(code) * u16::from(a) / 255) as u8;
            [times(r), times(g), times(b), a]
        }
        _ => [from[0]; 4],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosmic_text::Placement;

    fn glyph(width: u32, height: u32) -> SwashImage {
        let mut image = SwashImage::new();
        image.placement = Placement { left: 1, top: 2, width, height };
        image.data = vec![128; (width * height) as usize];
        image
    }

    #[test]
    fn glyphs_lie_beside_one_another_until_there_is_no_room() {
        let mut atlas = Atlas::default();
        let spots: Vec<Spot> = (0..6).filter_map(|_| atlas.put(&glyph(300, 200))).collect();
        let texels: Vec<_> = spots.iter().map(|spot| spot.texel).collect();
        assert_eq!(texels, [[0, 0], [300, 0], [600, 0], [0, 200], [300, 200], [600, 200]]);
        assert_eq!((atlas.height(), atlas.take_changed(), atlas.take_changed()), (512, 0..400, 0..0));
        assert_eq!(atlas.rows(&(0..1))[..4], [128; 4]);
        assert_eq!(atlas.put(&glyph(0, 5)), None);
        while atlas.put(&glyph(300, 200)).is_some() {}
        assert!(atlas.is_full() && atlas.height() == MOST_HEIGHT);
    }

    #[test]
    fn colors_are_premultiplied() {
        assert_eq!(premultiplied(&[200, 100, 0, 51]), [40, 20, 0, 51]);
        assert_eq!(premultiplied(&[77]), [77; 4]);
    }
}
