//! The time of the scene and how it passes. The editor and its windows share it: whoever changes it tells the others, and
//! between changes every clock runs by itself.

use std::time::Instant;

use crate::layers::timeline::{Timeline, Wrap};
use crate::preview::Transport;

/// The speeds that keys step through, in seconds of the scene per second.
pub const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// The time of the scene, and whether it is playing.
#[derive(Clone, Debug)]
pub struct Play {
    /// Scene time, in [0, 1].
    pub time: f64,
    /// Whether the animation is playing.
    pub playing: bool,
    /// Seconds of the scene per second.
    pub speed: f64,
}

impl Default for Play {
    fn default() -> Self {
        Play { time: 0.0, playing: false, speed: 1.0 }
    }
}

/// What the passing of time has done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// The animation is paused.
    Nothing,
    /// It plays on.
    On,
    /// It plays once, and has reached its end.
    End,
}

impl Play {
    /// The state of the animation as it is sent to windows.
    pub fn transport(&self, timeline: &Timeline) -> Transport {
        Transport { playing: self.playing, time: self.time * timeline.duration, speed: self.speed }
    }

    /// Plays or pauses as a window does; false if its numbers are not finite.
    pub fn follow(&mut self, Transport { playing, time, speed }: Transport, timeline: &Timeline) -> bool {
        let time = if timeline.duration > 0.0 { time / timeline.duration } else { 0.0 };
        let usable = time.is_finite() && speed.is_finite();
        if usable {
            let speed = speed.clamp(SPEEDS[0], SPEEDS[SPEEDS.len() - 1]);
            *self = Play { playing, time: time.clamp(0.0, 1.0), speed };
        }
        usable
    }

    /// Lets so many seconds pass, if the animation is playing.
    pub fn pass(&mut self, seconds: f64, timeline: &Timeline) -> Passed {
        if !self.playing || timeline.duration <= 0.0 {
            return Passed::Nothing;
        }
        let time = self.time + seconds * self.speed / timeline.duration;
        let ends = timeline.wrap == Wrap::Once && time >= 1.0;
        (self.time, self.playing) = if ends { (1.0, false) } else { (time - time.floor(), true) };
        if ends { Passed::End } else { Passed::On }
    }

    /// The frame that is shown, and how many there are.
    pub fn frame(&self, timeline: &Timeline) -> (u64, u64) {
        let frames = timeline.frames();
        let nearest = (self.time / timeline.time_of(1)).round() as u64;
        (nearest.min(frames - 1), frames)
    }
}

/// Measures the time that passes while the animation is playing.
#[derive(Debug, Default)]
pub struct Stopwatch(Option<Instant>);

impl Stopwatch {
    /// Seconds since the last call; 0 if the animation was paused then.
    pub fn lap(&mut self, playing: bool, now: Instant) -> f64 {
        let passed = self.0.map_or(0.0, |last| (now - last).as_secs_f64());
        self.0 = playing.then_some(now);
        passed
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn only_the_time_that_is_played_passes() {
        let begin = Instant::now();
        let mut watch = Stopwatch::default();
        for (after, playing, passed) in
            [(0, false, 0.0), (5, true, 0.0), (6, true, 1.0), (8, false, 2.0), (20, true, 0.0), (21, true, 1.0)]
        {
            assert_eq!(watch.lap(playing, begin + Duration::from_secs(after)), passed, "after {after}");
        }
    }
}
