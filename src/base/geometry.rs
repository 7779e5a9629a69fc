//! Outlines as polygons: winding, crossings, distance, arc length. Curves are flattened by kurbo; everything after that
//! is straight edges, so that a pixel's membership and the crossings of its path are decided by one rule.
//!
//! Coordinates are image pixels, x right, y down (folding.md, section 1).

use kurbo::{BezPath, Point, Rect, Vec2};

/// Curves are flattened to within this many pixels: so fine that a path which grazes a curve still meets it where it
/// should.
pub const FLATNESS_PX: f64 = 2e-5;

/// Sides that share a box, so that most of a curve is passed over at a glance.
const GROUP: usize = 32;

/// A closed polygon, even-odd; the closing side is implied. At least three vertices, all finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Vec<Point>,
    bounds: Rect,
    /// The box of each [`GROUP`] of sides.
    groups: Vec<Rect>,
}

impl Polygon {
    /// The polygon through `vertices`. A repeated last vertex is harmless.
    pub fn new(vertices: Vec<Point>) -> Self {
        let box_of = |points: &mut dyn Iterator<Item = Point>| {
            let corner = |r: Rect, p: Point| r.union_pt(p);
            points.next().map_or(Rect::ZERO, |first| points.fold(Rect::from_points(first, first), corner))
        };
        let n = vertices.len();
        let group = |start: usize| {
            let end = (start + GROUP).min(n);
            box_of(&mut (start..=end).map(|i| vertices[i % n]))
        };
        let groups = (0..n).step_by(GROUP).map(group).collect();
        Polygon { bounds: box_of(&mut vertices.iter().copied()), groups, vertices }
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

    /// The sides that may meet `area`: all that do, and a few more.
    pub fn sides_near(&self, area: Rect) -> impl Iterator<Item = (Point, Point)> + '_ {
        let meets = move |r: &Rect| r.x0 <= area.x1 && area.x0 <= r.x1 && r.y0 <= area.y1 && area.y0 <= r.y1;
        let n = self.vertices.len();
        let groups = self.groups.iter().enumerate().filter(move |(_, group)| meets(group));
        groups
            .flat_map(move |(g, _)| g * GROUP..((g + 1) * GROUP).min(n))
            .map(move |i| (self.vertices[i], self.vertices[(i + 1) % n]))
            .filter(move |(a, b)| meets(&Rect::from_points(*a, *b)))
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
        out.extend(self.sides_near(row).filter_map(|(a, b)| crossing_of_row(a, b, y)));
        out.sort_unstable_by(f64::total_cmp);
    }

    /// Distance from `q` to the nearest side, in pixels.
    pub fn distance(&self, q: Point) -> f64 {
        distance(q, self.sides())
    }

    /// Length of all sides, in pixels.
    pub fn perimeter(&self) -> f64 {
        self.sides().map(|(a, b)| (b - a).hypot2().sqrt()).sum()
    }

    /// The places s (any sign, in no order) where the line q + s d crosses a side: the parity of the crossings beyond s
    /// is the membership at s. `d` is not zero.
    pub fn line_crossings(&self, q: Point, d: Vec2) -> impl Iterator<Item = f64> + '_ {
        self.sides().filter_map(move |(a, b)| side_crossing(a, b, q, d))
    }
}

/// The s where the line q + s d crosses the side from `a` to `b`. Ties are decided as if the line lay a hair lower and
/// to the right, which is the half-open rule: along a left or top edge it is in, and a vertex counts with one of its
/// two sides. `d` is not zero.
pub fn side_crossing(a: Point, b: Point, q: Point, d: Vec2) -> Option<f64> {
    let rightward = if d.x != 0.0 { d.x > 0.0 } else { d.y < 0.0 };
    let left_of_line = |c: f64| if rightward { c > 0.0 } else { c >= 0.0 };
    let (ca, cb) = (d.cross(a - q), d.cross(b - q));
    (left_of_line(ca) != left_of_line(cb)).then(|| {
        let p = a + (b - a) * (ca / (ca - cb));
        (p - q).dot(d) / d.hypot2()
    })
}

/// Distance from `q` to the nearest of some sides, in pixels; infinite without any.
pub fn distance(q: Point, sides: impl IntoIterator<Item = (Point, Point)>) -> f64 {
    let nearest = sides.into_iter().map(|(a, b)| distance2_to_segment(q, a, b)).fold(f64::INFINITY, f64::min);
    nearest.sqrt()
}

/// Where the horizontal line at `y` crosses the side, by the half-open rule.
fn crossing_of_row(a: Point, b: Point, y: f64) -> Option<f64> {
    ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
}

fn distance2_to_segment(q: Point, a: Point, b: Point) -> f64 {
    let side = b - a;
    let length2 = side.hypot2();
    let along = if length2 > 0.0 { ((q - a).dot(side) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (q - (a + side * along)).hypot2()
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn groups_hide_no_side() {
        let round = Polygon::ellipse(Point::new(30.0, 30.0), Vec2::new(20.0, 25.0));
        assert!(round.groups.len() > 10);
        for area in
            [Rect::new(8.0, 3.0, 12.0, 40.0), Rect::new(49.9, 0.0, 60.0, 60.0), Rect::new(20.0, 20.0, 21.0, 21.0)]
        {
            let meets = |(a, b): &(Point, Point)| area.overlaps(Rect::from_points(*a, *b));
            assert_eq!(round.sides_near(area).filter(meets).count(), round.sides().filter(meets).count());
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
        let mut s: Vec<f64> = square().line_crossings(q, d).collect();
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
            assert_eq!(square().line_crossings(q.into(), d.into()).count(), crossings, "{q:?} {d:?}");
        }
    }

    #[test]
    fn distance_to_the_outline() {
        assert_eq!(square().distance(Point::new(3.0, 3.0)), 1.5);
        assert_eq!(square().distance(Point::new(0.5, 3.0)), 1.0);
    }
}
