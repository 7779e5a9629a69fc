//! What a sprite shows between two keys: a cubic curve through both, with tangents, and a residue that neither key has.

use std::num::Wrapping;
use std::ops::Range;

use super::sprites::levels::{Level, Number, across};
use super::sprites::residue::Residues;
use super::sprites::{KeyPlace, ONE, Pictures};
use crate::base::pixels::Rgba;
use crate::base::simd::vectorised;

/// The most keys that a picture is made of.
const MOST: usize = 4;

/// Slopes of so much altogether leave sums within the numbers that there are: keys alone take up to 1.25 of 2.
const STEEP: f32 = 0.75;

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
        || mixed.rows(rows, &mut Sums::default(), out),
    );
}

/// Memory for sums, used again and again.
#[derive(Default)]
pub struct Sums {
    texels: Vec<[Number; 4]>,
    /// The alpha of each texel, four times.
    alphas: Vec<[Number; 4]>,
}

/// Keys at a level, and how they are mixed. As weights add up to 1, a mix is the key of most weight, and what others differ
/// from it: so a key that is alone stays as it is.
pub struct Mixed<'a> {
    /// Texels of a side.
    pub side: usize,
    most: &'a Level,
    others: [(&'a Level, Number); MOST - 1],
    /// What differences to the right and down add, of the key of most weight and of the other; `None` if nothing.
    slopes: Option<[[Number; 2]; 2]>,
    /// How often numbers are halved, so that those of steep slopes fit.
    halved: usize,
    residue: Option<(&'a Level, Number, usize)>,
}

impl<'a> Mixed<'a> {
    /// A mix of these keys and residues at a level.
    #[inline(always)]
    pub fn new((pictures, residues): (&'a Pictures, &'a Residues), mix: &Mix, level: usize) -> Self {
        // Central differences, in texels of the largest level.
        let mut slopes = if mix.count == 2 { mix.slopes } else { [[0.0; 2]; 2] };
        slopes.as_flattened_mut().iter_mut().for_each(|slope| *slope /= (2 << level) as f32);
        let halved = halvings(slopes.as_flattened().iter().map(|slope| slope.abs()).sum::<f32>() / STEEP);
        let weight = |weight: f32| whole(weight, 15 - halved);
        let key = |i: usize| (pictures.key(mix.keys[i].0).level(level), weight(mix.keys[i].1));
        let first = usize::from(mix.count > 1 && mix.keys[1].1 > mix.keys[0].1);
        let most = key(first).0;
        let mut others = [(most, Wrapping(0)); MOST - 1];
        let rest = (0..mix.count).filter(|i| *i != first);
        others.iter_mut().zip(rest).for_each(|(other, i)| *other = key(i));
        let slopes = (slopes != [[0.0; 2]; 2]).then(|| [first, 1 - first].map(|i| slopes[i].map(weight)));
        let residue = mix.residue.map(|(track, interval, weight)| {
            let doubled = halvings(weight * 32.0);
            (residues.0[track][interval].level(level), whole(weight, 20 - doubled), doubled)
        });
        Mixed { side: pictures.side >> level, most, others, slopes, halved, residue }
    }

    /// Writes rows of texels.
    #[inline(always)]
    pub fn rows(&self, rows: Range<usize>, sums: &mut Sums, out: &mut [Rgba]) {
        let across = across(self.side);
        let count = across * rows.len();
        let texels = at_least(&mut sums.texels, count);
        match self.slopes {
            Some(slopes) => self.advected(slopes, &rows, texels.as_flattened_mut()),
            None => self.weighted(&rows, texels.as_flattened_mut()),
        }
        if let Some((random, weight, doubled)) = self.residue {
            let alphas = at_least(&mut sums.alphas, count);
            for (alphas, texel) in alphas.iter_mut().zip(&*texels) {
                *alphas = [texel[3]; 4];
            }
            let random = random.rows(&rows, 0).iter().zip(alphas.as_flattened());
            for (sum, (random, alpha)) in texels.as_flattened_mut().iter_mut().zip(random) {
                *sum += times(times(*alpha, *random), weight) << doubled;
            }
        }
        let one = 2.0 * (1 << self.halved) as f32 / ONE;
        for (sums, out) in texels.chunks_exact(across).zip(out.chunks_exact_mut(self.side)) {
            for (out, sum) in out.as_flattened_mut().iter_mut().zip(sums[1..].as_flattened()) {
                *out = f32::from(sum.0) * one;
            }
        }
    }

    /// Keys by their weights.
    #[inline(always)]
    fn weighted(&self, rows: &Range<usize>, out: &mut [Number]) {
        let halved = self.halved + 1;
        let weights = self.others.map(|(_, weight)| weight);
        let [b, c, d] = self.others.map(|(key, _)| &key.rows(rows, 0)[..out.len()]);
        let a = &self.most.rows(rows, 0)[..out.len()];
        for (i, out) in out.iter_mut().enumerate() {
            let others = times(b[i] - a[i], weights[0]) + times(c[i] - a[i], weights[1]);
            *out = (a[i] >> halved) + others + times(d[i] - a[i], weights[2]);
        }
    }

    /// Two keys with their slopes: all at once, since most of the time goes into fetching and storing numbers.
    #[inline(always)]
    fn advected(&self, [s, t]: [[Number; 2]; 2], rows: &Range<usize>, out: &mut [Number]) {
        let (other, weight) = self.others[0];
        let (halved, down) = (self.halved + 1, across(self.side) as isize);
        let around = |key: &'a Level| [0, -1, 1, -down, down].map(|moved| &key.rows(rows, moved)[..out.len()]);
        let [a, a_left, a_right, a_above, a_below] = around(self.most);
        let [b, b_left, b_right, b_above, b_below] = around(other);
        for (i, out) in out.iter_mut().enumerate() {
            // Products are rounded down: half of them are taken with the other sign.
            let faded = (a[i] >> halved) - times(a[i] - b[i], weight);
            let across = times(a_right[i] - a_left[i], s[0]) - times(b_left[i] - b_right[i], t[0]);
            let down = times(a_below[i] - a_above[i], s[1]) - times(b_above[i] - b_below[i], t[1]);
            *out = faded + across + down;
        }
    }
}

/// So many of them, for work that writes each before it reads it.
#[inline(always)]
pub fn at_least<T: Copy + Default>(all: &mut Vec<T>, count: usize) -> &mut [T] {
    if all.len() < count {
        all.resize(count, T::default());
    }
    &mut all[..count]
}

/// How often a number has to be halved to be at most 1.
fn halvings(mut number: f32) -> usize {
    let mut count = 0;
    while number > 1.0 {
        (number, count) = (number / 2.0, count + 1);
    }
    count
}

/// A weight as a number of which 2^`bits` are 1.
fn whole(weight: f32, bits: usize) -> Number {
    Wrapping((weight * (1 << bits) as f32).round() as i16)
}

/// The product of a number and of one of which 2^16 are 1, rounded down.
#[inline(always)]
fn times(number: Number, by: Number) -> Number {
    Wrapping(((i32::from(number.0) * i32::from(by.0)) >> 16) as i16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::hash::Random;
    use crate::layers::waterfall::sprites::levels::Levels;
    use crate::layers::waterfall::sprites::model::Shows;
    use crate::layers::waterfall::sprites::{Key, Source, Track};
    use std::sync::Arc;

    const SIDE: usize = 16;

    fn pictures(count: u32) -> Pictures {
        let key = |k: u32| {
            let texels = (0..256).map(|i| Random(1).of(k, i, 0).map(|v| v as f32)).collect();
            Key { window: None, texels: Arc::new(Levels::new(SIDE, texels, ONE)) }
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
                let own = |k: usize| pictures(4).key((0, k)).texels(level).collect::<Vec<_>>();
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
        let texel = |i: usize| [(3 * (i % SIDE) + 5 * (i / SIDE)) as f32 / 128.0; 4];
        let texels_of = (0..SIDE * SIDE).map(texel).collect();
        let key = Key { window: None, texels: Arc::new(Levels::new(SIDE, texels_of, ONE)) };
        let track = Track { kind: Shows::Water, source: Source::Sheet, keys: vec![key] };
        let pictures = Pictures { side: SIDE, tracks: vec![track] };
        let fade = [((0, 0), 0.7), ((0, 0), 0.3)];
        let mix = Mix { slopes: [[0.0; 2], [2.0, 1.0]], ..Mix::of(&fade) };
        for level in [0, 1] {
            let (mut out, side) = (Vec::new(), SIDE >> level);
            texels((&pictures, &Residues(Vec::new())), &mix, level, 0..side, &mut out);
            let own = pictures.key((0, 0));
            let added = |x: usize, y: usize| 128.0 * (out[y * side + x][0] - own.texel(level, x, y)[0]);
            // Edges repeat: half of the difference.
            for ((x, y), wanted) in [((2, 2), 11.0), ((0, 2), 8.0), ((side - 1, side - 1), 5.5)] {
                assert!((added(x, y) - wanted).abs() < 0.04, "{level} {x} {y}: {}", added(x, y));
            }
        }
    }
}
