//! Loops that snap: what jumps where time starts anew, and is seen to. A sampler that jumps where a fold hides it, or over
//! one color, is told of no one.

use super::{LayerSynth, Synth, cpu};
use crate::base::pixels::encode;
use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::folding::model::Zone;
use crate::layers::folding::seam::{BESIDE, Snap, closing, needs_time_alone, snap};
use crate::scene::Scene;

/// Pixels of a zone that are looked at, each way.
const PLACES: usize = 64;
/// A channel that differs by more codes than this is seen to jump,
const SEEN: u8 = 8;
/// and so is the zone where more than one in so many pixels do.
const ONE_IN: usize = 500;

/// A zone whose sampler jumps.
struct Suspect<'a> {
    layer: usize,
    index: usize,
    zone: &'a Zone,
    snap: Snap,
}

/// A warning for every zone that is seen to jump in the loop; `synth` is asked for only where one may.
pub fn warnings<S: std::borrow::Borrow<Synth>>(scene: &Scene, synth: impl FnOnce() -> Option<S>) -> Vec<Problem> {
    let suspects = suspects(scene);
    if suspects.is_empty() {
        return Vec::new();
    }
    let Some(synth) = synth() else { return Vec::new() };
    let seen = suspects.iter().filter(|suspect| is_seen(synth.borrow(), suspect));
    seen.map(|suspect| warning(scene, suspect)).collect()
}

fn zones(scene: &Scene) -> impl Iterator<Item = (usize, usize, &Zone)> {
    let layers = scene.layers.iter().enumerate();
    layers.flat_map(|(i, Layer::Picture(layer))| layer.zones.iter().enumerate().map(move |(j, zone)| (i, j, zone)))
}

fn suspects(scene: &Scene) -> Vec<Suspect<'_>> {
    let suspect = |(layer, index, zone)| Some(Suspect { layer, index, zone, snap: snap(zone, scene.timeline.wrap)? });
    if scene.timeline.frames() < 2 { Vec::new() } else { zones(scene).filter_map(suspect).collect() }
}

/// Whether the pixels of the zone differ before and after the jump.
fn is_seen(synth: &Synth, suspect: &Suspect) -> bool {
    let bounds = suspect.zone.outline.polygon().bounds();
    let LayerSynth::Picture(layer) = &synth.layers[suspect.layer];
    let places = |low: f64, high: f64, most: usize| -> Vec<usize> {
        let (low, high) = (low.max(0.0) as usize, (high.ceil().max(0.0) as usize).min(most));
        let step = high.saturating_sub(low).div_ceil(PLACES).max(1);
        (low..high).step_by(step).collect()
    };
    let columns = places(bounds.x0, bounds.x1, synth.size.0.min(layer.picture.width()));
    let rows = places(bounds.y0, bounds.y1, synth.size.1.min(layer.picture.height()));
    let (before, after) = match suspect.snap.time {
        1.0 => (1.0 - BESIDE, BESIDE),
        time => (time - BESIDE, time + BESIDE),
    };
    let [before, after] = [before, after].map(|time| cpu::lattice(synth, time, &columns, &rows));
    let differ = |(a, b): (&_, &_)| encode(*a).iter().zip(encode(*b)).any(|(a, b)| a.abs_diff(b) > SEEN);
    let count = before.cells().iter().zip(after.cells()).filter(|&pair| differ(pair)).count();
    count * ONE_IN > columns.len() * rows.len()
}

fn warning(scene: &Scene, suspect: &Suspect) -> Problem {
    let Snap { time, s: (before, after), cure } = &suspect.snap;
    let place = if *time == 1.0 { "where it begins anew".into() } else { format!("at t = {time:.3}") };
    let round = |s: f64| (s * 1000.0).round() / 1000.0;
    let message = format!("the loop snaps {place}: s jumps from {} to {}", round(*before), round(*after));
    let mut hint = cure.clone();
    let wrap = scene.timeline.wrap;
    let moving: Vec<&Zone> = zones(scene).map(|(.., zone)| zone).filter(|zone| needs_time_alone(zone, wrap)).collect();
    if needs_time_alone(suspect.zone, wrap)
        && let Some(n) = closing(&moving).filter(|n| *n > 1)
    {
        let seconds = round(scene.timeline.duration * f64::from(n));
        hint += &format!("; at the same pace a duration of {seconds} s closes it, with every speed times {n}");
    }
    Problem::warning(format!("/layers/{}/zones/{}", suspect.layer, suspect.index), message).hint(hint)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use serde_json::json;

    use super::*;
    use crate::base::pixels::Frame;
    use crate::layers::Materials;

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
        let materials = Materials { pictures: [("p".to_owned(), picture)].into(), ..Materials::default() };
        warnings(&scene, || crate::render::synth(&scene, &materials, None).ok())
    }

    #[test]
    fn a_snap_is_told_with_what_closes_it() {
        let text = |zone, wrap| found(zone, wrap).iter().map(Problem::to_string).collect::<Vec<_>>().join("\n");
        for (zone, wrap, parts) in [
            (
                json!({}),
                "repeat",
                &["/layers/0/zones/0: warning: the loop snaps", "from 1 to 0", "cosine", "ping-pong"][..],
            ),
            (json!({ "shift": 0.25 }), "repeat", &["at t = 0.75"]),
            (
                json!({ "speed": 1.5, "position": { "function": "cosine" } }),
                "repeat",
                &["from 1 to 0", "whole number, as 2", "a duration of 4 s", "every speed times 2"],
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
            // Past a wall: no sampler is within the region at either end of its way.
            (json!({ "fold": { "rule": "fly-over", "regions": region(200.0, 9.0) } }), "repeat"),
        ] {
            assert_eq!(found(zone.clone(), wrap), [], "{zone} {wrap}");
        }
    }
}
