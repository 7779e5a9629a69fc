//! Where a zone's sampler jumps because time starts over: at the seam of a loop, and at the end of every pass before
//! that. Jumps within a position function are intended; these often are not.

use super::model::{PictureLayer, Zone};
use super::position::{Pieces, Position};
use crate::base::clip::Clip;
use crate::base::number::rounded;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::repeat::{BESIDE, Repeat, Snap};
use crate::layers::timeline::{Timeline, Wrap};

/// The smallest jump in s that counts.
const LEAST: f64 = 0.01;

/// So close to its end, in frames, a clip has ended.
const CLOSE_FRAMES: f64 = 1e-3;

/// How a layer repeats: the first jump of each zone, clips that do not end with the timeline, and the speeds of the zones
/// whose passes end as they begin.
pub fn repeat(layer: &PictureLayer, timeline: &Timeline, materials: &Materials) -> Repeat {
    let wrap = timeline.wrap;
    let closing = layer.zones.iter().filter(|zone| closes(&zone.position, wrap));
    let speeds = closing.map(|zone| zone.speed).collect();
    let snaps = layer.zones.iter().enumerate().filter_map(|(i, zone)| {
        let (time, (before, after)) = snap(zone, wrap)?;
        Some(Snap {
            path: format!("/zones/{i}"),
            bounds: zone.outline.polygon().bounds(),
            time,
            what: format!("s jumps from {} to {}", rounded(before, 3), rounded(after, 3)),
            cure: cure(zone, wrap),
            needs_time_alone: closes(&zone.position, wrap),
        })
    });
    let clips = layer.zones.iter().enumerate().filter_map(|(i, zone)| {
        let (what, cure) = cut(materials.clips.get(zone.clip()?)?, timeline)?;
        let bounds = zone.outline.polygon().bounds();
        Some(Snap { path: format!("/zones/{i}/sampler"), bounds, time: 1.0, what, cure, needs_time_alone: false })
    });
    Repeat { snaps: snaps.chain(clips).collect(), speeds }
}

/// What jumps, and its cure, if a timeline that is played in a loop ends while a clip is under way.
fn cut(clip: &Clip, timeline: &Timeline) -> Option<(String, String)> {
    let count = clip.frames.len();
    let passes = timeline.duration * clip.fps / count as f64;
    if timeline.wrap == Wrap::Once || (passes - passes.round()).abs() * count as f64 <= CLOSE_FRAMES {
        return None;
    }
    let what = format!("the clip has come to frame {} of {count}, and begins again", clip.frame_at(timeline.duration));
    let whole = passes.round().max(1.0) * count as f64 / clip.fps;
    Some((what, format!("let the timeline take {} s, as the clip does", rounded(whole, 3))))
}

/// The first jump of a zone while the timeline is played in a loop: its scene time, and s before and after. `None` if
/// there is no jump.
fn snap(zone: &Zone, wrap: Wrap) -> Option<(f64, (f64, f64))> {
    let clock = zone.clock(wrap);
    if wrap == Wrap::Once || zone.speed == 0.0 || !zone.motion.iter().any(|tool| tool.facts().moves) {
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
            let found = snap(&zone(position, speed, shift), wrap).map(|(time, _)| rounded(time, 9));
            assert_eq!(found, time, "{position} {wrap:?} {speed} {shift}");
        }
    }

    #[test]
    fn a_clip_that_is_under_way_at_the_end_is_cut() {
        use crate::base::picture::Picture;
        let frame = std::sync::Arc::new(Picture::filled(1, 1, [0.0; 4]));
        let clip = Clip { fps: 5.0, frames: vec![frame; 10] };
        for (duration, wrap, cure) in [
            (2.0, Wrap::Repeat, None),
            (6.0, Wrap::PingPong, None),
            (2.2, Wrap::Once, None),
            (2.2, Wrap::Repeat, Some("take 2 s")),
            (3.5, Wrap::PingPong, Some("take 4 s")),
            (0.5, Wrap::Repeat, Some("take 2 s")),
        ] {
            let found = cut(&clip, &Timeline { duration, wrap, ..Timeline::default() });
            assert_eq!(found.is_some(), cure.is_some(), "{duration} {wrap:?}: {found:?}");
            assert!(cure.is_none_or(|cure| found.as_ref().unwrap().1.contains(cure)), "{found:?}");
        }
    }
}
