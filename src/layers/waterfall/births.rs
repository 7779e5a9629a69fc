//! What lines carry at a time. Each line gives birth again and again, at times that repeat with the timeline; how old
//! everything is follows from the time alone.

use super::hash::Random;
use super::lines::Line;

/// Its purpose in the hash: time of birth, track, sense of the spin, mirroring.
const BIRTH: u32 = 16;

/// Something that is alive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alive {
    /// The number of its birth on its line.
    pub birth: u32,
    /// When it was born, in seconds from the beginning of the timeline.
    pub born: f64,
    /// How old it is, in seconds.
    pub age: f64,
    /// Its random numbers: time of birth, track, sense of the spin, mirroring.
    pub own: [f64; 4],
}

/// The births of one line.
#[derive(Clone, Copy, Debug)]
pub struct Births {
    /// After how long they repeat, in seconds.
    pub period: f64,
    /// How many there are until then.
    pub count: u64,
}

impl Births {
    /// About `rate` births a second.
    pub fn new(rate: f64, period: f64) -> Births {
        Births { period, count: (rate * period + 0.5).floor().max(1.0) as u64 }
    }

    /// What `line` carries at the time `now`, in the order of births and then of ages.
    pub fn alive(&self, random: Random, line: &Line, now: f64) -> Vec<Alive> {
        let mut all = Vec::new();
        if !line.carries() {
            return all;
        }
        let (period, each) = (self.period, self.period / self.count as f64);
        let mut add = |birth: u64| {
            let own = random.of(line.number, birth as u32, BIRTH);
            let born = (birth as f64 + own[0]) * period / self.count as f64;
            let mut age = (now - born).rem_euclid(period);
            while age < line.life {
                all.push(Alive { birth: birth as u32, born, age, own });
                age += period;
            }
        };
        // Those that may be young enough, if only some are.
        let first = ((now - line.life) / each).floor() - 1.0;
        let last = (now / each).floor() + 1.0;
        if last - first + 1.0 >= self.count as f64 {
            (0..self.count).for_each(add);
            return all;
        }
        let count = self.count as i64;
        let mut births: Vec<u64> = (first as i64..=last as i64).map(|birth| birth.rem_euclid(count) as u64).collect();
        births.sort_unstable();
        births.into_iter().for_each(&mut add);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::path::Path;
    use glam::DVec3;

    fn line(life: f64) -> Line {
        let path = Path { start: DVec3::ZERO, velocity: DVec3::ZERO };
        Line { number: 3, foam: false, path, life, place: 0.0 }
    }

    #[test]
    fn only_the_living_are_looked_at_and_none_is_missed() {
        for (rate, life) in [(40.0, 0.3), (40.0, 1.99), (40.0, 5.0), (0.1, 0.5), (0.1, 7.0)] {
            let births = Births::new(rate, 2.0);
            for now in [0.0, 0.017, 0.9, 1.999, 2.0] {
                let found = births.alive(Random(1), &line(life), now);
                let mut wanted = Vec::new();
                for birth in 0..births.count {
                    let own = Random(1).of(3, birth as u32, 16);
                    let born = (birth as f64 + own[0]) * 2.0 / births.count as f64;
                    let ages = (0..9).map(|k| (now - born).rem_euclid(2.0) + 2.0 * f64::from(k));
                    wanted.extend(ages.filter(|age| *age < life).map(|age| (birth as u32, age)));
                }
                let found: Vec<_> = found.iter().map(|one| (one.birth, one.age)).collect();
                assert_eq!(found, wanted, "rate {rate}, life {life}, at {now}");
            }
        }
    }

    #[test]
    fn the_end_of_the_timeline_is_its_beginning() {
        let births = Births::new(31.0, 2.0);
        assert_eq!(births.alive(Random(1), &line(0.7), 0.0), births.alive(Random(1), &line(0.7), 2.0));
        assert_eq!(births.alive(Random(1), &line(1e-4), 0.0), []);
    }
}
