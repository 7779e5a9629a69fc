//! The pictures of sprites: keys in tracks, from sheets, windows picked by hand, and windows chosen automatically.

pub mod choose;
pub mod cut;
pub mod growth;
pub mod levels;
pub mod luma;
pub mod matte;
pub mod model;
pub mod residue;

use std::sync::Arc;

use serde_json::{Map, Value};

use self::levels::Levels;
use self::model::{Shows, Sprites};
use self::residue::Residues;
use super::hash::Random;
use crate::base::pixels::Rgba;

/// Sides of keys are multiples of this, in texels.
pub const SIDE_STEP: u32 = 16;
/// The most that they are, in texels.
pub const LARGEST: u32 = 256;
/// What stands for 1 in keys: so their differences are numbers of 16 bits too.
pub const ONE: f32 = 32_766.0;

/// Where a track comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// An image with keys side by side.
    Sheet,
    /// A window picked by hand.
    Pick,
    /// A window chosen automatically.
    Auto,
}

/// Keys that follow one another.
#[derive(Clone, Debug)]
pub struct Track {
    /// What it shows.
    pub kind: Shows,
    /// Where it comes from.
    pub source: Source,
    /// Its keys, at least one.
    pub keys: Vec<Key>,
}

/// A picture of a sprite.
#[derive(Clone, Debug)]
pub struct Key {
    /// Its frame in the clip, and left column and top row of its window, if it comes from there.
    pub window: Option<(usize, (usize, usize))>,
    /// Its texels.
    pub texels: Arc<Levels>,
}

/// All pictures of a layer.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// Texels of a side.
    pub side: usize,
    /// The tracks, by number.
    pub tracks: Vec<Track>,
}

/// The place of a key: its track, and its number in it.
pub type KeyPlace = (usize, usize);

impl Pictures {
    /// One track of a single key that shows nothing.
    pub fn blank(side: u32) -> Pictures {
        let side = side as usize;
        let keys = vec![key(side, vec![[0.0; 4]; side * side], None)];
        Pictures { side, tracks: vec![Track { kind: Shows::Water, source: Source::Auto, keys }] }
    }

    /// The tracks that sprites of a kind show; foam without its own shows water.
    pub fn of(&self, foam: bool) -> Vec<usize> {
        let all = |kind: Shows| (0..self.tracks.len()).filter(move |&i| self.tracks[i].kind == kind).collect();
        let own: Vec<usize> = if foam { all(Shows::Foam) } else { Vec::new() };
        if own.is_empty() { all(Shows::Water) } else { own }
    }

    /// A key.
    pub fn key(&self, (track, key): KeyPlace) -> &Levels {
        &self.tracks[track].keys[key].texels
    }

    /// The number of a key among all.
    pub fn number(&self, (track, key): KeyPlace) -> usize {
        self.tracks[..track].iter().map(|track| track.keys.len()).sum::<usize>() + key
    }

    /// The random numbers between keys, for each track and up to `most` intervals of it.
    pub fn residues(&self, random: Random, most: usize) -> Residues {
        use rayon::prelude::*;
        let of = |track: usize| {
            (0..most).map(move |interval| residue::residue(random, track as u32, interval as u32, self.side))
        };
        Residues((0..self.tracks.len()).into_par_iter().map(|track| of(track).collect()).collect())
    }
}

/// What `sprites` has to set to fit into a clip of this size and length, as little smaller than by default as can be: nothing
/// if the defaults fit. Where nothing fits, the least.
pub fn fitting((width, height): (usize, usize), frames: usize) -> Map<String, Value> {
    let usual = Sprites::default();
    let side = (width.min(height) as u32 / SIDE_STEP * SIDE_STEP).clamp(SIDE_STEP, usual.size);
    // A key is found by what moves from its frame to another one.
    let keys = (frames as u32).clamp(2, usual.keys);
    let step = (frames as u32).saturating_sub(1) / (keys - 1);
    let all = [("size", side, usual.size), ("keys", keys, usual.keys), ("step", step.clamp(1, usual.step), usual.step)];
    let set = all.into_iter().filter(|(_, fits, usual)| fits != usual);
    set.map(|(name, fits, _)| (name.to_owned(), fits.into())).collect()
}

/// How many bytes keys and residues take at most.
pub fn bytes_of(sprites: &Sprites) -> u64 {
    let (tracks, keys, longest) = sprites.most();
    (keys + tracks * longest) * Levels::bytes(sprites.size as usize)
}

/// A key from its texels; light below 0 or above 1 counts as that.
fn key(side: usize, mut texels: Vec<Rgba>, window: Option<(usize, (usize, usize))>) -> Key {
    texels.as_flattened_mut().iter_mut().for_each(|light| *light = light.clamp(0.0, 1.0));
    Key { window, texels: Arc::new(Levels::new(side, texels, ONE)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_is_set_fits_and_is_no_smaller_than_it_has_to_be() {
        for (size, frames, wanted) in [
            ((512, 400), 16, json!({})),
            ((64, 64), 11, json!({})),
            ((512, 400), 10, json!({ "step": 1 })),
            ((512, 400), 6, json!({ "step": 1 })),
            ((512, 400), 4, json!({ "keys": 4, "step": 1 })),
            ((512, 400), 1, json!({ "keys": 2, "step": 1 })),
            ((63, 400), 11, json!({ "size": 48 })),
            ((16, 16), 3, json!({ "size": 16, "keys": 3, "step": 1 })),
            ((8, 8), 11, json!({ "size": 16 })),
        ] {
            assert_eq!(Value::Object(fitting(size, frames)), wanted, "{size:?} {frames}");
        }
    }
}
