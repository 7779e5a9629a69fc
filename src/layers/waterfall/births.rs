//! What lines carry at a time. Each line gives birth again and again, at times that repeat with the timeline; how old
//! everything is follows from the time alone.

use std::iter::successors;
use std::ops::Range;

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
    /// After each birth `left_out` others are left out; which ones differs from line to line, so that no gap runs across.
    pub fn alive(&self, random: Random, line: &Line, now: f64, left_out: u32) -> impl Iterator<Item = Alive> + use<> {
        let Births { period, count } = *self;
        let (number, life) = (line.number, line.life);
        let of_birth = move |birth: u64| {
            let own = random.of(number, birth as u32, BIRTH);
            let born = (birth as f64 + own[0]) * period / count as f64;
            let youngest = (now - born).rem_euclid(period);
            let ages = successors(Some(youngest), move |age| Some(age + period)).take_while(move |age| *age < life);
            ages.map(move |age| Alive { birth: birth as u32, born, age, own })
        };
        let young = if line.carries() { self.young(life, now) } else { [0..0, 0..0] };
        let shown = move |birth: &u64| (birth + u64::from(number)).is_multiple_of(u64::from(left_out) + 1);
        young.into_iter().flatten().filter(shown).flat_map(of_birth)
    }

    /// The births, ascending, that may be young enough at the time `now`.
    fn young(&self, life: f64, now: f64) -> [Range<u64>; 2] {
        let each = self.period / self.count as f64;
        let first = ((now - life) / each).floor() - 1.0;
        let count = (now / each).floor() + 2.0 - first;
        if count >= self.count as f64 {
            return [0..self.count, 0..0];
        }
        // Births before the beginning of the timeline are those at its end.
        let from = (first as i64).rem_euclid(self.count as i64) as u64;
        let to = from + count as u64;
        [0..to.saturating_sub(self.count), from..to.min(self.count)]
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
                let found = births.alive(Random(1), &line(life), now, 0);
                let mut wanted = Vec::new();
                for birth in 0..births.count {
                    let own = Random(1).of(3, birth as u32, 16);
                    let born = (birth as f64 + own[0]) * 2.0 / births.count as f64;
                    let ages = (0..9).map(|k| (now - born).rem_euclid(2.0) + 2.0 * f64::from(k));
                    wanted.extend(ages.filter(|age| *age < life).map(|age| (birth as u32, age)));
                }
                let found: Vec<_> = found.map(|one| (one.birth, one.age)).collect();
                assert_eq!(found, wanted, "rate {rate}, life {life}, at {now}");
            }
        }
    }

    #[test]
    fn the_end_of_the_timeline_is_its_beginning() {
        let births = Births::new(31.0, 2.0);
        let alive = |life: f64, now: f64| births.alive(Random(1), &line(life), now, 0).collect::<Vec<_>>();
        assert_eq!(alive(0.7, 0.0), alive(0.7, 2.0));
        assert_eq!(alive(1e-4, 0.0), []);
    }

    #[test]
    fn births_left_out_are_always_the_same() {
        let births = Births::new(40.0, 2.0);
        for now in [0.0, 0.9, 1.99] {
            let alive = |left_out: u32| births.alive(Random(1), &line(0.7), now, left_out);
            let some: Vec<_> = alive(3).collect();
            assert_eq!(some, alive(0).filter(|one| (one.birth + 3).is_multiple_of(4)).collect::<Vec<_>>());
            assert!((6..9).contains(&some.len()), "{}", some.len());
        }
    }
}
