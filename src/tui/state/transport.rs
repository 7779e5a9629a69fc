//! Time, as the editor and its windows share it: whoever changes it tells the others, and between changes all clocks run by
//! themselves.

use std::time::Instant;

use super::State;
use crate::layers::timeline::Wrap;
use crate::preview::Transport;
use crate::tui::events::Effect;

/// What keys and windows may set the speed to, in seconds of the scene a second.
pub const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Measures the time that passes while the animation runs, and none of the time before it was started.
#[derive(Debug, Default)]
pub struct Stopwatch(Option<Instant>);

impl Stopwatch {
    /// Seconds since it was asked last, 0 where the animation stood then.
    pub fn lap(&mut self, playing: bool, now: Instant) -> f64 {
        let passed = self.0.map_or(0.0, |last| (now - last).as_secs_f64());
        self.0 = playing.then_some(now);
        passed
    }
}

impl State {
    /// How the animation runs.
    pub fn transport(&self) -> Transport {
        let duration = self.document().scene().timeline.duration;
        Transport { playing: self.playing, time: self.time * duration, speed: self.speed }
    }

    /// Plays or stands as a window does.
    pub fn follow(&mut self, Transport { playing, time, speed }: Transport) {
        let duration = self.document().scene().timeline.duration;
        let time = if duration > 0.0 { time / duration } else { 0.0 };
        if time.is_finite() && speed.is_finite() {
            (self.playing, self.time) = (playing, time.clamp(0.0, 1.0));
            self.speed = speed.clamp(SPEEDS[0], SPEEDS[SPEEDS.len() - 1]);
            self.ask(Effect::Pass);
        }
    }

    /// Runs on by so many seconds, where it plays. What plays once ends.
    pub fn pass(&mut self, seconds: f64) {
        let timeline = &self.document().scene().timeline;
        if !self.playing || timeline.duration <= 0.0 {
            return;
        }
        let time = self.time + seconds * self.speed / timeline.duration;
        let ends = timeline.wrap == Wrap::Once && time >= 1.0;
        (self.time, self.playing) = if ends { (1.0, false) } else { (time - time.floor(), true) };
        self.ask(if ends { Effect::Show } else { Effect::Pass });
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
