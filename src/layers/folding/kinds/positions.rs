//! Changing the kind of a position function: the curve is kept if the new kind can express it; keyframes are put on it.

use serde_json::{Value, json};

use crate::base::number::rounded;
use crate::layers::folding::neat::ratio;
use crate::layers::folding::position::{Position, Segment};
use crate::layers::keyframes::Between;
use crate::layers::technique::Turned;

/// Keyframes per cycle of a function.
const A_CYCLE: f64 = 8.0;
/// The most keyframes.
const MOST: f64 = 64.0;

/// The position function turned into the kind `to`; `None` if there is nothing to do but keep common fields.
pub fn turned(old: &Position, to: &str) -> Option<Turned> {
    match (old, to) {
        (Position::Linear, "keyframes") | (Position::Piecewise { .. }, "piecewise") => None,
        (Position::Keyframes { .. }, "keyframes") => None,
        (Position::Keyframes { points, between }, "piecewise") => segments(points, *between),
        (_, "piecewise") => {
            let ease = serde_json::to_value(old).ok().filter(|_| *old != Position::Linear);
            Some(piecewise(vec![segment(1.0, 0.0, 1.0, ease)]))
        }
        (Position::Piecewise { segments }, "keyframes") => Some(ends(segments)),
        (Position::Piecewise { segments }, _) => alone(segments, to),
        (_, "keyframes") => Some(sampled(old)),
        _ => None,
    }
}

fn piecewise(segments: Vec<Value>) -> Turned {
    Turned::whole(json!({ "function": "piecewise", "segments": segments }))
}

fn segment(until: f64, from: f64, to: f64, ease: Option<Value>) -> Value {
    let mut segment = json!({ "until": ratio(until), "from": ratio(from), "to": ratio(to) });
    if let Some(ease) = ease {
        segment["ease"] = ease;
    }
    segment
}

fn keyframes(points: &[[f64; 2]], between: &str) -> Turned {
    let points: Vec<Value> = points.iter().map(|&[at, s]| json!([ratio(at), ratio(s)])).collect();
    let mut all = json!({ "function": "keyframes", "points": points });
    if between != "linear" {
        all["between"] = between.into();
    }
    Turned::whole(all)
}

/// A segment between every two keyframes, and one at either end if they do not reach it.
fn segments(points: &[[f64; 2]], between: Between) -> Option<Turned> {
    let (&[first, start], &[last, end]) = (points.first()?, points.last()?);
    if first < 0.0 || last > 1.0 {
        return None;
    }
    let mut all = Vec::new();
    all.extend((first > 0.0).then(|| segment(first, start, start, None)));
    all.extend(points.windows(2).map(|pair| {
        let [[_, from], [until, to]] = [pair[0], pair[1]];
        segment(until, from, if between == Between::Step { from } else { to }, None)
    }));
    all.extend((last < 1.0).then(|| segment(1.0, end, end, None)));
    Some(piecewise(all).but_if(match between {
        Between::Linear => None,
        Between::Smooth => Some("what was smooth between the points is straight now".into()),
        Between::Step => Some("at each step the earlier value still holds now".into()),
    }))
}

/// Keyframes at the ends of segments.
fn ends(segments: &[Segment]) -> Turned {
    let starts = std::iter::once(0.0).chain(segments.iter().map(|segment| segment.until));
    if segments.iter().all(|segment| segment.from == segment.to) {
        let points: Vec<_> = starts.zip(segments).map(|(at, segment)| [at, segment.from]).collect();
        let one = points.len() == 1;
        let lost = (!one).then(|| "at each step the later value holds now".into());
        return keyframes(&points, if one { "linear" } else { "step" }).but_if(lost);
    }
    let first = segments.first().map(|segment| [0.0, segment.from]);
    let points: Vec<_> = first.into_iter().chain(segments.iter().map(|segment| [segment.until, segment.to])).collect();
    let straight = segments.iter().all(|segment| *segment.ease == Position::Linear);
    let joined = segments.windows(2).all(|pair| pair[0].to == pair[1].from);
    let lost = match (straight, joined) {
        (true, true) => None,
        (false, true) => Some("only the ends of the segments are kept, not how they get there"),
        (true, false) => Some("only the ends of the segments are kept, not where they begin"),
        (false, false) => Some("only the ends of the segments are kept, not where they begin nor how they get there"),
    };
    keyframes(&points, "linear").but_if(lost.map(str::to_owned))
}

/// The easing of a function that is a single segment from 0 to 1, if it is of the kind `to`.
fn alone(segments: &[Segment], to: &str) -> Option<Turned> {
    let [Segment { from: 0.0, to: 1.0, ease, .. }] = segments else { return None };
    let ease = serde_json::to_value(ease).ok()?;
    (ease["function"] == to).then(|| Turned::whole(ease))
}

/// Keyframes on a function, smooth between them.
fn sampled(old: &Position) -> Turned {
    let cycles = old.cycles().map_or(1.0, |cycles| cycles.abs().max(1.0));
    let n = (cycles * A_CYCLE).ceil().min(MOST);
    let on = |at: f64| [at, rounded(old.eval(at), 6)];
    let points: Vec<_> = (0..=n as usize).map(|i| on(i as f64 / n)).collect();
    keyframes(&points, "smooth").but(format!("{} keyframes are on it, smooth between them", points.len()))
}
