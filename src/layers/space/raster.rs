//! Which triangle each pixel of a frame shows: by exact signs of the same products on both sides of an edge, so that
//! triangles that share one neither overlap nor leave a gap. A pixel depends on nothing but its own place, so rows can be
//! computed on any core and in any order.
//!
//! A ray r meets a triangle a, b, c where r is a sum of the corners with weights of one sign: they are r . (b x c),
//! r . (c x a) and r . (a x b), and the same, divided by their sum, weigh attributes with perspective (Olano and Greer,
//! *Triangle Scan Conversion using 2D Homogeneous Coordinates*, 1997). Nothing need be clipped for that: what is nearer
//! than the near plane is skipped pixel by pixel.

use std::cmp::Ordering;

use glam::{DVec2, DVec3};
use kurbo::Vec2;
use rayon::prelude::*;

use super::eye::{Eye, NEAR_M};
use crate::layers::parts::moment::Columns;

/// No triangle.
pub const NONE: u32 = u32::MAX;

/// How far beyond its corners a triangle may reach by rounding, in pixels.
const SLACK_PX: f64 = 1e-6;

/// Of triangles that may cover more columns than these, the columns are found that they may cover in a row: slivers cover few.
const WIDE: usize = 16;

/// Triangles as one eye sees them.
pub struct Raster<'a> {
    triangles: &'a [[u32; 3]],
    /// The vertices in camera coordinates.
    seen: Vec<DVec3>,
    /// Whether triangles that face away are shown too.
    both: bool,
    /// The horizontal part of each column's ray, and the vertical part of each row's.
    rays: (Vec<f64>, Vec<f64>),
    /// What is known of each triangle in all rows.
    spans: Vec<Span>,
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

/// What is known of a triangle in all rows that it may cover. Kept small: there may be ten million.
#[derive(Clone, Copy, Default)]
struct Span {
    /// The first column that it may cover, and the one after the last.
    columns: [u32; 2],
    /// See [`order`].
    order: [u8; 3],
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
    /// `None` if the triangle is seen edge-on or from a side that is not shown. `order` is that of its corners.
    fn new(corners: [DVec3; 3], order: [u8; 3], both: bool) -> Option<Sides> {
        let order = order.map(usize::from);
        let [a, b, c] = order.map(|i| corners[i]);
        let swapped = (order[0] + 1) % 3 != order[1];
        let planes = [b.cross(c), c.cross(a), a.cross(b)];
        let volume = a.dot(planes[0]);
        let front = (volume < 0.0) != swapped;
        if volume == 0.0 || !volume.is_finite() || !(front || both) {
            return None;
        }
        // A change of sign is exact, so a side has the opposite values for the triangle on its other side.
        let inward = planes.map(|plane| plane * volume.signum());
        // A left side has its inside to the right; a top side is level and has its inside below.
        let owned = inward.map(|plane| plane.x > 0.0 || (plane.x == 0.0 && plane.y < 0.0));
        Some(Sides { order, inward, owned, volume: volume.abs(), front })
    }

    /// The depth at the ray (x, y, -1), in meters; `None` beside the triangle.
    #[inline]
    fn depth(&self, x: f64, y: f64) -> Option<f64> {
        let weights = weights(&self.inward, x, y);
        let inside = |k: usize| weights[k] > 0.0 || (weights[k] == 0.0 && self.owned[k]);
        (inside(0) && inside(1) && inside(2)).then(|| self.volume / (weights[0] + weights[1] + weights[2]))
    }

    /// Those of the columns `from..to` that it may cover in the row whose rays go down by `y`. The rays of columns, `along`, ascend.
    fn narrowed(&self, along: &[f64], y: f64, [mut from, mut to]: [usize; 2]) -> [usize; 2] {
        for plane in &self.inward {
            let side = -(plane.y * y - plane.z) / plane.x;
            // Beside a side by more than a column, no rounding leads across it.
            match plane.x {
                slope if slope > 0.0 && side.is_finite() => {
                    from = from.max(along.partition_point(|x| *x < side).saturating_sub(1));
                }
                slope if slope < 0.0 && side.is_finite() => to = to.min(along.partition_point(|x| *x <= side) + 1),
                _ => {}
            }
        }
        [from, to.max(from)]
    }

    /// `inward`, in the order in which the mesh has the corners.
    fn of_corners(&self) -> [DVec3; 3] {
        let mut planes = [DVec3::ZERO; 3];
        self.order.iter().zip(self.inward).for_each(|(corner, plane)| planes[*corner] = plane);
        planes
    }
}

/// What each of the planes weighs at the ray (x, y, -1).
#[inline]
fn weights(planes: &[DVec3; 3], x: f64, y: f64) -> [f64; 3] {
    planes.map(|plane| plane.x * x + (plane.y * y - plane.z))
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
        // Kept apart: the rows are not needed beyond this, and there may be ten million of both.
        let (mut spans, mut rows) = (Vec::new(), Vec::new());
        let found = triangles.par_iter().map(|triangle| {
            let corners = triangle.map(|i| seen[i as usize]);
            let order = order(corners);
            Sides::new(corners, order, both)?;
            let [low, high] = bounds(eye, corners)?;
            let columns = pixels(low.x, high.x, place.x, width);
            let rows = pixels(low.y, high.y, place.y, height);
            (columns[0] < columns[1] && rows[0] < rows[1]).then_some((Span { columns, order }, rows))
        });
        found.map(Option::unwrap_or_default).unzip_into_vecs(&mut spans, &mut rows);
        let of = |rows: &[u32; 2]| rows[0] as usize..rows[1] as usize;
        let mut starts = vec![0; height + 1];
        for rows in &rows {
            starts[1..][of(rows)].iter_mut().for_each(|count| *count += 1);
        }
        for y in 0..height {
            starts[y + 1] += starts[y];
        }
        let mut next = starts.clone();
        let mut of_rows = vec![0; starts[height]];
        for (i, rows) in rows.iter().enumerate() {
            for next in &mut next[of(rows)] {
                of_rows[*next] = i as u32;
                *next += 1;
            }
        }
        Raster { triangles, seen, both, rays, spans, starts, of_rows }
    }

    fn sides(&self, triangle: usize) -> Option<Sides> {
        Sides::new(self.triangles[triangle].map(|i| self.seen[i as usize]), self.spans[triangle].order, self.both)
    }

    /// For each wanted column of row `y`, the triangle that is nearest and nearer than `depth`, or [`NONE`]; its depth,
    /// in meters, goes to `depth`. Of triangles at the same depth the first wins.
    pub fn row(&self, y: usize, columns: Columns, depth: &mut [f64], triangles: &mut [u32]) {
        triangles.fill(NONE);
        let down = self.rays.1[y];
        for &triangle in &self.of_rows[self.starts[y]..self.starts[y + 1]] {
            let Some(sides) = self.sides(triangle as usize) else { continue };
            let mut columns_of = self.spans[triangle as usize].columns.map(|x| x as usize);
            if columns_of[1] - columns_of[0] > WIDE {
                columns_of = sides.narrowed(&self.rays.0, down, columns_of);
            }
            let [from, to] = columns_of;
            let mut meet = |cell: usize, along: f64| {
                if let Some(found) = sides.depth(along, down)
                    && (NEAR_M..depth[cell]).contains(&found)
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

    /// Calls `each` with every wanted cell of row `y` that shows one of these triangles at these depths, as
    /// [`Raster::row`] found them, and with what `of` knows of the triangle.
    #[inline]
    pub fn hits<T>(
        &self,
        y: usize,
        columns: Columns,
        (depth, triangles): (&[f64], &[u32]),
        of: impl Fn(usize) -> T,
        mut each: impl FnMut(usize, Hit, &T),
    ) {
        let down = self.rays.1[y];
        // Neighbors mostly show the same triangle.
        let mut last = (NONE, None);
        for (cell, &shown) in triangles.iter().enumerate().filter(|(_, triangle)| **triangle != NONE) {
            let triangle = shown as usize;
            if shown != last.0 {
                last = (shown, self.sides(triangle).map(|sides| (sides, sides.of_corners(), of(triangle))));
            }
            let Some((sides, planes, known)) = &last.1 else { continue };
            let along = self.rays.0[columns.at(cell)];
            // The sum is made in the order of the sides, as it was for the depth.
            let [a, b, c] = weights(&sides.inward, along, down);
            let sum = a + b + c;
            let weights = weights(planes, along, down).map(|weight| weight / sum);
            each(cell, Hit { triangle, weights, depth: depth[cell], front: sides.front }, known);
        }
    }
}

/// The corners in an order of their own: those of another triangle in another order get the same depths to the bit, since
/// sums are made in one order.
fn order(corners: [DVec3; 3]) -> [u8; 3] {
    let mut order = [0, 1, 2];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if compare(corners[usize::from(order[i])], corners[usize::from(order[j])]).is_gt() {
            order.swap(i, j);
        }
    }
    order
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

/// The pixels whose places lie between two coordinates: the first, and the one after the last.
fn pixels(low: f64, high: f64, place: f64, size: usize) -> [u32; 2] {
    let slack = SLACK_PX + (low.abs().max(high.abs())) * 1e-12;
    let from = (low - place - slack).ceil().clamp(0.0, size as f64);
    let to = ((high - place + slack).floor() + 1.0).clamp(0.0, size as f64);
    [from as u32, to as u32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::moment::CENTER;

    const SIZE: (usize, usize) = (40, 30);

    fn eye() -> Eye {
        Eye::new([DVec3::ZERO, -DVec3::Z, DVec3::Y], 60.0, SIZE)
    }

    /// A corner that is seen at a place of the frame.
    fn at(x: f64, y: f64, depth: f64) -> DVec3 {
        eye().ray(DVec2::new(x, y)) * depth
    }

    fn hit(raster: &Raster, x: usize, y: usize) -> Option<Hit> {
        let (mut depth, mut triangle, mut found) = ([f64::INFINITY], [NONE], None);
        let columns = Columns::Some(&[x]);
        raster.row(y, columns, &mut depth, &mut triangle);
        raster.hits(y, columns, (&depth, &triangle), |_| (), |_, hit, ()| found = Some(hit));
        found
    }

    fn frame(triangles: &[[u32; 3]], seen: &[DVec3], both: bool) -> Vec<u32> {
        let raster = Raster::new(&eye(), SIZE, CENTER, triangles, seen.to_vec(), both);
        let row = |y: usize| {
            let (mut depth, mut row) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
            raster.row(y, Columns::All, &mut depth, &mut row);
            row
        };
        (0..SIZE.1).flat_map(row).collect()
    }

    /// Depths and weights of triangles wherever they happen to be, around the eye and through the near plane.
    #[test]
    fn every_bit_is_as_kept() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let seen: Vec<DVec3> = (0..60).map(|_| DVec3::new(next() * 4.0, next() * 4.0, next() * 4.0 - 1.5)).collect();
        let triangles: Vec<[u32; 3]> = (0..40).map(|_| [0; 3].map(|_| ((next() + 0.5) * 60.0) as u32)).collect();
        let (mut hits, mut sum) = (0, 0_u64);
        for both in [false, true] {
            let raster = Raster::new(&eye(), SIZE, CENTER, &triangles, seen.clone(), both);
            for y in 0..SIZE.1 {
                let (mut depth, mut row) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
                raster.row(y, Columns::All, &mut depth, &mut row);
                let add = |cell: usize, hit: Hit, (): &()| {
                    hits += 1;
                    let [a, b, c] = hit.weights;
                    let whole = [cell as u64, hit.triangle as u64, u64::from(hit.front)];
                    for number in whole.into_iter().chain([hit.depth, a, b, c].map(f64::to_bits)) {
                        sum = (sum ^ number).wrapping_mul(0x0100_0000_01b3).rotate_left(23);
                    }
                };
                raster.hits(y, Columns::All, (&depth, &row), |_| (), add);
            }
        }
        assert_eq!((hits, sum), (2321, 0xb052_56b0_546b_12fc));
    }

    #[test]
    fn what_a_row_looks_at_is_all_that_a_triangle_covers() {
        let mut state = 7_u32;
        let mut any = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        // Some corners lie on whole columns and rows, and some triangles are slivers across the frame.
        let mut corner = |k: usize| {
            let (x, y, depth) = (any() * 60.0 - 10.0, any() * 50.0 - 10.0, any() * 4.0 - 0.5);
            if k.is_multiple_of(3) { at(x.round() + 0.5, y.round() + 0.5, depth) } else { at(x, y, depth) }
        };
        let seen: Vec<DVec3> = (0..600).map(&mut corner).collect();
        let triangles: Vec<[u32; 3]> = (0..598).map(|i| [i, i + 1, if i % 4 == 0 { i + 1 } else { i + 2 }]).collect();
        let raster = Raster::new(&eye(), SIZE, CENTER, &triangles, seen, true);
        let mut covered = 0;
        for y in 0..SIZE.1 {
            let (mut depth, mut shown) = (vec![f64::INFINITY; SIZE.0], vec![NONE; SIZE.0]);
            raster.row(y, Columns::All, &mut depth, &mut shown);
            for x in 0..SIZE.0 {
                let mut nearest = (f64::INFINITY, NONE);
                for (i, triangle) in triangles.iter().enumerate() {
                    let corners = triangle.map(|corner| raster.seen[corner as usize]);
                    let sides = Sides::new(corners, order(corners), true);
                    let found = sides.and_then(|sides| sides.depth(raster.rays.0[x], raster.rays.1[y]));
                    if let Some(found) = found.filter(|found| (NEAR_M..nearest.0).contains(found)) {
                        nearest = (found, i as u32);
                    }
                }
                assert_eq!((depth[x], shown[x]), nearest, "{x} {y}");
                covered += usize::from(nearest.1 != NONE);
            }
        }
        assert!(covered > 600, "{covered}");
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
        // A square whose corners are centers of pixels, at a depth that keeps them exact.
        let eye = Eye { focal_px: 32.0, ..eye() };
        let corner = |x: f64, y: f64| eye.ray(DVec2::new(x, y)) * 2.0;
        let seen = [corner(4.5, 3.5), corner(8.5, 3.5), corner(8.5, 7.5), corner(4.5, 7.5)].to_vec();
        let triangles = [[0, 2, 1], [0, 3, 2]];
        let raster = Raster::new(&eye, SIZE, CENTER, &triangles, seen, false);
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
        let raster = Raster::new(&eye(), SIZE, CENTER, &triangles, seen.to_vec(), false);
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
        let raster = Raster::new(&eye(), SIZE, CENTER, &triangles, seen.to_vec(), false);
        assert_eq!(hit(&raster, 30, 29), None);
        let hit = hit(&raster, 15, 16).unwrap();
        let point: DVec3 = (0..3).map(|k| seen[k] * hit.weights[k]).sum();
        let ray = eye().ray(DVec2::new(15.5, 16.5));
        assert!((point - ray * hit.depth).length() < 1e-12, "{point} {}", ray * hit.depth);
        assert!((hit.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
