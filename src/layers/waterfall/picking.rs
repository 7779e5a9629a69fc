//! The clip as somebody sees it who picks sprites from it: windows with the paths of their tracks, what is cut out of a frame,
//! and the sheet of all keys.

use std::sync::Arc;

use kurbo::{Point, Rect, Vec2};

use super::album::sheet;
use super::sprites::model::Shows;
use super::sprites::{Key, Source, Track};
use super::synth::Synth;
use crate::base::picture::Picture;
use crate::base::pixels::Rgba;
use crate::layers::parts::marks::{Dot, Look, Mark, Shape};
use crate::layers::parts::picking::{Picking, Subject};

/// A window of water that is picked by hand, one of foam, and one that is chosen automatically.
static PICK: Look = Look::new("pick", 40, [255, 220, 80, 255], 1.6).dots(Dot::Disc, 2.0);
static FOAM: Look = Look::new("pick of foam", 41, [120, 230, 255, 255], 1.2).dots(Dot::Diamond, 2.0).stroke("+");
static AUTOMATIC: Look =
    Look::new("window chosen automatically", 42, [200, 200, 200, 255], 1.0).dashed(4.0, 3.0).stroke("-");
/// A track that hardly moves, in the sheet.
static STILL: Look = Look::new("track that hardly moves", 43, [255, 90, 70, 255], 2.0).dashed(2.0, 2.0).stroke("!");

/// Windows of other frames are fainter.
const ELSEWHERE: f32 = 0.4;
/// A track hardly moves if its window goes less far than this on its way, as a share of its side.
const HARDLY: f64 = 0.1;

/// What there is to see; `None` without a clip, or if it has no such frame.
pub fn picking(synth: &Synth, sight: Subject) -> Option<Picking> {
    let clip = synth.made_of.1.clip.as_ref()?;
    let marks = |frame: usize| {
        let tracks = numbered(synth);
        tracks.flat_map(|(pick, track)| of_track(track, pick, frame, synth.pictures.side)).collect()
    };
    let (picture, marks) = match sight {
        Subject::Frame(frame) => (clip.frames.get(frame)?.clone(), marks(frame)),
        Subject::Cut(frame) => (Arc::new(cut(synth, clip.frames.get(frame)?, frame)), marks(frame)),
        Subject::Sheet => (Arc::new(laid(synth)), stills(synth)),
    };
    let (frames, followed) = (clip.frames.len(), synth.made_of.0.track_frames());
    Some(Picking { picture, marks, frames, followed, side: synth.pictures.side as f64 })
}

/// The tracks from the clip, those that are picked with the number of their pick.
fn numbered(synth: &Synth) -> impl Iterator<Item = (Option<usize>, &Track)> {
    let tracks = synth.pictures.tracks.iter().filter(|track| track.source != Source::Sheet);
    tracks.enumerate().map(|(i, track)| ((track.source == Source::Pick).then_some(i), track))
}

fn of_track(track: &Track, pick: Option<usize>, frame: usize, side: usize) -> Vec<Mark> {
    let path = pick.map_or("/sprites".to_owned(), |pick| format!("/sprites/picks/{pick}"));
    let look = match (pick, track.kind) {
        (None, _) => &AUTOMATIC,
        (_, Shows::Foam) => &FOAM,
        (_, Shows::Water) => &PICK,
    };
    let corner = |key: &Key| key.window.map(|(frame, (x, y))| (frame, Point::new(x as f64, y as f64)));
    let keys: Vec<(usize, Point)> = track.keys.iter().filter_map(corner).collect();
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else { return Vec::new() };
    let here = (first.0..=last.0).contains(&frame);
    // The key before the frame has the window.
    let shown = keys.iter().rev().find(|(of, _)| *of <= frame).unwrap_or(first).1;
    let half = Vec2::new(side as f64, side as f64) / 2.0;
    let way: Vec<Point> = keys.iter().map(|(_, corner)| *corner + half).collect();
    let window = Rect::from_origin_size(shown, (side as f64, side as f64));
    let mut shapes = vec![rectangle(window), Shape::Dot(shown + half)];
    if way.len() > 1 {
        shapes.push(Shape::Line { points: way, closed: false });
    }
    let strength = if here { 1.0 } else { ELSEWHERE };
    shapes.into_iter().map(|shape| Mark { strength, ..Mark::new(look, path.clone(), shape) }).collect()
}

fn rectangle(of: Rect) -> Shape {
    let points = [(of.x0, of.y0), (of.x1, of.y0), (of.x1, of.y1), (of.x0, of.y1)].map(Point::from);
    Shape::Line { points: points.into(), closed: true }
}

/// What is cut out of a frame, over black, where it comes from.
fn cut(synth: &Synth, picture: &Picture, frame: usize) -> Picture {
    let (width, height, side) = (picture.width(), picture.height(), synth.pictures.side);
    let mut cells: Vec<Rgba> = vec![[0.0, 0.0, 0.0, 1.0]; width * height];
    let keys = synth.pictures.tracks.iter().flat_map(|track| &track.keys);
    for (key, (_, (left, top))) in keys.filter_map(|key| Some((key, key.window.filter(|(of, _)| *of == frame)?))) {
        for (i, texel) in key.texels.texels(0).enumerate() {
            let cell = &mut cells[(top + i / side) * width + left + i % side];
            *cell = over(texel, *cell);
        }
    }
    Picture::from_cells(width, height, cells)
}

fn over(above: Rgba, below: Rgba) -> Rgba {
    std::array::from_fn(|c| above[c] + below[c] * (1.0 - above[3]))
}

/// All keys over black, a row for each track.
fn laid(synth: &Synth) -> Picture {
    let all = sheet(synth);
    let cells = all.cells().iter().map(|cell| over(*cell, [0.0, 0.0, 0.0, 1.0])).collect();
    Picture::from_cells(all.width(), all.height(), cells)
}

/// A frame around the rows of tracks that hardly move.
fn stills(synth: &Synth) -> Vec<Mark> {
    let side = synth.pictures.side as f64;
    let hardly = |track: &Track| {
        let corners = track.keys.iter().filter_map(|key| key.window).map(|(_, (x, y))| Point::new(x as f64, y as f64));
        let corners: Vec<Point> = corners.collect();
        let way: f64 = corners.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        corners.len() > 1 && way < HARDLY * side
    };
    let tracks = synth.pictures.tracks.iter().enumerate().filter(|(_, track)| hardly(track));
    let row = |(i, track): (usize, &Track)| {
        let room = Rect::new(0.0, i as f64 * side, track.keys.len() as f64 * side, (i + 1) as f64 * side);
        Mark::new(&STILL, "/sprites", rectangle(room.inset(-1.0)))
    };
    tracks.map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::clip::Clip;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;

    /// A bright square that falls by 3 pixels a frame, and one that stays.
    fn synth() -> Synth {
        let frame = |k: usize| {
            let cell = move |i: usize| {
                let (x, y) = (i % 64, i / 64);
                let falls = (20..28).contains(&x) && (10 + 3 * k..18 + 3 * k).contains(&y);
                let stays = (44..52).contains(&x) && (10..18).contains(&y);
                let v = if falls || stays { 0.6 } else { 0.01 };
                [v, v, v, 1.0]
            };
            Arc::new(Picture::from_cells(64, 48, (0..64 * 48).map(cell).collect()))
        };
        let clip = Arc::new(Clip { fps: 25.0, frames: (0..8).map(frame).collect() });
        let materials = Materials { clips: [("c".to_owned(), clip)].into(), ..Materials::default() };
        let layer = r#"{"name": "f", "clip": "c", "sprites": {"size": 16, "keys": 3, "picks": [
            {"frame": 1, "at": [24, 17]}, {"frame": 0, "at": [48, 14], "kind": "foam"}]}}"#;
        Synth::new(&serde_json::from_str(layer).unwrap(), &Making::plain(Wrap::Repeat, &materials), None).unwrap()
    }

    fn windows(found: &Picking) -> Vec<(&str, Point, f32)> {
        let corner = |mark: &'_ Mark| match &mark.shape {
            Shape::Line { points, closed: true } => Some(points[0]),
            _ => None,
        };
        found.marks.iter().filter_map(|mark| Some((&*mark.path, corner(mark)?, mark.strength))).collect()
    }

    #[test]
    fn windows_follow_their_tracks_from_frame_to_frame() {
        let synth = synth();
        let (falls, stays) = ("/sprites/picks/0", "/sprites/picks/1");
        for (frame, windows_there) in [
            (0, [(falls, (16.0, 9.0), ELSEWHERE), (stays, (40.0, 6.0), 1.0)]),
            (1, [(falls, (16.0, 9.0), 1.0), (stays, (40.0, 6.0), 1.0)]),
            (3, [(falls, (16.0, 15.0), 1.0), (stays, (40.0, 6.0), 1.0)]),
            (6, [(falls, (16.0, 21.0), ELSEWHERE), (stays, (40.0, 6.0), ELSEWHERE)]),
        ] {
            let found = picking(&synth, Subject::Frame(frame)).unwrap();
            let wanted = windows_there.map(|(path, at, strength)| (path, Point::from(at), strength));
            assert_eq!(windows(&found), wanted, "{frame}");
            assert!(Arc::ptr_eq(&found.picture, &synth.made_of.1.clip.as_ref().unwrap().frames[frame]));
            assert_eq!((found.frames, found.side), (8, 16.0));
        }
        assert!(picking(&synth, Subject::Frame(8)).is_none());
    }

    #[test]
    fn what_is_cut_out_is_seen_over_black() {
        let found = picking(&synth(), Subject::Cut(1)).unwrap().picture;
        assert!(found.texel(24, 17)[0] > 0.3, "{:?}", found.texel(24, 17));
        assert_eq!(found.texel(5, 40), [0.0, 0.0, 0.0, 1.0]);
        let none = picking(&synth(), Subject::Cut(7)).unwrap().picture;
        assert_eq!(none.texel(24, 31), [0.0, 0.0, 0.0, 1.0], "no key is of this frame");
    }

    #[test]
    fn the_sheet_marks_tracks_that_hardly_move() {
        let found = picking(&synth(), Subject::Sheet).unwrap();
        assert_eq!((found.picture.width(), found.picture.height()), (48, 32));
        let marked: Vec<_> = found.marks.iter().map(|mark| (mark.look.name, mark.shape.clone())).collect();
        assert_eq!(marked, [(STILL.name, rectangle(Rect::new(1.0, 17.0, 47.0, 31.0)))]);
    }
}
