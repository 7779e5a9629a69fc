//! The terminal itself: every mode that the editor sets, and the one function that undoes all of them, used by the normal
//! exit, errors, panics and signals alike.

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

/// Whether any mode is set; only then is there something to undo.
static SET: AtomicBool = AtomicBool::new(false);

/// Whether there is a terminal that a screen can be drawn on.
pub fn is_there() -> bool {
    stdin().is_terminal() && stdout().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Prints a line where there is no screen.
pub fn print(line: &str) {
    // Where nobody reads it there is nothing more to do.
    let _ = writeln!(stdout(), "{}", plain(line));
}

/// Says a line to the person, beside what is printed.
pub fn remark(line: &str) {
    // As above.
    let _ = writeln!(stderr(), "plica: {}", plain(line));
}

/// Sets every mode and gives the screen.
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

/// Draws all of the screen anew the next time. Ratatui's own `clear` asks the terminal for its cursor, and takes keys while
/// it waits for the answer; a resize asks nothing.
pub fn forget(screen: &mut Screen) -> std::io::Result<()> {
    let size = screen.size()?;
    screen.resize(Rect::from((Position::ORIGIN, size)))
}

/// Undoes every mode, shows the cursor and gives the screen back. May be called at any time, from any thread, twice.
pub fn restore() {
    if SET.swap(false, Ordering::SeqCst) {
        if is_behind() {
            // It does not read, and whoever writes would wait for it: its keys are as they were, at least.
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

/// Hands a text to the clipboard of the terminal, where it takes one.
pub fn copy(screen: &mut Screen, text: &str) {
    let through = Through::of(|name| std::env::var(name).ok());
    let out = screen.backend_mut();
    // A terminal that has gone away is met at the next drawing.
    let _ = out.write_all(sequence(text, through).as_bytes()).and_then(|()| Write::flush(out));
}

/// Makes a panic of this thread, which ends the process, restore the terminal before its message is printed. One of any
/// other thread goes to the log, and is `told`: the screen stays the editor's.
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

/// Whether a person types the lines.
pub fn is_interactive() -> bool {
    stdin().is_terminal() && stdout().is_terminal()
}
