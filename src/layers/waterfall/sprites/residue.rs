//! What pictures between two keys have that neither key has: smooth random numbers of variance 1, one for each texel.

use super::levels::Levels;
use crate::layers::waterfall::hash::Random;

/// Texels from one random number to the next.
const LATTICE: usize = 4;
/// Its purpose in the hash; the number of the interval is added.
const RESIDUE: u32 = 512;
/// Rows of the lattice are so far apart in the hash.
const ROW: u32 = 256;

/// What stands for 1 in residues: they are below 6.
pub const ONE: f32 = 4096.0;

/// The residues of all tracks, of each for as many intervals as of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Residues(pub Vec<Vec<Levels>>);

impl Residues {
    /// The number of an interval of a track among all.
    pub fn number(&self, track: usize, interval: usize) -> usize {
        track * self.0.first().map_or(0, Vec::len) + interval
    }
}

/// The residue of the interval after a key of a track, for sprites of this side.
pub fn residue(random: Random, track: u32, interval: u32, side: usize) -> Levels {
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
        let random = (sum / squares.sqrt()) as f32;
        // What is added to colors; nothing to the alpha.
        [random, random, random, 0.0]
    };
    Levels::new(side, (0..side * side).map(texel).collect(), ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_residue_has_the_checked_values_and_variance_1() {
        let all = residue(Random(1), 0, 0, 64);
        let texels: Vec<f32> = all.texels(0).map(|texel| texel[0]).collect();
        assert!((texels[0] + 0.167_137_8).abs() < 2.5e-4 && (texels[1] + 0.249_444_8).abs() < 2.5e-4);
        let variance = texels.iter().map(|v| v * v).sum::<f32>() / texels.len() as f32;
        assert!((variance - 1.0).abs() < 0.15, "{variance}");
        assert_ne!(residue(Random(1), 0, 1, 64), all);
    }
}
