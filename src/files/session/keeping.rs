//! Where the edits of a session are kept until they are saved.

use std::time::Instant;

use crate::files::journal::{Candidate, Journal};
use crate::scene::Document;

/// Where edits are kept until they are saved.
#[derive(Debug)]
pub(super) enum Keeping {
    /// Nowhere: the scene is only looked at.
    Nowhere,
    /// In a journal.
    Journal(Journal),
    /// In no journal yet.
    Waiting(Waiting),
}

/// A journal that could not be opened.
#[derive(Debug)]
pub(super) struct Waiting {
    /// The journal, locked; `None` if it could not even be found.
    pub(super) found: Option<Candidate>,
    /// The document that its first `records` records lead to.
    pub(super) leads_to: Document,
    pub(super) records: usize,
    /// Why it could not be opened.
    pub(super) why: String,
    /// When it was last tried.
    pub(super) tried: Instant,
}

impl Keeping {
    /// For a journal that could not even be found; `document` is the file's.
    pub fn unfound(why: String, document: Document) -> Keeping {
        Keeping::Waiting(Waiting { found: None, leads_to: document, records: 0, why, tried: Instant::now() })
    }

    /// The journal, if it is open.
    pub fn journal(&self) -> Option<&Journal> {
        if let Keeping::Journal(journal) = self { Some(journal) } else { None }
    }

    /// Why edits do not reach a journal.
    pub fn failing(&self) -> Option<String> {
        match self {
            Keeping::Nowhere => None,
            Keeping::Journal(journal) => journal.failing(),
            Keeping::Waiting(waiting) => Some(waiting.why.clone()),
        }
    }

    /// Waits until every change is in the journal.
    ///
    /// # Errors
    /// Why they are not.
    pub fn flush(&self) -> Result<(), String> {
        match self {
            Keeping::Nowhere => Ok(()),
            Keeping::Journal(journal) => journal.flush(),
            Keeping::Waiting(waiting) => Err(waiting.why.clone()),
        }
    }
}
