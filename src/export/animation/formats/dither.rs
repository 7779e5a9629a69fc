//! Frames in the colors of a palette, by error diffusion (Sierra's small kernel) with a memory: a pixel that has not changed
//! since the frame before keeps its color and passes on the same error as then. So what does not move does not shimmer,
//! and costs nothing to write.

use super::palette::{Palette, is_opaque};
use crate::base::pixels::Frame;

/// How much of an error its neighbors make good. With all of it they look grainier, without a visible gain in the mean.
const STRENGTH: f32 = 0.9;
/// Errors up to this many codes are ignored.
const UNSEEN: f32 = 0.5;

/// The color that a pixel became, and the error that it passes on.
#[derive(Clone, Copy, Default)]
struct Dithered {
    index: u8,
    error: [f32; 3],
}

/// Turns frames that follow one another into the colors of one palette.
#[derive(Default)]
pub struct Dither {
    before: Option<(Frame, Vec<Dithered>)>,
}

impl Dither {
    /// The index of the color of every pixel of `frame`.
    pub fn indices(&mut self, frame: &Frame, palette: &Palette) -> Vec<u8> {
        let (width, n) = (frame.width(), frame.cells().len());
        let (source, mut shown) = self.before.take().unzip();
        let mut all = shown.take().unwrap_or_else(|| vec![Dithered::default(); n]);
        // One more column on each side takes the error that falls outside the picture.
        let (mut owed, mut below) = (vec![[0.0f32; 3]; width + 2], vec![[0.0f32; 3]; width + 2]);
        for (y, row) in all.chunks_mut(width.max(1)).enumerate() {
            for (x, pixel) in row.iter_mut().enumerate() {
                let color = frame.row(y)[x];
                if source.as_ref().is_none_or(|source| source.row(y)[x] != color) {
                    *pixel = choose(palette, color, owed[x + 1]);
                }
                for (i, error) in pixel.error.into_iter().enumerate() {
                    owed[x + 2][i] += error / 2.0;
                    below[x][i] += error / 4.0;
                    below[x + 1][i] += error / 4.0;
                }
            }
            std::mem::swap(&mut owed, &mut below);
            below.fill([0.0; 3]);
        }
        let indices = all.iter().map(|pixel| pixel.index).collect();
        self.before = Some((frame.clone(), all));
        indices
    }
}

/// The color for a pixel, with the error of its neighbors.
fn choose(palette: &Palette, color: [u8; 4], owed: [f32; 3]) -> Dithered {
    if !is_opaque(color) {
        return Dithered { index: palette.transparent(), error: [0.0; 3] };
    }
    let wanted: [f32; 3] = std::array::from_fn(|i| (f32::from(color[i]) + owed[i]).clamp(0.0, 255.0));
    let index = palette.nearest(wanted.map(f64::from));
    let got = palette.colors()[usize::from(index)];
    let error = std::array::from_fn(|i| {
        let error = wanted[i] - f32::from(got[i]);
        error.signum() * (error.abs() - UNSEEN).max(0.0) * STRENGTH
    });
    Dithered { index, error }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: usize, height: usize) -> Frame {
        let cell = |i: usize| [(i % width * 255 / (width - 1)) as u8, (i / width * 255 / (height - 1)) as u8, 90, 255];
        Frame::from_cells(width, height, (0..width * height).map(cell).collect())
    }

    #[test]
    fn few_colors_are_exact() {
        let mut frame = ramp(15, 16);
        frame.cells_mut()[3] = [9, 9, 9, 0];
        let palette = Palette::of(std::slice::from_ref(&frame));
        let indices = Dither::default().indices(&frame, &palette);
        assert_eq!(indices[3], palette.transparent());
        for (i, (color, index)) in frame.cells().iter().zip(indices).enumerate() {
            assert!(i == 3 || palette.colors()[usize::from(index)] == color[..3], "{i}");
        }
    }

    #[test]
    fn many_colors_are_mixed_to_the_right_mean() {
        let palette = Palette::of(&[ramp(256, 256)]);
        assert!((200..=Palette::MOST).contains(&palette.colors().len()));
        let flat = Frame::filled(64, 64, [131, 77, 90, 255]);
        let indices = Dither::default().indices(&flat, &palette);
        for (channel, wanted) in [131.0, 77.0, 90.0].into_iter().enumerate() {
            let sum: f64 = indices.iter().map(|&i| f64::from(palette.colors()[usize::from(i)][channel])).sum();
            let mean = sum / indices.len() as f64;
            assert!((mean - wanted).abs() < 2.0, "{channel}: {mean}");
        }
        assert!(palette.error(&ramp(256, 256)) < 150.0);
    }

    #[test]
    fn what_does_not_move_does_not_shimmer() {
        let mut frame = ramp(200, 100);
        let palette = Palette::of(std::slice::from_ref(&frame));
        let mut dither = Dither::default();
        let before = dither.indices(&frame, &palette);
        let moves = |i: usize| (40..60).contains(&(i % 200)) && (30..50).contains(&(i / 200));
        for (i, cell) in frame.cells_mut().iter_mut().enumerate().filter(|(i, _)| moves(*i)) {
            *cell = [(i * 7 % 256) as u8, (i % 256) as u8, 200, 255];
        }
        let after = dither.indices(&frame, &palette);
        let changed = |moving: bool| (0..before.len()).filter(|&i| moves(i) == moving && before[i] != after[i]).count();
        assert_eq!(changed(false), 0);
        assert!(changed(true) > 300);
    }
}
