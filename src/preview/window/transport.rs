//! Playing: which frame is shown, and how it goes on. Places are counted in frames, so that a step is one and the
//! scene time follows as it does for a written frame.

use crate::layers::timeline::{Timeline, Wrap};

/// The speeds that keys go through.
const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Where the animation stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Playhead {
    /// Whether it runs.
    pub playing: bool,
    /// Place in frames, from 0; between two frames while it runs.
    pub frame: f64,
    /// Seconds of the scene a second.
    pub speed: f64,
    /// Whether only whole frames are shown, each as long as it lasts.
    pub whole_frames: bool,
    /// What of the timeline is played.
    pub part: Part,
}

/// What of the timeline is played.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Part {
    /// All.
    #[default]
    All,
    /// All, as only the first frame of a part is known.
    From(f64),
    /// From this frame to that one, again and again.
    Between(f64, f64),
}

impl Default for Playhead {
    fn default() -> Self {
        Playhead { playing: false, frame: 0.0, speed: 1.0, whole_frames: false, part: Part::All }
    }
}

impl Playhead {
    /// The place that is shown, in frames.
    pub fn shown(&self) -> f64 {
        if self.whole_frames { self.frame.floor() } else { self.frame }
    }

    /// Scene time t in [0, 1] of what is shown.
    pub fn scene_time(&self, timeline: &Timeline) -> f64 {
        self.shown() / frames_of_all(timeline)
    }

    /// Seconds from the beginning.
    pub fn secs(&self, timeline: &Timeline) -> f64 {
        self.shown() / timeline.fps
    }

    /// Stands at scene time `t`.
    pub fn seek(&mut self, t: f64, timeline: &Timeline) {
        let frame = bounded(t * frames_of_all(timeline), timeline);
        // A whole frame is meant where one is almost met.
        self.frame = if (frame - frame.round()).abs() < 1e-6 { bounded(frame.round(), timeline) } else { frame };
    }

    /// One speed faster (1) or slower (-1).
    pub fn change_speed(&mut self, by: i32) {
        let faster = SPEEDS.iter().find(|&&speed| speed > self.speed);
        let slower = SPEEDS.iter().rfind(|&&speed| speed < self.speed);
        self.speed = *if by > 0 { faster } else { slower }.unwrap_or(&self.speed);
    }

    /// Seconds until another whole frame is shown; `None` if that is not waited for.
    pub fn until_next(&self, timeline: &Timeline) -> Option<f64> {
        let rest = 1.0 - (self.frame - self.frame.floor());
        (self.playing && self.whole_frames).then(|| rest / (timeline.fps * self.speed))
    }

    /// Plays or pauses. What has come to its end begins again.
    pub fn toggle(&mut self, timeline: &Timeline) {
        self.playing = !self.playing;
        if self.playing && timeline.wrap == Wrap::Once && self.frame >= last(timeline) {
            self.frame = 0.0;
        }
    }

    /// Runs on by `secs`, if it plays. Returns whether it has gone back to the beginning of a part.
    pub fn advance(&mut self, secs: f64, timeline: &Timeline) -> bool {
        if !self.playing {
            return false;
        }
        let next = self.frame + secs * self.speed * timeline.fps;
        match self.part {
            Part::Between(first, last) if !(first..last + 1.0).contains(&next) => {
                self.frame = first + (next - first).rem_euclid(last + 1.0 - first);
                true
            }
            _ => {
                self.frame = bounded(next, timeline);
                self.playing = timeline.wrap != Wrap::Once || self.frame < last(timeline);
                false
            }
        }
    }

    /// How many frames were passed over since one that was shown, if all are to be.
    pub fn dropped(&self, shown: f64, timeline: &Timeline) -> u64 {
        let frames = match self.part {
            Part::Between(first, last) => last + 1.0 - first,
            Part::All | Part::From(_) => frames_of_all(timeline),
        };
        let on = (self.frame.floor() - shown.floor()).rem_euclid(frames);
        if self.whole_frames { (on - 1.0).max(0.0) as u64 } else { 0 }
    }

    /// The frame that is shown begins the part that is played, then ends it; then all is played again. Returns what it does in
    /// words.
    pub fn mark_part(&mut self) -> String {
        let here = self.frame.floor();
        let (part, told) = match self.part {
            Part::All => (Part::From(here), format!("a part begins at frame {here}: A at another frame ends it")),
            Part::From(first) => {
                let (first, last) = (first.min(here), first.max(here));
                (Part::Between(first, last), format!("frames {first} to {last} are played: A plays all again"))
            }
            Part::Between(..) => (Part::All, "all frames are played".to_owned()),
        };
        self.part = part;
        told
    }

    /// Pauses at a whole frame, `by` frames on (or back, if negative).
    pub fn step(&mut self, by: i64, timeline: &Timeline) {
        let from = if by > 0 { self.frame.floor() } else { self.frame.ceil() };
        self.go_to(from + by as f64, timeline);
    }

    /// Pauses at the last frame.
    pub fn go_to_end(&mut self, timeline: &Timeline) {
        self.go_to(last(timeline), timeline);
    }

    /// Pauses at a frame.
    pub fn go_to(&mut self, frame: f64, timeline: &Timeline) {
        (self.playing, self.frame) = (false, bounded(frame, timeline));
    }

    /// Keeps the place within a timeline that has changed.
    pub fn follow(&mut self, timeline: &Timeline) {
        self.frame = bounded(self.frame, timeline);
        let most = last(timeline);
        if matches!(self.part, Part::From(frame) | Part::Between(_, frame) if frame > most) {
            self.part = Part::All;
        }
    }
}

/// The place at which scene time is 1, in frames.
fn frames_of_all(timeline: &Timeline) -> f64 {
    match timeline.wrap {
        Wrap::Repeat | Wrap::PingPong => timeline.frames() as f64,
        Wrap::Once => last(timeline).max(1.0),
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
            let mut transport = Playhead { playing: true, frame: from, ..Playhead::default() };
            transport.step(by, &timeline(wrap));
            assert_eq!((transport.playing, transport.frame), (false, to), "{wrap:?} {from} {by}");
        }
    }

    #[test]
    fn frames_have_the_times_of_written_frames() {
        for wrap in [Wrap::Repeat, Wrap::PingPong, Wrap::Once] {
            for k in 0..4 {
                let mut transport = Playhead { frame: k as f64, ..Playhead::default() };
                let time = timeline(wrap).time_of(k);
                assert_eq!(transport.scene_time(&timeline(wrap)), time, "{wrap:?} {k}");
                transport.seek(time, &timeline(wrap));
                assert_eq!(transport.frame, k as f64, "{wrap:?} {k}: a time is where it came from");
            }
        }
    }

    #[test]
    fn what_plays_once_stops_and_begins_again() {
        let timeline = timeline(Wrap::Once);
        let mut transport = Playhead { playing: true, ..Playhead::default() };
        transport.advance(60.0, &timeline);
        assert_eq!((transport.playing, transport.frame), (false, 3.0));
        transport.toggle(&timeline);
        assert_eq!((transport.playing, transport.frame), (true, 0.0));
    }

    #[test]
    fn a_part_is_played_again_and_again() {
        for wrap in [Wrap::Repeat, Wrap::Once] {
            let timeline = Timeline { duration: 8.0, fps: 1.0, wrap };
            let mut transport = Playhead { playing: true, frame: 5.0, ..Playhead::default() };
            let mut marked = |frame| {
                transport.frame = frame;
                transport.mark_part();
                (transport.part, transport.clone())
            };
            assert_eq!(marked(5.5).0, Part::From(5.0), "{wrap:?}");
            let (part, mut playing) = marked(2.0);
            assert_eq!(part, Part::Between(2.0, 5.0), "{wrap:?}");
            for (from, by, to, back) in
                [(2.0, 3.5, 5.5, false), (5.5, 1.0, 2.5, true), (7.0, 0.5, 3.5, true), (0.0, 1.0, 5.0, true)]
            {
                playing.frame = from;
                assert_eq!(
                    (playing.advance(by, &timeline), playing.frame, playing.playing),
                    (back, to, true),
                    "{wrap:?} {from}"
                );
            }
            assert_eq!(marked(3.0).0, Part::All);
            playing.follow(&Timeline { duration: 5.0, ..timeline });
            assert_eq!(playing.part, Part::All, "its end is gone");
        }
    }

    #[test]
    fn speed_and_whole_frames() {
        let timeline = timeline(Wrap::Repeat);
        let mut transport = Playhead { playing: true, ..Playhead::default() };
        transport.change_speed(-1);
        transport.advance(1.25, &timeline);
        assert_eq!((transport.speed, transport.frame, transport.until_next(&timeline)), (0.5, 1.25, None));
        transport.whole_frames = true;
        assert_eq!((transport.shown(), transport.secs(&timeline)), (1.0, 0.5));
        assert_eq!(transport.until_next(&timeline), Some(0.75));
        (0..9).for_each(|_| transport.change_speed(1));
        assert_eq!(transport.speed, 4.0);
        (0..9).for_each(|_| transport.change_speed(-1));
        assert_eq!(transport.speed, 0.1);
    }
}
