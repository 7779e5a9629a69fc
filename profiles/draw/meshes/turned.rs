//! Shapes with round sections along an axis: a vase, and a fish.

use plica::base::maths::{TAU, cos, sin, smoothstep};

use super::{Obj, Vertex, Xyz, cross, dot, share, unit};

/// What goes smoothly from knot to knot; each is where, then how much.
fn eased<const N: usize>(knots: &[[f64; N]], at: f64) -> [f64; N] {
    let next = knots.iter().position(|knot| knot[0] >= at).unwrap_or(knots.len() - 1).max(1);
    let (from, to) = (knots[next - 1], knots[next]);
    let along = smoothstep(from[0], to[0], at);
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * along)
}

/// The height of the vase in meters, and its radius at heights.
const HEIGHT: f64 = 1.55;
const VASE: [[f64; 2]; 6] = [[0.0, 0.3], [0.06, 0.33], [0.62, 0.56], [1.22, 0.21], [1.46, 0.29], [HEIGHT, 0.33]];

/// A vase whose mouth is closed a little below its lip.
pub fn vase() -> String {
    let (rows, columns) = (22, 32);
    let radius = |y: f64| eased(&VASE, y)[1];
    // From the middle of its bottom up to its lip, then over that to the middle of its mouth: places and normals.
    let mut all = vec![([0.0, 0.0], [0.0, -1.0]), ([0.295, 0.0], [0.0, -1.0])];
    all.extend((0..=rows).map(|i| {
        let (y, step) = (HEIGHT * share(i, rows), 1e-4);
        let slope = (radius(y + step) - radius(y - step)) / (2.0 * step);
        let [out, up, _] = unit([1.0, -slope, 0.0]);
        ([radius(y), y], [out, up])
    }));
    all.extend([([0.325, HEIGHT], [0.0, 1.0]), ([0.29, HEIGHT], [0.0, 1.0])]);
    all.extend([([0.27, 1.48], [0.0, 1.0]), ([0.0, 1.48], [0.0, 1.0])]);
    let mut obj = Obj::default();
    obj.sheet(all.len() - 1, columns, |i, j| {
        let ([r, y], [out, up]) = all[i];
        let (x, z) = (sin(TAU * share(j, columns)), cos(TAU * share(j, columns)));
        let uv = [share(j, columns), share(i, all.len() - 1)];
        Vertex { position: [r * x, y, r * z], uv, normal: [out * x, up, out * z] }
    });
    obj.text()
}

/// Along the fish, from its mouth to the end of its tail: half its height, and half its width.
const FISH: [[f64; 3]; 7] = [
    [-1.0, 0.0, 0.0],
    [-0.93, 0.11, 0.07],
    [-0.2, 0.4, 0.2],
    [0.6, 0.1, 0.06],
    [0.7, 0.09, 0.045],
    [1.05, 0.36, 0.016],
    [1.12, 0.4, 0.008],
];

/// A fish that looks to the left.
pub fn fish() -> String {
    let (rows, columns) = (30, 24);
    let at = |x: f64, round: f64| -> Xyz {
        let [_, high, wide] = eased(&FISH, x);
        [x, high * sin(round), wide * cos(round)]
    };
    let mut obj = Obj::default();
    obj.sheet(rows, columns, |i, j| {
        // Closer at the mouth, where it is round.
        let (along, round) = (share(i, rows), TAU * share(j, columns));
        let (x, step) = (-1.0 + 2.12 * along * (0.6 + 0.4 * along), 1e-4);
        let less = |a: Xyz, b: Xyz| std::array::from_fn(|k| a[k] - b[k]);
        let across = less(at(x, round + step), at(x, round - step));
        let onward = less(at(x + step, round), at(x - step, round));
        let normal = cross(onward, across);
        let normal = if dot(normal, normal) > 0.0 { unit(normal) } else { [-1.0, 0.0, 0.0] };
        let outward = dot(normal, [0.0, sin(round), cos(round)]) >= 0.0;
        let normal = if outward || i == 0 { normal } else { normal.map(|v| -v) };
        Vertex { position: at(x, round), uv: [along, share(j, columns)], normal }
    });
    obj.text()
}
