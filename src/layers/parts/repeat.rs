//! What happens when time starts over: at the seam of a loop, and at the end of every pass before that.

use kurbo::Rect;

use crate::base::text::short;

/// How close to a jump it is evaluated, in timelines.
pub const BESIDE: f64 = 1e-7;

/// Something in a layer that jumps because time starts over.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// What jumps, relative to the layer.
    pub path: String,
    /// Where it is seen, in pixels of the frame.
    pub bounds: Rect,
    /// The scene time at which it happens; 1 is the seam.
    pub time: f64,
    /// What happens, in words: "s jumps from 1 to 0".
    pub what: String,
    /// What would fix it on its own.
    pub cure: String,
    /// Whether repeating the timeline alone would close the loop.
    pub needs_time_alone: bool,
}

/// How a layer repeats.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repeat {
    /// What jumps.
    pub snaps: Vec<Snap>,
    /// The speeds, in passes per timeline, of everything whose passes end as they begin: the loop closes if all of them
    /// are whole numbers.
    pub speeds: Vec<f64>,
}

/// Everything there is in a frame: what turns may be anywhere in it.
pub const EVERYWHERE: Rect = Rect::new(0.0, 0.0, 1e9, 1e9);

/// A snap at the seam of something that turns by so many degrees in a timeline, unless it comes round.
pub fn turned(path: &str, degrees: f64) -> Option<Snap> {
    const SAME_DEGREES: f64 = 1e-6;
    let rounds = degrees / 360.0;
    ((rounds - rounds.round()).abs() * 360.0 > SAME_DEGREES).then(|| Snap {
        path: path.to_owned(),
        bounds: EVERYWHERE,
        time: 1.0,
        what: format!("it has turned by {} degrees", short(degrees, 3)),
        cure: format!(
            "let it be {} degrees, or let the timeline be once or ping-pong",
            short(rounds.round().abs().max(1.0) * 360.0_f64.copysign(degrees), 3)
        ),
        needs_time_alone: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_round_does_not_snap() {
        for (degrees, cure) in [(360.0, None), (0.0, None), (-720.0, None), (50.0, Some("360")), (-500.0, Some("-360"))]
        {
            let found = turned("/spin", degrees).map(|snap| snap.cure);
            assert_eq!(found.is_some(), cure.is_some(), "{degrees}");
            assert!(found.unwrap_or_default().contains(cure.unwrap_or_default()), "{degrees}");
        }
    }
}
