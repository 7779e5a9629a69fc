//! An [`Error`] is something wrong *around* a scene: files, codecs, the GPU, the link. One message that names the place
//! and the cure.

use crate::base::problem::Problem;
use crate::base::text::line;

/// What went wrong around a scene.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Work that failed: a place (a file, a device, an option), what happened there, and the cure where it is known.
    #[error("{}: {}{}", line(place), line(what), cure.as_ref().map(|c| format!(" ({})", line(c))).unwrap_or_default())]
    Failed {
        /// A file, a device, an option.
        place: String,
        /// What happened there.
        what: String,
        /// How to mend it.
        cure: Option<String>,
    },
    /// A document that has errors in it; all of them.
    #[error("{}: {}", line(file), list(problems))]
    Scene {
        /// The scene file.
        file: String,
        /// Every problem found, worst first.
        problems: Vec<Problem>,
    },
    /// A wrong command line.
    #[error("{0}")]
    Usage(String),
    /// Interrupted by the user; nothing half-written is left.
    #[error("interrupted")]
    Interrupted,
}

/// The result of work that can meet an [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A failure at a place.
    pub fn at(place: impl std::fmt::Display, what: impl std::fmt::Display) -> Self {
        Error::Failed { place: place.to_string(), what: what.to_string(), cure: None }
    }

    /// Adds the cure.
    pub fn cure(mut self, text: impl Into<String>) -> Self {
        if let Error::Failed { cure, .. } = &mut self {
            *cure = Some(text.into());
        }
        self
    }

    /// The exit status of a process that ends with this error.
    pub fn exit_status(&self) -> u8 {
        match self {
            Error::Failed { .. } | Error::Scene { .. } => 1,
            Error::Usage(_) => 2,
            Error::Interrupted => 130,
        }
    }
}

fn list(problems: &[Problem]) -> String {
    match problems {
        [one] => one.to_string(),
        many => many.iter().map(|p| format!("\n  {p}")).collect(),
    }
}
