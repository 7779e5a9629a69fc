//! The path that something carried by a flow line takes, and how long it lives.

use glam::{DVec2, DVec3};

use super::drag::Fall;
use crate::base::maths::{exp, expm1};

/// A weaker wind than this a second carries nothing along.
const LEAST_RATE: f64 = 1e-4;
/// How often an interval of time is halved.
const HALVINGS: usize = 60;

/// What acts on everything in the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// What acts along y.
    pub fall: Fall,
    /// The speed of the wind along x and z, in m/s.
    pub wind: DVec2,
    /// How fast the wind carries along, in 1/s; `None` if at once.
    pub rate: Option<f64>,
}

/// Where something starts, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Where, in meters.
    pub start: DVec3,
    /// How fast, in m/s.
    pub velocity: DVec3,
}

impl Laws {
    /// Place and velocity at an age.
    pub fn at(&self, path: &Path, age: f64) -> (DVec3, DVec3) {
        let (from, v) = (path.start, path.velocity);
        let [dy, vy] = self.fall.after(v.y, age);
        let ([dx, vx], [dz, vz]) = (self.along(v.x, self.wind.x, age), self.along(v.z, self.wind.y, age));
        (from + DVec3::new(dx, dy, dz), DVec3::new(vx, vy, vz))
    }

    /// The way and the speed along a level axis.
    fn along(&self, v: f64, wind: f64, age: f64) -> [f64; 2] {
        match self.rate {
            None => [(v + wind) * age, v + wind],
            Some(rate) if rate < LEAST_RATE => [v * age, v],
            Some(rate) => {
                let passed = -expm1(-rate * age);
                [wind * age + (v - wind) * passed / rate, wind + (v - wind) * (1.0 - passed)]
            }
        }
    }

    /// The start speed along a level axis with this wind that takes something this far in that time.
    pub fn reaching(&self, way: f64, wind: f64, age: f64) -> f64 {
        match self.rate {
            None => way / age - wind,
            Some(rate) if rate < LEAST_RATE => way / age,
            Some(rate) => wind + (way - wind * age) * rate / -expm1(-rate * age),
        }
    }

    /// The start speed along a level axis with this wind that becomes `v` in that time.
    pub fn becoming(&self, v: f64, wind: f64, age: f64) -> f64 {
        match self.rate {
            None => v - wind,
            Some(rate) if rate < LEAST_RATE => v,
            Some(rate) => wind + (v - wind) * exp(rate * age),
        }
    }

    /// The first age at which a path comes down through y = `pool`, otherwise `most`.
    pub fn life(&self, path: &Path, pool: f64, most: f64) -> f64 {
        let height = |age: f64| path.start.y + self.fall.after(path.velocity.y, age)[0];
        let rises = |age: f64| self.fall.after(path.velocity.y, age)[1] > 0.0;
        let (mut top, mut bottom) = (0.0, most);
        if path.velocity.y > 0.0 {
            if rises(most) {
                return most;
            }
            top = first([0.0, most], |age| !rises(age));
        } else if rises(most) {
            bottom = first([0.0, most], rises);
        }
        if height(top) <= pool {
            0.0
        } else if height(bottom) > pool {
            most
        } else {
            first([top, bottom], |age| height(age) <= pool)
        }
    }
}

/// Where between two ages, or speeds, something becomes true that stays so.
pub fn first([mut before, mut after]: [f64; 2], is: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = (before + after) / 2.0;
        if is(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
    after
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::model::DragModel;

    fn laws(model: DragModel, amount: f64, gravity: f64) -> Laws {
        Laws { fall: Fall { model, amount, gravity }, wind: DVec2::new(2.0, -1.0), rate: None }
    }

    #[test]
    fn a_free_fall_ends_after_the_square_root_of_twice_the_height_over_gravity() {
        let path = Path { start: DVec3::new(0.0, 2.0, 0.0), velocity: DVec3::ZERO };
        let life = laws(DragModel::None, 0.0, 9.81).life(&path, 0.0, 5.0);
        assert!((life - (4.0_f64 / 9.81).sqrt()).abs() < 1e-9, "{life}");
    }

    #[test]
    fn lives_end_at_the_pool_or_last() {
        let (up, down) = (3.0, -3.0);
        for (y, v, gravity, most, life) in [
            // Up and down again; still on its way up; under the pool all the time.
            (1.0, up, 10.0, 5.0, 0.3 + 0.29_f64.sqrt()),
            (1.0, up, 10.0, 0.2, 0.2),
            (-2.0, up, 10.0, 5.0, 0.0),
            // Buoyant: turns before the pool; goes through it; rises from the beginning.
            (1.0, down, -10.0, 5.0, 5.0),
            (0.25, down, -10.0, 5.0, 0.1),
            (0.0, up, -10.0, 5.0, 5.0),
            (0.0, 0.0, -10.0, 5.0, 0.0),
        ] {
            let path = Path { start: DVec3::new(0.0, y, 0.0), velocity: DVec3::new(0.0, v, 0.0) };
            let found = laws(DragModel::None, 0.0, gravity).life(&path, 0.0, most);
            assert!((found - life).abs() < 1e-9, "y {y}, v {v}, g {gravity}: {found}");
        }
    }

    #[test]
    fn wind_carries_along_at_once_or_in_time() {
        let path = Path { start: DVec3::ZERO, velocity: DVec3::new(1.0, 0.0, 1.0) };
        let mut laws = laws(DragModel::None, 0.0, 0.0);
        for (rate, age, place, velocity) in [
            (None, 2.0, [6.0, 0.0, 0.0], [3.0, 0.0, 0.0]),
            (Some(1e-5), 2.0, [2.0, 0.0, 2.0], [1.0, 0.0, 1.0]),
            (Some(3.0), 0.0, [0.0; 3], [1.0, 0.0, 1.0]),
            (Some(100.0), 10.0, [20.0 - 0.01, 0.0, -10.0 + 0.02], [2.0, 0.0, -1.0]),
        ] {
            laws.rate = rate;
            let (at, v) = laws.at(&path, age);
            assert!((at - DVec3::from(place)).length() < 1e-9, "{rate:?}: {at}");
            assert!((v - DVec3::from(velocity)).length() < 1e-9, "{rate:?}: {v}");
        }
    }
}
