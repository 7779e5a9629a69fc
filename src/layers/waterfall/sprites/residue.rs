//! What pictures between two keys have that neither key has: smooth random numbers of variance 1, one for each texel.

use super::pyramid::Pyramid;
use crate::layers::waterfall::hash::Random;

/// Texels from one random number to the next.
const LATTICE: usize = 4;
/// Its purpose in the hash; the number of the interval is added.
const RESIDUE: u32 = 512;
/// Rows of the lattice are so far apart in the hash.
const ROW: u32 = 256;

/// The residues of all tracks, of each for as many intervals as of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Residues(pub Vec<Vec<Pyramid<1>>>);

impl Residues {
    /// The number of an interval of a track among all.
    pub fn number(&self, track: usize, interval: usize) -> usize {
        track * self.0.first().map_or(0, Vec::len) + interval
    }
}

/// The residue of the interval after a key of a track, for sprites of this side.
pub fn residue(random: Random, track: u32, interval: u32, side: usize) -> Pyramid<1> {
    let across = side / LATTICE + 1;
    let corner = |i: usize| random.bell(track, (i % across) as u32 + ROW * (i / across) as u32, RESIDUE + interval);
    let corners: Vec<f64> = (0..across * across).map(corner).collect();
    let texel = |i: usize| {
        let (x, y) = (i % side, i / side);
        let part = |v: usize| ((v % LATTICE) as f64 + 0.5) / LATTICE as f64;
        let (u, v) = (part(x), part(y));
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let at = y / LATTICE * across + x / LATTICE;
        let values = [at, at + 1, at + across, at + across + 1].map(|at| corners[at]);
        let sum: f64 = weights.iter().zip(values).map(|(weight, value)| weight * value).sum();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        [(sum / squares.sqrt()) as f32]
    };
    Pyramid::new(side, (0..side * side).map(texel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_residue_has_the_checked_values_and_variance_1() {
        let all = residue(Random(1), 0, 0, 64);
        let texels = &all.levels[0].1;
        assert!(
            (f64::from(texels[0][0]) + 0.167_137_798).abs() < 1e-7
                && (f64::from(texels[1][0]) + 0.249_444_811).abs() < 1e-7
        );
        let variance = texels.iter().map(|[v]| v * v).sum::<f32>() / texels.len() as f32;
        assert!((variance - 1.0).abs() < 0.15, "{variance}");
        assert_ne!(residue(Random(1), 0, 1, 64), all);
    }
}
