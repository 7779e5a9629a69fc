//! The loop of the editor that only runs scripts, without a screen.

use std::sync::mpsc;
use std::time::Duration;

use super::editor::Editor;
use super::terminal;
use crate::base::error::{Error, Result};
use crate::tui::events::Event;

/// How long to wait for an event before looking again.
const PATIENCE: Duration = Duration::from_secs(1);

impl Editor {
    /// Runs the scripts and prints the messages of their lines.
    ///
    /// # Errors
    /// The first mistake.
    pub fn run_unseen(mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        let result = self.refuse_undecided().and_then(|()| self.run_all(events));
        let unsaved = !self.leaving && !self.state.scene.is_saved();
        let left = unsaved.then(|| self.state.scene.left_unsaved());
        self.end();
        self.ended()?;
        match (result, left) {
            (Ok(()), Some(left)) => {
                Err(Error::at("the script", format!("ends, and {left}")).cure("w saves them, q! gives them up"))
            }
            (Err(error), Some(left)) => {
                terminal::remark(&left);
                Err(error)
            }
            (result, None) => result,
        }
    }

    /// Refuses to run while it is not decided what becomes of unsaved edits of an earlier session.
    fn refuse_undecided(&self) -> Result<()> {
        let Some(offer) = self.state.scene.offered() else { return Ok(()) };
        let what = format!("{} left behind, so the script is not run", offer.in_words());
        Err(Error::at(self.state.scene.path().display(), what)
            .cure("--after-recovery keep takes them, drop leaves them; plica edit shows them"))
    }

    fn run_all(&mut self, events: &mpsc::Receiver<Event>) -> Result<()> {
        while !self.leaving && !self.scripts.is_empty() {
            self.state.scene.tend();
            let ran = self.run_next()?;
            self.said().iter().for_each(|line| terminal::print(line));
            let patience = if ran { Duration::ZERO } else { PATIENCE };
            for event in events.recv_timeout(patience).into_iter().chain(events.try_iter()) {
                self.take(event);
            }
        }
        Ok(())
    }
}
