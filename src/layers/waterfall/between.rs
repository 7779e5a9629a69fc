//! What a sprite shows between two keys: a cubic curve through both, with tangents, and a residue that neither key has.

use std::ops::Range;

use glam::Vec4;

use super::sprites::residue::Residues;
use super::sprites::{Pictures, Place};
use crate::base::pixels::Rgba;

/// The most keys that a picture is made of.
const MOST: usize = 4;

/// Which keys make a picture, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mix {
    keys: [(Place, f32); MOST],
    count: usize,
    /// How much the slopes of the first two keys, to the right and down, add for each texel of the largest level.
    pub slopes: [[f32; 2]; 2],
    /// The residue's track and interval, and its weight; `None` if there is none.
    pub residue: Option<(usize, usize, f32)>,
}

impl Mix {
    /// These keys, each with its weight; the first two are those before and after.
    pub fn of(keys: &[(Place, f32)]) -> Mix {
        let mut mix = Mix::default();
        keys.iter().for_each(|key| mix.add(*key));
        mix
    }

    /// One more key; at most four.
    pub fn add(&mut self, key: (Place, f32)) {
        self.keys[self.count] = key;
        self.count += 1;
    }

    /// The keys, each with its weight.
    pub fn keys(&self) -> &[(Place, f32)] {
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
pub fn texels(
    (pictures, residues): (&Pictures, &Residues),
    mix: &Mix,
    level: usize,
    rows: Range<usize>,
    out: &mut Vec<Vec4>,
) {
    let side = pictures.side >> level;
    let key = |(place, weight): (Place, f32)| Key { texels: &pictures.key(place).levels[level].1, side, weight };
    let residue = mix.residue.map(|(track, interval, weight)| (&residues.0[track][interval].levels[level].1, weight));
    // Central differences, in texels of the largest level.
    let slopes = mix.slopes.map(|slope| slope.map(|v| v / (2 << level) as f32));
    // What is there is overwritten.
    out.resize(rows.len() * side, Vec4::ZERO);
    for (y, out) in rows.zip(out.chunks_exact_mut(side)) {
        match mix.keys() {
            [a, b] if slopes != [[0.0; 2]; 2] => {
                advected(&key(*a).around(y, slopes[0]), &key(*b).around(y, slopes[1]), out);
            }
            keys => weighted(keys.iter().map(|of| (key(*of).row(y), of.1)), out),
        }
        if let Some((random, weight)) = residue {
            add_residue(&random[y * side..][..side], weight, out);
        }
    }
}

/// A key at a level.
#[derive(Clone, Copy)]
struct Key<'a> {
    texels: &'a [Rgba],
    side: usize,
    weight: f32,
}

/// A row of a key with those above and below it, its weight, and what a difference to the right and down adds.
#[derive(Clone, Copy)]
struct Around<'a> {
    above: &'a [Rgba],
    own: &'a [Rgba],
    below: &'a [Rgba],
    weight: f32,
    slope: [f32; 2],
}

impl<'a> Key<'a> {
    fn row(self, y: usize) -> &'a [Rgba] {
        &self.texels[y * self.side..][..self.side]
    }

    /// Edges repeat.
    fn around(self, y: usize, slope: [f32; 2]) -> Around<'a> {
        let (above, below) = (self.row(y.saturating_sub(1)), self.row((y + 1).min(self.side - 1)));
        Around { above, own: self.row(y), below, weight: self.weight, slope }
    }
}

impl Around<'_> {
    /// The same, of this length as far as the compiler sees.
    #[inline(always)]
    fn of(self, len: usize) -> Self {
        Around { above: &self.above[..len], own: &self.own[..len], below: &self.below[..len], ..self }
    }

    /// What a texel's neighbors add to a color.
    #[inline(always)]
    fn add(&self, color: Vec4, [left, x, right]: [usize; 3]) -> Vec4 {
        let [across, down] = self.slope;
        let color = color + across * (Vec4::from(self.own[right]) - Vec4::from(self.own[left]));
        color + down * (Vec4::from(self.below[x]) - Vec4::from(self.above[x]))
    }
}

/// A row of two keys with their slopes: all at once, since most of the time goes into fetching and storing texels.
fn advected(a: &Around, b: &Around, out: &mut [Vec4]) {
    let last = out.len() - 1;
    let (a, b) = (a.of(out.len()), b.of(out.len()));
    out[0] = faded(&a, &b, [0, 0, 1.min(last)]);
    for (left, out) in out[1..last].iter_mut().enumerate() {
        *out = faded(&a, &b, [left, left + 1, left + 2]);
    }
    out[last] = faded(&a, &b, [last.saturating_sub(1), last, last]);
}

/// A texel between two keys.
#[inline(always)]
fn faded(a: &Around, b: &Around, at: [usize; 3]) -> Vec4 {
    let faded = Vec4::from(a.own[at[1]]) * a.weight + Vec4::from(b.own[at[1]]) * b.weight;
    b.add(a.add(faded, at), at)
}

/// A row of keys by their weights.
fn weighted<'a>(keys: impl Iterator<Item = (&'a [Rgba], f32)>, out: &mut [Vec4]) {
    out.fill(Vec4::ZERO);
    for (key, weight) in keys {
        out.iter_mut().zip(key).for_each(|(out, texel)| *out += Vec4::from(*texel) * weight);
    }
}

/// Adds random numbers to the colors, as far as these cover.
fn add_residue(random: &[[f32; 1]], weight: f32, out: &mut [Vec4]) {
    for (texel, [random]) in out.iter_mut().zip(random) {
        *texel += Vec4::new(1.0, 1.0, 1.0, 0.0) * (weight * random * texel.w);
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
        out.into_iter().map(Rgba::from).collect()
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
            let rows: Vec<Rgba> = rows.into_iter().map(Rgba::from).collect();
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
