//! Outlines as polygons: winding, crossings, distance, arc length. Curves are flattened by kurbo; everything after that
//! is straight edges, so that a pixel's membership and the crossings of its path are decided by one rule.
//!
//! Coordinates are image pixels, x right, y down (docs/folding.md, section 1).

use std::ops::Range;

use glam::DVec3;
use kurbo::{BezPath, Point, Rect, Vec2};
use rayon::prelude::*;

use super::chains::{Chains, Line, Part};
use super::number;
use super::pieces::{Piece, Sides};

/// Curves are flattened to within this many pixels: so fine that a path which grazes a curve still meets it where it
/// should. That many sides are looked at only where it matters ([`Chains`]): four of them lie within 0.001 px of their
/// chord, and a path that stays farther away skips all four at once.
pub const FLATNESS_PX: f64 = 2e-5;

/// A position or vector in image pixels, [x, y], as documents hold it.
pub type Xy = [f64; 2];

/// The point at a position of a document.
pub fn point([x, y]: Xy) -> Point {
    Point::new(x, y)
}

/// The nearest place with so many decimals.
pub fn rounded(at: DVec3, decimals: u32) -> DVec3 {
    DVec3::from(at.to_array().map(|v| number::rounded(v, decimals)))
}

/// A vector of a document.
pub fn vector([x, y]: Xy) -> Vec2 {
    Vec2::new(x, y)
}

/// A position or vector in space, [x, y, z], y up, as documents hold it.
pub type Xyz = [f64; 3];

/// How far points in space reach along each of some ways: the greatest scalar product with it. `None` without points.
pub fn reach(points: impl ParallelIterator<Item = DVec3>, ways: &[DVec3]) -> Option<Vec<f64>> {
    let nothing = || vec![f64::NEG_INFINITY; ways.len()];
    let farthest = |mut far: Vec<f64>, point: DVec3| {
        far.iter_mut().zip(ways).for_each(|(far, way)| *far = far.max(point.dot(*way)));
        far
    };
    let found = points.fold(nothing, farthest).reduce(nothing, farther);
    found.iter().all(|far| far.is_finite()).then_some(found)
}

/// How far two things together reach.
pub fn farther(a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    a.into_iter().zip(b).map(|(a, b)| a.max(b)).collect()
}

/// A closed polygon, even-odd; the closing side is implied. At least three vertices, all finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Vec<Point>,
    bounds: Rect,
    chains: Chains,
}

impl Polygon {
    /// The polygon through `vertices`. A repeated last vertex is harmless.
    pub fn new(vertices: Vec<Point>) -> Self {
        let corner = |r: Option<Rect>, &p: &Point| Some(r.map_or(Rect::from_points(p, p), |r| r.union_pt(p)));
        let bounds = vertices.iter().fold(None, corner).unwrap_or(Rect::ZERO);
        Polygon { bounds, chains: Chains::new(&vertices), vertices }
    }

    /// The polygon of a closed path, flattened to [`FLATNESS_PX`].
    pub fn flatten(path: &BezPath) -> Self {
        let mut vertices = Vec::new();
        kurbo::flatten(path, FLATNESS_PX, |el| match el {
            kurbo::PathEl::MoveTo(p) | kurbo::PathEl::LineTo(p) => vertices.push(p),
            _ => {}
        });
        if vertices.len() > 1 && vertices.first() == vertices.last() {
            vertices.pop();
        }
        Polygon::new(vertices)
    }

    /// An axis-parallel ellipse from its rightmost point, clockwise on the screen. The chords lie half inside and half
    /// outside the curve, nowhere farther from it than [`FLATNESS_PX`].
    pub fn ellipse(center: Point, radii: Vec2) -> Self {
        let largest = radii.x.abs().max(radii.y.abs()).max(1e-9);
        let half_step = crate::base::maths::acos((1.0 - 2.0 * FLATNESS_PX / largest).clamp(0.0, 1.0)).max(1e-4);
        let n = ((std::f64::consts::PI / half_step).ceil() as usize).max(16).next_multiple_of(4);
        // Chords of a circle of radius r reach in to r cos(pi / n): grow r so that they straddle the true one.
        let grow = 2.0 / (1.0 + crate::base::maths::cos(std::f64::consts::PI / n as f64));
        let vertices = (0..n)
            .map(|i| {
                let angle = crate::base::maths::TAU * i as f64 / n as f64;
                let (x, y) = (crate::base::maths::cos(angle), crate::base::maths::sin(angle));
                Point::new(center.x + radii.x * grow * x, center.y + radii.y * grow * y)
            })
            .collect();
        Polygon::new(vertices)
    }

    /// The vertices in order.
    pub fn vertices(&self) -> &[Point] {
        &self.vertices
    }

    /// The smallest rectangle around the polygon.
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// The sides in order, the closing one last.
    pub fn sides(&self) -> impl ExactSizeIterator<Item = (Point, Point)> + '_ {
        let n = self.vertices.len();
        (0..n).map(move |i| (self.vertices[i], self.vertices[(i + 1) % n]))
    }

    /// The chains of sides that may meet `area`: every side that does is in one of them.
    pub fn parts_near(&self, area: Rect) -> Vec<Part> {
        let mut found = Vec::new();
        self.chains.whole().into_iter().for_each(|whole| self.chains.near(whole, area, &mut found));
        found
    }

    /// As [`Polygon::parts_near`], but sides of the shortest chains are told one by one.
    pub fn pieces_near(&self, area: Rect) -> Vec<Piece> {
        let n = self.vertices.len();
        let side = |i: usize| Piece::side(i, (self.vertices[i], self.vertices[(i + 1) % n]));
        let mut found = Vec::new();
        for part in self.parts_near(area) {
            match part.few() {
                Some(sides) => {
                    found.extend((sides.start..sides.end.min(n)).map(side).filter(|side| side.touches(&area)))
                }
                None => found.push(Piece::chain(&self.chains, part)),
            }
        }
        found
    }

    /// Whether `q` is inside: even-odd; on a left or top edge in, on a right or bottom edge out.
    pub fn contains(&self, q: Point) -> bool {
        let mut xs = Vec::new();
        self.row_crossings(q.y, &mut xs);
        xs.iter().filter(|&&x| x <= q.x).count() % 2 == 1
    }

    /// The places, ascending, where the horizontal line at `y` crosses the polygon: a point (x, y) is inside between an
    /// even one (at or after it) and the odd one that follows (before it).
    pub fn row_crossings(&self, y: f64, out: &mut Vec<f64>) {
        out.clear();
        let row = Rect::new(f64::NEG_INFINITY, y, f64::INFINITY, y);
        let crossings = |sides| self.some(sides).filter_map(|(a, b)| crossing_of_row(a, b, y));
        if let Some(whole) = self.chains.whole() {
            self.chains.each_near(whole, row, &mut |sides| out.extend(crossings(sides)));
        }
        out.sort_unstable_by(f64::total_cmp);
    }

    /// Distance from `q` to the nearest side, in pixels.
    pub fn distance(&self, q: Point) -> f64 {
        self.distance_to(self.chains.whole().as_slice(), q)
    }

    /// Distance from `q` to the nearest side in `parts`, in pixels; infinite without any.
    pub fn distance_to(&self, parts: &[Part], q: Point) -> f64 {
        let nearest = |nearest2, &part: &Part| self.chains.nearest2(part, q, nearest2, &self.vertices);
        parts.iter().fold(f64::INFINITY, nearest).sqrt()
    }

    /// Length of all sides, in pixels.
    pub fn perimeter(&self) -> f64 {
        self.sides().map(|(a, b)| (b - a).hypot2().sqrt()).sum()
    }

    /// The places s (any sign, in no order) where the line q + s d crosses a side: the parity of the crossings beyond s
    /// is the membership at s. `d` is not zero.
    pub fn line_crossings(&self, q: Point, d: Vec2) -> Vec<f64> {
        let mut found = Vec::new();
        if let Some(whole) = self.chains.whole() {
            self.crossings_in(whole, &Line::new(q, d), &mut |s| found.push(s));
        }
        found
    }

    /// Calls back with each s where the line crosses a side of `part`, in no order.
    pub fn crossings_in(&self, part: Part, line: &Line, each: &mut impl FnMut(f64)) {
        self.chains.each_met(part, line, &self.vertices, &mut |sides| {
            self.some(sides).filter_map(|(a, b)| side_crossing(a, b, line)).for_each(&mut *each);
        });
    }

    /// Calls back with each s where the line crosses a side of `piece`, in no order.
    pub fn crossings_of(&self, piece: &Piece, line: &Line, each: &mut impl FnMut(f64)) {
        match piece.of {
            Sides::One(i) => self.some(i..i + 1).filter_map(|(a, b)| side_crossing(a, b, line)).for_each(each),
            Sides::Chain(part) => self.crossings_in(part, line, each),
        }
    }

    /// The sides whose first vertices have these numbers.
    fn some(&self, sides: Range<usize>) -> impl Iterator<Item = (Point, Point)> + '_ {
        let n = self.vertices.len();
        (sides.start..sides.end.min(n))
            .map(move |i| (self.vertices[i], self.vertices[if i + 1 == n { 0 } else { i + 1 }]))
    }
}

/// The s where the line crosses the side from `a` to `b`, by the half-open rule ([`Line::is_left`]). `d` is not zero.
fn side_crossing(a: Point, b: Point, line: &Line) -> Option<f64> {
    let (ca, cb) = (line.side(a), line.side(b));
    (line.is_left(ca) != line.is_left(cb)).then(|| {
        let p = a + (b - a) * (ca / (ca - cb));
        (p - line.q).dot(line.d) / line.d.hypot2()
    })
}

/// Where the horizontal line at `y` crosses the side, by the half-open rule.
fn crossing_of_row(a: Point, b: Point, y: f64) -> Option<f64> {
    ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::chains::distance2_to_segment;

    fn square() -> Polygon {
        Polygon::new(vec![(1.5, 1.5).into(), (4.5, 1.5).into(), (4.5, 4.5).into(), (1.5, 4.5).into()])
    }

    #[test]
    fn left_and_top_edges_are_in_right_and_bottom_out() {
        for (q, inside) in
            [((1.5, 2.5), true), ((2.5, 1.5), true), ((4.5, 2.5), false), ((2.5, 4.5), false), ((3.0, 3.0), true)]
        {
            assert_eq!(square().contains(q.into()), inside, "{q:?}");
        }
    }

    /// A star, an ellipse, a curve that crosses itself, and a polygon of many corners.
    fn several() -> Vec<Polygon> {
        let star = [(5.0, 0.3), (8.1, 9.7), (0.2, 3.9), (9.9, 4.1), (1.7, 9.5)];
        let mut loops = BezPath::new();
        loops.move_to((2.0, 2.0));
        loops.curve_to((30.0, 1.0), (-12.0, 14.0), (9.0, 8.0));
        loops.curve_to((20.0, 0.0), (20.0, -9.0), (2.0, 2.0));
        let comb = (0..77).map(|i| Point::new(f64::from(i) * 0.13, f64::from(i * i % 10)));
        vec![
            Polygon::new(star.iter().map(|&p| p.into()).collect()),
            Polygon::ellipse(Point::new(5.0, 5.0), Vec2::new(4.0, 2.5)),
            Polygon::flatten(&loops),
            Polygon::new(comb.collect()),
            Polygon::new(vec![(1.0, 1.0).into(), (1.0, 1.0).into(), (7.0, 3.0).into()]),
        ]
    }

    #[test]
    fn chains_hide_no_side() {
        let sorted = |mut s: Vec<f64>| {
            s.sort_unstable_by(f64::total_cmp);
            s
        };
        for polygon in several() {
            for i in 0..400 {
                let (x, y) = (f64::from(i % 20) * 0.61 - 1.0, f64::from(i / 20) * 0.61 - 1.0);
                let q = Point::new(x, y);
                // Lines through every second vertex too, where the half-open rule decides, and tangents of the ellipse.
                let vertex = polygon.vertices()[i as usize * 2 % polygon.vertices().len()];
                for d in [Vec2::new(x - 3.0, 2.0 - y), vertex - q, Vec2::new(1e-3, 0.0), Vec2::new(0.0, -9.0)] {
                    if d == Vec2::ZERO {
                        continue;
                    }
                    let line = Line::new(q, d);
                    let all = polygon.sides().filter_map(|(a, b)| side_crossing(a, b, &line)).collect();
                    assert_eq!(sorted(polygon.line_crossings(q, d)), sorted(all), "{q:?} {d:?}");
                }
                let nearest = polygon.sides().map(|(a, b)| distance2_to_segment(q, a, b)).fold(f64::INFINITY, f64::min);
                assert_eq!(polygon.distance(q), nearest.sqrt());
            }
        }
    }

    #[test]
    fn tangents_are_decided_to_the_full_fineness() {
        let round = Polygon::ellipse(Point::new(0.0, 0.0), Vec2::new(8.0, 8.0));
        for (y, crossings) in [(7.9999, 2), (8.0001, 0), (-7.9999, 2), (-8.0001, 0)] {
            let found = round.line_crossings(Point::new(-20.0, y), Vec2::new(10.0, 0.0));
            assert_eq!(found.len(), crossings, "{y}");
        }
    }

    #[test]
    fn parts_near_an_area_hold_all_that_meets_it() {
        for polygon in several() {
            for area in [Rect::new(0.0, 3.0, 2.0, 9.0), Rect::new(4.9, 0.0, 6.0, 6.0), Rect::new(2.0, 2.0, 2.1, 2.1)] {
                let line = Line::new(area.center(), Vec2::new(0.3, 0.7));
                let within = |s: &f64| area.contains(line.q + line.d * *s);
                let mut found = Vec::new();
                polygon
                    .parts_near(area)
                    .iter()
                    .for_each(|&part| polygon.crossings_in(part, &line, &mut |s| found.push(s)));
                found.retain(within);
                let mut all = polygon.line_crossings(line.q, line.d);
                all.retain(within);
                assert_eq!(found.len(), all.len(), "{area:?}");
            }
        }
    }

    #[test]
    fn rows_agree_with_points() {
        let star = Polygon::new(
            [(5.0, 0.3), (8.1, 9.7), (0.2, 3.9), (9.9, 4.1), (1.7, 9.5)].iter().map(|&p| p.into()).collect(),
        );
        let mut xs = Vec::new();
        for y in (0..40).map(|i| i as f64 * 0.25) {
            star.row_crossings(y, &mut xs);
            for x in (0..40).map(|i| i as f64 * 0.25) {
                let by_row = xs.iter().filter(|&&c| c <= x).count() % 2 == 1;
                let to_the_right = star.sides().filter_map(|(a, b)| crossing_of_row(a, b, y)).filter(|&c| c > x);
                assert_eq!(by_row, to_the_right.count() % 2 == 1, "{x} {y}");
            }
        }
    }

    #[test]
    fn ellipse_stays_within_flatness() {
        let ellipse = Polygon::ellipse(Point::new(3.0, 4.0), Vec2::new(200.0, 200.0));
        for (a, b) in ellipse.sides() {
            for p in [a, a.midpoint(b)] {
                let error = ((p - Point::new(3.0, 4.0)).hypot2().sqrt() - 200.0).abs();
                assert!(error <= FLATNESS_PX * 1.001, "{error}");
            }
        }
    }

    #[test]
    fn line_crossings_have_the_parity_of_membership() {
        let (q, d) = (Point::new(0.0, 2.0), Vec2::new(3.0, 0.0));
        let mut s = square().line_crossings(q, d);
        s.sort_unstable_by(f64::total_cmp);
        assert_eq!(s, [0.5, 1.5]);
    }

    #[test]
    fn lines_along_edges_follow_the_half_open_rule() {
        for (q, d, crossings) in [
            ((0.0, 1.5), (1.0, 0.0), 2),
            ((9.0, 1.5), (-1.0, 0.0), 2),
            ((0.0, 4.5), (1.0, 0.0), 0),
            ((9.0, 4.5), (-1.0, 0.0), 0),
            ((1.5, 0.0), (0.0, 1.0), 2),
            ((1.5, 9.0), (0.0, -1.0), 2),
            ((4.5, 0.0), (0.0, 1.0), 0),
            ((4.5, 9.0), (0.0, -1.0), 0),
        ] {
            assert_eq!(square().line_crossings(q.into(), d.into()).len(), crossings, "{q:?} {d:?}");
        }
    }

    #[test]
    fn distance_to_the_outline() {
        assert_eq!(square().distance(Point::new(3.0, 3.0)), 1.5);
        assert_eq!(square().distance(Point::new(0.5, 3.0)), 1.0);
    }
}
