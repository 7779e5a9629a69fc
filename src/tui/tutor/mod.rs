//! The tutor: a first animation in the real editor, lesson by lesson. Each lesson says what to do and with which keys, and
//! looks at the state to see that it was done.

use super::state::tutor::Tutor;
use lessons::{LESSONS, Lesson};

pub mod lessons;

/// The lesson that is on.
pub fn lesson(tutor: &Tutor) -> &'static Lesson {
    &LESSONS[tutor.at.min(LESSONS.len() - 1)]
}
