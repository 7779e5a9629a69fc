//! Warnings about loops that snap: what visibly jumps when time starts over. A sampler that jumps where a fold hides
//! it, or within one color, is not reported.

use std::borrow::Borrow;

use super::stage::Stage;
use super::{Synth, cpu};
use crate::base::number::rounded;
use crate::base::pixels::encode;
use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::repeat::{BESIDE, Repeat, Snap};
use crate::layers::space::camera::Camera;
use crate::layers::timeline::Wrap;
use crate::scene::Scene;

/// How many pixels of what jumps are compared, at most, in each direction.
const PLACES: usize = 64;
/// A pixel visibly jumps if a channel differs by more codes than this.
const SEEN: u8 = 8;
/// The whole visibly jumps if more than one in this many pixels does.
const ONE_IN: usize = 500;

/// A warning for everything that visibly jumps in the loop; `synth` is only called if something may jump.
pub fn warnings<S: Borrow<Synth>>(
    scene: &Scene,
    materials: &Materials,
    synth: impl FnOnce() -> Option<S>,
) -> Vec<Problem> {
    if scene.timeline.frames() < 2 {
        return Vec::new();
    }
    let repeat = |layer: &Layer| layer.technique().repeat(&scene.timeline, materials);
    let layers: Vec<Repeat> = scene.layers.iter().map(repeat).collect();
    // The camera only matters to layers in space.
    let camera = Stage::of(scene).seen_by().filter(|_| scene.timeline.wrap == Wrap::Repeat).map(Camera::snaps);
    let camera = camera.unwrap_or_default();
    if camera.is_empty() && layers.iter().all(|layer| layer.snaps.is_empty()) {
        return Vec::new();
    }
    let Some(synth) = synth() else { return Vec::new() };
    let speeds: Vec<f64> = layers.iter().flat_map(|layer| layer.speeds.iter().copied()).collect();
    let of_layers = layers.iter().enumerate();
    let of_layers = of_layers.flat_map(|(i, layer)| layer.snaps.iter().map(move |snap| (format!("/layers/{i}"), snap)));
    let snaps = camera.iter().map(|snap| ("/camera".to_owned(), snap)).chain(of_layers);
    let seen = snaps.filter(|(_, snap)| is_seen(synth.borrow(), snap));
    seen.map(|(at, snap)| warning(scene.timeline.duration, &speeds, snap).under(&at)).collect()
}

/// Whether enough pixels of what jumps differ before and after.
fn is_seen(synth: &Synth, snap: &Snap) -> bool {
    let places = |low: f64, high: f64, most: usize| -> Vec<usize> {
        let (low, high) = (low.max(0.0) as usize, (high.ceil().max(0.0) as usize).min(most));
        let step = high.saturating_sub(low).div_ceil(PLACES).max(1);
        (low..high).step_by(step).collect()
    };
    let columns = places(snap.bounds.x0, snap.bounds.x1, synth.size.0);
    let rows = places(snap.bounds.y0, snap.bounds.y1, synth.size.1);
    let (before, after) = match snap.time {
        1.0 => (1.0 - BESIDE, BESIDE),
        time => (time - BESIDE, time + BESIDE),
    };
    let [before, after] = [before, after].map(|time| cpu::lattice(synth, time, &columns, &rows));
    let differ = |(a, b): (&_, &_)| encode(*a).iter().zip(encode(*b)).any(|(a, b)| a.abs_diff(b) > SEEN);
    let count = before.cells().iter().zip(after.cells()).filter(|&pair| differ(pair)).count();
    count * ONE_IN > columns.len() * rows.len()
}

/// The warning about a jump in a timeline of `duration` seconds; its path is relative to the layer.
fn warning(duration: f64, speeds: &[f64], snap: &Snap) -> Problem {
    let place = if snap.time == 1.0 { "where it starts over".into() } else { format!("at t = {:.3}", snap.time) };
    let message = format!("the loop snaps {place}: {}", snap.what);
    let mut hint = snap.cure.clone();
    if snap.needs_time_alone
        && let Some(n) = closing(speeds).filter(|n| *n > 1)
    {
        let seconds = rounded(duration * f64::from(n), 3);
        hint += &format!("; at the same pace a duration of {seconds} s closes it, with every speed times {n}");
    }
    Problem::warning(snap.path.as_str(), message).hint(hint)
}

/// The smallest number of timelines in which everything with these speeds makes whole passes; `None` if it is above
/// 1000.
fn closing(speeds: &[f64]) -> Option<u32> {
    let whole = |speed: f64, n: f64| ((speed * n).round() - speed * n).abs() < 1e-6;
    (1..=1000).find(|&n| speeds.iter().all(|&speed| whole(speed, f64::from(n))))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use serde_json::json;

    use super::*;
    use crate::base::clip::Clip;
    use crate::base::picture::Picture;
    use crate::base::pixels::Frame;

    fn found(zone: serde_json::Value, wrap: &str) -> Vec<Problem> {
        let mut whole = json!({
            "name": "z", "outline": { "kind": "rectangle", "x": 4, "y": 4, "width": 40, "height": 20 },
            "motion": [{ "tool": "translate", "by": [6, 0] }]
        });
        zone.as_object().unwrap().iter().for_each(|(name, value)| whole[name] = value.clone());
        let scene: Scene = serde_json::from_value(json!({
            "plica": 1, "timeline": { "duration": 2, "fps": 10, "loop": wrap }, "images": { "p": { "path": "p.png" } },
            "layers": [{ "kind": "picture", "name": "l", "image": "p", "zones": [whole] }]
        }))
        .unwrap();
        let cells = (0..50 * 30).map(|i| [(i % 50 * 5) as u8, (i / 50 * 8) as u8, 90, 255]).collect();
        let picture = Arc::new(Frame::from_cells(50, 30, cells).to_linear().into());
        let shade = |k: usize| Arc::new(Picture::filled(50, 30, [k as f32 / 10.0, 0.0, 0.0, 1.0]));
        let clip = Arc::new(Clip { fps: 5.0, frames: (0..7).map(shade).collect() });
        let materials = Materials {
            pictures: [("p".to_owned(), picture)].into(),
            clips: [("c".to_owned(), clip)].into(),
            ..Materials::default()
        };
        warnings(&scene, &materials, || crate::render::synth(&scene, &materials, None).ok())
    }

    #[test]
    fn what_turns_without_coming_round_snaps() {
        let (scene, _) = crate::render::samples::two_squares();
        let found = |camera: serde_json::Value, spin: f64, wrap: &str| {
            let mut json = serde_json::to_value(&scene).unwrap();
            json["timeline"] = json!({ "loop": wrap });
            camera.as_object().unwrap().iter().for_each(|(name, value)| json["camera"][name] = value.clone());
            json["layers"][0]["pose"]["spin"] = spin.into();
            let scene: Scene = serde_json::from_value(json).unwrap();
            let materials = crate::render::samples::square();
            let told = warnings(&scene, &materials, || crate::render::synth(&scene, &materials, None).ok());
            told.iter().map(Problem::to_string).collect::<Vec<_>>().join("\n")
        };
        let keys = json!({ "keys": [{ "at": 0, "position": [0, 0, 4] }, { "at": 0.5, "position": [1, 1, 3] }] });
        for (camera, spin, wrap, told) in [
            (
                json!({}),
                50.0,
                "repeat",
                "layers.0.pose.spin: warning: the loop snaps where it starts over: it has turned by 50 degrees",
            ),
            (json!({}), 360.0, "repeat", ""),
            (json!({}), 50.0, "ping-pong", ""),
            (json!({ "turn": 90 }), 0.0, "repeat", "camera.turn"),
            (json!({ "turn": 360 }), 0.0, "repeat", ""),
            (
                keys.clone(),
                0.0,
                "repeat",
                "camera.keys: warning: the loop snaps where it starts over: it ends elsewhere",
            ),
            (keys, 0.0, "once", ""),
        ] {
            let found = found(camera, spin, wrap);
            assert!(if told.is_empty() { found.is_empty() } else { found.contains(told) }, "{told}: {found}");
        }
    }

    #[test]
    fn a_snap_is_told_with_what_closes_it() {
        let text = |zone, wrap| found(zone, wrap).iter().map(Problem::to_string).collect::<Vec<_>>().join("\n");
        for (zone, wrap, parts) in [
            (
                json!({}),
                "repeat",
                &["layers.0.zones.0: warning: the loop snaps", "from 1 to 0", "cosine", "ping-pong"][..],
            ),
            (json!({ "shift": 0.25 }), "repeat", &["at t = 0.75"]),
            (
                json!({ "position": { "function": "cosine" }, "sampler": { "clip": "c" } }),
                "repeat",
                &["layers.0.zones.0.sampler: warning: the loop snaps", "frame 3 of 7", "take 1.4 s"],
            ),
            (
                json!({ "speed": 1.5, "position": { "function": "cosine" } }),
                "repeat",
                &["from 1 to 0", "whole number, such as 2", "a duration of 4 s", "every speed times 2"],
            ),
        ] {
            let text = text(zone, wrap);
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        }
    }

    #[test]
    fn what_closes_or_is_hidden_is_not_told() {
        let region =
            |x: f64, width: f64| json!([{ "kind": "rectangle", "x": x, "y": 0, "width": width, "height": 30 }]);
        for (zone, wrap) in [
            (json!({}), "once"),
            (json!({}), "ping-pong"),
            (json!({ "position": { "function": "cosine" } }), "repeat"),
            (json!({ "motion": [{ "tool": "translate", "by": [0.01, 0] }] }), "repeat"),
            // Past a wall: no sampler is in the region at either end of its path.
            (json!({ "fold": { "rule": "fly-over", "regions": region(200.0, 9.0) } }), "repeat"),
        ] {
            assert_eq!(found(zone.clone(), wrap), [], "{zone} {wrap}");
        }
    }

    #[test]
    fn the_time_in_which_all_periods_close() {
        for (speeds, n) in
            [(&[1.5][..], Some(2)), (&[1.5, -0.4], Some(10)), (&[1.0, 2.0], Some(1)), (&[0.123_456], None)]
        {
            assert_eq!(closing(speeds), n, "{speeds:?}");
        }
    }
}
