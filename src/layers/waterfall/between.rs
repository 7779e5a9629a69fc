//! What a sprite shows between two keys: a cubic curve through both, with tangents, and a residue that neither key has.

use std::ops::Range;

use glam::Vec4;

use super::sprites::residue::Residues;
use super::sprites::{KeyPlace, Pictures};
use crate::base::pixels::Rgba;
use crate::base::simd::vectorised;

/// The most keys that a picture is made of.
const MOST: usize = 4;

/// Which keys make a picture, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mix {
    keys: [(KeyPlace, f32); MOST],
    count: usize,
    /// How much the slopes of the first two keys, to the right and down, add for each texel of the largest level.
    pub slopes: [[f32; 2]; 2],
    /// The residue's track and interval, and its weight; `None` if there is none.
    pub residue: Option<(usize, usize, f32)>,
}

impl Mix {
    /// These keys, each with its weight; the first two are those before and after.
    pub fn of(keys: &[(KeyPlace, f32)]) -> Mix {
        let mut mix = Mix::default();
        keys.iter().for_each(|key| mix.add(*key));
        mix
    }

    /// One more key; at most four.
    pub fn add(&mut self, key: (KeyPlace, f32)) {
        self.keys[self.count] = key;
        self.count += 1;
    }

    /// The keys, each with its weight.
    pub fn keys(&self) -> &[(KeyPlace, f32)] {
        &self.keys[..self.count]
    }
}

/// The weights of both keys and both tangents, `u` of the way from one key to the next.
pub fn hermite(u: f64) -> [f64; 4] {
    let (u2, u3) = (u * u, u * u * u);
    [2.0 * u3 - 3.0 * u2 + 1.0, 3.0 * u2 - 2.0 * u3, u3 - 2.0 * u2 + u, u3 - u2]
}

/// The weights of the keys before the interval, at its ends and after it, for tangents that point from the key before to
/// the one after; at the ends of a track there is none before, or after.
pub fn catmull(u: f64, before: bool, after: bool) -> [f64; 4] {
    let [a, b, leaving, reaching] = hermite(u);
    let mut weights = [0.0, a, b, 0.0];
    if before {
        weights[0] -= leaving / 2.0;
        weights[2] += leaving / 2.0;
    } else {
        weights[1] -= leaving;
        weights[2] += leaving;
    }
    if after {
        weights[1] -= reaching / 2.0;
        weights[3] += reaching / 2.0;
    } else {
        weights[1] -= reaching;
        weights[2] += reaching;
    }
    weights
}

/// How much of the residue there is, for a share of 1.
pub fn residue(u: f64) -> f64 {
    let away = u * (1.0 - u);
    16.0 * away * away
}

/// Writes rows of the texels of a level, not clamped, to `out`.
pub fn texels(from: (&Pictures, &Residues), mix: &Mix, level: usize, rows: Range<usize>, out: &mut Vec<Rgba>) {
    let mixed = Mixed::new(from, mix, level);
    // What is there is overwritten.
    out.resize(rows.len() * mixed.side, [0.0; 4]);
    vectorised(
        #[inline(always)]
        || mixed.rows(rows, out),
    );
}

/// Keys at a level, and how they are mixed.
pub struct Mixed<'a> {
    /// Texels of a side.
    pub side: usize,
    count: usize,
    keys: [(&'a [Rgba], f32); MOST],
    /// What differences to the right and down add, of the first two keys; `None` if nothing.
    slopes: Option<[[f32; 2]; 2]>,
    residue: Option<(&'a [[f32; 1]], f32)>,
}

impl<'a> Mixed<'a> {
    /// A mix of these keys and residues at a level.
    #[inline(always)]
    pub fn new((pictures, residues): (&'a Pictures, &'a Residues), mix: &Mix, level: usize) -> Self {
        let mut keys: [(&[Rgba], f32); MOST] = [(&[], 0.0); MOST];
        for (key, (place, weight)) in keys.iter_mut().zip(mix.keys()) {
            *key = (&pictures.key(*place).levels[level].1, *weight);
        }
        let residue = mix.residue.map(|(track, interval, weight)| {
            let random: &[[f32; 1]] = &residues.0[track][interval].levels[level].1;
            (random, weight)
        });
        let mut slopes = mix.slopes;
        // Central differences, in texels of the largest level.
        for slope in slopes.as_flattened_mut() {
            *slope /= (2 << level) as f32;
        }
        let slopes = (mix.count == 2 && slopes != [[0.0; 2]; 2]).then_some(slopes);
        Mixed { side: pictures.side >> level, count: mix.count, keys, slopes, residue }
    }

    /// Writes rows of texels.
    #[inline(always)]
    pub fn rows(&self, rows: Range<usize>, out: &mut [Rgba]) {
        match self.slopes {
            Some(slopes) => self.advected(slopes, rows.clone(), out),
            None => self.weighted(rows.clone(), out),
        }
        if let Some((random, weight)) = self.residue {
            add_residue(&random[rows.start * self.side..rows.end * self.side], weight, out);
        }
    }

    /// Keys by their weights.
    #[inline(always)]
    fn weighted(&self, rows: Range<usize>, out: &mut [Rgba]) {
        out.fill([0.0; 4]);
        for (key, weight) in &self.keys[..self.count] {
            let key = part(key, rows.start * self.side, rows.len() * self.side);
            for (out, number) in out.as_flattened_mut().iter_mut().zip(key) {
                *out += number * weight;
            }
        }
    }

    /// Two keys with their slopes: all at once, since most of the time goes into fetching and storing texels.
    #[inline(always)]
    fn advected(&self, [s, t]: [[f32; 2]; 2], rows: Range<usize>, out: &mut [Rgba]) {
        let side = self.side;
        let [(a, weight_a), (b, weight_b)] = [self.keys[0], self.keys[1]];
        // The rows at the top and at the bottom have none above and below; all others are one long row.
        let inner = rows.start.max(1)..rows.end.min(side - 1);
        let runs =
            [(rows.start..inner.start, [0, side]), (inner.clone(), [side, side]), (inner.end..rows.end, [side, 0])];
        for (run, steps) in runs {
            // The first and the last texel of a picture have none to the left and to the right.
            let run = (run.start * side).max(1)..(run.end * side).min(side * side - 1);
            if run.is_empty() {
                continue;
            }
            let (a, b) = (Around::new(a, run.clone(), steps), Around::new(b, run.clone(), steps));
            let out = out[run.start - rows.start * side..run.end - rows.start * side].as_flattened_mut();
            for (i, out) in out.iter_mut().enumerate() {
                let faded = a.own[i] * weight_a + b.own[i] * weight_b;
                let sloped = faded + (a.right[i] - a.left[i]) * s[0] + (a.below[i] - a.above[i]) * s[1];
                *out = sloped + (b.right[i] - b.left[i]) * t[0] + (b.below[i] - b.above[i]) * t[1];
            }
        }
        // The first and the last texel of each row have other neighbors than these.
        let last = side - 1;
        for (y, out) in rows.zip(out.chunks_exact_mut(side)) {
            let (up, down) = (y.saturating_sub(1) * side, (y + 1).min(last) * side);
            let y = y * side;
            for (x, left, right) in [(0, 0, 1), (last, last - 1, last)] {
                let at = |key: &[Rgba], i: usize| Vec4::from(key[i]);
                let add = |key: &[Rgba], slope: [f32; 2]| {
                    let across = at(key, y + right) - at(key, y + left);
                    across * slope[0] + (at(key, down + x) - at(key, up + x)) * slope[1]
                };
                let faded = at(a, y + x) * weight_a + at(b, y + x) * weight_b;
                out[x] = (faded + add(a, s) + add(b, t)).to_array();
            }
        }
    }
}

/// Texels of a key and those next to them, number by number.
struct Around<'a> {
    above: &'a [f32],
    left: &'a [f32],
    own: &'a [f32],
    right: &'a [f32],
    below: &'a [f32],
}

impl<'a> Around<'a> {
    /// Texels with those so far above and below them.
    #[inline(always)]
    fn new(key: &'a [Rgba], texels: Range<usize>, [up, down]: [usize; 2]) -> Self {
        Around {
            above: part(key, texels.start - up, texels.len()),
            left: part(key, texels.start - 1, texels.len()),
            own: part(key, texels.start, texels.len()),
            right: part(key, texels.start + 1, texels.len()),
            below: part(key, texels.start + down, texels.len()),
        }
    }
}

/// So many texels, number by number.
#[inline(always)]
fn part(key: &[Rgba], from: usize, count: usize) -> &[f32] {
    key[from..][..count].as_flattened()
}

/// Adds random numbers to the colors, as far as these cover.
#[inline(always)]
fn add_residue(random: &[[f32; 1]], weight: f32, out: &mut [Rgba]) {
    let colors = Vec4::new(weight, weight, weight, 0.0);
    for (texel, [random]) in out.iter_mut().zip(random) {
        *texel = (Vec4::from(*texel) + colors * (texel[3] * random)).to_array();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::hash::Random;
    use crate::layers::waterfall::sprites::model::Shows;
    use crate::layers::waterfall::sprites::pyramid::Pyramid;
    use crate::layers::waterfall::sprites::{Key, Source, Track};
    use std::sync::Arc;

    const SIDE: usize = 16;

    fn pictures(count: u32) -> Pictures {
        let key = |k: u32| {
            let texels = (0..256).map(|i| Random(1).of(k, i, 0).map(|v| v as f32)).collect();
            Key { window: None, texels: Arc::new(Pyramid::new(SIDE, texels)) }
        };
        let track = Track { kind: Shows::Water, source: Source::Sheet, keys: (0..count).map(key).collect() };
        Pictures { side: SIDE, tracks: vec![track] }
    }

    fn mix(u: f64, kind: &str) -> Mix {
        let [a, b, leaving, reaching] = hermite(u);
        let keys = match kind {
            "catmull" => {
                let [before, a, b, after] = catmull(u, true, true);
                vec![(1, a), (2, b), (0, before), (3, after)]
            }
            _ => vec![(1, a), (2, b)],
        };
        let slopes = match kind {
            "advect" => [[leaving * 0.6, leaving * -0.8], [reaching * 0.6, reaching * -0.8]],
            _ => [[0.0; 2]; 2],
        };
        let keys: Vec<_> = keys.into_iter().map(|(i, weight)| ((0, i), weight as f32)).collect();
        Mix {
            slopes: slopes.map(|slope| slope.map(|v| v as f32)),
            residue: Some((0, 1, (0.1 * residue(u)) as f32)),
            ..Mix::of(&keys)
        }
    }

    fn shown(u: f64, kind: &str, level: usize) -> Vec<Rgba> {
        let pictures = pictures(4);
        let mut out = Vec::new();
        let residues = pictures.residues(Random(1), 3);
        texels((&pictures, &residues), &mix(u, kind), level, 0..SIDE >> level, &mut out);
        out
    }

    #[test]
    fn hermite_weights_are_exact() {
        assert_eq!(hermite(0.0), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(hermite(1.0), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(hermite(0.5), [0.5, 0.5, 0.125, -0.125]);
        for (before, after) in [(false, false), (false, true), (true, false), (true, true)] {
            let sum: f64 = catmull(0.3, before, after).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
        // Of two keys alone the tangents are the way between them: a straight line.
        let line = catmull(0.3, false, false);
        assert!((line[1] - 0.7).abs() < 1e-15 && (line[2] - 0.3).abs() < 1e-15, "{line:?}");
    }

    #[test]
    fn at_a_key_it_is_the_key_to_the_bit() {
        for kind in ["zero", "catmull", "advect"] {
            for level in [0, 2] {
                let own = |k: usize| pictures(4).key((0, k)).levels[level].1.clone();
                assert_eq!(shown(0.0, kind, level), own(1), "{kind}");
                assert_eq!(shown(1.0, kind, level), own(2), "{kind}");
                assert_ne!(shown(0.5, kind, level), own(1), "{kind}");
            }
        }
    }

    #[test]
    fn rows_are_those_of_the_whole() {
        for kind in ["zero", "catmull", "advect"] {
            let (pictures, mut rows) = (pictures(4), Vec::new());
            let residues = pictures.residues(Random(1), 3);
            texels((&pictures, &residues), &mix(0.3, kind), 0, 5..9, &mut rows);
            assert_eq!(rows, shown(0.3, kind, 0)[5 * SIDE..9 * SIDE], "{kind}");
        }
    }

    #[test]
    fn slopes_are_central_differences_in_texels_of_the_largest_level() {
        let texel = |i: usize| [(3 * (i % SIDE) + 5 * (i / SIDE)) as f32; 4];
        let texels_of = (0..SIDE * SIDE).map(texel).collect();
        let key = Key { window: None, texels: Arc::new(Pyramid::new(SIDE, texels_of)) };
        let track = Track { kind: Shows::Water, source: Source::Sheet, keys: vec![key] };
        let pictures = Pictures { side: SIDE, tracks: vec![track] };
        let mix = Mix { slopes: [[2.0, 1.0], [0.0; 2]], ..Mix::of(&[((0, 0), 0.0), ((0, 0), 0.0)]) };
        for level in [0, 1] {
            let (mut out, side) = (Vec::new(), SIDE >> level);
            texels((&pictures, &Residues(Vec::new())), &mix, level, 0..side, &mut out);
            let at = |x: usize, y: usize| out[y * side + x][0];
            assert_eq!(at(2, 2), 2.0 * 3.0 + 5.0);
            // Edges repeat: half of the difference.
            assert_eq!((at(0, 2), at(side - 1, side - 1)), (3.0 + 5.0, 3.0 + 2.5));
        }
    }
}
