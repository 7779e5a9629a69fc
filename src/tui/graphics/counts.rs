//! Which numbers from 0 to 1 the pixels of a pass have, and how often.

use super::request::CountAt;
use crate::base::pixels::Linear;
use crate::render::Synth;

/// How many equal parts from 0 to 1 are told apart.
pub const PARTS: usize = 64;

/// What share of the pixels that show something have a number in each part.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Of what.
    pub at: CountAt,
    /// One share for each part, ascending; all 0 if no pixel shows anything.
    pub shares: Vec<f64>,
}

impl Counts {
    /// Counts the pixels of a frame.
    pub fn new(at: CountAt, synth: &Synth) -> Counts {
        let shares = shares(&at.of.picture(synth, at.time));
        Counts { at, shares }
    }
}

fn shares(picture: &Linear) -> Vec<f64> {
    let mut counts = [0u32; PARTS];
    for [number, .., alpha] in picture.cells() {
        if *alpha > 0.0 {
            counts[((number * PARTS as f32) as usize).min(PARTS - 1)] += 1;
        }
    }
    let all = counts.iter().sum::<u32>().max(1);
    counts.map(|count| f64::from(count) / f64::from(all)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_counted_by_parts() {
        let cell = |number: f32, alpha: f32| [number, number, number, alpha];
        let cells = vec![cell(0.0, 1.0), cell(0.01, 1.0), cell(1.0, 1.0), cell(0.5, 1.0), cell(0.9, 0.0)];
        let shares = shares(&Linear::from_cells(5, 1, cells));
        assert_eq!((shares[0], shares[32], shares[63], shares[57]), (0.5, 0.25, 0.25, 0.0));
    }
}
