//! Cuts the keys of all tracks out of a clip and of sheets.

use std::sync::Arc;

use rayon::prelude::*;

use super::choose::{Window, followed, windows};
use super::matte::{self, Cut};
use super::model::{MatteKind, Pick, Rows, Sheet, Shows, Sprites};
use super::{Pictures, Source, Track, key, luma};
use crate::base::clip::Clip;
use crate::base::picture::Picture;
use crate::base::pixels::Grid;

/// A window goes no farther than this from one frame to the next, in pixels each way.
const REACH: i32 = 8;
/// Of all frames, this share is darker than what counts as dark at a pixel.
const DARK_SHARE: usize = 10;

/// What sprites are cut from.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The clip, if the layer names one.
    pub clip: Option<Arc<Clip>>,
    /// The image of each sheet.
    pub sheets: Vec<Arc<Picture>>,
}

impl Sources {
    /// Whether they are the same values in memory.
    pub fn is(&self, other: &Sources) -> bool {
        let clip = match (&self.clip, &other.clip) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        let sheets = self.sheets.iter().zip(&other.sheets).all(|(a, b)| Arc::ptr_eq(a, b));
        clip && sheets && self.sheets.len() == other.sheets.len()
    }
}

/// The tracks of a layer. Without a water sprite from sheets or by hand, windows are chosen; there may be none.
pub fn pictures(sprites: &Sprites, sources: &Sources) -> Pictures {
    let side = sprites.size as usize;
    let mut tracks: Vec<Track> = Vec::new();
    for (sheet, image) in sprites.sheets.iter().zip(&sources.sheets) {
        tracks.extend(laid(sheet, image, side));
    }
    let Some(clip) = &sources.clip else { return Pictures { side, tracks } };
    let frames = luma::frames(clip);
    let picked = |pick: &Pick| {
        let edge = |at: f64| (at - side as f64 / 2.0 + 0.5).floor().max(0.0) as usize;
        let window = Window { frame: pick.frame as usize, at: (edge(pick.at[0]), edge(pick.at[1])) };
        (pick.kind, Source::Pick, pick.track, window)
    };
    let mut chosen: Vec<_> = sprites.picks.iter().map(picked).collect();
    if sprites.is_automatic() {
        let found = windows(sprites, clip.fps, &frames).into_iter();
        chosen.extend(found.map(|window| (Shows::Water, Source::Auto, true, window)));
    }
    let dark = (sprites.matte.kind == MatteKind::Motion).then(|| dark(clip));
    let cut = chosen.into_par_iter().map(|(kind, source, track, window)| {
        let path = if track { path(sprites, &frames, window) } else { vec![window] };
        let cuts: Vec<Cut> = path.iter().map(|window| cut(clip, dark.as_ref(), *window, side)).collect();
        let keys = matte::keys(&sprites.matte, side, &cuts).into_iter().zip(path);
        let keys = keys.map(|(texels, window)| key(side, texels, Some((window.frame, window.at))));
        Track { kind, source, keys: keys.collect() }
    });
    tracks.extend(cut.collect::<Vec<_>>());
    Pictures { side, tracks }
}

/// The windows of the keys of a track that begins with `first`.
pub fn path(sprites: &Sprites, frames: &[Grid<u8>], first: Window) -> Vec<Window> {
    let (side, step) = (sprites.size as usize, sprites.step as usize);
    let mut at = first.at;
    let mut keys = vec![first];
    for i in 1..sprites.track_frames() {
        let frame = first.frame + i;
        at = followed(&frames[frame - 1], &frames[frame], at, side, REACH);
        if i % step == 0 {
            keys.push(Window { frame, at });
        }
    }
    keys
}

/// The keys of a sheet, taken as they are.
fn laid(sheet: &Sheet, image: &Picture, side: usize) -> Vec<Track> {
    let cell = |row: u32, column: u32| {
        let (left, top) = (column as usize * side, row as usize * side);
        let texel = |i: usize| image.texel(left + i % side, top + i / side);
        key(side, (0..side * side).map(texel).collect(), None)
    };
    let row = |row: u32| (0..sheet.columns).map(|column| cell(row, column)).collect::<Vec<_>>();
    let rows = (0..sheet.rows).map(row);
    let tracks: Vec<Vec<_>> = match sheet.tracks {
        Rows::Rows => rows.collect(),
        Rows::All => vec![rows.flatten().collect()],
    };
    tracks.into_iter().map(|keys| Track { kind: sheet.kind, source: Source::Sheet, keys }).collect()
}

fn cut(clip: &Clip, dark: Option<&Grid<u16>>, window: Window, side: usize) -> Cut {
    let frame = &clip.frames[window.frame];
    let place = |i: usize| (window.at.0 + i % side, window.at.1 + i / side);
    let places = || (0..side * side).map(place);
    let light = |(x, y): (usize, usize)| {
        let [r, g, b, _] = frame.texel(x, y);
        [r, g, b]
    };
    Cut {
        luma: places().map(|(x, y)| luma::of(frame.codes(x, y))).collect(),
        light: places().map(light).collect(),
        dark: dark.map(|dark| places().map(|(x, y)| *dark.get(x, y)).collect()),
    }
}

/// What counts as dark at each pixel of a clip.
fn dark(clip: &Clip) -> Grid<u16> {
    let (width, height) = clip.size_px();
    let count = clip.frames.len();
    let pixel = |i: usize| {
        let mut all: Vec<u16> = clip.frames.iter().map(|frame| luma::of(frame.codes(i % width, i / width))).collect();
        *all.select_nth_unstable(count / DARK_SHARE).1
    };
    Grid::from_cells(width, height, (0..width * height).into_par_iter().map(pixel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, height: usize, code: impl Fn(usize, usize) -> u8) -> Arc<Picture> {
        let light = |i: usize| {
            let v = crate::base::pixels::linear_from_srgb(f64::from(code(i % width, i / width)) / 255.0) as f32;
            [v, v, v, 1.0]
        };
        Arc::new(Picture::from_cells(width, height, (0..width * height).map(light).collect()))
    }

    /// A bright square that falls by 3 pixels a frame.
    fn clip(frames: usize) -> Arc<Clip> {
        let frame = |k: usize| {
            grey(48, 80, move |x, y| {
                let inside = (20..28).contains(&x) && (10 + 3 * k..18 + 3 * k).contains(&y);
                if inside { 200 } else { 20 + ((x * 5 + y * 3) % 7) as u8 }
            })
        };
        Arc::new(Clip { fps: 25.0, frames: (0..frames).map(frame).collect() })
    }

    fn sprites(json: &str) -> Sprites {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn tracks_are_numbered_sheets_then_picks_then_automatic_ones() {
        let sheet = grey(32, 16, |x, _| if x < 16 { 0 } else { 255 });
        let sources = Sources { clip: Some(clip(12)), sheets: vec![sheet.clone(), sheet] };
        let picks = r#""picks": [{"frame": 1, "at": [24, 17.4], "kind": "foam"}, {"frame": 0, "at": [24, 14], "kind": "foam", "track": false}]"#;
        let sheets = r#""sheets": [{"image": "s", "columns": 2, "kind": "foam"}, {"image": "s", "columns": 2, "tracks": "all", "kind": "foam"}]"#;
        let found = pictures(&sprites(&format!(r#"{{"size": 16, "keys": 3, {picks}, {sheets}}}"#)), &sources);
        let kinds: Vec<_> = found.tracks.iter().map(|track| (track.source, track.keys.len())).collect();
        assert_eq!(kinds[..4], [(Source::Sheet, 2), (Source::Sheet, 2), (Source::Pick, 3), (Source::Pick, 1)]);
        assert!(kinds.len() > 4 && kinds[4..].iter().all(|kind| *kind == (Source::Auto, 3)), "{kinds:?}");
        assert_eq!((found.of(true), found.of(false)[0]), (vec![0, 1, 2, 3], 4));
        // The picked window goes down with the square, 3 pixels a frame and 6 a key.
        let windows: Vec<_> = found.tracks[2].keys.iter().map(|key| key.window).collect();
        assert_eq!(windows, [Some((1, (16, 9))), Some((3, (16, 15))), Some((5, (16, 21)))]);
        assert_eq!(found.key((0, 1)).texel(0, 0, 0), [1.0; 4]);
    }

    #[test]
    fn sheets_of_rows_are_a_track_each() {
        let sheet = grey(16, 48, |_, y| (y / 16 * 100) as u8);
        let sources = Sources { clip: None, sheets: vec![sheet] };
        let found = pictures(&sprites(r#"{"size": 16, "sheets": [{"image": "s", "rows": 3}]}"#), &sources);
        assert_eq!(found.tracks.iter().map(|track| track.keys.len()).collect::<Vec<_>>(), [1, 1, 1]);
        assert_eq!((found.of(false), found.of(true)), (vec![0, 1, 2], vec![0, 1, 2]));
    }

    #[test]
    fn what_is_always_bright_is_dark_for_motion() {
        let found = dark(&clip(12));
        assert_eq!((*found.get(0, 0), *found.get(24, 14)), (20 * 256, (20 + (24 * 5 + 14 * 3) as u16 % 7) * 256));
    }
}
