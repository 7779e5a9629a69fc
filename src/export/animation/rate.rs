//! Frames a second as a fraction, and how long each frame stands in formats that count in whole units.

/// Frames a second: `num / den`, both at least 1 and at most [`Rate::MOST`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    /// Frames.
    pub num: u32,
    /// in so many seconds.
    pub den: u32,
}

impl Rate {
    /// APNG keeps a delay as two 16-bit numbers.
    pub const MOST: u32 = 65535;

    /// The simplest fraction that is `fps` to eight digits (29.97 is 2997/100); the nearest one where that has larger
    /// terms than [`Rate::MOST`]. Found by continued fractions.
    pub fn from_fps(fps: f64) -> Self {
        let fps = if fps.is_finite() { fps.clamp(1.0 / f64::from(Self::MOST), f64::from(Self::MOST)) } else { 1.0 };
        let (mut before, mut now) = ((0u64, 1u64), (1u64, 0u64));
        let mut rest = fps;
        loop {
            let whole = rest.floor();
            let next = (whole as u64 * now.0 + before.0, whole as u64 * now.1 + before.1);
            if next.0.max(next.1) > u64::from(Self::MOST) {
                break;
            }
            (before, now) = (now, next);
            let off = (now.0 as f64 / now.1 as f64 - fps).abs();
            if now.0 > 0 && off <= fps * 1e-8 {
                break;
            }
            rest = 1.0 / (rest - whole);
        }
        let (num, den) = if now.0 == 0 { (1, Self::MOST.into()) } else { now };
        Rate { num: num as u32, den: den as u32 }
    }

    /// The rate of every `step`-th frame.
    pub fn every(self, step: u64) -> Self {
        if step <= 1 { self } else { Rate::from_fps(f64::from(self.num) / f64::from(self.den) / step as f64) }
    }

    /// How many `units` of a second (100 for hundredths) frame `k` stands. Rounding is spread so that the frames
    /// together last as long as they should, to within half a unit.
    pub fn delay(self, k: u64, units: u64) -> u64 {
        self.begin(k + 1, units) - self.begin(k, units)
    }

    /// When frame `k` begins, rounded to a unit.
    fn begin(self, k: u64, units: u64) -> u64 {
        let (num, den) = (u128::from(self.num), u128::from(self.den));
        ((2 * u128::from(k) * u128::from(units) * den + num) / (2 * num)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_fractions_people_mean() {
        for (fps, num, den) in [
            (30.0, 30, 1),
            (29.97, 2997, 100),
            (30000.0 / 1001.0, 30000, 1001),
            (23.976, 2997, 125),
            (12.5, 25, 2),
            (0.001, 1, 1000),
            (1000.0, 1000, 1),
            (1.0 / 3.0, 1, 3),
        ] {
            assert_eq!(Rate::from_fps(fps), Rate { num, den }, "{fps}");
        }
        let pi = Rate::from_fps(std::f64::consts::PI);
        assert!((f64::from(pi.num) / f64::from(pi.den) - std::f64::consts::PI).abs() < 1e-6);
        assert_eq!(Rate::from_fps(30.0).every(2), Rate { num: 15, den: 1 });
    }

    #[test]
    fn rounded_delays_add_up() {
        for (fps, units, frames, total) in [(30.0, 100, 60, 200), (24.0, 100, 24, 100), (60.0, 1000, 60, 1000)] {
            let rate = Rate::from_fps(fps);
            let delays: Vec<_> = (0..frames).map(|k| rate.delay(k, units)).collect();
            assert_eq!(delays.iter().sum::<u64>(), total, "{fps}");
            assert!(delays.iter().max().unwrap() - delays.iter().min().unwrap() <= 1, "{delays:?}");
        }
    }
}
