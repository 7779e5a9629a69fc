//! Procedural noise: the grain of everything drawn. By integer hashes, so the same on every machine.

/// A pseudo-random number in [0, 1), fixed for its place and seed.
pub fn hash(x: i64, y: i64, seed: u32) -> f64 {
    let mut h =
        (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    for _ in 0..2 {
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    }
    f64::from((h ^ (h >> 15)) >> 8) / f64::from(1 << 24)
}

/// Smooth value noise with features about one unit wide, in [-1, 1].
pub fn noise(x: f64, y: f64, seed: u32) -> f64 {
    let (ix, iy) = (x.floor(), y.floor());
    let ease = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v) = (ease(x - ix), ease(y - iy));
    let at = |dx: i64, dy: i64| hash(ix as i64 + dx, iy as i64 + dy, seed);
    let top = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
    let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    (top + (bottom - top) * v) * 2.0 - 1.0
}

/// Noise over `octaves` octaves, each half as wide and half as strong as the one before, approximately in [-1, 1].
pub fn fbm(x: f64, y: f64, octaves: u32, seed: u32) -> f64 {
    let (mut sum, mut strength, mut scale) = (0.0, 0.5, 1.0);
    for octave in 0..octaves {
        sum += strength * noise(x * scale, y * scale, seed.wrapping_add(octave * 101));
        strength *= 0.5;
        scale *= 2.03;
    }
    sum
}

/// Distances to the nearest and the second nearest of scattered points, about one per unit square.
pub fn cells(x: f64, y: f64, seed: u32) -> (f64, f64) {
    let (ix, iy) = (x.floor() as i64, y.floor() as i64);
    let (mut first, mut second) = (9.0f64, 9.0f64);
    for cy in iy - 1..=iy + 1 {
        for cx in ix - 1..=ix + 1 {
            let (dx, dy) = (cx as f64 + hash(cx, cy, seed) - x, cy as f64 + hash(cx, cy, seed ^ 7777) - y);
            let d = dx * dx + dy * dy;
            second = second.min(d.max(first));
            first = first.min(d);
        }
    }
    (first.sqrt(), second.sqrt())
}

/// A sequence of pseudo-random numbers.
pub struct Chance(i64, u32);

impl Chance {
    /// The sequence of a seed.
    pub fn new(seed: u32) -> Chance {
        Chance(0, seed)
    }

    /// The next number in [from, to).
    pub fn within(&mut self, from: f64, to: f64) -> f64 {
        self.0 += 1;
        from + (to - from) * hash(self.0, 17, self.1)
    }
}
