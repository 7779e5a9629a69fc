//! Moving least squares by rigid motions (Schaefer, McPhail and Warren 2006), weights d^-2.

use kurbo::{Point, Vec2};

use super::{Jumps, Method, Run};
use crate::layers::folding::anchor::Anchor;

/// If the sum that determines the rotation is no larger than this (in square pixels), the rotation is undefined.
const UNDEFINED_PX2: f64 = 1e-20;

/// The method; it has no parameters.
pub struct Rigid;

impl Method for Rigid {
    /// Places exactly at an anchor get undefined values.
    fn run(&self, anchors: &[Anchor], run: &Run, out: &mut Jumps) {
        for k in 0..run.len {
            let jump = at(anchors, Point::new(run.x(k), run.y()));
            (out.x[k], out.y[k]) = (jump.x, jump.y);
        }
    }
}

fn at(anchors: &[Anchor], q: Point) -> Vec2 {
    let weight = |anchor: &Anchor| 1.0 / (anchor.at - q).hypot2();
    let (mut total, mut from, mut to) = (0.0, Vec2::ZERO, Vec2::ZERO);
    for anchor in anchors {
        let w = weight(anchor);
        total += w;
        // Relative to q, so that the sums stay small where it matters.
        from += (anchor.at - q) * w;
        to += (anchor.at - q + anchor.jump) * w;
    }
    let (from, to) = (from / total, to / total);
    // The rotation as a complex number: the sum of w conj(p - p*) (p + u - q*).
    let (mut re, mut im) = (0.0, 0.0);
    for anchor in anchors {
        let w = weight(anchor) / total;
        let p = anchor.at - q - from;
        let r = anchor.at - q + anchor.jump - to;
        re += w * p.dot(r);
        im += w * p.cross(r);
    }
    let size = (re * re + im * im).sqrt();
    if size <= UNDEFINED_PX2 || size.is_nan() {
        return to - from;
    }
    let (cos, sin) = (re / size, im / size);
    to - Vec2::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y)
}
