//! Where a layer has a rim, and how far each pixel is from it.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::base::simd::vectorised;

/// Steps in depth are known to this share.
const SURE: f64 = 1e-6;

/// What is known of each pixel of a frame.
pub struct Pixels<'a> {
    /// Width and height.
    pub size_px: (usize, usize),
    /// Distance of the picture plane, in pixels.
    pub focal_px: f64,
    /// 1 / the depth of what it shows; 0 where that is nothing.
    pub inverse: &'a [f64],
    /// The triangle of the layer that it shows, `u32::MAX` where it shows none.
    pub triangle: &'a [u32],
    /// The normal there.
    pub normal: &'a [Vec3],
    /// 1 / the depth of a triangle's plane at a pixel (x, y): x times the first, y times the second, plus the third.
    pub plane: &'a (dyn Fn(u32) -> DVec3 + Sync),
}

/// What makes a rim within the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// A step in depth by more than so many pixels.
    pub step_px: f64,
    /// The cosine of the least angle between normals; `None` if they make none.
    pub crease: Option<f64>,
}

impl Pixels<'_> {
    /// Whether each pixel is at a rim of the layer.
    pub fn rim(&self, rules: &Rules) -> Vec<bool> {
        let (width, height) = self.size_px;
        let mut found = vec![false; width * height];
        found.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
            let planes = self.planes(y);
            vectorised(
                #[inline(always)]
                || self.may_be(rules, (y, &planes), row),
            );
            for (x, found) in row.iter_mut().enumerate().filter(|(_, found)| **found) {
                let i = y * width + x;
                if self.triangle[i] == u32::MAX {
                    *found = false;
                    continue;
                }
                let beside = [
                    (x > 0).then(|| i - 1),
                    (x + 1 < width).then(|| i + 1),
                    (y > 0).then(|| i - width),
                    (y + 1 < height).then(|| i + width),
                ];
                *found = beside.into_iter().flatten().any(|other| self.parts(rules, (i, planes[x]), other));
            }
        });
        found
    }

    /// The planes of the triangles of a row; 0 where the layer is not shown.
    fn planes(&self, y: usize) -> Vec<DVec3> {
        let width = self.size_px.0;
        // Neighbors mostly show the same triangle.
        let mut last = (u32::MAX, DVec3::ZERO);
        let plane = |own: &u32| {
            if *own != last.0 {
                last = (*own, if *own == u32::MAX { DVec3::ZERO } else { (self.plane)(*own) });
            }
            last.1
        };
        self.triangle[y * width..(y + 1) * width].iter().map(plane).collect()
    }

    /// Tells where in a row a rim may be, by the depth of what is beside alone: most pixels are then done with.
    #[inline(always)]
    fn may_be(&self, rules: &Rules, (y, planes): (usize, &[DVec3]), found: &mut [bool]) {
        let (width, height) = self.size_px;
        // The first and the last may be.
        found.fill(true);
        let Some(count) = width.checked_sub(2).filter(|_| rules.crease.is_none()) else { return };
        let row = |y: usize, x: usize| {
            let own = y * width + x..y * width + x + count;
            (&self.inverse[own.clone()], &self.triangle[own])
        };
        let beside = [row(y, 0), row(y, 2), row(y.saturating_sub(1), 1), row((y + 1).min(height - 1), 1)];
        let ((own, triangles), planes, found) = (row(y, 1), &planes[1..=count], &mut found[1..=count]);
        let step = rules.step_px / self.focal_px * (1.0 - SURE);
        for x in 0..count {
            let (here, DVec3 { x: right, y: down, .. }) = (own[x], planes[x]);
            let mut parts = false;
            for ((other, triangle), slope) in beside.iter().zip([-right, right, -down, down]) {
                let leaves = (triangle[x] == u32::MAX) | (here + slope - other[x] > step * here);
                parts |= (other[x] < here) & leaves;
            }
            found[x] = parts & (triangles[x] != u32::MAX);
        }
    }

    /// Whether a pixel of the layer, whose triangle has this plane, is at a rim toward its neighbor.
    fn parts(&self, rules: &Rules, (here, plane): (usize, DVec3), other: usize) -> bool {
        let farther = self.inverse[other] < self.inverse[here];
        if self.triangle[other] == u32::MAX {
            return farther;
        }
        let crease = rules.crease.is_some_and(|least| f64::from(self.normal[here].dot(self.normal[other])) < least);
        if crease || !farther {
            return crease;
        }
        let at = |plane: DVec3, i: usize| {
            let (x, y) = (i % self.size_px.0, i / self.size_px.0);
            plane.x * (x as f64 + 0.5) + plane.y * (y as f64 + 0.5) + plane.z
        };
        let is_step = |away: f64| away * self.focal_px / self.inverse[here] > rules.step_px;
        // Seen from both sides; the other plane is seldom asked for.
        is_step(at(plane, other) - self.inverse[other])
            && is_step(self.inverse[here] - at((self.plane)(self.triangle[other]), here))
    }
}

/// The square of the distance of each pixel to the nearest that is marked, in pixels; infinite where none is within
/// `reach` of its row and `reach` of its column.
pub fn squares((width, height): (usize, usize), marked: &[bool], reach: usize) -> Vec<f32> {
    let width = width.max(1);
    // Along each row, then down the columns.
    let mut rows = vec![0.0; marked.len()];
    rows.par_chunks_mut(width).zip(marked.par_chunks(width)).for_each(|(row, marked)| in_row(row, marked, reach));
    let any: Vec<bool> = rows.par_chunks(width).map(|row| row.iter().any(|square| square.is_finite())).collect();
    let mut out = vec![0.0; marked.len()];
    out.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        out.copy_from_slice(&rows[y * width..(y + 1) * width]);
        let near = y.saturating_sub(reach)..(y + reach + 1).min(height);
        vectorised(
            #[inline(always)]
            || {
                for other in near.filter(|other| any[*other]) {
                    let away = y.abs_diff(other) as f32;
                    for (out, square) in out.iter_mut().zip(&rows[other * width..(other + 1) * width]) {
                        let square = square + away * away;
                        *out = if square < *out { square } else { *out };
                    }
                }
            },
        );
    });
    out
}

/// The same among the pixels of a row.
fn in_row(row: &mut [f32], marked: &[bool], reach: usize) {
    let mut away = f32::INFINITY;
    for (out, marked) in row.iter_mut().zip(marked) {
        away = if *marked { 0.0 } else { away + 1.0 };
        *out = away;
    }
    away = f32::INFINITY;
    for out in row.iter_mut().rev() {
        away = out.min(away + 1.0);
        *out = if away <= reach as f32 { away * away } else { f32::INFINITY };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_exact() {
        let (width, height) = (23, 17);
        let marked: Vec<bool> = (0..width * height).map(|i| i * 7919 % 61 == 3).collect();
        for reach in [0, 3, 30] {
            let found = squares((width, height), &marked, reach);
            for (i, found) in found.iter().enumerate() {
                let all = marked.iter().enumerate().filter(|(_, marked)| **marked);
                let away = all.map(|(k, _)| ((k % width).abs_diff(i % width), (k / width).abs_diff(i / width)));
                let near = away.filter(|(x, y)| *x.max(y) <= reach).map(|(x, y)| (x * x + y * y) as f32);
                assert_eq!(*found, near.fold(f32::INFINITY, f32::min), "{i}, {reach}");
            }
        }
        assert!(squares((4, 3), &[false; 12], 9).iter().all(|square| *square == f32::INFINITY));
    }

    #[test]
    fn what_is_farther_or_bent_makes_a_rim() {
        // A row: the layer at depth 2, a step of its own to depth 4, another layer nearer, nothing.
        let inverse = [0.5, 0.5, 0.25, 0.25, 1.0, 0.25, 0.0];
        let triangle = [0, 0, 1, 2, u32::MAX, 1, u32::MAX];
        let normal = [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::X, Vec3::Z, Vec3::Z, Vec3::Z];
        let plane = |triangle: u32| DVec3::new(0.0, 0.0, if triangle == 0 { 0.5 } else { 0.25 });
        let pixels = Pixels {
            size_px: (7, 1),
            focal_px: 100.0,
            inverse: &inverse,
            triangle: &triangle,
            normal: &normal,
            plane: &plane,
        };
        let rim = |step_px: f64, crease: Option<f64>| pixels.rim(&Rules { step_px, crease });
        assert_eq!(rim(4.0, None), [false, true, false, false, false, true, false]);
        assert_eq!(rim(60.0, None), [false, false, false, false, false, true, false], "50 px");
        assert_eq!(rim(60.0, Some(0.5)), [false, false, true, true, false, true, false]);
    }
}
