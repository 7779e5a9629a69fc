//! Where a zone's sampler jumps because time starts over: at the seam of a loop, and at the end of every pass before
//! that. Jumps within a position function are intended; these often are not.

use super::model::{PictureLayer, Zone};
use super::position::{Pieces, Position};
use super::tools::Tool;
use crate::layers::parts::repeat::{BESIDE, Repeat, Snap};
use crate::layers::timeline::Wrap;

/// The smallest jump in s that counts.
const LEAST: f64 = 0.01;

/// How a layer repeats: the first jump of each zone, and the speeds of the zones whose passes end as they begin.
pub fn repeat(layer: &PictureLayer, wrap: Wrap) -> Repeat {
    let closing = layer.zones.iter().filter(|zone| closes(&zone.position, wrap));
    let speeds = closing.map(|zone| zone.speed).collect();
    let round = |s: f64| (s * 1000.0).round() / 1000.0;
    let snaps = layer.zones.iter().enumerate().filter_map(|(i, zone)| {
        let (time, (before, after)) = snap(zone, wrap)?;
        Some(Snap {
            path: format!("/zones/{i}"),
            bounds: zone.outline.polygon().bounds(),
            time,
            what: format!("s jumps from {} to {}", round(before), round(after)),
            cure: cure(zone, wrap),
            needs_time_alone: closes(&zone.position, wrap),
        })
    });
    Repeat { snaps: snaps.collect(), speeds }
}

/// The first jump of a zone while the timeline is played in a loop: its scene time, and s before and after. `None` if
/// there is no jump.
fn snap(zone: &Zone, wrap: Wrap) -> Option<(f64, (f64, f64))> {
    let clock = zone.clock(wrap);
    let still = |tool: &Tool| matches!(tool, Tool::StillBorder { .. });
    if wrap == Wrap::Once || zone.speed == 0.0 || zone.motion.iter().all(still) {
        return None;
    }
    let jump = |time: f64, before: f64, after: f64| {
        let s = (clock.s(before), clock.s(after));
        ((s.0 - s.1).abs() > LEAST).then_some((time, s))
    };
    // At the seam time continues at 0; at speeds up to a million, BESIDE is less than a tenth of a pass.
    let seam = || jump(1.0, 1.0 - BESIDE, BESIDE);
    let within = || {
        let (first, last) = (clock.speed * clock.shift, clock.speed * (1.0 + clock.shift));
        let turn = if clock.speed > 0.0 { first.floor() + 1.0 } else { first.ceil() - 1.0 };
        let time = turn / clock.speed - clock.shift;
        let inside = turn > first.min(last) && turn < first.max(last);
        if inside { jump(time, time - BESIDE, time + BESIDE) } else { None }
    };
    seam().or_else(within)
}

/// Whether every pass of the zone ends as it begins, so that a whole number of passes closes the loop.
fn closes(position: &Position, wrap: Wrap) -> bool {
    wrap == Wrap::PingPong || (position.eval(1.0 - BESIDE) - position.eval(BESIDE)).abs() <= LEAST
}

fn cure(zone: &Zone, wrap: Wrap) -> String {
    if closes(&zone.position, wrap) {
        let nearest = zone.speed.abs().round().max(1.0).copysign(zone.speed);
        return format!("set its speed to a whole number, such as {nearest}");
    }
    match (zone.position.cycles(), zone.position.pieces()) {
        (Some(_), _) => "give it whole cycles".into(),
        (None, Pieces::Points(..) | Pieces::Segments(_)) => {
            "let its last s be its first, or set the loop to ping-pong".into()
        }
        (None, Pieces::Whole) => {
            "take a function that comes back, as cosine, or set the loop to ping-pong or once".into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zone(position: &str, speed: f64, shift: f64) -> Zone {
        serde_json::from_str(&format!(
            r#"{{"name":"z","outline":{{"kind":"rectangle","x":0,"y":0,"width":9,"height":9}},"speed":{speed},"shift":{shift},
            "motion":[{{"tool":"translate","by":[3,0]}}],"position":{position}}}"#
        ))
        .unwrap()
    }

    #[test]
    fn loops_that_snap_and_loops_that_close() {
        let (linear, sine) = (r#"{"function":"linear"}"#, r#"{"function":"sine"}"#);
        let odd = r#"{"function":"cosine","cycles":0.7}"#;
        let back = r#"{"function":"keyframes","points":[[0,0],[0.3,1],[1,0]]}"#;
        for (position, wrap, speed, shift, time) in [
            (linear, Wrap::Repeat, 1.0, 0.0, Some(1.0)),
            (linear, Wrap::Repeat, -1.0, 0.0, Some(1.0)),
            (linear, Wrap::Repeat, 1.0, 0.25, Some(0.75)),
            (linear, Wrap::Repeat, -2.0, 0.1, Some(0.4)),
            (linear, Wrap::Repeat, 0.5, 0.0, Some(1.0)),
            (linear, Wrap::PingPong, 1.0, 0.3, None),
            (linear, Wrap::PingPong, 1.5, 0.0, Some(1.0)),
            (linear, Wrap::Once, 1.0, 0.0, None),
            (linear, Wrap::Repeat, 0.0, 0.4, None),
            (sine, Wrap::Repeat, 3.0, 0.2, None),
            (sine, Wrap::Repeat, 1.5, 0.0, Some(1.0)),
            (odd, Wrap::Repeat, 1.0, 0.0, Some(1.0)),
            (back, Wrap::Repeat, 1.0, 0.6, None),
        ] {
            let found = snap(&zone(position, speed, shift), wrap).map(|(time, _)| (time * 1e9).round() / 1e9);
            assert_eq!(found, time, "{position} {wrap:?} {speed} {shift}");
        }
    }
}
