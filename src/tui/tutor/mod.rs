//! The tutor: a first animation in the real editor, lesson by lesson. Each lesson says what to do and with which keys, and
//! checks the state to find out whether it was done.

use super::state::tutor::Tutor;
use lessons::{LESSONS, Lesson};

pub mod lessons;

/// The current lesson.
pub fn lesson(tutor: &Tutor) -> &'static Lesson {
    &LESSONS[tutor.at.min(LESSONS.len() - 1)]
}
