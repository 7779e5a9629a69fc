//! Rectangles packed into one. Offline and exact; the crates for this are made for atlases that change, and allow at most
//! 65535 texels per side.

/// Packed rectangles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Packed {
    /// The first column and row of each.
    pub places: Vec<(usize, usize)>,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// Packs rectangles of these widths and heights: the smallest result over a few widths.
pub fn pack(sizes: &[(usize, usize)]) -> Packed {
    let total: usize = sizes.iter().map(|(w, h)| w * h).sum();
    let least = sizes.iter().map(|s| s.0).max().unwrap_or(1).max(total.isqrt());
    let packed = (0..8).map(|k| shelves(sizes, least + least * k / 8));
    packed.min_by_key(|packed| packed.width * packed.height).unwrap_or_default()
}

/// Rectangles on shelves at most `most` wide, tallest first.
fn shelves(sizes: &[(usize, usize)], most: usize) -> Packed {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&i| (std::cmp::Reverse(sizes[i].1), std::cmp::Reverse(sizes[i].0), i));
    let mut places = vec![(0, 0); sizes.len()];
    let (mut x, mut y, mut shelf, mut widest) = (0, 0, 0, 0);
    for i in order {
        let (width, height) = sizes[i];
        if x + width > most {
            (x, y, shelf) = (0, y + shelf, 0);
        }
        places[i] = (x, y);
        x += width;
        shelf = shelf.max(height);
        widest = widest.max(x);
    }
    Packed { places, width: widest, height: y + shelf }
}
