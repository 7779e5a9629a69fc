//! What comes from windows and scripts to the editor.

use std::sync::mpsc;

use crate::base::problem::Problem;
use crate::preview::wire::message::ToEditor;
use crate::scene::edit::Edit;

/// What comes from windows and scripts; delivered on their threads.
#[derive(Debug)]
pub enum Event {
    /// [`Preview::status`](super::Preview::status) has something new to say.
    Status,
    /// What a window says. Its text is one line without control characters.
    Said(ToEditor),
    /// The windows have told what they had not before the question, but for those that did not in time.
    Answered(Silent),
    /// A script asks for a change.
    Edit(Asked),
}

/// Which windows do not answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Silent {
    /// Their numbers, from 1, in the order in which windows joined.
    pub windows: Vec<usize>,
    /// How many windows there are.
    pub of: usize,
}

/// A change that a script asks for and waits to hear about.
#[derive(Debug)]
pub struct Asked {
    /// The change.
    pub edit: Edit,
    answer: mpsc::SyncSender<Vec<Problem>>,
}

impl Asked {
    pub(in crate::preview) fn new(edit: Edit) -> (Self, mpsc::Receiver<Vec<Problem>>) {
        let (answer, answered) = mpsc::sync_channel(1);
        (Asked { edit, answer }, answered)
    }

    /// Tells the script: no problems means done. Unanswered requests are refused when dropped.
    pub fn answer(self, problems: Vec<Problem>) {
        drop(self.answer.try_send(problems));
    }
}
