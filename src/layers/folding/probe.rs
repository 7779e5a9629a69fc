//! What one pixel does, and why: the answer to `plica probe`, in double precision, by the same code as the frame.

use kurbo::{Point, Vec2};

use super::clock::Clock;
use super::field::{Inputs, Pixel, Prepared};
use super::model::{PictureLayer, Zone};
use super::synth::source;
use crate::base::problem::Problem;
use crate::layers::parts::moment::CENTER;
use crate::layers::parts::readout::{Axis, Entry, ReadOut, Value};
use crate::layers::ready::Making;

/// What one pixel of a zone does at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// The last zone in the list that contains the pixel.
    pub zone: String,
    /// Jump vector in pixels.
    pub jump: Vec2,
    /// The places s in (0, 1] at which the path meets the fold regions.
    pub thresholds: Vec<f64>,
    /// Local time.
    pub tau: f64,
    /// The place along the path.
    pub s: f64,
    /// Effective place: s without a fold; 0 where `cover` is still.
    pub e: f64,
    /// Whether the sampler is active.
    pub active: bool,
    /// Where it reads (or would read), in pixels of the sampler image.
    pub read: Point,
    /// The frame that it reads, if that is one of a clip.
    pub frame: Option<usize>,
    /// The stretches of s in [0, 1] in which the sampler is active, ascending.
    pub active_parts: Vec<(f64, f64)>,
}

/// What the pixel in column `x`, row `y` of the layer does at `time`; `None` outside every zone.
///
/// # Errors
/// As [`super::synth::synth`].
pub fn probe(
    layer: &PictureLayer,
    making: &Making,
    (x, y): (usize, usize),
    time: f64,
) -> Result<Option<Probe>, Problem> {
    let &Making { wrap, materials, .. } = making;
    let own = materials.picture(&layer.image, "/image")?;
    let center = Point::new(x as f64 + 0.5, y as f64 + 0.5);
    for (index, zone) in layer.zones.iter().enumerate().rev() {
        // Preparing a zone is expensive, so it is done only for one that may contain the pixel.
        if !zone.outline.polygon().bounds().contains(center) {
            continue;
        }
        let inputs = Inputs::new(zone, (own.width(), own.height()), CENTER);
        let pixel =
            Prepared::new(&inputs, materials).map_err(|problem| problem.under(&format!("/zones/{index}")))?.pixel(x, y);
        if pixel.inside {
            let source = source(layer, index, &own, making)?;
            let clock = zone.clock(wrap);
            let frame = source.clip.as_ref().map(|playing| playing.frame_at(time));
            return Ok(Some(Probe { frame, ..at(zone, &pixel, &clock, center + source.offset, time) }));
        }
    }
    Ok(None)
}

/// A probe as the data that panes and commands print; `None` is a pixel outside every zone.
pub fn read_out(probe: Option<Probe>) -> ReadOut {
    let entry = |key, label, value| Entry { key, label, value };
    let Some(probe) = probe else {
        return ReadOut { entries: vec![entry("zone", "zone", Value::Of(None))], ..ReadOut::default() };
    };
    let mut entries = vec![
        entry("zone", "zone", Value::Of(Some(probe.zone))),
        entry("jump", "jump", Value::Vector(probe.jump)),
        entry("thresholds", "thresholds", Value::List(probe.thresholds.clone())),
        entry("tau", "τ", Value::Number(probe.tau)),
        entry("s", "s", Value::Number(probe.s)),
        entry("e", "e", Value::Number(probe.e)),
        entry("active", "active", Value::Flag { on: probe.active, off: "still" }),
        entry("read", "reads", Value::Place(probe.read)),
    ];
    entries.extend(probe.frame.map(|frame| entry("frame", "frame", Value::Index(frame))));
    let points = vec![("s", probe.s), ("e", probe.e)];
    let axis = Axis { stretches: probe.active_parts, ticks: probe.thresholds, points };
    ReadOut { entries, axis: Some(axis), uv: None }
}

fn at(zone: &Zone, pixel: &Pixel, clock: &Clock, origin: Point, time: f64) -> Probe {
    let s = clock.s(time);
    let jump = Vec2::new(pixel.jump[0].into(), pixel.jump[1].into());
    let crossings = if s < 0.0 { &pixel.crossings.behind } else { &pixel.crossings.ahead };
    let rule = zone.fold.as_ref().and_then(|fold| fold.rule());
    let effective = match rule {
        None => Some(s),
        Some(rule) => rule.effective(pixel.crossings.inside, crossings, s),
    };
    let e = effective.unwrap_or_else(|| rule.map_or(s, |rule| rule.still_place(s)));
    let thresholds: Vec<f64> = pixel.crossings.ahead.iter().copied().filter(|c| *c > 0.0 && *c <= 1.0).collect();
    let active = |s: f64| rule.is_none_or(|r| r.effective(pixel.crossings.inside, &pixel.crossings.ahead, s).is_some());
    Probe {
        zone: zone.name.clone(),
        jump,
        active_parts: active_parts(&thresholds, active),
        thresholds,
        tau: clock.tau(time),
        s,
        e,
        active: effective.is_some(),
        read: origin + jump * e,
        frame: None,
    }
}

/// The stretches between neighboring thresholds (including 0 and 1) in whose middle the sampler is active; adjacent
/// stretches
fn active_parts(thresholds: &[f64], active: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
    let ends = thresholds.iter().copied().chain([1.0]);
    let (mut from, mut parts): (f64, Vec<(f64, f64)>) = (0.0, Vec::new());
    for to in ends {
        if to > from && active((from + to) / 2.0) {
            match parts.last_mut().filter(|last| last.1 == from) {
                Some(last) => last.1 = to,
                None => parts.push((from, to)),
            }
        }
        from = to;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn active_parts_lie_between_thresholds() {
        for (thresholds, changes, parts) in [
            (&[][..], &[][..], &[(0.0, 1.0)][..]),
            (&[0.25, 0.5], &[0.25, 0.5], &[(0.0, 0.25), (0.5, 1.0)]),
            (&[0.25, 0.5], &[0.5], &[(0.0, 0.5)]),
            (&[1.0], &[1.0], &[(0.0, 1.0)]),
        ] {
            let active = |s: f64| changes.iter().filter(|&&change| change < s).count() % 2 == 0;
            assert_eq!(active_parts(thresholds, active), parts, "{thresholds:?}");
        }
    }
}
