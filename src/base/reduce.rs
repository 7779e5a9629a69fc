//! Pictures made smaller: the mean of each block of pixels, in linear light.

use std::sync::Arc;

use rayon::prelude::*;

use super::clip::Clip;
use super::picture::Picture;
use super::pixels::Rgba;

/// Pictures made smaller, each once.
#[derive(Debug)]
pub struct Reduced {
    /// How many times smaller on each side; at least 1.
    pub by: usize,
    made: Vec<(Arc<Picture>, Arc<Picture>)>,
    clips: Vec<(Arc<Clip>, Arc<Clip>)>,
}

impl Reduced {
    /// No picture yet.
    pub fn new(by: usize) -> Self {
        Reduced { by, made: Vec::new(), clips: Vec::new() }
    }

    /// The picture made smaller; the same one for the same `Arc`.
    pub fn picture(&mut self, picture: &Arc<Picture>) -> Arc<Picture> {
        if let Some((_, made)) = self.made.iter().find(|(large, _)| Arc::ptr_eq(large, picture)) {
            return made.clone();
        }
        let made = Arc::new(means(picture, self.by));
        self.made.push((picture.clone(), made.clone()));
        made
    }

    /// The clip with all its frames made smaller; the same one for the same `Arc`.
    pub fn clip(&mut self, clip: &Arc<Clip>) -> Arc<Clip> {
        if let Some((_, made)) = self.clips.iter().find(|(large, _)| Arc::ptr_eq(large, clip)) {
            return made.clone();
        }
        let frames = clip.frames.par_iter().map(|frame| Arc::new(means(frame, self.by))).collect();
        let made = Arc::new(Clip { fps: clip.fps, frames });
        self.clips.push((clip.clone(), made.clone()));
        made
    }
}

/// The mean of every block of `by` x `by` pixels; blocks at the right and bottom edges may be smaller.
pub fn means(picture: &Picture, by: usize) -> Picture {
    let (width, height) = (picture.width().div_ceil(by), picture.height().div_ceil(by));
    let mut means: Vec<Rgba> = vec![[0.0; 4]; width * height];
    let lines = means.par_chunks_mut(width.max(1)).enumerate();
    lines.for_each_init(
        || vec![[0.0; 4]; picture.width()],
        |colors, (y, means)| {
            let rows = y * by..(y * by + by).min(picture.height());
            let count = rows.len();
            for row in rows {
                picture.row(0, row, colors);
                for (mean, colors) in means.iter_mut().zip(colors.chunks(by)) {
                    *mean = colors.iter().fold(*mean, |sum, color| std::array::from_fn(|c| sum[c] + color[c]));
                }
            }
            for (mean, colors) in means.iter_mut().zip(colors.chunks(by)) {
                *mean = mean.map(|sum| sum / (colors.len() * count) as f32);
            }
        },
    );
    Picture::from_cells(width, height, means)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_at_the_edges_are_means_of_what_there_is() {
        let picture = Arc::new(Picture::from_cells(3, 1, [1.0, 3.0, 8.0].map(|v| [v; 4]).to_vec()));
        let mut reduced = Reduced::new(2);
        let small = reduced.picture(&picture);
        assert_eq!((small.texel(0, 0), small.texel(1, 0)), ([2.0; 4], [8.0; 4]));
        assert!(Arc::ptr_eq(&small, &reduced.picture(&picture)));
        let clip = Arc::new(Clip { fps: 5.0, frames: vec![picture; 3] });
        let small = reduced.clip(&clip);
        assert_eq!((small.fps, small.frames.len(), small.size_px()), (5.0, 3, (2, 1)));
        assert_eq!(small.frames[2].texel(1, 0), [8.0; 4]);
        assert!(Arc::ptr_eq(&small, &reduced.clip(&clip)));
    }
}
