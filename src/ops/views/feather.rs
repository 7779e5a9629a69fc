//! How far a picture fades towards its border, so that no seam is seen where it ends on a surface.

use crate::base::number::rounded;
use crate::base::picture::Picture;

/// How much of the shorter side that is.
const SHARE: f64 = 0.05;

/// The feather of a picture, in pixels; 0 if its own alpha says where it ends.
pub fn px(picture: &Picture) -> f64 {
    let shorter = picture.width().min(picture.height()) as f64;
    if ends_by_itself(picture) { 0.0 } else { rounded(SHARE * shorter, 2) }
}

/// Whether it is not whole everywhere along its border.
fn ends_by_itself(picture: &Picture) -> bool {
    let [right, below] = [picture.width(), picture.height()].map(|side| side.saturating_sub(1));
    let across = (0..=right).flat_map(|x| [(x, 0), (x, below)]);
    let mut border = across.chain((0..=below).flat_map(|y| [(0, y), (right, y)]));
    picture.channels().have_alpha() && border.any(|(x, y)| picture.texel(x, y)[3] < 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alpha_that_is_whole_along_the_border_is_none() {
        let picture = |clear: Option<usize>| {
            let cell = |i| [0.0, 0.0, 0.0, if Some(i) == clear { 0.5 } else { 1.0 }];
            Picture::from_cells(60, 40, (0..2400).map(cell).collect())
        };
        for (clear, feather_px) in
            [(None, 2.0), (Some(20 * 60 + 30), 2.0), (Some(0), 0.0), (Some(2399), 0.0), (Some(60), 0.0)]
        {
            assert_eq!(px(&picture(clear)), feather_px, "{clear:?}");
        }
    }
}
