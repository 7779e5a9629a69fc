//! Where jump paths meet the fold regions. Along a path, membership of a region changes at the sides that the path
//! crosses; the regions count as their union (docs/folding.md, section 3).

use kurbo::{Point, Rect, Vec2};

use super::outline::Outline;
use crate::base::chains::Line;
use crate::base::geometry::Polygon;
use crate::base::pieces::Piece;

/// Crossings closer to each other than this, as a share of the path, are the same place: regions that share a side have
/// no gap between them.
pub const SAME: f64 = 1e-9;

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

/// What paths are followed with, one after the other.
#[derive(Default)]
pub struct Walk {
    /// Places where membership of a region changes, and the region.
    events: Vec<(f64, usize)>,
    /// Which regions contain the places just beside the init-position.
    beside: Vec<bool>,
    found: Crossings,
}

/// Sides that a run of paths may cross, and the region they belong to.
pub struct Near {
    region: usize,
    /// The sides.
    pub piece: Piece,
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

    /// The sides that can meet paths within `bounds`; most runs of pixels have none.
    pub fn sides_within(&self, bounds: Rect) -> Vec<Near> {
        let bounds = bounds.inflate(1e-6, 1e-6);
        let of_region = |(region, polygon): (usize, &Polygon)| {
            polygon.pieces_near(bounds).into_iter().map(move |piece| Near { region, piece })
        };
        self.polygons.iter().enumerate().flat_map(of_region).collect()
    }

    /// Which regions contain `q`.
    pub fn members(&self, q: Point) -> Vec<bool> {
        self.polygons.iter().map(|polygon| polygon.contains(q)).collect()
    }

    /// Where the path from `q` along `jump` meets the union, for s in `low..=high`. `sides` must include all that the
    /// path can cross; `member` says which regions contain `q`.
    pub fn follow<'a, 'b>(
        &self,
        (q, jump): (Point, Vec2),
        (low, high): (f64, f64),
        sides: impl IntoIterator<Item = &'b Near>,
        member: &[bool],
        walk: &'a mut Walk,
    ) -> &'a Crossings {
        let Walk { events, beside, found } = walk;
        found.inside = member.contains(&true);
        found.ahead.clear();
        found.behind.clear();
        events.clear();
        let line = Line::new(q, jump);
        for Near { region, piece } in sides.into_iter().filter(|_| jump != Vec2::ZERO) {
            self.polygons[*region].crossings_of(piece, &line, &mut |s| {
                if s >= low - SAME && s <= high + SAME {
                    events.push((s, *region));
                }
            });
        }
        if events.is_empty() {
            return found;
        }
        events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let first_ahead = events.partition_point(|(s, _)| *s < -SAME);
        let first_beyond = events.partition_point(|(s, _)| *s <= SAME);
        let start = |sign: f64, beside: &mut Vec<bool>| {
            beside.clear();
            match first_ahead < first_beyond {
                true => beside.extend(self.polygons.iter().map(|polygon| is_inside_beside(polygon, q, jump, sign))),
                false => beside.extend_from_slice(member),
            }
        };
        start(1.0, beside);
        changes(found.inside, beside, events[first_beyond..].iter(), &mut found.ahead);
        start(-1.0, beside);
        changes(found.inside, beside, events[..first_ahead].iter().rev(), &mut found.behind);
        found.ahead.retain(|s| *s <= high);
        found.behind.retain(|s| *s >= low);
        found
    }
}

/// Whether the place just beside an init-position that is exactly on a side is inside: by the parity of the crossings
/// beyond, along the jump vector or, with a negative `sign`, against it.
fn is_inside_beside(polygon: &Polygon, q: Point, jump: Vec2, sign: f64) -> bool {
    polygon.line_crossings(q, jump).iter().filter(|&s| s * sign > SAME).count() % 2 == 1
}

/// Walks from s = 0 outwards through `events` (places, and the region that changes there) and lists where the union
/// changes. `member` says which regions contain the places just beside s = 0.
fn changes<'a>(
    inside: bool,
    member: &mut [bool],
    events: impl Iterator<Item = &'a (f64, usize)>,
    found: &mut Vec<f64>,
) {
    let mut before = inside;
    let mut place = 0.0f64;
    for &(s, region) in events {
        if (s - place).abs() > SAME {
            let now = member.contains(&true);
            if now != before {
                found.push(place);
            }
            (before, place) = (now, s);
        }
        member[region] = !member[region];
    }
    if member.contains(&true) != before {
        found.push(place);
    }
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
        let member = regions.members(q);
        let mut walk = Walk::default();
        let found = regions.follow((q, jump), range, &sides, &member, &mut walk);
        (found.inside, found.ahead.clone(), found.behind.clone())
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
