//! Runs the editor: chooses its loop, gives the terminal back whatever happens, and ends on signals.

use crate::base::system::signals;
use crate::tui::outside::editor::Editor;
use crate::tui::outside::options::Options;
use std::sync::mpsc;
use std::time::Duration;

use super::terminal;
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::base::system::signals::{Answer, Signal};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::Event;

/// How long the editor has to end by itself once the system asks for it.
const GRACE: Duration = Duration::from_secs(2);

/// Opens the scene, edits it until the person leaves, and gives the terminal back.
///
/// # Errors
/// The scene cannot be opened, or there is no terminal.
pub fn run(options: Options) -> Result<()> {
    let scene = OpenScene::open(&options.path, options.mode(), &options.files)?;
    let (sender, events) = mpsc::channel();
    let unseen = !terminal::is_there();
    let _signals = end_on_signals(sender.clone(), unseen && terminal::is_interactive())?;
    if unseen {
        let script = options.script.is_some();
        let editor = Editor::new(options, scene, None, sender)?;
        return if script { editor.run_unseen(&events) } else { editor.run_lines(&events) };
    }
    let faults = sender.clone();
    // Nobody listens once the editor has left.
    terminal::on_panic(move |fault| drop(faults.send(Event::Fault(fault))));
    let screen = terminal::enter()?;
    // A panic in a loop over all cores comes back to this thread without a word of its own.
    let result = fault::caught(|| {
        Editor::new(options, scene, Some(screen), sender).and_then(|editor| editor.run_on_screen(&events))
    });
    terminal::restore();
    let left =
        result.unwrap_or_else(|fault| Err(Error::at("the editor", fault).cure("plica edit offers what was typed")))?;
    if let Some(folder) = left {
        terminal::remark(&format!("your files from the tutor are in {}", folder.display()));
    }
    Ok(())
}

/// The signal thread asks the editor to end, and ends the process where that takes too long: a terminal that went away
/// can hold a write for ever. Where a person types `lines`, Ctrl-C comes as a signal and ends only what runs.
fn end_on_signals(sender: mpsc::Sender<Event>, lines: bool) -> Result<signals::Registration> {
    let handler = move |signal| match signal {
        Signal::Interrupt if lines => {
            // Where nobody listens any more the editor is leaving already.
            let _ = sender.send(Event::Line("leave".into()));
            Answer::Done
        }
        Signal::Hangup | Signal::Terminate | Signal::Interrupt => {
            // As above.
            let _ = sender.send(Event::End);
            std::thread::spawn(|| {
                std::thread::sleep(GRACE);
                terminal::restore();
                std::process::exit(i32::from(Error::Interrupted.exit_status()));
            });
            Answer::Done
        }
        Signal::Stop => {
            // As above.
            let _ = sender.send(Event::Stop);
            Answer::Done
        }
        Signal::Resize => {
            // As above.
            let _ = terminal::size().map(|(width, height)| sender.send(Event::Resize(width, height)));
            Answer::Done
        }
        Signal::Continue => Answer::Pass,
    };
    signals::handle(handler).map_err(|error| Error::at("signals", error))
}
