//! A scene as large as the window shows it. What the GPU cannot hold is made smaller, and a large picture for as long as its
//! pixels are finer than those of the screen: it is there soon, takes little memory and plays.

use crate::render::Synth;
use crate::render::reduce::reduced;

/// Frames with no more pixels than this are made as they are.
const SMALL: usize = 1 << 24;
/// The longer side of larger ones before their zoom is known, in pixels: at least this, and less than twice as much.
const FIRST: f64 = 1024.0;

/// A scene, moving and still.
pub struct Frames {
    pub moving: Synth,
    pub still: Synth,
    /// How many times smaller than the picture they are, on each side.
    pub by: usize,
}

impl Frames {
    /// A scene made so many times smaller.
    pub fn new(synth: &Synth, by: usize) -> Frames {
        let moving = if by > 1 { reduced(synth, by) } else { synth.clone() };
        Frames { still: moving.unmoved(), moving, by }
    }

    /// Pixels of the frames a pixel of the picture.
    pub fn scale(&self) -> f64 {
        1.0 / self.by as f64
    }
}

/// How many times smaller a scene has to be made for a GPU that holds pictures of at most `most` pixels a side.
pub fn held(synth: &Synth, most: usize) -> usize {
    let read = synth.layers.iter().map(|layer| layer.largest_texture());
    let largest = read.chain([synth.size.0, synth.size.1]).max().unwrap_or(1);
    largest.div_ceil(most.max(1)).max(1)
}

/// How many times smaller frames of this size may be with nothing lost on the screen; `zoom`, in pixels of the screen a pixel
/// of the picture, is not known before the first is shown.
pub fn enough((width, height): (usize, usize), zoom: Option<f64>) -> usize {
    if width * height <= SMALL {
        return 1;
    }
    let times = zoom.map_or(width.max(height) as f64 / FIRST, |zoom| 1.0 / zoom);
    1 << (times as usize).max(1).ilog2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_frames_are_as_large_as_they_are_seen() {
        for (size, zoom, times) in [
            ((4096, 4096), None, 1),
            ((4096, 4096), Some(0.1), 1),
            ((12000, 9000), None, 8),
            ((12000, 9000), Some(0.071), 8),
            ((12000, 9000), Some(0.25), 4),
            ((12000, 9000), Some(0.26), 2),
            ((12000, 9000), Some(0.51), 1),
            ((12000, 9000), Some(8.0), 1),
            ((1 << 20, 17), None, 1024),
        ] {
            assert_eq!(enough(size, zoom), times, "{size:?} {zoom:?}");
        }
        let synth = Synth { size: (480, 360), ..Synth::default() };
        assert_eq!([1000, 480, 479, 200, 0].map(|most| held(&synth, most)), [1, 1, 2, 3, 480]);
        let frames = Frames::new(&synth, 3);
        assert_eq!((frames.moving.size, frames.still.size, frames.scale()), ((160, 120), (160, 120), 1.0 / 3.0));
    }
}
