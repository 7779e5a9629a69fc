//! The drawing of a frame: the time runs on, the window is painted, what was lost is replaced.

use std::time::{Duration, Instant};

use super::app::App;
use super::screen::Presented;
use super::show::Show;
use super::text::of_system;
use super::thin::Thin;
use super::worker::Event;
use crate::base::error::Result;
use crate::preview::wire::message::Gesture;

impl App {
    /// Draws the window, if it can be seen. A lost device is replaced, and another drawing requested.
    pub(super) fn draw(&mut self) -> Result<()> {
        self.advance();
        self.follow_zoom();
        let Some(opened) = &mut self.opened else { return Ok(()) };
        let was_hidden = opened.hidden;
        if opened.is_seen() {
            let began = Instant::now();
            self.letters.begin();
            let live = self.state.capture.as_ref().and_then(|round| {
                let next = round.next(&self.state.transport, &self.state.timeline)?;
                self.state.thin = Thin::default();
                Some(std::mem::replace(&mut self.state.transport, next))
            });
            let beside = (&self.letters, &self.proxy);
            let said = (self.state.words.progress.clone(), self.state.words.told.clone());
            let painted = opened.paint(&mut self.state, self.shown.as_ref(), &mut self.marks, beside);
            live.into_iter().for_each(|live| self.state.transport = live);
            match painted {
                _ if opened.gpu.device().is_lost() => self.reopen()?,
                Ok(Presented::Yes) => self.drawn(),
                Ok(Presented::Again) => opened.window.request_redraw(),
                Ok(Presented::Hidden) => opened.hidden = true,
                Ok(Presented::Lost) => self.reopen()?,
                Err(error) => return Err(error),
            }
            if said != (self.state.words.progress.clone(), self.state.words.told.clone()) {
                self.report();
            }
            self.clock.drawn += 1;
            let took = self.opened.as_mut().and_then(|opened| opened.took(began.elapsed()));
            self.took(took);
        } else if !was_hidden {
            self.report();
        }
        self.tell_view();
        self.tell_drag();
        self.owed.take().into_iter().for_each(|reply| self.reply(reply));
        Ok(())
    }

    /// Tells the editor where the window looks from, if that has changed.
    pub(super) fn tell_view(&mut self) {
        if self.told_view != self.state.own {
            self.told_view = self.state.own;
            self.hurry.changed(Instant::now());
            self.reply(Gesture::Camera(self.state.own_camera()));
        }
    }

    /// A drawing is on the screen.
    fn drawn(&mut self) {
        let Some(opened) = &mut self.opened else { return };
        opened.hidden = false;
        if let Some(size) = self.grows_to.take() {
            let _ = opened.window.request_inner_size(size); // answered by Resized
        }
        if self.letters.asks_for_fonts() {
            let proxy = self.proxy.clone();
            // If the window is gone by then, they are not needed.
            std::thread::spawn(move || drop(proxy.send_event(Event::Fonts(Box::new(of_system())))));
        }
    }

    /// Whether one picture follows the other: it plays, or a key is held.
    fn runs(&mut self) -> bool {
        self.state.transport.playing || self.hurry.is_on(Instant::now())
    }

    /// A new picture took so long: sprites are left out if it is too long to play.
    fn took(&mut self, time: Option<Duration>) {
        let sprites = self.shown.as_ref().is_some_and(Show::has_sprites);
        let before = self.state.thin.left_out();
        match self.runs() && sprites {
            true => time.into_iter().for_each(|time| self.state.thin.took(time.as_secs_f64())),
            false => self.state.thin = Thin::default(),
        }
        if self.state.thin.left_out() != before {
            self.report();
        }
    }

    /// The animation runs on; one that plays once stops at its end.
    fn advance(&mut self) {
        let (passed, fps) = self.clock.tick();
        if !self.state.transport.playing {
            if !self.runs() && std::mem::take(&mut self.state.thin).left_out() > 0 {
                self.report();
            }
            return;
        }
        if let Some(fps) = fps {
            self.state.fps = Some(fps);
            self.report();
        }
        let before = self.state.transport.frame;
        let goes_back = self.state.transport.advance(passed, &self.state.timeline);
        self.state.dropped += self.state.transport.dropped(before, &self.state.timeline);
        if goes_back {
            self.lead();
        }
        if !self.state.transport.playing {
            self.lead();
            self.report();
        }
    }

    /// Replaces a lost device or surface, in the same window.
    fn reopen(&mut self) -> Result<()> {
        if let Some(opened) = self.opened.take() {
            self.opened = Some(opened.anew()?);
            self.send_next();
            self.redraw();
        }
        Ok(())
    }
}
