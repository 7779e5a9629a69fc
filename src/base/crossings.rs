//! What is degenerate about a polygon: no area, or sides that cross each other.

use kurbo::Point;

use super::geometry::Polygon;

/// Pairs of sides that are looked at before the search for a crossing gives up: it is only used for a warning.
const MAX_PAIRS: usize = 2_000_000;

/// Areas below this share of the squared size count as none.
const FLAT: f64 = 1e-12;

/// Why a polygon encloses nothing; `None` if it does.
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
    (twice_area.abs() <= least && self_crossing(polygon, 0.0).is_none()).then_some("has no area")
}

/// A place where two sides of a polygon cross properly; `None` also if that takes too long to find out. For curves, whose
/// sides are within `slack` of them, a crossing counts only if it cuts off more than that slack can explain: where two
/// pieces leave a node almost side by side, their straight sides cross although the curves do not.
pub fn self_crossing(polygon: &Polygon, slack: f64) -> Option<Point> {
    let mut sides: Vec<(usize, (Point, Point))> = polygon.sides().enumerate().filter(|(_, (a, b))| a != b).collect();
    sides.sort_by(|(_, s), (_, t)| s.0.x.min(s.1.x).total_cmp(&t.0.x.min(t.1.x)));
    let mut active: Vec<(usize, (Point, Point))> = Vec::new();
    let mut pairs = 0;
    for (i, side) in sides {
        let left = side.0.x.min(side.1.x);
        active.retain(|(_, other)| other.0.x.max(other.1.x) >= left);
        pairs += active.len();
        for &(j, other) in &active {
            let Some(place) = crossing(side, other) else { continue };
            pairs += if slack > 0.0 { polygon.vertices().len() } else { 0 };
            if slack <= 0.0 || opens(polygon, (i.min(j), i.max(j)), place, slack) {
                return Some(place);
            }
        }
        if pairs > MAX_PAIRS {
            return None;
        }
        active.push((i, side));
    }
    None
}

/// Whether the crossing of two sides at `place` divides the polygon into two parts that are both thicker than what two
/// sides may be off by.
fn opens(polygon: &Polygon, (i, j): (usize, usize), place: Point, slack: f64) -> bool {
    let vertices = polygon.vertices();
    let thick = |ring: &mut dyn Iterator<Item = Point>| {
        let (mut area, mut length, mut before) = (0.0, 0.0, place);
        for p in ring.chain([place]) {
            area += (before - place).cross(p - place) / 2.0;
            length += before.distance(p);
            before = p;
        }
        // A strip of this length and a width of two slacks on either side.
        area.abs() > 4.0 * slack * length / 2.0
    };
    thick(&mut vertices[i + 1..=j].iter().copied())
        && thick(&mut vertices[j + 1..].iter().chain(&vertices[..=i]).copied())
}

/// Where two sides cross; `None` if they only touch.
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
    use kurbo::{BezPath, CubicBez, ParamCurve, Vec2};
    use proptest::prelude::*;

    use super::*;
    use crate::base::geometry::FLATNESS_PX;

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
            assert_eq!(self_crossing(&polygon(points), 0.0), crossed.map(Point::from), "{points:?}");
        }
    }

    /// A closed path of nodes (place, handle in, handle out) as flattened, and as straight sides of equal steps.
    type Nodes = Vec<[(f64, f64); 3]>;

    fn pieces(nodes: &Nodes) -> Vec<CubicBez> {
        let at = |i: usize| nodes[i % nodes.len()].map(Vec2::from);
        let piece = |i: usize| {
            let ([a, _, out], [b, back, _]) = (at(i), at(i + 1));
            CubicBez::new(a.to_point(), (a + out).to_point(), (b + back).to_point(), b.to_point())
        };
        (0..nodes.len()).map(piece).collect()
    }

    fn flattened(nodes: &Nodes) -> Polygon {
        let mut path = BezPath::new();
        for (i, piece) in pieces(nodes).into_iter().enumerate() {
            if i == 0 {
                path.move_to(piece.p0);
            }
            path.curve_to(piece.p1, piece.p2, piece.p3);
        }
        path.close_path();
        Polygon::flatten(&path)
    }

    /// Every place where the sides of equal steps cross, and how thick the thinner part is.
    fn by_force(nodes: &Nodes, steps: usize) -> Vec<f64> {
        let step = |piece: CubicBez| (0..steps).map(move |k| piece.eval(k as f64 / steps as f64));
        let polygon = Polygon::new(pieces(nodes).into_iter().flat_map(step).collect());
        let sides: Vec<_> = polygon.sides().collect();
        let mut found = Vec::new();
        for i in 0..sides.len() {
            for j in 0..i {
                let Some(place) = crossing(sides[i], sides[j]) else { continue };
                let thickness = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0];
                found.push(thickness.into_iter().find(|&slack| opens(&polygon, (j, i), place, slack)).unwrap_or(0.0));
            }
        }
        found
    }

    /// Whether fine steps cross within half a pixel of a place.
    fn crosses_near(nodes: &Nodes, place: Point) -> bool {
        const STEPS: usize = 20_000;
        let step = |piece: CubicBez| (0..STEPS).map(move |k| piece.eval(k as f64 / STEPS as f64));
        let polygon = Polygon::new(pieces(nodes).into_iter().flat_map(step).collect());
        let near: Vec<_> = polygon.sides().filter(|(a, _)| a.distance(place) < 0.5).collect();
        (0..near.len()).any(|i| (0..i).any(|j| crossing(near[i], near[j]).is_some()))
    }

    #[test]
    fn a_loop_smaller_than_a_pixel_is_found() {
        let nodes = vec![
            [(0., 0.), (0., 0.), (0., 0.)],
            [(36., 17.), (0., -2.), (0., 5.)],
            [(0., 27.), (3., -15.), (5., -24.)],
        ];
        // The curves leave (0, 27) with slopes of 1 / 5 and 5 / 24, and bend towards each other: they meet 0.15 px below.
        let place = self_crossing(&flattened(&nodes), FLATNESS_PX).unwrap();
        assert!(place.distance(Point::new(0.031, 26.85)) < 0.01 && crosses_near(&nodes, place), "{place}");
    }

    #[test]
    fn pieces_that_share_an_end_do_not_cross_there() {
        for (nodes, crosses) in [
            // Leaves its first node and comes back to it from the same side.
            (vec![[(207., 332.), (10., 17.), (10., -11.)], [(264., 351.), (-19., -28.), (-20., 5.)]], false),
            (vec![[(264., 351.), (-19., -28.), (-20., 5.)], [(207., 332.), (10., 17.), (10., -11.)]], false),
            // A cusp: both handles in one direction, the curves bending apart.
            (
                vec![
                    [(0., 0.), (30., 0.), (30., 0.)],
                    [(60., 40.), (0., -20.), (-10., 0.)],
                    [(50., -40.), (0., 0.), (0., 0.)],
                ],
                true,
            ),
            (
                vec![
                    [(0., 0.), (30., 0.), (30., 0.)],
                    [(50., -40.), (0., 0.), (0., 0.)],
                    [(60., 40.), (0., -20.), (-10., 0.)],
                ],
                false,
            ),
            (
                vec![
                    [(0., 0.), (30., 1e-7), (30., 0.)],
                    [(50., -40.), (0., 0.), (0., 0.)],
                    [(60., 40.), (0., 0.), (0., 0.)],
                ],
                false,
            ),
            // One piece that makes a loop, large and small.
            (vec![[(0., 0.), (0., 0.), (90., 90.)], [(30., 0.), (-90., 90.), (0., -30.)]], true),
            (vec![[(0., 0.), (0., 0.), (25., 40.)], [(30., 0.), (-25., 40.), (0., -30.)]], false),
            // A figure of eight.
            (vec![[(0., 0.), (0., 20.), (0., -20.)], [(40., 0.), (0., 20.), (0., -20.)]], true),
        ] {
            let found = self_crossing(&flattened(&nodes), FLATNESS_PX);
            assert_eq!(found.is_some(), crosses, "{nodes:?}: {found:?}, {:?}", by_force(&nodes, 200));
        }
    }

    /// Nodes as people place them: on whole pixels; handles short, long, missing, or in line with the handle opposite.
    fn nodes() -> impl Strategy<Value = Nodes> {
        let place = (0..60i32, 0..60i32).prop_map(|(x, y)| (f64::from(x), f64::from(y)));
        let handle = (-25..25i32, -25..25i32).prop_map(|(x, y)| (f64::from(x), f64::from(y)));
        let node = (place, handle.clone(), handle, 0..6u8).prop_map(|(at, back, out, how)| match how {
            0 => [at, back, (-back.0, -back.1)],
            1 => [at, back, back],
            2 => [at, (out.0 * 1.001, out.1), out],
            3 => [at, (0.0, 0.0), out],
            _ => [at, back, out],
        });
        prop::collection::vec(node, 2..5)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn crossings_are_those_that_brute_force_finds(nodes in nodes()) {
            let found = self_crossing(&flattened(&nodes), FLATNESS_PX);
            let forced = [150, 157].map(|steps| by_force(&nodes, steps));
            if forced.iter().all(|all| all.iter().any(|&thickness| thickness >= 1e-2)) {
                prop_assert!(found.is_some(), "{nodes:?} {forced:?}");
            }
            // A loop may be smaller than those steps.
            if let Some(place) = found.filter(|_| forced.iter().all(Vec::is_empty)) {
                prop_assert!(crosses_near(&nodes, place), "{nodes:?}: {found:?}");
            }
        }
    }
}
