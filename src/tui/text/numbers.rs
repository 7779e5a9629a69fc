//! Numbers and vectors for people: short decimals, and polar coordinates (length, and degrees counter-clockwise from x as on
//! paper, so that a jump of (0, -18) points up at 90 degrees).

use kurbo::Vec2;
use serde_json::Value;

pub use crate::base::number::{text as exact, tidy};
use crate::base::{maths, number, text};

/// The most decimals that a table shows; an entry shows all of them.
const DECIMALS: usize = 3;

/// `value` with at most three decimals and no trailing zeros.
pub fn short(value: f64) -> String {
    text::short(value, DECIMALS)
}

/// `value` as a table shows it: exact if three decimals are enough, else rounded with a mark. Without the mark one would take
/// `0.123` for the value in the file.
pub fn shown(value: f64) -> String {
    const LONGEST: usize = 12;
    let text = short(value);
    let whole = |text: &str| text.parse() == Ok(value);
    if whole(&text) && text.len() <= LONGEST {
        return text;
    }
    // Far from 1, three decimals show nothing or take too much room.
    let far = value != 0.0 && !(0.0005..1e9).contains(&value.abs());
    let text = if far { format!("{value:.3e}") } else { text };
    let text = text.split_once('e').map_or(text.clone(), |(digits, power)| {
        format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
    });
    if whole(&text) { text } else { format!("~{text}") }
}

/// The text of a number shortened to this many characters: with fewer decimals and a mark, else as a power of ten.
pub fn fitted(text: &str, room: usize) -> String {
    if text.chars().count() <= room {
        return text.to_owned();
    }
    let Ok(value) = text.trim_start_matches('~').parse::<f64>() else { return "…".into() };
    let rounded = (0..DECIMALS).rev().map(|decimals| format!("~{value:.decimals$}"));
    let rounded = rounded.chain([2, 0].map(|decimals| format!("~{value:.decimals$e}")));
    rounded.into_iter().find(|text| text.len() <= room).unwrap_or_else(|| "…".into())
}

/// Length and direction of a vector, in degrees; the direction is 0 if the length is.
pub fn polar(vector: Vec2) -> (f64, f64) {
    let length = tidy(vector.hypot2().sqrt());
    let degrees = if length == 0.0 { 0.0 } else { tidy(maths::atan2(0.0 - vector.y, vector.x).to_degrees()) };
    (length, degrees + 0.0)
}

/// The vector with a length and a direction in degrees; quarter turns are exact.
pub fn cartesian(length: f64, degrees: f64) -> Vec2 {
    let turn = degrees.rem_euclid(360.0);
    let (x, y) = match turn {
        0.0 => (1.0, 0.0),
        90.0 => (0.0, -1.0),
        180.0 => (-1.0, 0.0),
        270.0 => (0.0, 1.0),
        _ => (maths::cos(turn.to_radians()), -maths::sin(turn.to_radians())),
    };
    Vec2::new(tidy(length * x), tidy(length * y))
}

/// `vector` with another length in the same direction; along x if it has no direction.
pub fn with_length(vector: Vec2, length: f64) -> Vec2 {
    let (old, _) = polar(vector);
    if old == 0.0 {
        Vec2::new(length, 0.0)
    } else {
        Vec2::new(tidy(vector.x * length / old), tidy(vector.y * length / old))
    }
}

/// Every number of a value with six decimals at most: what was pointed at is no more exact.
pub fn rounded(value: Value) -> Value {
    number::mapped(value, |value| number::rounded(value, 6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_of_columns_tell_the_same_vector() {
        for (x, y, length, degrees) in
            [(0.0, -18.0, 18.0, 90.0), (3.0, 4.0, 5.0, -53.130102354), (-1.0, 0.0, 1.0, 180.0), (0.0, 0.0, 0.0, 0.0)]
        {
            assert_eq!(polar(Vec2::new(x, y)), (length, degrees));
            let back = cartesian(length, degrees);
            assert!((back - Vec2::new(x, y)).hypot() < 1e-8, "{back:?}");
        }
        assert_eq!(cartesian(18.0, 90.0), Vec2::new(0.0, -18.0));
        assert_eq!(with_length(Vec2::new(0.0, -18.0), 20.0), Vec2::new(0.0, -20.0));
        assert_eq!(with_length(Vec2::ZERO, 20.0), Vec2::new(20.0, 0.0));
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [(150.0, "150"), (0.12345, "0.123"), (-0.0001, "0"), (-0.0, "0"), (2.5, "2.5")] {
            assert_eq!(short(value), text);
        }
        for (value, text) in [
            (150.0, "150"),
            (-139.7, "-139.7"),
            (0.125, "0.125"),
            (0.12345, "~0.123"),
            (0.99999, "~1"),
            (-0.0001, "-1e-4"),
            (0.000123456, "~1.235e-4"),
            (123456.5, "123456.5"),
            (1e9, "1000000000"),
            (1.5e12, "1.5e12"),
            (1.0 / 3.0 * 1e20, "~3.333e19"),
            (0.0, "0"),
        ] {
            assert_eq!(shown(value), text);
        }
        for (room, text) in [(8, "-139.736"), (7, "~-139.7"), (6, "~-140"), (5, "~-140"), (4, "…")] {
            assert_eq!(fitted("-139.736", room), text, "{room}");
        }
        assert_eq!(fitted("123456789.125", 8), "~1.23e8");
        assert_eq!((exact(0.1 + 0.2).as_str(), exact(-18.0).as_str()), ("0.30000000000000004", "-18"));
    }
}
