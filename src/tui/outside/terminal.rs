//! The terminal: all modes that the editor sets, and the function that undoes them, which is used by the normal exit, errors,
//! panics and signals.

use crate::tui::text::plain;
use std::io::{IsTerminal, Write, stderr, stdin, stdout};
use std::sync::atomic::{AtomicBool, Ordering};

use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::{cursor, event, execute, terminal};
use ratatui::layout::{Position, Rect};

use super::pace::{Pace, is_behind};
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::tui::text::clipboard::{Through, sequence};

/// The terminal that the editor draws on.
pub type Screen = Terminal<CrosstermBackend<Pace>>;

/// Whether modes are set, so that there is something to undo.
static SET: AtomicBool = AtomicBool::new(false);

/// Whether there is a terminal that can draw a screen.
pub fn is_there() -> bool {
    stdin().is_terminal() && stdout().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Prints a line to standard output. Only without a screen.
pub fn print(line: &str) {
    // If nobody reads it, there is nothing to do.
    let _ = writeln!(stdout(), "{}", plain(line));
}

/// Prints a line to standard error.
pub fn remark(line: &str) {
    // As above.
    let _ = writeln!(stderr(), "plica: {}", plain(line));
}

/// Sets all modes and returns the screen.
pub fn enter() -> Result<Screen> {
    let failed = |e: std::io::Error| Error::at("the terminal", e).cure("`plica edit` needs an interactive terminal");
    terminal::enable_raw_mode().map_err(failed)?;
    SET.store(true, Ordering::SeqCst);
    let modes =
        execute!(stdout(), terminal::EnterAlternateScreen, event::EnableBracketedPaste, event::EnableMouseCapture);
    let screen = modes.and_then(|()| Terminal::new(CrosstermBackend::new(Pace::new())));
    screen.map_err(|e| {
        restore();
        failed(e)
    })
}

/// The size of the terminal, in cells.
pub fn size() -> Option<(u16, u16)> {
    terminal::size().ok()
}

/// Makes the next drawing redraw the whole screen. Ratatui's own `clear` asks the terminal for its cursor and swallows keys
/// while it waits for the answer; a resize asks nothing.
pub fn forget(screen: &mut Screen) -> std::io::Result<()> {
    let size = screen.size()?;
    screen.resize(Rect::from((Position::ORIGIN, size)))
}

/// Undoes all modes, shows the cursor and leaves the alternate screen. May be called at any time, from any thread, repeatedly.
pub fn restore() {
    if SET.swap(false, Ordering::SeqCst) {
        if is_behind() {
            // The terminal does not read, so writing would block. At least its keys work as before.
            let _ = terminal::disable_raw_mode();
            return;
        }
        let mut out = stdout();
        // A terminal that has gone away cannot be restored; there is nobody to tell.
        let _ = execute!(
            out,
            event::DisableMouseCapture,
            event::DisableBracketedPaste,
            terminal::LeaveAlternateScreen,
            cursor::SetCursorStyle::DefaultUserShape,
            cursor::Show
        );
        let _ = out.flush();
        let _ = terminal::disable_raw_mode();
    }
}

/// Copies a text to the clipboard of the terminal, if it allows that.
pub fn copy(screen: &mut Screen, text: &str) {
    let through = Through::of(|name| std::env::var(name).ok());
    let out = screen.backend_mut();
    // A terminal that has gone away is noticed at the next drawing.
    let _ = out.write_all(sequence(text, through).as_bytes()).and_then(|()| Write::flush(out));
}

/// Restores the terminal before the message of a panic of this thread, which ends the process, is printed. A panic of any
/// other thread is logged and passed to `told`, and the screen stays.
pub fn on_panic(told: impl Fn(String) + Send + Sync + 'static) {
    let (print, main) = (std::panic::take_hook(), std::thread::current().id());
    std::panic::set_hook(Box::new(move |panic| {
        if std::thread::current().id() == main {
            restore();
            print(panic);
        } else {
            tracing::error!("{panic}\n{}", std::backtrace::Backtrace::force_capture());
            told(fault::told(panic.payload()));
        }
    }));
}

/// Whether a person types the input.
pub fn is_interactive() -> bool {
    stdin().is_terminal() && stdout().is_terminal()
}
