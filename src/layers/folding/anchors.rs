//! The results of a zone's tools: anchors, in the order of docs/folding.md section 4, and dense fields.

use std::sync::Arc;

use kurbo::{Affine, CubicBez, ParamCurve, ParamCurveArclen, PathSeg, Point, Vec2};
use serde_json::{Value, json};

use super::anchor::Anchor;
use super::neat::{pair, px, ratio};
use super::outline::Outline;
use super::tools::{CurveFrame, Distribution, JumpAlong, LassoVertex, Tool};
use crate::base::geometry::{Polygon, point, vector};
use crate::base::maths;
use crate::base::pixels::Grid;
use crate::layers::parts::materials::Materials;
use crate::layers::shapes::node::{Node, bezier};

/// A field that is defined everywhere, in pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum Dense {
    /// J(q) = T(q) - q.
    Transform(Affine),
    /// A sampled field, read bilinearly and multiplied by a factor.
    Sampled(Arc<Grid<[f32; 2]>>, f64),
}

/// Lengths are exact to this many pixels.
const ARC_ACCURACY_PX: f64 = 1e-6;

/// All anchors of a zone with this motion and outline, tools in list order.
pub fn anchors(motion: &[Tool], outline: &Outline) -> Vec<Anchor> {
    let mut all = Vec::new();
    for (tool, each) in motion.iter().enumerate() {
        let given = given(each, outline).into_iter();
        all.extend(given.map(|(at, jump)| Anchor { at, jump, tool }));
    }
    all
}

/// The anchors of one tool in a zone with this outline: their places and jump vectors.
pub fn given(tool: &Tool, outline: &Outline) -> Vec<(Point, Vec2)> {
    match tool {
        Tool::Point { at, jump } => vec![(point(*at), vector(*jump))],
        // A shape that is not there.
        Tool::Curve { nodes, .. } if nodes.is_empty() => Vec::new(),
        Tool::Curve { frame, samples, distribution, nodes, jumps } => {
            curve(nodes, *samples, |along| jump_at(jumps, *distribution, along), *frame)
        }
        Tool::Lasso { samples, vertices } => lasso(vertices, *samples),
        Tool::StillBorder { spacing } => still_border(&outline.polygon(), *spacing),
        Tool::Translate { .. }
        | Tool::Scale { .. }
        | Tool::Rotate { .. }
        | Tool::Shear { .. }
        | Tool::Affine { .. }
        | Tool::Field { .. } => Vec::new(),
    }
}

/// All dense fields of a motion, tools in list order. A `field` whose file is not among the materials is left out.
pub fn dense(motion: &[Tool], materials: &Materials) -> Vec<Dense> {
    motion.iter().filter_map(|tool| dense_of(tool, materials)).collect()
}

fn dense_of(tool: &Tool, materials: &Materials) -> Option<Dense> {
    match tool {
        Tool::Field { path, scale } => Some(Dense::Sampled(materials.fields.get(path)?.clone(), *scale)),
        other => transform(other).map(Dense::Transform),
    }
}

/// The map T of a transform, with J(q) = T(q) - q; `None` if the tool is not a transform.
pub fn transform(tool: &Tool) -> Option<Affine> {
    let about = |center: &[f64; 2], linear: [f64; 4]| {
        let c = vector(*center);
        let [a, b, c_, d] = linear;
        Affine::translate(c) * Affine::new([a, b, c_, d, 0.0, 0.0]) * Affine::translate(-c)
    };
    // kurbo's coefficients go by columns: x' = c0 x + c2 y + c4, y' = c1 x + c3 y + c5.
    Some(match tool {
        Tool::Translate { by } => Affine::translate(vector(*by)),
        Tool::Scale { center, factor: [x, y] } => about(center, [*x, 0.0, 0.0, *y]),
        Tool::Rotate { center, degrees } => {
            let (cos, sin) = turn(*degrees);
            about(center, [cos, sin, -sin, cos])
        }
        Tool::Shear { center, factor: [a, b] } => about(center, [1.0, *b, *a, 1.0]),
        Tool::Affine { matrix: [[a, b, tx], [c, d, ty]] } => Affine::new([*a, *c, *b, *d, *tx, *ty]),
        Tool::Point { .. }
        | Tool::Curve { .. }
        | Tool::Lasso { .. }
        | Tool::StillBorder { .. }
        | Tool::Field { .. } => return None,
    })
}

/// Cosine and sine of an angle in degrees, exact at quarter turns.
fn turn(degrees: f64) -> (f64, f64) {
    let part = degrees.rem_euclid(360.0);
    match part {
        0.0 => (1.0, 0.0),
        90.0 => (0.0, 1.0),
        180.0 => (-1.0, 0.0),
        270.0 => (0.0, -1.0),
        _ => (maths::cos(part.to_radians()), maths::sin(part.to_radians())),
    }
}

/// The tool `to`, of the kind of `like`, that is nearest to a map, about its `own` center if it has one, otherwise about the
/// fixed point of the map, or about the `middle`; `None` if that kind is no map.
pub fn nearest(map: Affine, to: &str, like: &Tool, own: Option<Point>, middle: Point) -> Option<Value> {
    let [a, c, b, d, tx, ty] = map.as_coeffs();
    let center = |linear: [f64; 4]| pair(own.unwrap_or_else(|| fixed(linear, Vec2::new(tx, ty), middle)));
    Some(match like {
        Tool::Translate { .. } => json!({ "tool": to, "by": pair(map * middle - middle) }),
        Tool::Affine { .. } => {
            json!({ "tool": to, "matrix": [[ratio(a), ratio(b), px(tx)], [ratio(c), ratio(d), px(ty)]] })
        }
        Tool::Shear { .. } => {
            json!({ "tool": to, "center": center([1.0, b, c, 1.0]), "factor": [ratio(b), ratio(c)] })
        }
        Tool::Scale { .. } => {
            let [x, y] = stretch(a, b, c, d);
            json!({ "tool": to, "center": center([x, 0.0, 0.0, y]), "factor": [ratio(x), ratio(y)] })
        }
        Tool::Rotate { .. } => {
            let angle = maths::atan2(c - b, a + d);
            let (cos, sin) = (maths::cos(angle), maths::sin(angle));
            json!({ "tool": to, "center": center([cos, -sin, sin, cos]), "degrees": ratio(angle.to_degrees()) })
        }
        Tool::Point { .. }
        | Tool::Curve { .. }
        | Tool::Lasso { .. }
        | Tool::StillBorder { .. }
        | Tool::Field { .. } => return None,
    })
}

/// The factors of a linear map along x and y, after its rotation is removed.
fn stretch(a: f64, b: f64, c: f64, d: f64) -> [f64; 2] {
    if b == 0.0 && c == 0.0 {
        return [a, d];
    }
    let angle = maths::atan2(c - b, a + d);
    let (cos, sin) = (maths::cos(angle), maths::sin(angle));
    [cos * a + sin * c, cos * d - sin * b]
}

/// The fixed point of x -> L x + t; along directions that are not moved, the coordinate of `near`.
fn fixed([a, b, c, d]: [f64; 4], t: Vec2, near: Point) -> Point {
    let (p, q, r, s) = (1.0 - a, -b, -c, 1.0 - d);
    let det = p * s - q * r;
    let over = |x: f64, by: f64, other: f64| if by.abs() > 1e-12 { x / by } else { other };
    if det.abs() > 1e-12 {
        return Point::new((s * t.x - q * t.y) / det, (p * t.y - r * t.x) / det);
    }
    match q == 0.0 && r == 0.0 {
        true => Point::new(over(t.x, p, near.x), over(t.y, s, near.y)),
        false => Point::new(over(t.y, r, near.x), over(t.x, q, near.y)),
    }
}

impl Dense {
    /// The vector at `q`, in pixels.
    pub fn at(&self, q: Point) -> Vec2 {
        match self {
            Dense::Transform(map) => *map * q - q,
            Dense::Sampled(grid, scale) => read(grid, q) * *scale,
        }
    }
}

/// The bilinear read of a vector field, clamped to its edge.
fn read(grid: &Grid<[f32; 2]>, q: Point) -> Vec2 {
    let (gx, gy) = (q.x - 0.5, q.y - 0.5);
    let (fx, fy) = (gx.floor(), gy.floor());
    let cell = |x: f64, y: f64| {
        let clamp = |v: f64, n: usize| v.clamp(0.0, (n - 1) as f64) as usize;
        let [u, v] = *grid.get(clamp(x, grid.width()), clamp(y, grid.height()));
        Vec2::new(u.into(), v.into())
    };
    let top = cell(fx, fy).lerp(cell(fx + 1.0, fy), gx - fx);
    let bottom = cell(fx, fy + 1.0).lerp(cell(fx + 1.0, fy + 1.0), gx - fx);
    top.lerp(bottom, gy - fy)
}

fn curve(nodes: &[Node], samples: u32, jump_at: impl Fn(f64) -> Vec2, frame: CurveFrame) -> Vec<(Point, Vec2)> {
    let pieces = Pieces::new(nodes);
    (0..samples)
        .map(|i| {
            let along = if samples == 1 { 0.5 } else { f64::from(i) / f64::from(samples - 1) };
            let (at, tangent) = pieces.at(along);
            let jump = jump_at(along);
            let jump = match frame {
                CurveFrame::Image => jump,
                CurveFrame::Curve => tangent * jump.x + Vec2::new(tangent.y, -tangent.x) * jump.y,
            };
            (at, jump)
        })
        .collect()
}

/// The pieces of a spline with their lengths; pieces of length 0 are left out.
struct Pieces {
    start: Point,
    pieces: Vec<(CubicBez, f64)>,
}

impl Pieces {
    fn new(nodes: &[Node]) -> Self {
        let path = bezier(nodes, false);
        let cubics = path.segments().filter_map(|segment| match segment {
            PathSeg::Cubic(cubic) => Some((cubic, cubic.arclen(ARC_ACCURACY_PX))),
            _ => None,
        });
        let start = nodes.first().map_or(Point::ZERO, |node| point(node.at));
        Pieces { start, pieces: cubics.filter(|(_, length)| *length > ARC_ACCURACY_PX).collect() }
    }

    /// Position and unit tangent at a fraction of the arc length. At a node, those of the piece that starts there; at
    /// the end, those of the last piece.
    fn at(&self, along: f64) -> (Point, Vec2) {
        let total: f64 = self.pieces.iter().map(|(_, length)| length).sum();
        let mut rest = along * total;
        let last = self.pieces.len().saturating_sub(1);
        for (i, (cubic, length)) in self.pieces.iter().enumerate() {
            if rest < length - ARC_ACCURACY_PX || i == last {
                let t = if rest <= ARC_ACCURACY_PX {
                    0.0
                } else if rest >= length - ARC_ACCURACY_PX {
                    1.0
                } else {
                    cubic.inv_arclen(rest, ARC_ACCURACY_PX)
                };
                return (cubic.eval(t), tangent(cubic, t));
            }
            rest = (rest - length).max(0.0);
        }
        (self.start, Vec2::new(1.0, 0.0))
    }
}

/// The unit tangent; where the derivative vanishes (a missing handle), its limit.
fn tangent(cubic: &CubicBez, t: f64) -> Vec2 {
    let CubicBez { p0, p1, p2, p3 } = *cubic;
    let v = 1.0 - t;
    let derivative = (p1 - p0) * (v * v) + (p2 - p1) * (2.0 * v * t) + (p3 - p2) * (t * t);
    let towards = if t < 0.5 { [derivative, p2 - p0, p3 - p0] } else { [derivative, p3 - p1, p3 - p0] };
    let found = towards.into_iter().find(|d| d.hypot2() > 1e-18).unwrap_or(Vec2::new(1.0, 0.0));
    found / found.hypot2().sqrt()
}

/// The jump vector at a fraction of the arc length, by the places where it is given.
fn jump_at(jumps: &[JumpAlong], distribution: Distribution, along: f64) -> Vec2 {
    let after = jumps.partition_point(|jump| jump.along <= along);
    let vector_of = |i: usize| vector(jumps[i].jump);
    if jumps.is_empty() {
        return Vec2::ZERO;
    }
    if after == 0 || after == jumps.len() {
        return vector_of(after.saturating_sub(1));
    }
    let (from, to) = (&jumps[after - 1], &jumps[after]);
    let part = (along - from.along) / (to.along - from.along);
    let part = match distribution {
        Distribution::Linear => part,
        Distribution::Smooth => maths::smoothstep(0.0, 1.0, part),
        Distribution::Constant => 0.0,
    };
    vector_of(after - 1).lerp(vector_of(after), part)
}

fn lasso(vertices: &[LassoVertex], samples: u32) -> Vec<(Point, Vec2)> {
    let anchor = |vertex: &LassoVertex| (point(vertex.from), point(vertex.to) - point(vertex.from));
    let mut all = Vec::new();
    for (i, vertex) in vertices.iter().enumerate() {
        let (at, jump) = anchor(vertex);
        let (next_at, next_jump) = anchor(&vertices[(i + 1) % vertices.len()]);
        all.push((at, jump));
        all.extend((1..=samples).map(|k| {
            let part = f64::from(k) / f64::from(samples + 1);
            (at.lerp(next_at, part), jump.lerp(next_jump, part))
        }));
    }
    all
}

fn still_border(outline: &Polygon, spacing: f64) -> Vec<(Point, Vec2)> {
    let length = outline.perimeter();
    let n = (length / spacing + 0.5).floor().max(1.0) as usize;
    let mut all = Vec::with_capacity(n);
    let mut before = 0.0;
    for (a, b) in outline.sides() {
        let side = (b - a).hypot2().sqrt();
        // The k-th anchor is at k length / n; it belongs to the side that reaches it.
        while all.len() < n && (all.len() as f64 * length / n as f64) < before + side {
            let part = (all.len() as f64 * length / n as f64 - before) / side;
            all.push((a.lerp(b, part.max(0.0)), Vec2::ZERO));
        }
        before += side;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::folding::model::Zone;

    fn zone(motion: &str) -> Zone {
        serde_json::from_str(&format!(
            r#"{{"name":"z","outline":{{"kind":"rectangle","x":10,"y":20,"width":30,"height":10}},"motion":{motion}}}"#
        ))
        .unwrap()
    }

    fn found(motion: &str) -> Vec<[f64; 4]> {
        zone(motion).anchors().iter().map(|a| [a.at.x, a.at.y, a.jump.x, a.jump.y]).collect()
    }

    #[track_caller]
    fn assert_near(found: &[[f64; 4]], expected: &[[f64; 4]]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (f, e) in found.iter().zip(expected) {
            assert!(f.iter().zip(e).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}, not {expected:?}");
        }
    }

    #[test]
    fn anchors_of_every_tool() {
        let straight = r#""nodes":[{"at":[0,0]},{"at":[10,0]},{"at":[10,10]}]"#;
        assert_near(&found(r#"[{"tool":"point","at":[1,2],"jump":[3,4]}]"#), &[[1., 2., 3., 4.]]);
        assert_near(
            &found(&format!(
                r#"[{{"tool":"curve","samples":5,{straight},"jumps":[{{"along":0.25,"jump":[0,0]}},{{"along":0.75,"jump":[8,4]}}]}}]"#
            )),
            &[[0., 0., 0., 0.], [5., 0., 0., 0.], [10., 0., 4., 2.], [10., 5., 8., 4.], [10., 10., 8., 4.]],
        );
        assert_near(
            &found(&format!(
                r#"[{{"tool":"curve","frame":"curve","samples":3,{straight},"jumps":[{{"along":0,"jump":[2,1]}}]}}]"#
            )),
            &[[0., 0., 2., -1.], [10., 0., 1., 2.], [10., 10., 1., 2.]],
        );
        assert_near(
            &found(&format!(
                r#"[{{"tool":"curve","samples":1,"distribution":"constant",{straight},"jumps":[{{"along":0,"jump":[2,1]}},{{"along":0.5,"jump":[7,7]}}]}}]"#
            )),
            &[[10., 0., 7., 7.]],
        );
        assert_near(
            &found(
                r#"[{"tool":"lasso","samples":1,"vertices":[{"from":[0,0],"to":[2,0]},{"from":[4,0],"to":[4,4]},{"from":[0,4],"to":[0,4]}]}]"#,
            ),
            &[
                [0., 0., 2., 0.],
                [2., 0., 1., 2.],
                [4., 0., 0., 4.],
                [2., 2., 0., 2.],
                [0., 4., 0., 0.],
                [0., 2., 1., 0.],
            ],
        );
        let border = found(r#"[{"tool":"still-border","spacing":10}]"#);
        assert_eq!(border.len(), 8);
        assert_near(
            &border[..5],
            &[[10., 20., 0., 0.], [20., 20., 0., 0.], [30., 20., 0., 0.], [40., 20., 0., 0.], [40., 30., 0., 0.]],
        );
        assert_eq!(found(r#"[{"tool":"still-border","spacing":1000}]"#).len(), 1);
    }

    #[test]
    fn dense_fields_of_every_transform() {
        for (tool, q, jump) in [
            (r#"{"tool":"translate","by":[3,-1]}"#, (5., 5.), (3., -1.)),
            (r#"{"tool":"scale","center":[1,1],"factor":[3,2]}"#, (2., 3.), (2., 2.)),
            (r#"{"tool":"rotate","center":[1,1],"degrees":90}"#, (3., 1.), (-2., 2.)),
            (r#"{"tool":"shear","center":[0,1],"factor":[0.5,2]}"#, (3., 3.), (1., 6.)),
            (r#"{"tool":"affine","matrix":[[1,2,3],[4,5,6]]}"#, (1., 1.), (5., 14.)),
        ] {
            let fields = dense(&zone(&format!("[{tool}]")).motion, &Materials::default());
            let found = fields[0].at(q.into());
            assert_eq!((found.x, found.y), jump, "{tool}");
        }
    }

    #[test]
    fn a_sampled_field_is_read_bilinearly() {
        let grid = Grid::from_cells(2, 1, vec![[0.0, 2.0], [4.0, 2.0]]);
        let field = Dense::Sampled(Arc::new(grid), 0.5);
        assert_eq!(field.at(Point::new(1.0, 0.5)), Vec2::new(1.0, 1.0));
        assert_eq!(field.at(Point::new(-5.0, 9.0)), Vec2::new(0.0, 1.0));
    }
}
