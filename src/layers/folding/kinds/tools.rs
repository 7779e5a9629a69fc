//! Changing the kind of a tool. Tools that give anchors keep them: each becomes a point, a vertex of a lasso or a place
//! on a curve. Tools that give a dense field keep its map, as far as the new kind can express it; between these two
//! groups, some vectors are kept.

use std::mem::discriminant;

use kurbo::{Affine, Point, Rect, Vec2};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::base::geometry::point;
use crate::base::text::short;
use crate::layers::folding::anchors::{given, nearest, transform};
use crate::layers::folding::counts;
use crate::layers::folding::model::Zone;
use crate::layers::folding::neat::{pair, ratio};
use crate::layers::folding::tools::{Keeps, Tool, fresh};
use crate::layers::technique::Turned;

/// The most points, vertices or places that a tool becomes; if there are more, some are left out, evenly.
const MOST: usize = 10_000;

/// Vectors that differ by less than this count as equal.
const SAME_PX: f64 = 1e-6;

/// The tool of `zone` turned into the kind `to`; `None` if it is of that kind already, or there is no such kind.
pub fn turned(zone: &Zone, old: &Tool, to: &str) -> Option<Turned> {
    let bounds = zone.outline.polygon().bounds();
    let new: Tool = Tool::deserialize(fresh(to, bounds)?).ok()?;
    if discriminant(&new) == discriminant(old) {
        return None;
    }
    let name = serde_json::to_value(old).ok()?.get("tool")?.as_str()?.to_owned();
    let turning = Turning { zone, old, kind: name, bounds };
    Some(match new.facts().keeps {
        Keeps::Points => turning.points(),
        Keeps::Vertices => turning.lasso(),
        Keeps::Path => turning.curve(),
        Keeps::Map => turning.dense(to, &new),
        Keeps::Nothing => turning.fresh(to),
    })
}

struct Turning<'a> {
    zone: &'a Zone,
    old: &'a Tool,
    kind: String,
    /// The bounding box of the zone.
    bounds: Rect,
}

/// A place and its jump vector.
type Given = (Point, Vec2);

impl Turning<'_> {
    /// The initial value of a field of a new tool of that kind.
    fn start(&self, kind: &str, field: &str) -> Value {
        fresh(kind, self.bounds).and_then(|tool| tool.get(field).cloned()).unwrap_or_default()
    }

    /// A new tool that keeps nothing of the old one.
    fn fresh(&self, to: &str) -> Turned {
        let tool = fresh(to, self.bounds).unwrap_or_default();
        let lost = match self.old {
            Tool::Point { jump, .. } | Tool::Translate { by: jump } if *jump == [0.0; 2] => None,
            Tool::StillBorder { .. } => Some("its spacing is not kept".to_owned()),
            Tool::Field { .. } => Some("its file is not kept".to_owned()),
            _ => Some(format!("nothing of the {} is kept", self.kind)),
        };
        Turned::whole(tool).but_if(lost)
    }

    /// The anchors of the old tool, and how many were left out; `None` if it gives none.
    fn anchors(&self) -> Option<(Vec<Given>, usize)> {
        if counts::anchors(self.old, &self.zone.outline) == 0.0 {
            return None;
        }
        // A curve of ten million samples is thinned out before it is evaluated.
        let all = match self.old {
            Tool::Curve { samples, frame, distribution, nodes, jumps } if *samples as usize > MOST => {
                let samples = MOST as u32;
                let (frame, distribution, nodes, jumps) = (*frame, *distribution, nodes.clone(), jumps.clone());
                given(&Tool::Curve { samples, frame, distribution, nodes, jumps }, &self.zone.outline)
            }
            other => given(other, &self.zone.outline),
        };
        let total = if let Tool::Curve { samples, .. } = self.old { *samples as usize } else { all.len() };
        let every = all.len().div_ceil(MOST).max(1);
        let kept: Vec<_> = all.into_iter().step_by(every).collect();
        let left_out = total - kept.len();
        Some((kept, left_out))
    }

    /// The center of the transform, if it has one.
    fn own_center(&self) -> Option<Point> {
        self.old.facts().center.map(point)
    }

    /// One point per anchor.
    fn points(&self) -> Turned {
        let of = |(at, jump): Given| json!({ "tool": "point", "at": pair(at), "jump": pair(jump) });
        if let Some((all, left_out)) = self.anchors() {
            let lost = match (left_out, all.len()) {
                (0, n) if n > 1 => format!("the {} is now {n} points, one for each anchor", self.kind),
                (0, _) => return Turned { items: all.into_iter().map(of).collect(), lost: None },
                (left_out, n) => format!("the {} is now {n} points, {left_out} anchors are left out", self.kind),
            };
            return Turned { items: all.into_iter().map(of).collect(), lost: Some(lost) };
        }
        let Some(map) = transform(self.old) else { return self.fresh("point") };
        let at = self.own_center().unwrap_or(self.bounds.center());
        let lost = (!is_translation(map)).then(|| format!("only the jump of the {} at the point is kept", self.kind));
        Turned::whole(of((at, map * at - at))).but_if(lost)
    }

    /// A lasso with one vertex per anchor; if there are fewer than three, a new lasso that moves as they do.
    fn lasso(&self) -> Turned {
        let dragged = |all: &[Given]| {
            let vertices = all.iter().map(|&(at, jump)| json!({ "from": pair(at), "to": pair(at + jump) }));
            Turned::whole(json!({ "tool": "lasso", "vertices": vertices.collect::<Vec<_>>() }))
        };
        match self.anchors() {
            Some((all, left_out)) if all.len() >= 3 => {
                let more = if left_out > 0 { format!(", {left_out} anchors are left out") } else { String::new() };
                let lost = match self.old {
                    Tool::Curve { .. } => Some(format!("the curve's {} anchors are the vertices{more}", all.len())),
                    _ if left_out > 0 => Some(format!("{} vertices{more}", all.len())),
                    _ => None,
                };
                dragged(&all).but_if(lost)
            }
            Some((all, _)) => {
                let (middle, jump, same) = mean(&all);
                let corners = self.corners();
                let by = middle - center_of(&corners);
                let all: Vec<Given> = corners.into_iter().map(|at| (at + by, jump)).collect();
                dragged(&all).but_if((!same).then(|| "only the mean of its jump vectors is kept".to_owned()))
            }
            None => match transform(self.old) {
                Some(map) => {
                    let all: Vec<Given> = self.corners().into_iter().map(|at| (at, map * at - at)).collect();
                    let lost = format!("only the jumps of the {} at the vertices are kept", self.kind);
                    dragged(&all).but_if((!is_translation(map)).then_some(lost))
                }
                None => self.fresh("lasso"),
            },
        }
    }

    /// The corners of a new lasso.
    fn corners(&self) -> Vec<Point> {
        let vertices = self.start("lasso", "vertices");
        let places = vertices.as_array().into_iter().flatten();
        places.filter_map(|vertex| place(&vertex["from"])).collect()
    }

    /// A curve through the vertices of a lasso or the places of a border, in straight lines and back to the first;
    /// otherwise a new curve.
    fn curve(&self) -> Turned {
        if let Some((all, left_out)) = self.anchors().filter(|(all, _)| all.len() >= 3) {
            return self.closed(all, left_out);
        }
        let nodes = self.start("curve", "nodes");
        let ends: Vec<Point> = nodes.as_array().into_iter().flatten().filter_map(|node| place(&node["at"])).collect();
        let (ends, jumps, lost) = match (self.anchors(), transform(self.old)) {
            (Some((all, _)), _) => {
                let (middle, jump, same) = mean(&all);
                let by = middle - center_of(&ends);
                let ends = ends.into_iter().map(|at| at + by).collect();
                (ends, vec![jump], (!same).then(|| "only the mean of its jump vectors is kept".to_owned()))
            }
            (None, Some(map)) => {
                let jumps: Vec<Vec2> = ends.iter().map(|&at| map * at - at).collect();
                let lost = format!("only the jumps of the {} along the curve are kept", self.kind);
                let moved = is_translation(map);
                (ends, jumps[..if moved { 1 } else { jumps.len() }].to_vec(), (!moved).then_some(lost))
            }
            (None, None) => return self.fresh("curve"),
        };
        let nodes: Vec<Value> = ends.into_iter().map(|at| json!({ "at": pair(at) })).collect();
        let last = (jumps.len() - 1).max(1) as f64;
        let jumps = jumps.iter().enumerate().map(|(i, &jump)| along(i as f64 / last, jump)).collect();
        spline(self.start("curve", "samples"), nodes, jumps).but_if(lost)
    }

    /// A curve through vertices and back to the first, with as many anchors as there were.
    fn closed(&self, anchors: Vec<Given>, left_out: usize) -> Turned {
        let count = anchors.len();
        let mut corners: Vec<Given> = match self.old {
            Tool::Lasso { vertices, .. } if vertices.len() <= MOST => {
                vertices.iter().map(|v| (point(v.from), point(v.to) - point(v.from))).collect()
            }
            _ => anchors,
        };
        corners.push(corners[0]);
        corners.dedup_by(|next, before| next.0.distance(before.0) < SAME_PX);
        let steps: Vec<f64> = corners.windows(2).map(|pair| pair[0].0.distance(pair[1].0)).collect();
        let whole: f64 = steps.iter().sum();
        if corners.len() < 3 {
            return self.fresh("curve");
        }
        let mut gone = 0.0;
        let mut jumps = vec![along(0.0, corners[0].1)];
        let last = corners.len() - 1;
        for (i, step) in steps.iter().enumerate() {
            gone += step;
            // Places along a curve must ascend, even after rounding.
            if i + 1 == last || *step > 2e-9 * whole && whole - gone > 2e-9 * whole {
                jumps.push(along(if i + 1 == last { 1.0 } else { gone / whole }, corners[i + 1].1));
            }
        }
        if corners.iter().all(|corner| corner.1 == corners[0].1) {
            jumps.truncate(1);
        }
        let nodes = corners.iter().map(|(at, _)| json!({ "at": pair(*at) })).collect();
        let even = steps.iter().all(|step| (step - whole / last as f64).abs() < SAME_PX);
        let lost = match (left_out, even) {
            (0, true) => None,
            (0, false) => Some(format!("the {} anchors are now evenly spaced along the curve", count + 1)),
            _ => Some(format!("{left_out} anchors are left out")),
        };
        spline(json!(count + 1), nodes, jumps).but_if(lost)
    }

    /// A transform: the nearest to another transform, or the mean motion of anchors.
    fn dense(&self, to: &str, new: &Tool) -> Turned {
        let nearest = |map, own, middle| nearest(map, to, new, own, middle).unwrap_or_default();
        if let Some(map) = transform(self.old) {
            return self.compared(map, nearest(map, self.own_center(), self.bounds.center()));
        }
        let Some((all, _)) = self.anchors() else {
            return Turned::whole(nearest(Affine::IDENTITY, None, self.bounds.center())).but("its file is not kept");
        };
        let (middle, jump, same) = mean(&all);
        // What has no center can move all places alike.
        let moves = new.facts().center.is_none();
        let tool = nearest(if moves { Affine::translate(jump) } else { Affine::IDENTITY }, Some(middle), middle);
        let still = same && jump.hypot() < SAME_PX;
        Turned::whole(tool).but_if(match (moves, same) {
            _ if still => None,
            (true, true) => None,
            (true, false) => Some(format!("only the mean of its {} jump vectors is kept", all.len())),
            (false, _) => Some("its jump vectors are not kept, only their places".to_owned()),
        })
    }

    /// Adds how far the new transform is from the old one.
    fn compared(&self, old: Affine, tool: Value) -> Turned {
        let new = Tool::deserialize(&tool).ok().and_then(|tool| transform(&tool)).unwrap_or_default();
        let Rect { x0, y0, x1, y1 } = self.bounds;
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(Point::from);
        let most = corners.into_iter().map(|q| (old * q - new * q).hypot()).fold(0.0, f64::max);
        let kind = tool["tool"].as_str().unwrap_or_default().to_owned();
        let lost = format!("no {kind} is that {}: jump vectors differ by up to {} px", self.kind, short(most, 2));
        // Smaller differences are only rounding: numbers are written with few decimals.
        let told = most > 0.01;
        Turned::whole(tool).but_if(told.then_some(lost))
    }
}

fn is_translation(map: Affine) -> bool {
    let [a, c, b, d, ..] = map.as_coeffs();
    [a, b, c, d] == [1.0, 0.0, 0.0, 1.0]
}

/// The mean place and jump vector, and whether all vectors are equal to it.
fn mean(all: &[Given]) -> (Point, Vec2, bool) {
    let n = all.len().max(1) as f64;
    let place = all.iter().fold(Vec2::ZERO, |sum, (at, _)| sum + at.to_vec2()) / n;
    let jump = all.iter().fold(Vec2::ZERO, |sum, (_, jump)| sum + *jump) / n;
    (place.to_point(), jump, all.iter().all(|(_, own)| (*own - jump).hypot() < SAME_PX))
}

fn center_of(places: &[Point]) -> Point {
    let sum = places.iter().fold(Vec2::ZERO, |sum, at| sum + at.to_vec2());
    (sum / places.len().max(1) as f64).to_point()
}

fn place(value: &Value) -> Option<Point> {
    Some(Point::new(value.get(0)?.as_f64()?, value.get(1)?.as_f64()?))
}

fn along(at: f64, jump: Vec2) -> Value {
    json!({ "along": ratio(at), "jump": pair((jump.x, jump.y)) })
}

fn spline(samples: Value, nodes: Vec<Value>, jumps: Vec<Value>) -> Turned {
    Turned::whole(json!({ "tool": "curve", "samples": samples, "nodes": nodes, "jumps": jumps }))
}
