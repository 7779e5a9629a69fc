//! `plica set` and `plica get` through the editor that has the scene open: what they read is what it shows, and what they
//! write can be undone there.

use std::path::Path;

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::preview::wire::connection::Wire;
use crate::preview::wire::frame::{self, most};
use crate::preview::wire::handshake;
use crate::preview::wire::message::{FromEditor, Role, ToEditor};
use crate::scene::Document;
use crate::scene::check::Rules;
use crate::scene::edit::Edit;

/// How often an edit is retried if the document changed meanwhile.
const TRIES: usize = 5;

/// The document as the editor has it; `None` if no editor has the scene open.
pub fn document(scene: &Path) -> Option<Result<Document>> {
    let joined = ask(scene).transpose()?;
    Some(joined.map(|joined| joined.document))
}

/// Has the editor make an edit of its document; `None` if no editor has the scene open.
///
/// # Errors
/// What `make` says, or the editor's problems with the edit.
pub fn edit(scene: &Path, make: impl Fn(&Document) -> Result<Edit>) -> Option<Result<()>> {
    try_edit(scene, make).transpose()
}

fn try_edit(scene: &Path, make: impl Fn(&Document) -> Result<Edit>) -> Result<Option<()>> {
    let Some(mut joined) = ask(scene)? else { return Ok(None) };
    for _ in 1..TRIES {
        let problems = match joined.edit(make(&joined.document)?)? {
            problems if problems.is_empty() => return Ok(Some(())),
            problems => problems,
        };
        let revision = joined.revision;
        let refused = Error::Scene { file: scene.display().to_string(), problems };
        joined = ask(scene)?.ok_or_else(gone)?;
        if joined.revision == revision {
            return Err(refused);
        }
    }
    Err(Error::at("editor", "the scene changes too fast").cure("try again when nobody edits"))
}

struct Joined {
    wire: Wire,
    document: Document,
    revision: u64,
}

fn ask(scene: &Path) -> Result<Option<Joined>> {
    let Some((hello, wire)) = handshake::join(scene, Role::Script, most())? else { return Ok(None) };
    let FromEditor::Hello { revision, document, .. } = hello else { return Err(gone()) };
    let document = Document::from_json_under(document, Rules::NONE);
    let document = document.map_err(|problems| Error::Scene { file: scene.display().to_string(), problems })?;
    Ok(Some(Joined { wire, document, revision }))
}

impl Joined {
    fn edit(&mut self, patch: Edit) -> Result<Vec<Problem>> {
        frame::write(&mut self.wire.writer, &ToEditor::Edit { revision: self.revision, patch })?;
        let answer = frame::read(&mut self.wire.reader, most())?;
        answer.and_then(FromEditor::answer).ok_or_else(gone)
    }
}

fn gone() -> Error {
    Error::at("editor", "it left without an answer").cure("check whether the edit was made, then try again")
}
