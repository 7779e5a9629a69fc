//! Pictures at several sizes, each half as large as the one before.

/// The smallest side that is halved.
const SMALLEST: usize = 8;

/// A square picture of `N` numbers a texel, and smaller ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid<const N: usize> {
    /// Side in texels, and the texels row by row, of each level.
    pub levels: Vec<(usize, Vec<[f32; N]>)>,
}

impl<const N: usize> Pyramid<N> {
    /// The levels of a square picture of this side.
    pub fn new(side: usize, texels: Vec<[f32; N]>) -> Self {
        let mut levels = vec![(side, texels)];
        while let Some((side, texels)) = levels.last().filter(|(side, _)| side % 2 == 0 && *side >= SMALLEST) {
            let half = side / 2;
            let mean = |i: usize| {
                let at = i / half * 2 * side + i % half * 2;
                let block = [at, at + 1, at + side, at + side + 1].map(|at| texels[at]);
                std::array::from_fn(|c| (block[0][c] + block[1][c] + block[2][c] + block[3][c]) * 0.25)
            };
            let next = (half, (0..half * half).map(mean).collect());
            levels.push(next);
        }
        Pyramid { levels }
    }

    /// The number of the smallest level of a picture of this side.
    pub fn last(side: usize) -> usize {
        let sides = std::iter::successors(Some(side), |side| (side % 2 == 0 && *side >= SMALLEST).then_some(side / 2));
        sides.count() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_means_down_to_sides_that_are_odd_or_small() {
        for (side, sides) in [(64, vec![64, 32, 16, 8, 4]), (48, vec![48, 24, 12, 6]), (16, vec![16, 8, 4])] {
            let pyramid = Pyramid::new(side, (0..side * side).map(|i| [(i % side) as f32]).collect());
            assert_eq!(pyramid.levels.iter().map(|level| level.0).collect::<Vec<_>>(), sides);
            assert_eq!(Pyramid::<1>::last(side), sides.len() - 1);
            assert_eq!(pyramid.levels[1].1[1], [2.5]);
        }
    }
}
