//! The window: shows a scene as it plays, with what explains it drawn over it, and takes the keys of `preview::keys`.
//! It is drawn only when something changes or plays; if it cannot be opened, the reason is one line.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};

use winit::error::EventLoopError;
use winit::event_loop::EventLoop;

use libraries::Missing;

use super::follow::Update;
use super::wire::message::ToEditor;
use crate::base::error::{Error, Result};

mod app;
mod bar;
mod canvas;
mod capture;
mod chrome;
mod clock;
mod draw;
mod events;
mod follow;
mod frames;
mod glyphs;
mod grasp;
mod hurry;
mod input;
mod kept;
mod labels;
mod legend;
mod libraries;
mod marks;
mod mouse;
mod opened;
mod options;
mod overlays;
mod own_view;
mod panel;
mod pass;
mod problems;
mod run;
mod screen;
mod show;
mod state;
mod steer;
mod stroke;
mod style;
mod text;
mod thin;
mod transport;
mod viewport;
mod words;
mod worker;
#[cfg_attr(any(not(unix), target_os = "macos"), path = "x11_none.rs")]
mod x11;

pub use options::WindowOptions;
pub use worker::Load;

use options::PLACE;

/// What a window is opened with.
pub struct Setup {
    /// How it opens and behaves.
    pub options: WindowOptions,
    /// What it shows.
    pub updates: Receiver<Update>,
    /// What it has to say.
    pub replies: Sender<ToEditor>,
    /// How the pictures of a scene are loaded.
    pub load: Load,
    /// Set by a signal: the window ends, interrupted.
    pub cancel: Arc<AtomicBool>,
}

/// Opens the window and runs it until it is closed.
///
/// # Errors
/// There is no display, or no GPU and no software driver that can show on it.
pub fn run(setup: Setup) -> Result<()> {
    let event_loop =
        quietly(|| EventLoop::with_user_event().build()).map_err(no_display)?.map_err(|e| no_display(e.to_string()))?;
    let (proxy, sender) = (event_loop.create_proxy(), event_loop.create_proxy());
    worker::start(setup.updates, setup.load, setup.cancel, move |event| sender.send_event(event).is_ok());
    let instance = crate::render::gpu::device::instance(Some(Box::new(event_loop.owned_display_handle())));
    let mut app = app::App::new(instance, setup.options, setup.replies, proxy);
    quietly(|| event_loop.run_app(&mut app)).map_err(|e| Error::at(PLACE, e))?.map_err(|error| match error {
        EventLoopError::ExitFailure(_) => Error::at(PLACE, "the display is gone"),
        other => Error::at(PLACE, other),
    })?;
    app.ended()
}

fn no_display(what: String) -> Error {
    let line = what.lines().next().unwrap_or_default();
    // winit puts the line of its source before the reason.
    let what =
        line.strip_prefix("os error at ").and_then(|rest| rest.split_once(": ")).map_or(line, |(_, reason)| reason);
    match libraries::missing(what) {
        Some(Missing { library, package }) => {
            Error::at(PLACE, format!("no display can be opened: {library} is missing or broken"))
                .cure(format!("on Debian: apt-get install {package}; plica render and plica edit need none"))
        }
        None => {
            Error::at(PLACE, format!("no display can be opened: {what}")).cure("plica render and plica edit need none")
        }
    }
}

/// Does `work`; a panic of the window system's libraries becomes its message instead of a trace on the terminal.
fn quietly<T>(work: impl FnOnce() -> T) -> std::result::Result<T, String> {
    let said = Arc::new(Mutex::new(String::new()));
    let before = Arc::new(std::panic::take_hook());
    let (heard, others, here) = (said.clone(), before.clone(), std::thread::current().id());
    std::panic::set_hook(Box::new(move |info| {
        if std::thread::current().id() != here {
            return others(info);
        }
        let text = info.payload_as_str().unwrap_or("a library of the window system failed");
        *heard.lock().unwrap_or_else(PoisonError::into_inner) = format!("{text} ({})", place(info));
    }));
    let done = catch_unwind(AssertUnwindSafe(work));
    std::panic::set_hook(Box::new(move |info| before(info)));
    done.map_err(|_| said.lock().unwrap_or_else(PoisonError::into_inner).clone())
}

fn place(info: &std::panic::PanicHookInfo<'_>) -> String {
    info.location()
        .map_or(String::new(), |l| format!("{}:{}", l.file().rsplit('/').next().unwrap_or_default(), l.line()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message() {
        assert_eq!(quietly(|| 3), Ok(3));
        let said = quietly(|| panic!("no library")).unwrap_err();
        assert!(said.starts_with("no library (mod.rs:"), "{said}");
    }
}
