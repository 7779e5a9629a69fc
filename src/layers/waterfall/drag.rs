//! How fast and how far something falls against air resistance, in closed form: no error of integration, and any age costs
//! the same.

use super::model::DragModel;
use crate::base::maths::{atan, atanh, cos, exp, expm1, ln, ln_1p, tan, tanh};

/// Weaker resistance than this is none.
const LEAST: f64 = 1e-4;

/// What acts on what falls, along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fall {
    /// How resistance depends on speed.
    pub model: DragModel,
    /// How strong it is.
    pub amount: f64,
    /// The acceleration downwards, in m/s2; negative is buoyancy.
    pub gravity: f64,
}

impl Fall {
    /// The way up, in meters, and the speed upwards, in m/s, `t` seconds after it was `v`.
    pub fn after(&self, v: f64, t: f64) -> [f64; 2] {
        let (g, k) = (self.gravity, self.amount);
        match self.model {
            DragModel::Constant => free(g.signum() * (g.abs() - k).max(0.0), v, t),
            DragModel::Linear if k >= LEAST => {
                let (end, passed) = (-g / k, -expm1(-k * t));
                [end * t + (v - end) * passed / k, end + (v - end) * (1.0 - passed)]
            }
            DragModel::Quadratic if k >= LEAST => quadratic(g, k, v, t),
            DragModel::None | DragModel::Linear | DragModel::Quadratic => free(g, v, t),
        }
    }
}

fn free(g: f64, v: f64, t: f64) -> [f64; 2] {
    [v * t - g * t * t / 2.0, v - g * t]
}

fn quadratic(g: f64, k: f64, v: f64, t: f64) -> [f64; 2] {
    if g < 0.0 {
        return quadratic(-g, k, -v, t).map(|mirrored| -mirrored);
    }
    if g == 0.0 {
        let slowed = 1.0 + k * v.abs() * t;
        return [v.signum() * ln(slowed) / k, v / slowed];
    }
    // The speed at which resistance balances gravity.
    let w = (g / k).sqrt();
    if v <= 0.0 {
        return sinking(g, w, -v, t);
    }
    let angle = atan(v / w);
    let top = w / g * angle;
    if t <= top {
        let rest = angle - g * t / w;
        return [w * w / g * ln(cos(rest) / cos(angle)), w * tan(rest)];
    }
    let height = w * w / g * ln_1p(v * v / (w * w)) / 2.0;
    let [dy, speed] = sinking(g, w, 0.0, t - top);
    [height + dy, speed]
}

/// The same for what sinks at the speed `d`, if `w` is the speed at which it would stay.
fn sinking(g: f64, w: f64, d: f64, t: f64) -> [f64; 2] {
    let (x, q) = (g * t / w, d / w);
    if q < 1.0 {
        let c = atanh(q);
        [-(w * w / g) * (ln_cosh(x + c) - ln_cosh(c)), -w * tanh(x + c)]
    } else if 1.0 / q < 1.0 {
        let c = atanh(1.0 / q);
        [-(w * w / g) * (ln_sinh(x + c) - ln_sinh(c)), -w / tanh(x + c)]
    } else {
        [-w * t, -w]
    }
}

/// The logarithm of cosh, for arguments whose cosh is too large for a number too.
fn ln_cosh(x: f64) -> f64 {
    x.abs() + ln_1p(exp(-2.0 * x.abs())) - std::f64::consts::LN_2
}

/// The same of sinh, above 0.
fn ln_sinh(x: f64) -> f64 {
    x + ln(-expm1(-2.0 * x)) - std::f64::consts::LN_2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fall(model: DragModel, amount: f64, gravity: f64) -> Fall {
        Fall { model, amount, gravity }
    }

    #[test]
    fn quadratic_resistance_has_the_checked_values() {
        let water = fall(DragModel::Quadratic, 0.45, 9.81);
        for (v, [dy, speed]) in [(1.2, [-0.084_650_840, -1.688_445_044]), (-9.0, [-2.038_320_678, -5.590_523_475])] {
            let found = water.after(v, 0.3);
            assert!((found[0] - dy).abs() < 1e-9 && (found[1] - speed).abs() < 1e-9, "{v}: {found:?}");
        }
    }

    /// The acceleration upwards.
    fn acceleration(fall: &Fall, v: f64) -> f64 {
        let (g, k) = (fall.gravity, fall.amount);
        match fall.model {
            DragModel::None => -g,
            DragModel::Constant => -g.signum() * (g.abs() - k).max(0.0),
            DragModel::Linear => -g - k * v,
            DragModel::Quadratic => -g - k * v * v.abs(),
        }
    }

    /// Runge and Kutta's method of fourth order.
    fn integrated(fall: &Fall, mut v: f64, t: f64) -> [f64; 2] {
        const STEPS: usize = 16_000;
        let (h, mut y) = (t / STEPS as f64, 0.0);
        for _ in 0..STEPS {
            let k1 = acceleration(fall, v);
            let k2 = acceleration(fall, v + h / 2.0 * k1);
            let k3 = acceleration(fall, v + h / 2.0 * k2);
            let k4 = acceleration(fall, v + h * k3);
            y += h * v + h * h / 6.0 * (k1 + k2 + k3);
            v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        [y, v]
    }

    #[test]
    fn closed_forms_agree_with_integration() {
        let models = [DragModel::None, DragModel::Constant, DragModel::Linear, DragModel::Quadratic];
        for model in models {
            for amount in [1e-4, 0.6, 12.0] {
                for gravity in [9.81, -4.0, 0.0] {
                    for v in [-20.0, -1.3, 0.0, 8.0] {
                        let fall = fall(model, amount, gravity);
                        let [found, wanted] = [fall.after(v, 4.0), integrated(&fall, v, 4.0)];
                        let far = (found[0] - wanted[0]).abs().max((found[1] - wanted[1]).abs());
                        assert!(far < 1e-5, "{fall:?} {v}: {found:?} {wanted:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_speed_at_which_resistance_balances_gravity_stays() {
        let linear = fall(DragModel::Linear, 0.6, 9.81).after(3.0, 500.0)[1];
        assert!((linear + 9.81 / 0.6).abs() < 1e-9);
        let quadratic = fall(DragModel::Quadratic, 0.5, 8.0);
        assert_eq!(quadratic.after(-4.0, 2.0), [-8.0, -4.0]);
        let [dy, speed] = quadratic.after(0.0, 600.0);
        assert!((speed + 4.0).abs() < 1e-12 && dy < -2390.0 && dy.is_finite(), "{dy} {speed}");
    }
}
