//! The functions of an expression.

use crate::base::maths;

/// A function of an expression.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// How many arguments it takes; `None`: one or more.
    pub arguments: Option<usize>,
    /// Its value.
    pub apply: fn(&[f64]) -> f64,
}

const fn function(name: &'static str, arguments: usize, apply: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments: Some(arguments), apply }
}

/// All of them. Angles are degrees.
pub const FUNCTIONS: &[Function] = &[
    function("sqrt", 1, |x| x[0].sqrt()),
    function("abs", 1, |x| x[0].abs()),
    function("sign", 1, |x| if x[0] == 0.0 { 0.0 } else { x[0].signum() }),
    function("sin", 1, |x| maths::sin(x[0].to_radians())),
    function("cos", 1, |x| maths::cos(x[0].to_radians())),
    function("tan", 1, |x| maths::sin(x[0].to_radians()) / maths::cos(x[0].to_radians())),
    function("asin", 1, |x| 90.0 - maths::acos(x[0]).to_degrees()),
    function("acos", 1, |x| maths::acos(x[0]).to_degrees()),
    function("atan", 1, |x| maths::atan2(x[0], 1.0).to_degrees()),
    function("atan2", 2, |x| maths::atan2(x[0], x[1]).to_degrees()),
    function("hypot", 2, |x| (x[0] * x[0] + x[1] * x[1]).sqrt()),
    function("exp", 1, |x| maths::exp(x[0])),
    function("ln", 1, |x| maths::ln(x[0])),
    function("floor", 1, |x| x[0].floor()),
    function("ceil", 1, |x| x[0].ceil()),
    function("round", 1, |x| x[0].round()),
    function("clamp", 3, |x| x[0].max(x[1]).min(x[2])),
    function("lerp", 3, |x| maths::lerp(x[0], x[1], x[2])),
    function("if", 3, |x| if x[0] == 0.0 { x[2] } else { x[1] }),
    Function { name: "min", arguments: None, apply: |x| x.iter().copied().fold(f64::INFINITY, f64::min) },
    Function { name: "max", arguments: None, apply: |x| x.iter().copied().fold(f64::NEG_INFINITY, f64::max) },
];
