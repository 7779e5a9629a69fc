//! Runs the editor: chooses its loop, restores the terminal whatever happens, and ends on signals.

use std::sync::mpsc;
use std::time::Duration;

use super::editor::Editor;
use super::options::Options;
use super::terminal;
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::base::system::process;
use crate::base::system::signals::{self, Answer, Signal};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::Event;

/// How long the editor has to end by itself after a signal.
const GRACE: Duration = Duration::from_secs(2);

/// Opens the scene, edits it until the person leaves, and restores the terminal.
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
    // A panic in a parallel loop reaches this thread without having printed a message.
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

/// Starts the thread that handles signals. It asks the editor to end, and ends the process if that takes too long: a write to
/// a terminal that went away may block forever. In the line mode Ctrl-C arrives as a signal, and ends only long work.
fn end_on_signals(sender: mpsc::Sender<Event>, lines: bool) -> Result<signals::Registration> {
    let handler = move |signal| match signal {
        Signal::Interrupt if lines => {
            // If nobody listens any more, the editor is leaving already.
            let _ = sender.send(Event::Line("leave".into()));
            Answer::Done
        }
        Signal::Hangup | Signal::Terminate | Signal::Interrupt => {
            // As above.
            let _ = sender.send(Event::End);
            std::thread::spawn(|| {
                std::thread::sleep(GRACE);
                terminal::restore();
                process::end(Error::Interrupted.exit_status());
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
        Signal::Continue => {
            // As above.
            let _ = sender.send(Event::Continue);
            Answer::Done
        }
    };
    signals::handle(handler).map_err(|error| Error::at("signals", error))
}
