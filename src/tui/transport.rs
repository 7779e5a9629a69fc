//! Time, as the editor and its windows share it: whoever changes it tells the others, and between changes all clocks run by
//! themselves.

use super::app::State;
use super::update::Effect;
use crate::layers::timeline::Wrap;
use crate::preview::Transport;

/// What keys and windows may set the speed to, in seconds of the scene a second.
pub const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

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
