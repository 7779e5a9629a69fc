//! Masks without alpha, applied to the pictures that they are for.

use std::sync::Arc;

use crate::base::budget::Share;
use crate::base::mask;
use crate::base::picture::Picture;
use crate::base::problem::Problem;
use crate::layers::parts::materials::{Materials, Of, Use, What};
use crate::scene::Scene;

/// A mask without alpha, applied to the picture that it is for.
#[derive(Clone, Debug)]
pub(super) struct Masked {
    mask: Arc<Picture>,
    own: Arc<Picture>,
    made: Arc<Picture>,
    /// Released with the rest.
    _share: Arc<Share>,
}

/// Applies masks without alpha to their pictures once, not every time they are read.
pub(super) fn lay(scene: &Scene, materials: &mut Materials, known: &mut Vec<Masked>, problems: &mut Vec<Problem>) {
    let mut kept: Vec<Masked> = Vec::new();
    for Use { at, of, what } in scene.uses() {
        let (Of::Name(_, name), What::Mask { on }) = (of, what) else { continue };
        let (Some(mask), Some(own)) = (materials.pictures.get(name), materials.pictures.get(on)) else { continue };
        if mask.channels().have_alpha() || !mask::fits(own, mask) {
            continue;
        }
        let same = |m: &&Masked| Arc::ptr_eq(&m.mask, mask) && Arc::ptr_eq(&m.own, own);
        let masked = match known.iter().chain(&kept).find(same) {
            Some(masked) => masked.clone(),
            None => match materials.budget.try_take(mask::bytes(own, mask)) {
                Ok(share) => {
                    let made = Arc::new(mask::by_brightness(own, mask));
                    Masked { mask: mask.clone(), own: own.clone(), made, _share: Arc::new(share) }
                }
                Err(short) => {
                    problems.push(short.problem(at));
                    continue;
                }
            },
        };
        materials.masks.insert((name.to_owned(), on.to_owned()), masked.made.clone());
        kept.push(masked);
    }
    *known = kept;
}
