//! A map of a picture, for moving what stands in it: places, vectors from them, lengths.

use kurbo::{Affine, Point, Rect, Vec2};
use serde_json::{Value, json};

use crate::base::number;

/// Two numbers that differ by less are equal.
const NEAR: f64 = 1e-9;

/// Whether two numbers are equal but for rounding.
pub fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < NEAR
}

/// A number that was computed, as it is written.
pub fn written(x: f64) -> Value {
    number::json(number::tidy(x))
}

/// A pair of them.
pub fn pair(x: f64, y: f64) -> Value {
    json!([written(x), written(y)])
}

/// A pair of numbers, if that is what is written.
pub fn xy(value: &Value) -> Option<(f64, f64)> {
    match value.as_array()?.as_slice() {
        [x, y] => Some((x.as_f64()?, y.as_f64()?)),
        _ => None,
    }
}

/// A map of a picture, and the box around the places that it was applied to.
#[derive(Debug)]
pub struct Moving {
    /// The map.
    pub by: Affine,
    /// Around these places before.
    pub seen: Option<Rect>,
}

/// How a thing is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moved {
    /// Only these of its fields are moved already; all others are to be moved one by one, as the schema tells of them.
    FieldsBut(&'static [&'static str]),
    /// All of it is moved already.
    Whole,
}

/// Moves what is written of an object, or says how that is done.
///
/// # Errors
/// Why it cannot be moved.
pub type Mover = fn(&mut Moving, &mut Value) -> Result<Moved, String>;

impl Moving {
    /// Where a place goes.
    pub fn place(&mut self, at: Point) -> Point {
        self.see(Rect::from_points(at, at));
        self.by * at
    }

    /// Counts these places as moved.
    pub fn see(&mut self, places: Rect) {
        self.seen = Some(self.seen.map_or(places, |seen| seen.union(places)));
    }

    /// What becomes of a vector from one place to another.
    pub fn vector(&self, v: Vec2) -> Vec2 {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
    }

    /// By how much lengths grow, on average.
    pub fn scale(&self) -> f64 {
        self.by.determinant().abs().sqrt()
    }

    /// Whether upright boxes stay upright.
    pub fn is_upright(&self) -> bool {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        is_near(b, 0.0) && is_near(c, 0.0) || is_near(a, 0.0) && is_near(d, 0.0)
    }

    /// Whether shapes stay similar.
    pub fn is_even(&self) -> bool {
        let [a, b, c, d, ..] = self.by.as_coeffs();
        is_near(a * c + b * d, 0.0) && is_near(a * a + b * b, c * c + d * d)
    }

    /// 1, or -1 if it mirrors.
    pub fn turn(&self) -> f64 {
        self.by.determinant().signum()
    }
}
