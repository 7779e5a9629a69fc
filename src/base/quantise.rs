//! Few colors for many: the box with the largest error is cut at its mean (variance cut), then k-means settles them; and a
//! fast search for the nearest of them.
//!
//! Distances are those of sRGB codes. Boxes and means in Oklab gave 0.5 dB less on photographs at the same size of file, and
//! no fewer specks: how visible errors of a few codes are depends on how they are spread.

use rayon::prelude::*;

/// A color in sRGB codes, 0 to 255.
pub type Codes = [f64; 3];

/// Rounds of k-means.
const ROUNDS: usize = 16;
/// Bits of a channel that are left out where colors are counted together; their mean stays.
const COARSE: u32 = 1;

/// How often colors occur. The order and the pieces in which they are counted make no difference.
#[derive(Default)]
pub struct Histogram {
    /// For every coarse color the number of its bin, from 1 on; 0 without one. Empty before the first color.
    places: Vec<u32>,
    bins: Vec<Bin>,
}

/// A coarse color, the sums of the channels of all that are in it, and how many these are.
type Bin = ([u8; 3], [u64; 4]);

impl Histogram {
    /// Counts these colors.
    pub fn of(colors: impl Iterator<Item = [u8; 3]>) -> Self {
        Histogram::default().and(colors)
    }

    /// Counts these colors too.
    pub fn and(mut self, colors: impl Iterator<Item = [u8; 3]>) -> Self {
        for color in colors {
            let [r, g, b] = color.map(u64::from);
            self.add((color.map(|code| code >> COARSE), [r, g, b, 1]));
        }
        self
    }

    /// Both together.
    pub fn with(mut self, other: Histogram) -> Self {
        if self.bins.len() < other.bins.len() {
            return other.with(self);
        }
        other.bins.into_iter().for_each(|bin| self.add(bin));
        self
    }

    fn add(&mut self, (coarse, sums): Bin) {
        const BITS: u32 = 8 - COARSE;
        self.places.resize(1 << (3 * BITS), 0);
        let place = coarse.into_iter().fold(0, |place, code| place << BITS | usize::from(code));
        if self.places[place] == 0 {
            self.bins.push((coarse, [0; 4]));
            self.places[place] = self.bins.len() as u32;
        }
        let (_, bin) = &mut self.bins[self.places[place] as usize - 1];
        bin.iter_mut().zip(sums).for_each(|(sum, add)| *sum += add);
    }

    /// At most `most` colors (up to 256) that represent all, ascending; empty without colors.
    pub fn palette(self, most: usize) -> Vec<[u8; 3]> {
        let mut bins = self.bins;
        bins.sort_unstable();
        let point = |(_, [r, g, b, n]): (_, [u64; 4])| Point {
            color: [r, g, b].map(|sum| sum as f64 / n as f64),
            weight: n as f64,
        };
        let points: Vec<Point> = bins.into_iter().map(point).collect();
        if points.is_empty() {
            return Vec::new();
        }
        let centers = cut(points.clone(), most).into_iter().map(|group| group.mean).collect();
        let centers = settle(&points, centers);
        let mut colors: Vec<[u8; 3]> = centers.into_iter().map(|c| c.map(|code| code.round() as u8)).collect();
        colors.sort_unstable();
        colors.dedup();
        colors
    }
}

/// A color, and how often it occurs.
#[derive(Clone, Copy)]
pub struct Point {
    /// In sRGB codes.
    pub color: Codes,
    /// How often.
    pub weight: f64,
}

/// Points that one color may stand for.
pub struct Group {
    /// At least one.
    pub points: Vec<Point>,
    /// Their mean: that color.
    pub mean: Codes,
    /// The axis on which they spread most.
    axis: usize,
    /// Sum of weighted squared distances to the mean.
    spread: f64,
}

impl Group {
    fn of(points: Vec<Point>) -> Self {
        let weight: f64 = points.iter().map(|p| p.weight).sum();
        let mean: Codes = std::array::from_fn(|i| points.iter().map(|p| p.color[i] * p.weight).sum::<f64>() / weight);
        let spread = |i: usize| {
            let squares = points.iter().map(|p| (p.color[i] - mean[i]) * (p.color[i] - mean[i]) * p.weight);
            squares.sum::<f64>()
        };
        let spreads: [f64; 3] = std::array::from_fn(spread);
        let axis = (0..3).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b])).unwrap_or(0);
        Group { points, mean, axis, spread: spreads.iter().sum() }
    }
}

/// All points in at most `most` groups; empty without points.
pub fn cut(points: Vec<Point>, most: usize) -> Vec<Group> {
    if points.is_empty() {
        return Vec::new();
    }
    let mut groups = vec![Group::of(points)];
    while groups.len() < most {
        let Some(worst) = (0..groups.len()).max_by(|&a, &b| groups[a].spread.total_cmp(&groups[b].spread)) else {
            break;
        };
        let Group { points, mean, axis, .. } = groups.swap_remove(worst);
        let (low, high): (Vec<_>, Vec<_>) = points.iter().partition(|p| p.color[axis] <= mean[axis]);
        if low.is_empty() || high.is_empty() {
            groups.push(Group { points, mean, axis, spread: 0.0 }); // one place: cannot be cut, and so can no other
            break;
        }
        groups.extend([Group::of(low), Group::of(high)]);
    }
    groups
}

/// Moves each color to the mean of the points nearest to it, a few times.
fn settle(points: &[Point], mut colors: Vec<Codes>) -> Vec<Codes> {
    for _ in 0..ROUNDS {
        let nearest = Nearest::new(&colors);
        let owners: Vec<u8> = points.par_iter().map(|p| nearest.of(p.color)).collect();
        let mut sums = vec![([0.0; 3], 0.0); colors.len()];
        for (point, owner) in points.iter().zip(owners) {
            let (sum, weight) = &mut sums[usize::from(owner)];
            *sum = std::array::from_fn(|i| sum[i] + point.color[i] * point.weight);
            *weight += point.weight;
        }
        let moved = sums.into_iter().map(|(sum, weight)| (weight > 0.0).then(|| sum.map(|s| s / weight)));
        colors.iter_mut().zip(moved).for_each(|(color, moved)| *color = moved.unwrap_or(*color));
    }
    colors
}

/// The nearest of at most 256 colors. Space is cut into cells; each knows the colors that are nearest to any place in it.
pub struct Nearest {
    colors: Vec<Codes>,
    cells: Vec<Vec<u8>>,
}

/// Cells along an axis, and their width in codes.
const CELLS: usize = 16;
const WIDTH: f64 = 256.0 / CELLS as f64;

impl Nearest {
    /// Of these colors, at least one.
    pub fn new(colors: &[Codes]) -> Self {
        let cells = (0..CELLS * CELLS * CELLS).into_par_iter().map(|cell| near(colors, cell)).collect();
        Nearest { colors: colors.to_vec(), cells }
    }

    /// The number of the color nearest to one in 0 to 255; of equal ones the first.
    pub fn of(&self, wanted: Codes) -> u8 {
        let [r, g, b] = wanted.map(|code| ((code / WIDTH) as usize).min(CELLS - 1));
        let mut best = (f64::INFINITY, 0);
        for &i in &self.cells[(r * CELLS + g) * CELLS + b] {
            let distance = distance2(self.colors[usize::from(i)], wanted);
            if distance < best.0 {
                best = (distance, i);
            }
        }
        best.1
    }

    /// The squared distance of a color to the nearest.
    pub fn error(&self, wanted: Codes) -> f64 {
        distance2(self.colors[usize::from(self.of(wanted))], wanted)
    }
}

/// The colors that may be the nearest to a place in the cell.
fn near(colors: &[Codes], cell: usize) -> Vec<u8> {
    let low = [cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS].map(|i| i as f64 * WIDTH);
    let square = |color: &Codes, axis: &dyn Fn(f64, f64) -> f64| {
        let each = color.iter().zip(low).map(|(&code, low)| axis(code - low, low + WIDTH - code));
        each.map(|away| away * away).sum::<f64>()
    };
    let farthest = |color: &Codes| square(color, &|from_low, to_high| from_low.abs().max(to_high.abs()));
    let least = |color: &Codes| square(color, &|from_low, to_high| (-from_low).max(-to_high).max(0.0));
    let bound = colors.iter().map(farthest).fold(f64::INFINITY, f64::min) + 1e-6;
    let within = colors.iter().enumerate().filter(|(_, color)| least(color) <= bound);
    within.map(|(i, _)| i as u8).collect()
}

fn distance2(a: Codes, b: Codes) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colors(n: usize) -> impl Iterator<Item = [u8; 3]> {
        (0..n).map(|i| [(i * 7 % 256) as u8, (i * i / 5 % 256) as u8, (i / 3 % 256) as u8])
    }

    #[test]
    fn the_nearest_is_the_nearest_of_all() {
        let palette: Vec<Codes> = colors(97).map(|c| c.map(f64::from)).collect();
        let nearest = Nearest::new(&palette);
        for wanted in colors(3000).map(|c| c.map(|code| f64::from(code) * 0.999)) {
            let least = palette.iter().map(|&c| distance2(c, wanted)).fold(f64::INFINITY, f64::min);
            assert_eq!(nearest.error(wanted), least, "{wanted:?}");
        }
    }

    #[test]
    fn a_palette_does_not_depend_on_how_colors_were_counted() {
        let whole = Histogram::of(colors(5000)).palette(40);
        let halves = Histogram::of(colors(5000).skip(2000)).with(Histogram::of(colors(2000)));
        assert_eq!((whole.len(), &whole), (40, &halves.palette(40)));
        assert!(Histogram::default().palette(9).is_empty());
        assert_eq!(Histogram::of([[9, 8, 7]; 3].into_iter()).palette(9), [[9, 8, 7]]);
    }

    #[test]
    fn means_settle_where_colors_are() {
        let two = [[10, 10, 10]; 90].into_iter().chain([[13, 10, 10]; 30]).chain([[200, 0, 0]; 5]);
        assert_eq!(Histogram::of(two).palette(2), [[11, 10, 10], [200, 0, 0]]);
    }
}
