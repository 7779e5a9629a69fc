//! Smooth noise over the place along the lip and the time of birth: what leaves the lip together stays together.

use super::hash::Random;
use crate::base::maths::smoothstep;

/// The purpose of the noise, in the hash.
const SURGE: u32 = 32;

/// The noise of a layer.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// Its random numbers.
    pub random: Random,
    /// The size of a clump along the lip, in meters.
    pub width: f64,
    /// How many clumps leave one after the other until it repeats.
    pub count: f64,
    /// After how long it repeats, in seconds.
    pub period: f64,
}

impl Noise {
    /// Noise that repeats after `period` seconds, with clumps of about `time` seconds.
    pub fn new(random: Random, [width, time]: [f64; 2], period: f64) -> Noise {
        Noise { random, width, count: (period / time + 0.5).floor().max(1.0), period }
    }

    /// Noise number `q` at a place and a time of birth, from 0 to 1.
    pub fn at(&self, q: u32, place: f64, born: f64) -> f64 {
        let (x, y) = (place / self.width, born * self.count / self.period);
        let coarse = self.layer(x, y, self.count, SURGE + 2 * q);
        let fine = self.layer(2.0 * x, 2.0 * y, 2.0 * self.count, SURGE + 2 * q + 1);
        0.6 * coarse + 0.4 * fine
    }

    fn layer(&self, x: f64, y: f64, repeat: f64, purpose: u32) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (smoothstep(0.0, 1.0, x - i), smoothstep(0.0, 1.0, y - j));
        let corner = |i: f64, j: f64| {
            let (i, j) = (i as i64 as u32, j.rem_euclid(repeat) as i64 as u32);
            self.random.of(i, j, purpose)[0]
        };
        let row = |j: f64| corner(i, j) * (1.0 - u) + corner(i + 1.0, j) * u;
        row(j) * (1.0 - v) + row(j + 1.0) * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_has_the_checked_value_and_repeats() {
        let time = 0.4 * (4.0_f64 / 9.81).sqrt();
        let noise = Noise::new(Random(1), [0.24, time], 2.0);
        assert!((noise.at(0, 0.5, 0.3) - 0.809_727_455).abs() < 1e-9, "{}", noise.at(0, 0.5, 0.3));
        assert!((noise.at(1, 0.7, 0.0) - noise.at(1, 0.7, 2.0)).abs() < 1e-12);
        assert!((noise.at(1, 0.7, 1e-9) - noise.at(1, 0.7, 2.0 - 1e-9)).abs() < 1e-7);
    }
}
