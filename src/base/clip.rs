//! Clips: moving pictures that a scene names, all frames of one size.

use std::sync::Arc;

use super::picture::Picture;

/// So close before its time, in frames, a frame is shown already.
const AGAINST_ROUNDING: f64 = 1e-9;

/// The frames of a clip, at least one.
#[derive(Clone, Debug)]
pub struct Clip {
    /// Frames a second.
    pub fps: f64,
    /// In the order of time, from the first that the scene takes.
    pub frames: Vec<Arc<Picture>>,
}

impl Clip {
    /// The number of the frame that is shown after so many seconds, from 0; after the last comes the first.
    pub fn frame_at(&self, seconds: f64) -> usize {
        let passed = (seconds * self.fps + AGAINST_ROUNDING).floor();
        passed.rem_euclid(self.frames.len().max(1) as f64) as usize
    }

    /// Width and height of its frames, in pixels.
    pub fn size_px(&self) -> (usize, usize) {
        self.frames.first().map_or((0, 0), |frame| (frame.width(), frame.height()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_follow_the_time_and_start_over() {
        let frame = Arc::new(Picture::filled(1, 1, [0.0; 4]));
        let clip = Clip { fps: 25.0, frames: vec![frame; 64] };
        for (seconds, shown) in
            [(0.0, 0), (0.0399, 0), (0.04, 1), (0.28, 7), (2.52, 63), (2.56, 0), (2.6, 1), (-0.04, 63), (1e12, 0)]
        {
            assert_eq!(clip.frame_at(seconds), shown, "{seconds}");
        }
        // 0.1 + 0.2 and the like fall just short of their frame.
        assert!((0..1000).all(|k| clip.frame_at(f64::from(k) / 1000.0 * 40.0) == k as usize % 64));
    }
}
