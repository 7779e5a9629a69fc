//! Playing: which frame is shown, and how it goes on. Places are counted in frames, so that a step is one and the
//! scene time follows as it does for a written frame.

use crate::layers::timeline::{Timeline, Wrap};

/// Where the animation stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transport {
    /// Whether it runs.
    pub playing: bool,
    /// Place in frames, from 0; between two frames while it runs.
    pub frame: f64,
}

impl Transport {
    /// Scene time t in [0, 1].
    pub fn scene_time(&self, timeline: &Timeline) -> f64 {
        let n = timeline.frames() as f64;
        match timeline.wrap {
            Wrap::Repeat | Wrap::PingPong => self.frame / n,
            Wrap::Once => (self.frame / (n - 1.0).max(1.0)).min(1.0),
        }
    }

    /// Seconds from the beginning.
    pub fn secs(&self, timeline: &Timeline) -> f64 {
        self.frame / timeline.fps
    }

    /// Stands at `secs` from the beginning.
    pub fn seek(&mut self, secs: f64, timeline: &Timeline) {
        self.frame = bounded(secs * timeline.fps, timeline);
    }

    /// Plays or pauses. What has come to its end begins again.
    pub fn toggle(&mut self, timeline: &Timeline) {
        self.playing = !self.playing;
        if self.playing && timeline.wrap == Wrap::Once && self.frame >= last(timeline) {
            self.frame = 0.0;
        }
    }

    /// Runs on by `secs`, where it plays.
    pub fn advance(&mut self, secs: f64, timeline: &Timeline) {
        if self.playing {
            self.seek(self.secs(timeline) + secs, timeline);
            self.playing = timeline.wrap != Wrap::Once || self.frame < last(timeline);
        }
    }

    /// Pauses at a whole frame, so many on or back.
    pub fn step(&mut self, by: i64, timeline: &Timeline) {
        let from = if by > 0 { self.frame.floor() } else { self.frame.ceil() };
        self.go_to(from + by as f64, timeline);
    }

    /// Pauses at a frame; none: the last.
    pub fn go_to_end(&mut self, timeline: &Timeline) {
        self.go_to(last(timeline), timeline);
    }

    /// Pauses at a frame.
    pub fn go_to(&mut self, frame: f64, timeline: &Timeline) {
        *self = Transport { playing: false, frame: bounded(frame, timeline) };
    }

    /// Keeps the place within a timeline that has changed.
    pub fn follow(&mut self, timeline: &Timeline) {
        self.frame = bounded(self.frame, timeline);
    }
}

fn last(timeline: &Timeline) -> f64 {
    timeline.frames() as f64 - 1.0
}

/// A place within the timeline: what repeats comes round, what plays once stays at its end.
fn bounded(frame: f64, timeline: &Timeline) -> f64 {
    match timeline.wrap {
        Wrap::Once => frame.clamp(0.0, last(timeline)),
        Wrap::Repeat | Wrap::PingPong => frame.rem_euclid(timeline.frames() as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline(wrap: Wrap) -> Timeline {
        Timeline { duration: 2.0, fps: 2.0, wrap }
    }

    #[test]
    fn steps_come_round_or_stop() {
        for (wrap, from, by, to) in [
            (Wrap::Repeat, 3.0, 1, 0.0),
            (Wrap::Repeat, 0.0, -1, 3.0),
            (Wrap::Once, 3.0, 1, 3.0),
            (Wrap::Once, 0.0, -1, 0.0),
            (Wrap::PingPong, 1.5, 1, 2.0),
            (Wrap::PingPong, 1.5, -1, 1.0),
        ] {
            let mut transport = Transport { playing: true, frame: from };
            transport.step(by, &timeline(wrap));
            assert_eq!(transport, Transport { playing: false, frame: to }, "{wrap:?} {from} {by}");
        }
    }

    #[test]
    fn frames_have_the_times_of_written_frames() {
        for wrap in [Wrap::Repeat, Wrap::PingPong, Wrap::Once] {
            for k in 0..4 {
                let transport = Transport { playing: false, frame: k as f64 };
                assert_eq!(transport.scene_time(&timeline(wrap)), timeline(wrap).time_of(k), "{wrap:?} {k}");
            }
        }
    }

    #[test]
    fn what_plays_once_stops_and_begins_again() {
        let timeline = timeline(Wrap::Once);
        let mut transport = Transport { playing: true, frame: 0.0 };
        transport.advance(60.0, &timeline);
        assert_eq!(transport, Transport { playing: false, frame: 3.0 });
        transport.toggle(&timeline);
        assert_eq!(transport, Transport { playing: true, frame: 0.0 });
    }
}
