//! The pictures of a layer's sprites, and those between them, as files.

use glam::{DVec2, Vec4};
use serde_json::{Value, json};

use super::between::texels;
use super::color::shaded;
use super::splat::mix;
use super::sprites::model::Shows;
use super::sprites::{Key, Source, Track};
use super::synth::Synth;
use crate::base::pixels::Linear;
use crate::layers::parts::album::Album;

/// All keys, `between` even steps after each but the last of a track, and a sheet with a row for each track.
pub fn album(synth: &Synth, between: usize) -> Album {
    let tracks = &synth.pictures.tracks;
    let mut pictures = Vec::new();
    for (number, track) in tracks.iter().enumerate() {
        let last = track.keys.len() - 1;
        for key in 0..=last {
            let name = file_name(number, track, key);
            pictures.push((name.clone(), shown(synth, number, key, 0.0)));
            let steps = (1..=between).filter(|_| key < last);
            let step = |n: usize| shown(synth, number, key, n as f64 / (between + 1) as f64);
            pictures.extend(steps.map(|n| (format!("{name}-{n:02}"), step(n))));
        }
    }
    pictures.push(("sheet".into(), sheet(synth)));
    let listing = tracks.iter().enumerate().map(|(number, track)| listed(number, track));
    let listing = json!({ "size": synth.pictures.side, "tracks": listing.collect::<Vec<_>>() });
    Album { pictures, listing, taken: taken(synth) }
}

fn word(track: &Track) -> &'static str {
    if track.kind == Shows::Foam { "foam" } else { "water" }
}

fn file_name(number: usize, track: &Track, key: usize) -> String {
    format!("{}-{number:02}-{key:02}", word(track))
}

fn listed(number: usize, track: &Track) -> Value {
    let source = match track.source {
        Source::Sheet => "sheet",
        Source::Pick => "pick",
        Source::Auto => "auto",
    };
    let key = |(i, key): (usize, &Key)| {
        let [frame, x, y] = match key.window {
            Some((frame, (x, y))) => [frame, x, y].map(Value::from),
            None => [Value::Null, Value::Null, Value::Null],
        };
        json!({ "frame": frame, "x": x, "y": y, "file": file_name(number, track, i) + ".png" })
    };
    let keys: Vec<Value> = track.keys.iter().enumerate().map(key).collect();
    json!({ "kind": word(track), "source": source, "keys": keys })
}

/// What is shown `u` of the way after a key, on a line that runs down.
fn shown(synth: &Synth, track: usize, key: usize, u: f64) -> Linear {
    let keys: Vec<_> = (0..synth.pictures.tracks[track].keys.len()).map(|key| (track, key)).collect();
    // The last one is where the interval before it ends.
    let place = if key + 1 == keys.len() { (key.saturating_sub(1), 1.0) } else { (key, u) };
    let mix = mix(&synth.between, &keys, place, |_| DVec2::Y);
    let mut own = Vec::new();
    let side = synth.pictures.side;
    texels((&synth.pictures, &synth.residues), &mix, 0, 0..side, &mut own);
    Linear::from_cells(side, side, own.into_iter().map(|texel| shaded(texel.into(), Vec4::ONE).to_array()).collect())
}

/// All keys, a row for each track.
pub fn sheet(synth: &Synth) -> Linear {
    let (side, tracks) = (synth.pictures.side, &synth.pictures.tracks);
    let longest = tracks.iter().map(|track| track.keys.len()).max().unwrap_or(0);
    let mut all = Linear::filled(longest * side, tracks.len() * side, [0.0; 4]);
    let width = all.width();
    for (number, track) in tracks.iter().enumerate() {
        for key in 0..track.keys.len() {
            let own = shown(synth, number, key, 0.0);
            for y in 0..side {
                let first = (number * side + y) * width + key * side;
                all.cells_mut()[first..first + side].copy_from_slice(own.row(y));
            }
        }
    }
    all
}

/// The picks that give the automatic choice.
fn taken(synth: &Synth) -> Vec<(String, Value)> {
    let automatic = synth.pictures.tracks.iter().filter(|track| track.source == Source::Auto);
    let half = synth.pictures.side / 2;
    let pick = |track: &Track| {
        let (frame, (x, y)) = track.keys.first()?.window?;
        Some(json!({ "frame": frame, "at": [x + half, y + half] }))
    };
    let found: Vec<Value> = automatic.filter_map(pick).collect();
    if found.is_empty() {
        return Vec::new();
    }
    let own = synth.made_of.0.picks.iter().map(|pick| json!(pick));
    vec![("/sprites/picks".into(), own.chain(found).collect())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::Picture;
    use crate::base::pixels::Rgba;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;
    use std::sync::Arc;

    #[test]
    fn an_album_has_every_key_what_is_between_them_and_a_sheet() {
        let cells: Vec<Rgba> =
            (0..32 * 16).map(|i| if i % 32 < 16 { [0.5; 4] } else { [0.25, 0.0, 0.0, 0.25] }).collect();
        let image = Arc::new(Picture::from_cells(32, 16, cells));
        let materials = Materials { pictures: [("s".to_owned(), image)].into(), ..Materials::default() };
        let layer = r#"{"name": "f", "sprites": {"size": 16, "sheets": [{"image": "s", "columns": 2}]}}"#;
        let layer = serde_json::from_str(layer).unwrap();
        let synth = Synth::new(&layer, &Making::plain(Wrap::Repeat, &materials), None).unwrap();
        let found = album(&synth, 1);
        let names: Vec<&str> = found.pictures.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["water-00-00", "water-00-00-01", "water-00-01", "sheet"]);
        let sheet = &found.pictures[3].1;
        assert_eq!((sheet.width(), sheet.height()), (32, 16));
        for (x, wanted) in [(3, [0.5; 4]), (20, [0.25, 0.0, 0.0, 0.25])] {
            let far = (0..4).map(|c| (sheet.get(x, 3)[c] - wanted[c]).abs()).fold(0.0, f32::max);
            assert!(far < 3.1e-5, "{:?}", sheet.get(x, 3));
        }
        assert_eq!(found.listing["tracks"][0]["keys"][1]["file"], "water-00-01.png");
        assert_eq!(found.taken, []);
    }
}
