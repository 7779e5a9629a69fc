//! Which triangle each pixel of a frame shows: by exact signs of the same products on both sides of an edge, so that
//! triangles that share one neither overlap nor leave a gap. A pixel depends on nothing but its own place, so rows can be
//! computed on any core and in any order.
//!
//! A ray r meets a triangle a, b, c where r is a sum of the corners with weights of one sign: they are r . (b x c),
//! r . (c x a) and r . (a x b), and the same, divided by their sum, weigh attributes with perspective (Olano and Greer,
//! *Triangle Scan Conversion using 2D Homogeneous Coordinates*, 1997). Nothing need be clipped for that: what is nearer
//! than the near plane is skipped pixel by pixel.

use std::cmp::Ordering;
use std::ops::Range;

use glam::{DVec2, DVec3};
use kurbo::Vec2;
use rayon::prelude::*;

use super::eye::{Eye, NEAR_M};
use crate::layers::parts::moment::Columns;

/// No triangle.
pub const NONE: u32 = u32::MAX;

/// How far beyond its corners a triangle may reach by rounding, in pixels.
const SLACK_PX: f64 = 1e-6;

/// Triangles as one eye sees them.
pub struct Raster<'a> {
    triangles: &'a [[u32; 3]],
    /// The vertices in camera coordinates.
    seen: Vec<DVec3>,
    /// Whether triangles that face away are shown too.
    both: bool,
    /// The horizontal part of each column's ray, and the vertical part of each row's.
    rays: (Vec<f64>, Vec<f64>),
    /// The first and last column that each triangle may cover.
    columns: Vec<[u32; 2]>,
    /// The triangles that each row may show, ascending: those of row y are `of_rows[starts[y]..starts[y + 1]]`.
    starts: Vec<usize>,
    of_rows: Vec<u32>,
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle.
    pub triangle: usize,
    /// How much each of its corners counts there; the sum is 1.
    pub weights: [f64; 3],
    /// The depth there, in meters.
    pub depth: f64,
    /// Whether the front of the triangle is seen.
    pub front: bool,
}

/// A triangle in front of a ray.
#[derive(Clone, Copy)]
struct Sides {
    /// The corners in the order of what follows.
    order: [usize; 3],
    /// The normals of the planes through the eye and the side opposite each corner, pointing inward.
    inward: [DVec3; 3],
    /// Whether a ray in the plane of a side still belongs to the triangle.
    owned: [bool; 3],
    /// Six times the volume of the triangle and the eye.
    volume: f64,
    front: bool,
}

impl Sides {
    /// `None` if the triangle is seen edge-on or from a side that is not shown.
    fn new(corners: [DVec3; 3], both: bool) -> Option<Sides> {
        // The same corners in another order get the same depth to the bit: sums are made in one order.
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| compare(corners[i], corners[j]));
        let [a, b, c] = order.map(|i| corners[i]);
        let swapped = matches!(order, [0, 2, 1] | [1, 0, 2] | [2, 1, 0]);
        let planes = [b.cross(c), c.cross(a), a.cross(b)];
        let volume = a.dot(planes[0]);
        let front = (volume < 0.0) != swapped;
        if volume == 0.0 || !volume.is_finite() || !(front || both) {
            return None;
        }
        // Negation is exact, so a side has the opposite values for the triangle on its other side.
        let inward = if volume < 0.0 { planes.map(|plane| -plane) } else { planes };
        // A left side has its inside to the right; a top side is level and has its inside below.
        let owned = inward.map(|plane| plane.x > 0.0 || (plane.x == 0.0 && plane.y < 0.0));
        Some(Sides { order, inward, owned, volume: volume.abs(), front })
    }

    /// The weights, not yet divided by their sum, at the ray (x, y, -1), and the depth; `None` beside the triangle.
    #[inline]
    fn at(&self, x: f64, y: f64) -> Option<([f64; 3], f64)> {
        let weight = |k: usize| self.inward[k].x * x + (self.inward[k].y * y - self.inward[k].z);
        let weights = [weight(0), weight(1), weight(2)];
        let inside = |k: usize| weights[k] > 0.0 || (weights[k] == 0.0 && self.owned[k]);
        if !(inside(0) && inside(1) && inside(2)) {
            return None;
        }
        let depth = self.volume / (weights[0] + weights[1] + weights[2]);
        (depth >= NEAR_M && depth.is_finite()).then_some((weights, depth))
    }
}

impl<'a> Raster<'a> {
    /// The triangles of these vertices, in camera coordinates, in a frame of this width and height. `place` is the
    /// place in each pixel that is looked at; `both` also shows what faces away.
    pub fn new(
        eye: &Eye,
        (width, height): (usize, usize),
        place: Vec2,
        triangles: &'a [[u32; 3]],
        seen: Vec<DVec3>,
        both: bool,
    ) -> Self {
        let along = |x: usize| eye.ray(DVec2::new(x as f64 + place.x, 0.0)).x;
        let down = |y: usize| eye.ray(DVec2::new(0.0, y as f64 + place.y)).y;
        let rays = ((0..width).map(along).collect(), (0..height).map(down).collect());
        let spans: Vec<[Range<usize>; 2]> = triangles
            .par_iter()
            .map(|triangle| {
                let [low, high] = bounds(eye, triangle.map(|i| seen[i as usize]))?;
                Some([pixels(low.x, high.x, place.x, width), pixels(low.y, high.y, place.y, height)])
            })
            .map(|spans| spans.filter(|spans| spans.iter().all(|span| !span.is_empty())).unwrap_or([0..0, 0..0]))
            .collect();
        let mut starts = vec![0; height + 1];
        for [_, rows] in &spans {
            starts[rows.start + 1..rows.end + 1].iter_mut().for_each(|count| *count += 1);
        }
        for y in 0..height {
            starts[y + 1] += starts[y];
        }
        let mut next = starts.clone();
        let mut of_rows = vec![0; starts[height]];
        for (i, [_, rows]) in spans.iter().enumerate() {
            for next in &mut next[rows.clone()] {
                of_rows[*next] = i as u32;
                *next += 1;
            }
        }
        let columns = spans.into_iter().map(|[columns, _]| [columns.start as u32, columns.end as u32]).collect();
        Raster { triangles, seen, both, rays, columns, starts, of_rows }
    }

    fn sides(&self, triangle: usize) -> Option<Sides> {
        Sides::new(self.triangles[triangle].map(|i| self.seen[i as usize]), self.both)
    }

    /// For each wanted column of row `y`, the triangle that is nearest and nearer than `depth`, or [`NONE`]; its depth,
    /// in meters, goes to `depth`. Of triangles at the same depth the first wins.
    pub fn row(&self, y: usize, columns: Columns, depth: &mut [f64], triangles: &mut [u32]) {
        triangles.fill(NONE);
        let down = self.rays.1[y];
        for &triangle in &self.of_rows[self.starts[y]..self.starts[y + 1]] {
            let Some(sides) = self.sides(triangle as usize) else { continue };
            let [from, to] = self.columns[triangle as usize].map(|x| x as usize);
            let mut meet = |cell: usize, along: f64| {
                if let Some((_, found)) = sides.at(along, down)
                    && found < depth[cell]
                {
                    depth[cell] = found;
                    triangles[cell] = triangle;
                }
            };
            match columns {
                Columns::All => (from..to).for_each(|x| meet(x, self.rays.0[x])),
                Columns::Some(wanted) => {
                    let first = wanted.partition_point(|x| *x < from);
                    let last = wanted.partition_point(|x| *x < to);
                    (first..last).for_each(|cell| meet(cell, self.rays.0[wanted[cell]]));
                }
            }
        }
    }

    /// What the pixel in column `x`, row `y` shows of a triangle that [`Raster::row`] found there.
    pub fn hit(&self, x: usize, y: usize, triangle: u32) -> Option<Hit> {
        let triangle = triangle as usize;
        let sides = self.sides(triangle)?;
        let (weights, depth) = sides.at(self.rays.0[x], self.rays.1[y])?;
        let sum = weights[0] + weights[1] + weights[2];
        let mut of_corners = [0.0; 3];
        sides.order.iter().zip(weights).for_each(|(corner, weight)| of_corners[*corner] = weight / sum);
        Some(Hit { triangle, weights: of_corners, depth, front: sides.front })
    }
}

fn compare(a: DVec3, b: DVec3) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// The smallest rectangle of the frame that has all of a triangle that is not nearer than the near plane.
fn bounds(eye: &Eye, corners: [DVec3; 3]) -> Option<[DVec2; 2]> {
    let before = |p: DVec3| -p.z >= NEAR_M;
    let mut found: Option<[DVec2; 2]> = None;
    let mut add = |p: DVec3| {
        let at = eye.project(p);
        found = Some(found.map_or([at, at], |[low, high]| [low.min(at), high.max(at)]));
    };
    for k in 0..3 {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        if before(from) {
            add(from);
        }
        if before(from) != before(to) {
            let share = (-NEAR_M - from.z) / (to.z - from.z);
            let cut = from.lerp(to, share);
            add(DVec3::new(cut.x, cut.y, -NEAR_M));
        }
    }
    found
}

/// The pixels whose places lie between two coordinates.
fn pixels(low: f64, high: f64, place: f64, size: usize) -> Range<usize> {
    let slack = SLACK_PX + (low.abs().max(high.abs())) * 1e-12;
    let from = (low - place - slack).ceil().clamp(0.0, size as f64);
    let to = ((high - place + slack).floor() + 1.0).clamp(0.0, size as f64);
    from as usize..to as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::moment::CENTRE;

    const SIZE: (usize, usize) = (40, 30);

    fn eye() -> Eye {
        Eye::new([DVec3::ZERO, -DVec3::Z, DVec3::Y], 60.0, SIZE)
    }

    /// A corner that is seen at a place of the frame.
    fn at(x: f64, y: f64, depth: f64) -> DVec3 {
        eye().ray(DVec2::new(x, y)) * depth
    }

    fn frame(triangles: &[[u32; 3]], seen: &[DVec3], both: bool) -> Vec<u32> {
        let raster = Raster::new(&eye(), SIZE, CENTRE, triangles, seen.to_vec(), both);
        let row = |y: usize| {
            let (mut depth, mut row) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
            raster.row(y, Columns::All, &mut depth, &mut row);
            row
        };
        (0..SIZE.1).flat_map(row).collect()
    }

    #[test]
    fn a_shared_side_belongs_to_one_triangle() {
        // Fans round a middle: every pixel of the inside is covered exactly once, wherever the corners are.
        for (middle, far) in [((20.5, 15.5), 3.0), ((20.0, 15.0), 9.0), ((17.3, 11.1), 1.5)] {
            let rim = [(10.5, 5.5), (30.5, 5.5), (30.5, 25.5), (20.5, 25.5), (10.5, 25.5)];
            let mut seen = vec![at(middle.0, middle.1, far)];
            seen.extend(rim.iter().enumerate().map(|(i, &(x, y))| at(x, y, 1.0 + i as f64)));
            let fan: Vec<[u32; 3]> = (1..=5).map(|i| [0, i % 5 + 1, i]).collect();
            let mut counts = vec![0; SIZE.0 * SIZE.1];
            for triangle in &fan {
                let covered = frame(&[*triangle], &seen, false);
                counts.iter_mut().zip(covered).for_each(|(count, found)| *count += usize::from(found != NONE));
            }
            let inside = |i: usize| (11..30).contains(&(i % SIZE.0)) && (6..25).contains(&(i / SIZE.0));
            assert!((0..counts.len()).all(|i| counts[i] <= 1 && (!inside(i) || counts[i] == 1)), "{middle:?}");
        }
    }

    #[test]
    fn top_and_left_sides_own_their_pixels() {
        // A square whose corners are centres of pixels, at a depth that keeps them exact.
        let eye = Eye { focal_px: 32.0, ..eye() };
        let corner = |x: f64, y: f64| eye.ray(DVec2::new(x, y)) * 2.0;
        let seen = [corner(4.5, 3.5), corner(8.5, 3.5), corner(8.5, 7.5), corner(4.5, 7.5)].to_vec();
        let triangles = [[0, 2, 1], [0, 3, 2]];
        let raster = Raster::new(&eye, SIZE, CENTRE, &triangles, seen, false);
        let covered = |y: usize| {
            let (mut depth, mut row) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
            raster.row(y, Columns::All, &mut depth, &mut row);
            (0..SIZE.0).filter(|&x| row[x] != NONE).collect::<Vec<_>>()
        };
        assert!(covered(2).is_empty());
        assert_eq!(covered(3), [4, 5, 6, 7]);
        assert_eq!(covered(6), [4, 5, 6, 7]);
        assert!(covered(7).is_empty());
    }

    #[test]
    fn the_nearest_wins_then_the_first() {
        let square = |depth: f64| [at(5.0, 5.0, depth), at(5.0, 25.0, depth), at(35.0, 25.0, depth)];
        let seen: Vec<DVec3> = [square(3.0), square(2.0), square(2.0)].concat();
        let found = frame(&[[0, 1, 2], [3, 4, 5], [6, 7, 8]], &seen, false);
        assert_eq!(found[20 * SIZE.0 + 15], 1);
        assert_eq!(found.iter().filter(|&&t| t == 0 || t == 2).count(), 0);
    }

    #[test]
    fn of_the_same_corners_in_any_order_the_first_wins() {
        let seen = [at(3.1, 4.7, 1.3), at(7.7, 27.3, 2.9), at(36.2, 11.9, 4.1)];
        let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        let alone = frame(&[orders[0]], &seen, true);
        assert!(alone.iter().filter(|&&triangle| triangle == 0).count() > 100);
        for other in orders {
            assert_eq!(frame(&[orders[0], other], &seen, true), alone, "{other:?}");
            assert_eq!(frame(&[other, orders[0]], &seen, true), alone, "{other:?}");
        }
    }

    #[test]
    fn what_faces_away_is_seen_only_on_demand() {
        let seen = [at(5.0, 5.0, 2.0), at(35.0, 25.0, 2.0), at(5.0, 25.0, 2.0)];
        let middle = 20 * SIZE.0 + 10;
        assert_eq!(frame(&[[0, 1, 2]], &seen, false)[middle], NONE);
        assert_eq!(frame(&[[0, 1, 2]], &seen, true)[middle], 0);
        assert_eq!(frame(&[[0, 2, 1]], &seen, false)[middle], 0);
    }

    #[test]
    fn a_floor_under_the_eye_is_cut_at_the_near_plane() {
        // It reaches from behind the eye to far in front.
        let seen = [DVec3::new(-50.0, -1.0, 50.0), DVec3::new(50.0, -1.0, 50.0), DVec3::new(0.0, -1.0, -400.0)];
        let triangles = [[0, 1, 2]];
        let raster = Raster::new(&eye(), SIZE, CENTRE, &triangles, seen.to_vec(), false);
        for y in 0..SIZE.1 {
            let (mut depth, mut row) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
            raster.row(y, Columns::All, &mut depth, &mut row);
            let expected = -1.0 / eye().ray(DVec2::new(20.5, y as f64 + 0.5)).y;
            let shown = row[20] == 0;
            assert_eq!(shown, y >= 15 && expected < 350.0, "row {y}");
            assert!(!shown || (depth[20] - expected).abs() < 1e-9 * expected, "row {y}: {} {expected}", depth[20]);
        }
    }

    #[test]
    fn attributes_follow_the_perspective() {
        let seen = [at(5.0, 15.0, 1.0), at(5.0, 25.0, 1.0), at(35.0, 15.0, 5.0)];
        let triangles = [[0, 1, 2]];
        let raster = Raster::new(&eye(), SIZE, CENTRE, &triangles, seen.to_vec(), false);
        let hit = raster.hit(15, 16, 0).unwrap();
        let point: DVec3 = (0..3).map(|k| seen[k] * hit.weights[k]).sum();
        let ray = eye().ray(DVec2::new(15.5, 16.5));
        assert!((point - ray * hit.depth).length() < 1e-12, "{point} {}", ray * hit.depth);
        assert!((hit.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert_eq!(raster.hit(30, 29, 0), None);
    }
}
