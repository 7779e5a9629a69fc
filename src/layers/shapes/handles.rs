//! Nodes of paths made anew: handles that make them smooth, and nodes evenly along a path.

use std::collections::BTreeSet;

use kurbo::{ParamCurve, ParamCurveArclen, PathSeg, Point, Vec2};
use serde_json::Value;

use super::node::{self, Node, bezier};
use crate::base::geometry::{Xy, point, vector};
use crate::base::number;

/// Lengths along a path are exact to this many pixels.
const ACCURACY_PX: f64 = 1e-6;
/// Handles this share as long as the way to the next node follow a circle closely.
const THIRD: f64 = 1.0 / 3.0;

/// What becomes of the handles of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handles {
    /// The path goes through smoothly, parallel to the line between its neighbors, and ends as the circle through the last three.
    Smooth,
    /// The shorter handle is the longer one turned about the node.
    Mirrored,
    /// None: the node is a corner between straight sides.
    None,
}

fn xy(v: Vec2) -> Xy {
    [number::tidy(v.x), number::tidy(v.y)]
}

/// Nodes of a path as they are written, with the handles of some made anew; `None` if they are no nodes.
pub fn handled(nodes: &[Value], closed: bool, chosen: &BTreeSet<usize>, handles: Handles) -> Option<Vec<Value>> {
    let all = with_handles(&node::read(nodes)?, closed, chosen, handles);
    // Those that stay are written as they were.
    let each = nodes.iter().zip(&all).enumerate();
    let written = |(i, (old, new)): (usize, (&Value, &_))| {
        if chosen.contains(&i) { node::written(new) } else { old.clone() }
    };
    Some(each.map(written).collect())
}

/// So many nodes evenly along the path of nodes as they are written; `None` if they are no nodes.
pub fn resampled(nodes: &[Value], closed: bool, count: usize) -> Option<Vec<Value>> {
    Some(evenly(&node::read(nodes)?, closed, count).iter().map(node::written).collect())
}

/// Nodes, as they are written, with the handles that the sides beside them have: those of `first` and `last`.
pub fn ends_kept(mut nodes: Vec<Value>, first: &Value, last: &Value) -> Vec<Value> {
    let keep = |end: Option<&mut Value>, of: &Value, handle: &str| {
        let Some(end) = end.and_then(Value::as_object_mut) else { return };
        match of.get(handle) {
            Some(kept) => drop(end.insert(handle.to_owned(), kept.clone())),
            None => drop(end.remove(handle)),
        }
    };
    keep(nodes.first_mut(), first, "in");
    keep(nodes.last_mut(), last, "out");
    nodes
}

/// The path with these nodes' handles made anew.
fn with_handles(nodes: &[Node], closed: bool, chosen: &BTreeSet<usize>, handles: Handles) -> Vec<Node> {
    let last = nodes.len().saturating_sub(1);
    let neighbor = |i: usize, forward: bool| match (i, forward) {
        (0, false) => closed.then_some(last),
        (i, true) if i == last => closed.then_some(0),
        (i, true) => Some(i + 1),
        (i, false) => Some(i - 1),
    };
    let at = |i: Option<usize>| i.and_then(|i| nodes.get(i)).map(|node| point(node.at));
    let beyond = |i: Option<usize>, forward: bool| at(i.and_then(|i| neighbor(i, forward)));
    let made = |(i, node): (usize, &Node)| {
        if !chosen.contains(&i) {
            return node.clone();
        }
        let here = point(node.at);
        let (before, after) = (neighbor(i, false), neighbor(i, true));
        let (back, on) = match handles {
            Handles::None => (Vec2::ZERO, Vec2::ZERO),
            Handles::Smooth => match (at(before), at(after)) {
                (Some(before), Some(after)) => smooth(here, before, after),
                (None, Some(next)) => (Vec2::ZERO, end(here, next, beyond(after, true))),
                (Some(next), None) => (end(here, next, beyond(before, false)), Vec2::ZERO),
                (None, None) => (Vec2::ZERO, Vec2::ZERO),
            },
            Handles::Mirrored => {
                let (back, on) = (vector(node.handle_in), vector(node.handle_out));
                if back.hypot2() > on.hypot2() { (back, -back) } else { (-on, on) }
            }
        };
        Node { at: node.at, handle_in: xy(back), handle_out: xy(on) }
    };
    nodes.iter().enumerate().map(made).collect()
}

/// The handles of a smooth node between two others.
fn smooth(here: Point, before: Point, after: Point) -> (Vec2, Vec2) {
    if before == after {
        return (Vec2::ZERO, Vec2::ZERO);
    }
    let along = (after - before).normalize();
    (along * -(here - before).hypot() * THIRD, along * (after - here).hypot() * THIRD)
}

/// The handle of a smooth end, towards the node next to it: along the circle that has the direction of that node there, where one
/// is beyond it, otherwise straight.
fn end(here: Point, next: Point, beyond: Option<Point>) -> Vec2 {
    let side = next - here;
    match beyond.filter(|beyond| *beyond != here && next != here) {
        None => side * THIRD,
        Some(beyond) => {
            let (along, chord) = ((beyond - here).normalize(), side.normalize());
            (chord * (2.0 * along.dot(chord)) - along) * side.hypot() * THIRD
        }
    }
}

/// A path of nodes that goes smoothly through these points, with handles in hundredths of a pixel.
pub fn through(points: &[Point]) -> Vec<Node> {
    let corners: Vec<Node> = points.iter().map(|&at| Node::corner([at.x, at.y])).collect();
    let mut nodes = with_handles(&corners, false, &(0..points.len()).collect(), Handles::Smooth);
    for handle in nodes.iter_mut().flat_map(|node| [&mut node.handle_in, &mut node.handle_out]) {
        *handle = handle.map(|length| number::rounded(length, 2));
    }
    nodes
}

/// So many nodes evenly along a path, which it goes through in the directions that it had there; straight sides stay straight.
pub fn evenly(nodes: &[Node], closed: bool, count: usize) -> Vec<Node> {
    let path = bezier(nodes, closed);
    let sides: Vec<(PathSeg, f64)> = path.segments().map(|side| (side, side.arclen(ACCURACY_PX))).collect();
    let whole: f64 = sides.iter().map(|(_, length)| length).sum();
    let gaps = if closed { count } else { count.saturating_sub(1) }.max(1);
    let step = whole / gaps as f64;
    let straight = nodes.iter().all(|node| node.handle_in == [0.0; 2] && node.handle_out == [0.0; 2]);
    let made = |k: usize| {
        let (at, along) = place(&sides, step * k as f64);
        let handle = if straight { Vec2::ZERO } else { along * step * THIRD };
        let (back, on) = match k {
            0 if !closed => (Vec2::ZERO, handle),
            _ if !closed && k == gaps => (-handle, Vec2::ZERO),
            _ => (-handle, handle),
        };
        Node { at: xy(at.to_vec2()), handle_in: xy(back), handle_out: xy(on) }
    };
    (0..count).map(made).collect()
}

/// The point so far along the sides, and the direction there.
fn place(sides: &[(PathSeg, f64)], mut along: f64) -> (Point, Vec2) {
    let last = sides.len().saturating_sub(1);
    for (i, (side, length)) in sides.iter().enumerate() {
        if along > *length && i < last {
            along -= length;
            continue;
        }
        let t = side.inv_arclen(along.clamp(0.0, *length), ACCURACY_PX).clamp(0.0, 1.0);
        // A side without handles stands still at its ends, so the direction is taken between two places.
        const NEAR: f64 = 1e-4;
        let (a, b) = (side.eval((t - NEAR).max(0.0)), side.eval((t + NEAR).min(1.0)));
        let way = if a == b { Vec2::ZERO } else { (b - a).normalize() };
        return (side.eval(t), way);
    }
    (Point::ZERO, Vec2::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Node {
        Node { at: [x, y], handle_in: [0.0; 2], handle_out: [0.0; 2] }
    }

    #[test]
    fn handles_are_smooth_mirrored_or_none() {
        let nodes = [at(0.0, 0.0), at(30.0, 30.0), at(60.0, 0.0)];
        let made = |closed, handles, chosen: &[usize]| {
            with_handles(&nodes, closed, &chosen.iter().copied().collect(), handles)
        };
        let smooth = made(false, Handles::Smooth, &[0, 1, 2]);
        let third = Vec2::new(30.0, 30.0).hypot() / 3.0;
        assert_eq!(
            (smooth[1].handle_in, smooth[1].handle_out),
            (xy(Vec2::new(-third, 0.0)), xy(Vec2::new(third, 0.0)))
        );
        assert_eq!(
            (smooth[0].handle_in, smooth[0].handle_out),
            ([0.0; 2], xy(Vec2::new(0.0, third))),
            "an end follows the circle"
        );
        assert_eq!((smooth[2].handle_in, smooth[2].handle_out), (xy(Vec2::new(0.0, third)), [0.0; 2]));
        let two = with_handles(&nodes[..2], false, &[0, 1].into(), Handles::Smooth);
        assert_eq!((two[0].handle_out, two[1].handle_in), ([10.0, 10.0], [-10.0, -10.0]), "two are joined straight");
        let closed = made(true, Handles::Smooth, &[0]);
        assert_eq!(closed[0].handle_out, xy(Vec2::new(-1.0, 1.0).normalize() * third));
        assert_eq!(closed[1..], nodes[1..], "only those that are chosen");
        let mut one_sided = nodes.clone();
        one_sided[1].handle_in = [-4.0, 2.0];
        let mirrored = with_handles(&one_sided, false, &[1].into(), Handles::Mirrored);
        assert_eq!(mirrored[1].handle_out, [4.0, -2.0]);
        assert_eq!(with_handles(&mirrored, false, &[1].into(), Handles::None)[1], nodes[1]);
    }

    #[test]
    fn nodes_are_even_and_the_path_stays() {
        let line = evenly(&[at(0.0, 0.0), at(10.0, 0.0), at(40.0, 0.0)], false, 5);
        assert_eq!(line.iter().map(|node| node.at[0]).collect::<Vec<_>>(), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert!(line.iter().all(|node| node.handle_out == [0.0; 2]), "straight stays straight");
        let square = evenly(&[at(0.0, 0.0), at(8.0, 0.0), at(8.0, 8.0), at(0.0, 8.0)], true, 8);
        assert_eq!((square[1].at, square[7].at), ([4.0, 0.0], [0.0, 4.0]));
        // A circle of four nodes, made of twelve, stays a circle.
        let k = 55.228_474_983_079_36;
        let node = |x: f64, y: f64, [a, b]: Xy| Node { at: [x, y], handle_in: [-a, -b], handle_out: [a, b] };
        let circle = [
            node(100.0, 0.0, [0.0, k]),
            node(0.0, 100.0, [-k, 0.0]),
            node(-100.0, 0.0, [0.0, -k]),
            node(0.0, -100.0, [k, 0.0]),
        ];
        let twelve = bezier(&evenly(&circle, true, 12), true);
        for side in twelve.segments() {
            for t in [0.0, 0.3, 0.5, 0.9] {
                let radius = side.eval(t).to_vec2().hypot();
                assert!((radius - 100.0).abs() < 0.2, "{radius}");
            }
        }
    }
}
