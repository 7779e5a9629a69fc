//! Where jump paths meet the fold regions. Along a path, membership of a region changes at the sides that the path
//! crosses; the regions count as their union (docs/folding.md, section 3).

use kurbo::{Point, Rect, Vec2};

use super::outline::Outline;
use crate::base::chains::{Line, Part};
use crate::base::geometry::Polygon;

/// Crossings closer to each other than this, as a share of the path, are the same place: regions that share a side have
/// no gap between them.
const SAME: f64 = 1e-9;

/// The fold regions of a zone.
pub struct Regions {
    polygons: Vec<Polygon>,
}

/// Where one path meets the union of the regions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Whether the init-position itself is in a region (s = 0).
    pub inside: bool,
    /// The places s >= 0 at which membership changes, ascending.
    pub ahead: Vec<f64>,
    /// The places s <= 0 at which membership changes, descending.
    pub behind: Vec<f64>,
}

/// Sides that a run of paths may cross, and the region they belong to.
pub struct Near {
    region: usize,
    part: Part,
}

impl Regions {
    /// The regions as polygons.
    pub fn new(outlines: &[Outline]) -> Self {
        Regions { polygons: outlines.iter().map(Outline::polygon).collect() }
    }

    /// The regions as polygons.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }

    /// Number of regions.
    pub fn count(&self) -> usize {
        self.polygons.len()
    }

    /// The sides that can meet paths within `bounds`; most runs of pixels have none.
    pub fn sides_within(&self, bounds: Rect) -> Vec<Near> {
        let bounds = bounds.inflate(1e-6, 1e-6);
        let of_region = |(region, polygon): (usize, &Polygon)| {
            polygon.parts_near(bounds).into_iter().map(move |part| Near { region, part })
        };
        self.polygons.iter().enumerate().flat_map(of_region).collect()
    }

    /// Which regions contain each of the `len` places from `first` on, one pixel apart: one list of flags per region.
    pub fn memberships(&self, first: Point, len: usize) -> Vec<Vec<bool>> {
        let mut xs = Vec::new();
        let row = |polygon: &Polygon| {
            polygon.row_crossings(first.y, &mut xs);
            (0..len).map(|k| xs.partition_point(|&x| x <= first.x + k as f64) % 2 == 1).collect()
        };
        self.polygons.iter().map(row).collect()
    }

    /// Where the path from `q` along `jump` meets the union, for s in `low..=high`. `sides` must include all that the
    /// path can cross; `member` says which regions contain `q`.
    pub fn crossings(
        &self,
        q: Point,
        jump: Vec2,
        (low, high): (f64, f64),
        sides: &[Near],
        member: &[bool],
    ) -> Crossings {
        let inside = member.iter().any(|&m| m);
        if sides.is_empty() || jump == Vec2::ZERO {
            return Crossings { inside, ..Crossings::default() };
        }
        let mut events: Vec<(f64, usize)> = Vec::new();
        let line = Line::new(q, jump);
        for &Near { region, part } in sides {
            self.polygons[region].crossings_in(part, &line, &mut |s| {
                if s >= low - SAME && s <= high + SAME {
                    events.push((s, region));
                }
            });
        }
        if events.is_empty() {
            return Crossings { inside, ..Crossings::default() };
        }
        events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let first_ahead = events.partition_point(|(s, _)| *s < -SAME);
        let first_beyond = events.partition_point(|(s, _)| *s <= SAME);
        let at_init = first_ahead < first_beyond;
        let start = |sign: f64| if at_init { self.member_beside(q, jump, sign) } else { member.to_vec() };
        let ahead = events[first_beyond..].iter().copied();
        let behind = events[..first_ahead].iter().rev().copied();
        Crossings {
            inside,
            ahead: changes(inside, start(1.0), ahead).into_iter().filter(|s| *s <= high).collect(),
            behind: changes(inside, start(-1.0), behind).into_iter().filter(|s| *s >= low).collect(),
        }
    }

    /// Which regions contain the places just beside an init-position that is exactly on a side: by the parity of the
    /// crossings beyond.
    fn member_beside(&self, q: Point, jump: Vec2, sign: f64) -> Vec<bool> {
        let parity = |polygon: &Polygon| {
            let crossings = polygon.line_crossings(q, jump);
            crossings.iter().filter(|&s| s * sign > SAME).count() % 2 == 1
        };
        self.polygons.iter().map(parity).collect()
    }
}

/// Walks from s = 0 outwards through `events` (places, and the region that changes there) and lists where the union
/// changes. `member` says which regions contain the places just beside s = 0.
fn changes(inside: bool, mut member: Vec<bool>, events: impl Iterator<Item = (f64, usize)>) -> Vec<f64> {
    let mut found = Vec::new();
    let mut before = inside;
    let mut place = 0.0f64;
    for (s, region) in events {
        if (s - place).abs() > SAME {
            let now = member.iter().any(|&m| m);
            if now != before {
                found.push(place);
            }
            (before, place) = (now, s);
        }
        member[region] = !member[region];
    }
    if member.iter().any(|&m| m) != before {
        found.push(place);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, size: f64) -> Outline {
        Outline::Rectangle { x, y, width: size, height: size }
    }

    fn find(regions: &[Outline], q: (f64, f64), jump: (f64, f64), range: (f64, f64)) -> (bool, Vec<f64>, Vec<f64>) {
        let regions = Regions::new(regions);
        let (q, jump) = (Point::from(q), Vec2::from(jump));
        let bounds = Rect::from_points(q + jump * range.0, q + jump * range.1);
        let sides = regions.sides_within(bounds);
        let member: Vec<bool> = regions.memberships(q, 1).iter().map(|m| m[0]).collect();
        let found = regions.crossings(q, jump, range, &sides, &member);
        (found.inside, found.ahead, found.behind)
    }

    #[test]
    fn paths_meet_regions() {
        let one = [square(10.0, 0.0, 10.0)];
        let touching = [square(10.0, 0.0, 10.0), square(20.0, 0.0, 10.0)];
        let overlapping = [square(10.0, 0.0, 10.0), square(15.0, -5.0, 10.0)];
        for (regions, q, jump, range, expected) in [
            (&one[..], (0.0, 5.0), (40.0, 0.0), (0.0, 1.0), (false, vec![0.25, 0.5], vec![])),
            (&one, (0.0, 5.0), (16.0, 0.0), (0.0, 1.0), (false, vec![0.625], vec![])),
            (&one, (0.0, 5.0), (16.0, 0.0), (0.0, 2.0), (false, vec![0.625, 1.25], vec![])),
            (&one, (15.0, 5.0), (10.0, 0.0), (-1.0, 1.0), (true, vec![0.5], vec![-0.5])),
            (&one, (15.0, 5.0), (0.0, 0.0), (-1.0, 1.0), (true, vec![], vec![])),
            (&one, (0.0, 5.0), (0.0, 9.0), (0.0, 1.0), (false, vec![], vec![])),
            (&touching, (0.0, 5.0), (40.0, 0.0), (0.0, 1.0), (false, vec![0.25, 0.75], vec![])),
            (&overlapping, (0.0, 2.5), (50.0, 0.0), (0.0, 1.0), (false, vec![0.2, 0.5], vec![])),
            // on a left edge, which is inside: leaving to the left, staying to the right
            (&one, (10.0, 5.0), (-10.0, 0.0), (-0.5, 1.0), (true, vec![0.0], vec![])),
            (&one, (10.0, 5.0), (10.0, 0.0), (-0.5, 0.5), (true, vec![], vec![0.0])),
            // on a right edge, which is outside
            (&one, (20.0, 5.0), (-20.0, 0.0), (0.0, 1.0), (false, vec![0.0, 0.5], vec![])),
            // diagonally through two corners
            (&one, (0.0, -10.0), (40.0, 40.0), (0.0, 1.0), (false, vec![0.25, 0.5], vec![])),
        ] {
            let found = find(regions, q, jump, range);
            let near = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(
                found.0 == expected.0 && near(&found.1, &expected.1) && near(&found.2, &expected.2),
                "{q:?} {jump:?}: {found:?}, not {expected:?}"
            );
        }
    }
}
