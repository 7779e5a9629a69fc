//! Numbers and places of new things, as a person would write them.

use kurbo::{Point, Rect};
use serde_json::{Value, json};

use crate::base::number;

/// The middle half of a rectangle, in whole pixels if it is large enough.
pub fn middle(r: Rect) -> Rect {
    let half = r.inset((-r.width() / 4.0, -r.height() / 4.0));
    if half.width().min(half.height()) >= 4.0 { half.round() } else { half }
}

/// The corners of a rectangle from the top-left one, clockwise on the screen.
pub fn corners(r: Rect) -> [Value; 4] {
    [r.origin(), Point::new(r.x1, r.y0), Point::new(r.x1, r.y1), Point::new(r.x0, r.y1)].map(neat_pair)
}

/// A place of something new.
pub fn neat_pair(at: Point) -> Value {
    json!([neat(at.x), neat(at.y)])
}

/// A number of something new: at most three decimals, none if it is whole.
pub fn neat(x: f64) -> Value {
    number::rounded_json(x, 3)
}

/// A number without floating-point noise: pixels, to a millionth.
pub fn px(x: f64) -> Value {
    number::json(number::tidied(x, 6))
}

/// A factor, an angle or a fraction, to nine decimals.
pub fn ratio(x: f64) -> Value {
    number::json(number::tidy(x))
}

/// Both coordinates of a place or a vector in pixels.
pub fn pair(p: impl Into<(f64, f64)>) -> Value {
    let (x, y) = p.into();
    json!([px(x), px(y)])
}
