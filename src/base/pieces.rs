//! Pieces of a polygon's outline, and many short paths at once that may cross them: a few products tell of most pairs of a
//! path and a piece that they do not meet.

use kurbo::{Point, Rect};

use super::chains::{Chains, Part};

/// Paths in a [`Bundle`].
pub const PATHS: usize = 16;

/// Pixels by which a path may come near a piece without meeting it: more than any rounding error of the place.
const NEAR_PX: f64 = 1e-6;

/// As a share of the lengths involved: more than any rounding error.
const ROUNDING: f64 = 1e-12;

/// Sides of a polygon that lie close to a straight axis.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Which sides.
    pub of: Sides,
    axis: (Point, Point),
    /// No side is farther from the axis than this.
    band: f64,
}

/// What a [`Piece`] consists of.
#[derive(Clone, Copy, Debug)]
pub enum Sides {
    /// The side that begins at the vertex of this number.
    One(usize),
    /// A chain of them.
    Chain(Part),
}

impl Piece {
    /// The side of this number.
    pub fn side(number: usize, ends: (Point, Point)) -> Self {
        Piece { of: Sides::One(number), axis: ends, band: 0.0 }
    }

    /// A chain.
    pub fn chain(chains: &Chains, part: Part) -> Self {
        let (axis, band) = chains.axis(part);
        Piece { of: Sides::Chain(part), axis, band }
    }

    /// Whether the box around its axis, which is all of it if it is a side, meets `area`.
    pub fn touches(&self, area: &Rect) -> bool {
        let Rect { x0, y0, x1, y1 } = Rect::from_points(self.axis.0, self.axis.1);
        x0 <= area.x1 && area.x0 <= x1 && y0 <= area.y1 && area.y0 <= y1
    }
}

/// Straight paths that begin side by side.
pub struct Bundle {
    /// How many there are.
    count: usize,
    /// x and y where each begins.
    begins: [[f64; PATHS]; 2],
    /// x and y of the way along each.
    ways: [[f64; PATHS]; 2],
    /// x and y where each is left, and where it is entered.
    ends: [[[f64; PATHS]; 2]; 2],
    lengths: [f64; PATHS],
}

impl Bundle {
    /// Paths along `ways`, the first from `q`, each beginning a unit to the right of the one before; only what is between the
    /// `range` of multiples of the way counts.
    #[inline(always)]
    pub fn new(q: Point, ways: &[[f32; 2]], (low, high): (f64, f64)) -> Self {
        let mut bundle = Bundle {
            count: ways.len().min(PATHS),
            begins: [[0.0; PATHS], [q.y; PATHS]],
            ways: [[0.0; PATHS]; 2],
            ends: [[[0.0; PATHS]; 2]; 2],
            lengths: [0.0; PATHS],
        };
        for (k, way) in ways.iter().take(PATHS).enumerate() {
            bundle.ways[0][k] = f64::from(way[0]);
            bundle.ways[1][k] = f64::from(way[1]);
        }
        let [xs, ys] = &bundle.ways;
        for k in 0..PATHS {
            bundle.begins[0][k] = q.x + k as f64;
            bundle.lengths[k] = (xs[k] * xs[k] + ys[k] * ys[k]).sqrt();
        }
        for (end, s) in bundle.ends.iter_mut().zip([low, high]) {
            for ((ends, begins), ways) in end.iter_mut().zip(&bundle.begins).zip(&bundle.ways) {
                for ((end, begin), way) in ends.iter_mut().zip(begins).zip(ways) {
                    *end = begin + s * way;
                }
            }
        }
        bundle
    }

    /// Which paths may cross a piece, the first by the lowest bit: all that do, and few others.
    #[inline(always)]
    pub fn may_cross(&self, piece: &Piece) -> u16 {
        let (a, b) = piece.axis;
        let side = b - a;
        let length = side.hypot2().sqrt();
        let ([x, y], [dx, dy]) = (&self.begins, &self.ways);
        let [[low_x, low_y], [high_x, high_y]] = &self.ends;
        // By how much each path, and the line that it is on, clears the piece; not positive if it does not.
        let mut clear = [0.0; PATHS];
        for k in 0..PATHS {
            let (ax, ay, bx, by) = (a.x - x[k], a.y - y[k], b.x - x[k], b.y - y[k]);
            let (of_a, of_b) = (dx[k] * ay - dy[k] * ax, dx[k] * by - dy[k] * bx);
            let far = ax.abs() + ay.abs() + bx.abs() + by.abs() + piece.band;
            let beside = apart(of_a, of_b) - self.lengths[k] * (piece.band + ROUNDING * far);
            let of_low = side.x * (low_y[k] - a.y) - side.y * (low_x[k] - a.x);
            let of_high = side.x * (high_y[k] - a.y) - side.y * (high_x[k] - a.x);
            let far = (low_x[k] - high_x[k]).abs() + (low_y[k] - high_y[k]).abs() + far;
            let short = apart(of_low, of_high) - length * (piece.band + NEAR_PX + ROUNDING * far);
            clear[k] = if beside > short { beside } else { short };
        }
        let clears = clear.iter().enumerate().fold(0, |clears, (k, clear)| clears | u16::from(*clear > 0.0) << k);
        !clears & ((1_u32 << self.count) - 1) as u16
    }
}

/// How far two numbers are from 0 on the same side of it; negative if they are on both.
#[inline(always)]
fn apart(a: f64, b: f64) -> f64 {
    let (least, most) = if a < b { (a, b) } else { (b, a) };
    if least > -most { least } else { -most }
}

#[cfg(test)]
mod tests {
    use kurbo::Vec2;

    use super::*;
    use crate::base::chains::Line;
    use crate::base::geometry::Polygon;

    #[test]
    fn a_bundle_hides_no_crossing_and_rules_out_most_pieces() {
        let corner = |i: u32| Point::new(f64::from(i * 37 % 50), f64::from(i * 23 % 41));
        let (mut asked, mut met) = (0, 0);
        for polygon in [
            Polygon::new((0..24).map(corner).collect()),
            Polygon::new([(8.5, 3.5), (20.5, 3.5), (20.5, 30.5)].map(Point::from).to_vec()),
            Polygon::ellipse(Point::new(25.0, 20.0), Vec2::new(20.0, 12.0)),
        ] {
            let pieces = polygon.pieces_near(Rect::new(-90.0, -90.0, 140.0, 130.0));
            let small = polygon.pieces_near(Rect::new(24.0, 8.0, 30.0, 12.0));
            for (i, piece) in pieces.iter().chain(&small).enumerate() {
                for y in (0..40).map(|y| f64::from(y) + 0.5) {
                    let way = |k: u16| [f32::from(k * 7 % 11) - 5.0, (f32::from(k) - 8.0) * (y as f32 - 20.0) / 8.0];
                    let (q, range) = (Point::new(y * 37.0 % 50.0 + 0.5, y), (-1.0, 1.5 + i as f64 % 2.0));
                    let ways: Vec<[f32; 2]> = (0..13).map(way).collect();
                    let may = Bundle::new(q, &ways, range).may_cross(piece);
                    assert_eq!(may >> ways.len(), 0);
                    for (k, way) in ways.iter().enumerate().filter(|(_, way)| **way != [0.0; 2]) {
                        let line = Line::new(q + Vec2::new(k as f64, 0.0), Vec2::new(way[0].into(), way[1].into()));
                        let mut meets = false;
                        polygon.crossings_of(piece, &line, &mut |s| meets |= s >= range.0 && s <= range.1);
                        assert!(may >> k & 1 == 1 || !meets, "{piece:?} {line:?}");
                        (asked, met) = (asked + u32::from(may >> k & 1), met + u32::from(meets));
                    }
                }
            }
        }
        assert!(met > 1000 && asked < 2 * met, "{asked} {met}");
    }
}
