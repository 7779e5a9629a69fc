//! What is open once there is something to show: the window with its GPU and surface, and one drawing of it.

use std::sync::Arc;
use std::time::Duration;

use kurbo::Size;
use winit::dpi::PhysicalSize;
use winit::window::{Fullscreen, Window};

use super::chrome;
use super::screen::{Drawn, Pictures, Screen};
use super::show::{Cached, Show, jump_at};
use super::state::{BAR_PX, State};
use crate::base::error::Result;
use crate::render::Synth;
use crate::render::gpu::Gpu;

/// Smallest and first size of a window, in logical pixels.
const SMALLEST: (f64, f64) = (480.0, 320.0);
const FIRST: (f64, f64) = (960.0, 640.0);
/// A window opens on at most this share of the monitor.
const MOST_OF_MONITOR: f64 = 0.85;
/// Frames a second where the monitor does not tell.
const RATE: f64 = 60.0;

/// What is open once there is something to show.
pub struct Opened {
    pub window: Arc<Window>,
    pub gpu: Gpu,
    pub screen: Screen,
    pub hidden: bool,
}

impl Opened {
    /// Draws all that the window shows.
    pub fn paint(&mut self, state: &mut State, show: Option<&Show>, marks: &mut Cached) -> Result<Drawn> {
        let pictures = match show {
            Some(show) => {
                marks.follow(state, show);
                (state.arrow_scale, state.longest) = (marks.arrow_scale, marks.longest);
                let asked = state.pointed().filter(|_| state.shows_jumps());
                state.jump = asked.and_then(|at| jump_at(&show.synth, at));
                self.pictures(state, show)?
            }
            None => {
                let frame = self.gpu.texture(&Synth { size: (1, 1), layers: Vec::new() }, 0.0)?;
                Pictures { frame, other: None, scale: 1.0 }
            }
        };
        let chrome = chrome::draw(state);
        let strokes = [&marks.fixed.strokes[..], &marks.moving.strokes[..], &chrome.strokes[..]];
        let drawn = self.screen.draw(&self.gpu, state, &pictures, strokes);
        self.gpu.device().take_uncaught()?;
        drawn
    }

    fn pictures(&mut self, state: &State, show: &Show) -> Result<Pictures> {
        let time = state.transport.scene_time(&state.timeline);
        let last = state.timeline.time_of(state.timeline.frames() - 1);
        let (frame, other) = if state.shown.seam {
            ((&show.frames, last), Some((&show.frames, 0.0)))
        } else if state.shown.wipe {
            ((&show.frames, time), Some((&show.still, 0.0)))
        } else {
            ((if state.shown.still { &show.still } else { &show.frames }, time), None)
        };
        let (frame, other) = self.gpu.textures(frame, other)?;
        Ok(Pictures { frame, other, scale: show.frame_scale })
    }

    /// Fills the screen, or goes back to a window.
    pub fn toggle_full_screen(&self) {
        let full = self.window.fullscreen().is_none().then_some(Fullscreen::Borderless(None));
        self.window.set_fullscreen(full);
    }

    /// How long a frame of the display lasts.
    pub fn interval(&self) -> Duration {
        let rate = self.window.current_monitor().and_then(|m| m.refresh_rate_millihertz());
        Duration::from_secs_f64(1.0 / rate.map_or(RATE, |r| f64::from(r) / 1000.0).max(1.0))
    }
}

/// The size of a window around a picture, in physical pixels.
pub fn first_size(picture: Size, scale: f64, room: Option<PhysicalSize<u32>>) -> (u32, u32) {
    let first = if picture == Size::ZERO { Size::from(FIRST) * scale } else { picture };
    let side = |wanted: f64, least: f64, room: Option<u32>| {
        let most = room.map_or(f64::INFINITY, |r| f64::from(r) * MOST_OF_MONITOR);
        wanted.max(least * scale).min(most).round() as u32
    };
    let bar = (BAR_PX * scale).round();
    (side(first.width, SMALLEST.0, room.map(|r| r.width)), side(first.height + bar, SMALLEST.1, room.map(|r| r.height)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_opens_around_its_picture_within_the_monitor() {
        let room = Some(PhysicalSize::new(1000, 1000));
        for (picture, scale, size) in [
            (Size::ZERO, 1.0, (850, 674)),
            (Size::new(600.0, 400.0), 1.0, (600, 434)),
            (Size::new(10.0, 10.0), 1.0, (480, 320)),
            (Size::new(5000.0, 10.0), 1.0, (850, 320)),
            (Size::new(600.0, 400.0), 1.5, (720, 480)),
        ] {
            assert_eq!(first_size(picture, scale, room), size, "{picture:?}");
        }
    }
}
