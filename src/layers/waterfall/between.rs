//! What a sprite shows between two keys: a cubic curve through both, with tangents, and a residue that neither key has.

use super::sprites::pyramid::Pyramid;
use super::sprites::{Pictures, Place};

/// Which keys make a picture, and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mix {
    /// The keys, each with its weight; the first two are those before and after.
    pub keys: Vec<(Place, f32)>,
    /// How much the slopes of the first two, to the right and down, add for each texel of the largest level.
    pub slopes: [[f32; 2]; 2],
    /// The residue's track and interval, and its weight; `None` if there is none.
    pub residue: Option<(usize, usize, f32)>,
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

/// Writes the texels of a level, not clamped, to `out`: four numbers each.
pub fn texels(pictures: &Pictures, residues: &[Vec<Pyramid<1>>], mix: &Mix, level: usize, out: &mut Vec<f32>) {
    let key = |place: Place| pictures.key(place).levels[level].1.as_flattened();
    let side = pictures.side >> level;
    out.clear();
    let Some(((first, weight), others)) = mix.keys.split_first() else { return };
    out.extend(key(*first).iter().map(|v| v * weight));
    for (place, weight) in others {
        out.iter_mut().zip(key(*place)).for_each(|(out, v)| *out += v * weight);
    }
    for ((place, _), slope) in mix.keys.iter().zip(mix.slopes) {
        if slope != [0.0; 2] {
            // Central differences, in texels of the largest level.
            let each = slope.map(|s| s / (2 << level) as f32);
            add_slopes(key(*place), side, each, out);
        }
    }
    if let Some((track, interval, weight)) = mix.residue {
        let random = &residues[track][interval].levels[level].1;
        for (texel, [random]) in out.as_chunks_mut::<4>().0.iter_mut().zip(random) {
            let more = weight * random * texel[3];
            texel[..3].iter_mut().for_each(|v| *v += more);
        }
    }
}

/// Adds differences between neighbors to the right and down; edges repeat.
fn add_slopes(key: &[f32], side: usize, [across, down]: [f32; 2], out: &mut [f32]) {
    let width = 4 * side;
    for (y, out) in out.chunks_exact_mut(width).enumerate() {
        let row = |y: usize| &key[y * width..][..width];
        let (above, own, below) = (row(y.saturating_sub(1)), row(y), row((y + 1).min(side - 1)));
        let inner = out[4..width - 4].iter_mut().zip(&own[8..]).zip(&own[..width - 8]);
        inner.for_each(|((out, right), left)| *out += across * (right - left));
        for c in 0..4 {
            out[c] += across * (own[4 + c] - own[c]);
            out[width - 4 + c] += across * (own[width - 4 + c] - own[width - 8 + c]);
        }
        out.iter_mut().zip(below).zip(above).for_each(|((out, below), above)| *out += down * (below - above));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::hash::Random;
    use crate::layers::waterfall::sprites::model::Shows;
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
        Mix {
            keys: keys.into_iter().map(|(i, weight)| ((0, i), weight as f32)).collect(),
            slopes: slopes.map(|slope| slope.map(|v| v as f32)),
            residue: Some((0, 1, (0.1 * residue(u)) as f32)),
        }
    }

    fn shown(u: f64, kind: &str, level: usize) -> Vec<f32> {
        let pictures = pictures(4);
        let mut out = Vec::new();
        texels(&pictures, &pictures.residues(Random(1), 3).0, &mix(u, kind), level, &mut out);
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
                let own = |k: usize| pictures(4).key((0, k)).levels[level].1.as_flattened().to_vec();
                assert_eq!(shown(0.0, kind, level), own(1), "{kind}");
                assert_eq!(shown(1.0, kind, level), own(2), "{kind}");
                assert_ne!(shown(0.5, kind, level), own(1), "{kind}");
            }
        }
    }

    #[test]
    fn slopes_are_central_differences_in_texels_of_the_largest_level() {
        let texel = |i: usize| [(3 * (i % SIDE) + 5 * (i / SIDE)) as f32; 4];
        let texels_of = (0..SIDE * SIDE).map(texel).collect();
        let key = Key { window: None, texels: Arc::new(Pyramid::new(SIDE, texels_of)) };
        let track = Track { kind: Shows::Water, source: Source::Sheet, keys: vec![key] };
        let pictures = Pictures { side: SIDE, tracks: vec![track] };
        let mix = Mix { keys: vec![((0, 0), 0.0)], slopes: [[2.0, 1.0], [0.0; 2]], residue: None };
        for level in [0, 1] {
            let (mut out, side) = (Vec::new(), SIDE >> level);
            texels(&pictures, &[], &mix, level, &mut out);
            let at = |x: usize, y: usize| out[4 * (y * side + x)];
            assert_eq!(at(2, 2), 2.0 * 3.0 + 5.0);
            // Edges repeat: half of the difference.
            assert_eq!((at(0, 2), at(side - 1, side - 1)), (3.0 + 5.0, 3.0 + 2.5));
        }
    }
}
