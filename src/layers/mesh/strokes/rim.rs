//! Where a layer has a rim, and how far each pixel is from it.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

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
        let at = |i: usize| {
            let (x, y) = (i % width, i / width);
            let beside = [
                (x > 0).then(|| i - 1),
                (x + 1 < width).then(|| i + 1),
                (y > 0).then(|| i - width),
                (y + 1 < height).then(|| i + width),
            ];
            self.triangle[i] != u32::MAX && beside.into_iter().flatten().any(|other| self.parts(rules, i, other))
        };
        (0..width * height).into_par_iter().map(at).collect()
    }

    /// Whether a pixel of the layer is at a rim toward its neighbor.
    fn parts(&self, rules: &Rules, here: usize, other: usize) -> bool {
        let farther = self.inverse[other] < self.inverse[here];
        if self.triangle[other] == u32::MAX {
            return farther;
        }
        let crease = rules.crease.is_some_and(|least| f64::from(self.normal[here].dot(self.normal[other])) < least);
        if crease || !farther {
            return crease;
        }
        let plane = |triangle: u32, at: usize| {
            let plane = (self.plane)(triangle);
            let (x, y) = (at % self.size_px.0, at / self.size_px.0);
            plane.x * (x as f64 + 0.5) + plane.y * (y as f64 + 0.5) + plane.z
        };
        let from_own = plane(self.triangle[here], other) - self.inverse[other];
        let from_other = self.inverse[here] - plane(self.triangle[other], here);
        from_own.min(from_other) * self.focal_px / self.inverse[here] > rules.step_px
    }
}

/// The distance of each pixel to the nearest that is marked, in pixels; infinite if there is none. Exact (Felzenszwalb and
/// Huttenlocher 2012, "Distance Transforms of Sampled Functions").
pub fn distances((width, height): (usize, usize), marked: &[bool]) -> Vec<f64> {
    // Down each column, then along each row.
    let mut columns = vec![f64::INFINITY; width * height];
    columns.par_chunks_mut(height.max(1)).enumerate().for_each(|(x, column)| {
        let own: Vec<f64> = (0..height).map(|y| if marked[y * width + x] { 0.0 } else { f64::INFINITY }).collect();
        lower_envelope(&own, column);
    });
    let mut rows = vec![f64::INFINITY; width * height];
    rows.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        let own: Vec<f64> = (0..width).map(|x| columns[x * height + y]).collect();
        lower_envelope(&own, row);
        row.iter_mut().for_each(|square| *square = square.sqrt());
    });
    rows
}

/// For each place the least of all values, each plus the square of its distance.
fn lower_envelope(values: &[f64], out: &mut [f64]) {
    let (mut places, mut from): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
    for (q, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        let (own, q) = (q as f64, q);
        loop {
            let Some(&last) = places.last() else {
                places.push(q);
                from.push(f64::NEG_INFINITY);
                break;
            };
            let at = last as f64;
            let meets = ((value + own * own) - (values[last] + at * at)) / (2.0 * (own - at));
            if from.last().is_some_and(|from| meets <= *from) {
                places.pop();
                from.pop();
                continue;
            }
            places.push(q);
            from.push(meets);
            break;
        }
    }
    if places.is_empty() {
        return out.fill(f64::INFINITY);
    }
    let mut k = 0;
    for (x, out) in out.iter_mut().enumerate() {
        while k + 1 < places.len() && from[k + 1] < x as f64 {
            k += 1;
        }
        let away = x as f64 - places[k] as f64;
        *out = values[places[k]] + away * away;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_exact() {
        let (width, height) = (23, 17);
        let marked: Vec<bool> = (0..width * height).map(|i| i * 7919 % 61 == 3).collect();
        let found = distances((width, height), &marked);
        for (i, found) in found.iter().enumerate() {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let all = marked.iter().enumerate().filter(|(_, marked)| **marked);
            let away = all.map(|(k, _)| {
                glam::DVec2::new((k % width) as f64, (k / width) as f64).distance(glam::DVec2::new(x, y))
            });
            let least = away.fold(f64::INFINITY, f64::min);
            assert!((found - least).abs() < 1e-12, "{x} {y}: {found} {least}");
        }
        assert!(distances((4, 3), &[false; 12]).iter().all(|d| *d == f64::INFINITY));
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
