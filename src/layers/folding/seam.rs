//! Where a zone's sampler jumps because time starts anew: at the seam of a loop, and wherever a pass ends before. Jumps
//! within a position function are meant; these often are not.

use super::model::Zone;
use super::position::{Clock, Position};
use super::tools::Tool;
use crate::layers::timeline::Wrap;

/// How near to a jump it is looked at, in timelines.
pub const BESIDE: f64 = 1e-7;

/// The least jump in s.
const LEAST: f64 = 0.01;

/// A jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// The scene time at which it happens; 1 is the seam.
    pub time: f64,
    /// s before and after.
    pub s: (f64, f64),
    /// What would mend it, for this zone alone.
    pub cure: String,
}

/// The first jump of a zone while the timeline is played in a loop; `None` if every pass ends as it begins.
pub fn snap(zone: &Zone, wrap: Wrap) -> Option<Snap> {
    let clock = Clock::of(zone, wrap);
    let still = |tool: &Tool| matches!(tool, Tool::StillBorder { .. });
    if wrap == Wrap::Once || zone.speed == 0.0 || zone.motion.iter().all(still) {
        return None;
    }
    let jump = |time: f64, before: f64, after: f64| {
        let s = (clock.s(before), clock.s(after));
        ((s.0 - s.1).abs() > LEAST).then_some((time, s))
    };
    // At the seam time goes on at 0; speeds up to a million move less than a tenth of a pass in BESIDE.
    let seam = || jump(1.0, 1.0 - BESIDE, BESIDE);
    let within = || {
        let (first, last) = (clock.speed * clock.shift, clock.speed * (1.0 + clock.shift));
        let turn = if clock.speed > 0.0 { first.floor() + 1.0 } else { first.ceil() - 1.0 };
        let time = turn / clock.speed - clock.shift;
        let inside = turn > first.min(last) && turn < first.max(last);
        if inside { jump(time, time - BESIDE, time + BESIDE) } else { None }
    };
    let (time, s) = seam().or_else(within)?;
    Some(Snap { time, s, cure: cure(zone, wrap) })
}

/// Whether every pass of the zone ends as it begins, so that whole passes are all that a loop needs.
fn closes(position: &Position, wrap: Wrap) -> bool {
    wrap == Wrap::PingPong || (position.eval(1.0 - BESIDE) - position.eval(BESIDE)).abs() <= LEAST
}

fn cure(zone: &Zone, wrap: Wrap) -> String {
    if closes(&zone.position, wrap) {
        let nearest = zone.speed.abs().round().max(1.0).copysign(zone.speed);
        return format!("set its speed to a whole number, as {nearest}");
    }
    match &zone.position {
        Position::Sine { .. } | Position::Cosine { .. } => "give it whole cycles".into(),
        Position::Keyframes { .. } | Position::Piecewise { .. } => {
            "let its last s be its first, or set the loop to ping-pong".into()
        }
        _ => "take a function that comes back, as cosine, or set the loop to ping-pong or once".into(),
    }
}

/// The least number of timelines after which all of these zones have made whole passes, where there is one up to a thousand.
pub fn closing(zones: &[&Zone]) -> Option<u32> {
    let whole = |speed: f64, n: f64| ((speed * n).round() - speed * n).abs() < 1e-6;
    (1..=1000).find(|&n| zones.iter().all(|zone| whole(zone.speed, f64::from(n))))
}

/// Whether more timelines, and nothing else, would close the loop of a zone.
pub fn needs_time_alone(zone: &Zone, wrap: Wrap) -> bool {
    closes(&zone.position, wrap)
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
            let found = snap(&zone(position, speed, shift), wrap).map(|snap| (snap.time * 1e9).round() / 1e9);
            assert_eq!(found, time, "{position} {wrap:?} {speed} {shift}");
        }
    }

    #[test]
    fn the_time_in_which_all_periods_close() {
        for (speeds, n) in
            [(&[1.5][..], Some(2)), (&[1.5, -0.4], Some(10)), (&[1.0, 2.0], Some(1)), (&[0.123_456], None)]
        {
            let zones: Vec<Zone> = speeds.iter().map(|&speed| zone(r#"{"function":"sine"}"#, speed, 0.0)).collect();
            assert_eq!(closing(&zones.iter().collect::<Vec<_>>()), n, "{speeds:?}");
        }
    }
}
