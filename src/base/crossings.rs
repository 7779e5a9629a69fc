//! What is degenerate about a polygon: no area, or sides that cross each other.

use kurbo::Point;

use super::geometry::Polygon;

/// Pairs of sides that are looked at before the search for a crossing gives up: it serves a warning only.
const MAX_PAIRS: usize = 2_000_000;

/// Areas below this share of the squared size count as none.
const FLAT: f64 = 1e-12;

/// Why a polygon encloses nothing; none where it does.
pub fn emptiness(polygon: &Polygon) -> Option<&'static str> {
    let vertices = polygon.vertices();
    let Some(&a) = vertices.first() else { return Some("has no points") };
    let Some(&b) = vertices.iter().find(|&&p| p != a) else { return Some("is a single point") };
    if vertices.iter().all(|&p| p == a || p == b) {
        return Some("has only two distinct points");
    }
    let size = polygon.bounds().width().max(polygon.bounds().height());
    let least = FLAT * size * size;
    if vertices.iter().all(|&p| (b - a).cross(p - a).abs() <= least) {
        return Some("has no area: its points lie on one line");
    }
    let twice_area: f64 = polygon.sides().map(|(p, q)| (p - a).cross(q - a)).sum();
    (twice_area.abs() <= least && self_crossing(polygon).is_none()).then_some("has no area")
}

/// A place where two sides of a polygon cross properly; none too where that takes too long to find out.
pub fn self_crossing(polygon: &Polygon) -> Option<Point> {
    let mut sides: Vec<(Point, Point)> = polygon.sides().filter(|(a, b)| a != b).collect();
    sides.sort_by(|s, t| s.0.x.min(s.1.x).total_cmp(&t.0.x.min(t.1.x)));
    let mut active: Vec<(Point, Point)> = Vec::new();
    let mut pairs = 0;
    for side in sides {
        let left = side.0.x.min(side.1.x);
        active.retain(|other| other.0.x.max(other.1.x) >= left);
        pairs += active.len();
        if pairs > MAX_PAIRS {
            return None;
        }
        if let Some(place) = active.iter().find_map(|&other| crossing(side, other)) {
            return Some(place);
        }
        active.push(side);
    }
    None
}

/// Where two sides cross; none where they only touch.
fn crossing((a, b): (Point, Point), (c, d): (Point, Point)) -> Option<Point> {
    let side_of = |p: Point| (b - a).cross(p - a);
    let (of_c, of_d) = (side_of(c), side_of(d));
    let other_side_of = |p: Point| (d - c).cross(p - c);
    let (of_a, of_b) = (other_side_of(a), other_side_of(b));
    let apart = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    (apart(of_c, of_d) && apart(of_a, of_b)).then(|| a + (b - a) * (of_a / (of_a - of_b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        Polygon::new(points.iter().map(|&p| p.into()).collect())
    }

    #[test]
    fn degenerate_outlines() {
        for (points, empty, crossed) in [
            (&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)] as &[_], None, None),
            (&[(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)], Some("is a single point"), None),
            (&[(1.0, 1.0), (2.0, 1.0), (1.0, 1.0)], Some("has only two distinct points"), None),
            (&[(0.0, 0.0), (1.0, 0.1), (2.0, 0.2)], Some("has no area: its points lie on one line"), None),
            (&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (9.0, 0.0)], Some("has no area"), None),
            (&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)], None, Some((2.0, 2.0))),
        ] {
            assert_eq!(emptiness(&polygon(points)), empty, "{points:?}");
            assert_eq!(self_crossing(&polygon(points)), crossed.map(Point::from), "{points:?}");
        }
    }
}
