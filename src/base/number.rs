//! Numbers as a person writes them: no point where they are whole.

use serde_json::{Number, Value};

use super::maths::powi;

/// Whole numbers below this have all their digits.
const MOST_WHOLE: f64 = 1e15;

/// Smaller ones have no decimals, but a power of ten.
const LEAST_DECIMAL: f64 = 1e-6;

fn is_whole(number: f64) -> bool {
    number == number.trunc() && number.abs() < MOST_WHOLE
}

/// A JSON number, an integer if it is whole; `null` if it is not finite.
pub fn json(number: f64) -> Value {
    if is_whole(number) { Value::from(number as i64) } else { Value::from(number) }
}

/// A number as text with all its decimals: a power of ten where it would have many zeros otherwise.
pub fn text(number: f64) -> String {
    match number {
        _ if is_whole(number) => format!("{number:.0}"),
        _ if number.is_finite() && !(LEAST_DECIMAL..MOST_WHOLE).contains(&number.abs()) => format!("{number:e}"),
        _ => number.to_string(),
    }
}

/// A number of a document as text: `1e300` and `50`, where JSON has `1e+300` and `50.0`.
pub fn written(number: &Number) -> String {
    number.as_f64().filter(|_| number.is_f64()).map_or_else(|| number.to_string(), text)
}

/// A value with all its numbers changed, and as a person writes them.
pub fn mapped(value: Value, change: fn(f64) -> f64) -> Value {
    match value {
        Value::Number(number) => number.as_f64().map_or(Value::Number(number), |n| json(change(n))),
        Value::Array(all) => all.into_iter().map(|value| mapped(value, change)).collect(),
        Value::Object(all) => all.into_iter().map(|(key, value)| (key, mapped(value, change))).collect(),
        other => other,
    }
}

/// The nearest number with so many decimals, as a person would write it.
pub fn rounded(value: f64, decimals: u32) -> f64 {
    let parts = powi(10.0, decimals);
    (value * parts).round() / parts
}

/// [`rounded`], as JSON.
pub fn rounded_json(value: f64, decimals: u32) -> Value {
    json(rounded(value, decimals))
}

/// How many decimals tell a size in so many units of the last of them, up to nine.
pub fn decimals(size: f64, units: f64) -> u32 {
    const MOST: u32 = 9;
    (0..MOST).find(|decimals| size * powi(10.0, *decimals) >= units).unwrap_or(MOST)
}

/// Rounds away the floating-point noise of a computed number.
pub fn tidy(value: f64) -> f64 {
    tidied(value, 9)
}

/// The same to so many decimals. Large numbers have no meaningful ones that far down.
pub fn tidied(value: f64, decimals: u32) -> f64 {
    let rounded = rounded(value, decimals);
    if rounded.is_finite() && rounded.abs() < 1e6 { rounded + 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_decimals() {
        for (value, decimals, expected) in [(0.126, 2, 0.13), (-1.25, 1, -1.3), (2.5, 0, 3.0), (0.1 + 0.2, 9, 0.3)] {
            assert_eq!(rounded(value, decimals), expected);
        }
    }

    #[test]
    fn sizes_have_as_many_decimals_as_they_need() {
        for (size, expected) in [(2e4, 0), (1e4, 0), (9999.0, 1), (0.5, 5), (1e-9, 9), (0.0, 9)] {
            assert_eq!(decimals(size, 1e4), expected, "{size}");
        }
    }

    #[test]
    fn whole_numbers_have_no_point() {
        for (number, expected) in [(3.0, "3"), (-0.5, "-0.5"), (-7.0, "-7"), (1e14, "100000000000000"), (0.1, "0.1")] {
            assert_eq!((json(number).to_string(), text(number)), (expected.to_owned(), expected.to_owned()));
        }
        for (number, expected) in [(1e300, "1e300"), (-2.5e-7, "-2.5e-7"), (0.000_25, "0.00025"), (1e9, "1000000000")] {
            assert_eq!([text(number), written(&Number::from_f64(number).unwrap())], [expected; 2]);
        }
        assert_eq!(written(&Number::from(u64::MAX)), u64::MAX.to_string());
        assert_eq!(json(1e15).to_string(), "1e+15".parse::<f64>().map(Value::from).unwrap().to_string());
        assert_eq!(json(f64::NAN), Value::Null);
    }
}
