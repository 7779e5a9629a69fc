//! A history rebuilt from what a journal recorded. The changes were checked when they were made: only the resulting
//! document is checked again, once, so that thousands of changes take no more than a moment. Only then is it also
//! brought to the current version of the format, since the changes fit the version they were made in.

use serde_json::Value;

use super::past::History;
use super::tree::{Stamp, Tree};
use crate::base::problem::Problem;
use crate::scene::check::Rules;
use crate::scene::edit::Copies;
use crate::scene::{Document, Edit};

/// A history being rebuilt.
#[derive(Debug)]
pub struct Replay {
    json: Value,
    tree: Tree,
    revision: u64,
    saved: Option<usize>,
    copies: Copies,
}

/// A history that was rebuilt.
#[derive(Debug)]
pub struct Remade {
    /// The history, with its last step closed.
    pub history: History,
    /// The edit that brought the document to the current version of the format, and its inverse; it is not a step.
    pub migration: Option<(Edit, Edit)>,
}

impl Replay {
    /// Begins with the document before the first change; whether it is in a file is not known.
    pub fn new(json: Value) -> Replay {
        Replay { json, tree: Tree::default(), revision: 0, saved: None, copies: Copies::default() }
    }

    /// Replays an edit, with its inverse, of the step `id`. An edit to another version of the format restarts the
    /// history.
    ///
    /// # Errors
    /// If it cannot be applied; the replay must not be used any more.
    pub fn edit(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp, id: u64) -> Result<(), Problem> {
        let version = self.json.get("plica").cloned();
        edit.patch_within(&mut self.json, &mut self.copies)?;
        self.revision += 1;
        if version.as_ref() == self.json.get("plica") {
            self.tree.note(edit.clone(), inverse.clone(), stamp, Some(id));
        } else {
            self.tree = std::mem::take(&mut self.tree).begun_anew();
            self.tree.reserve(id);
            self.saved = None;
        }
        Ok(())
    }

    /// Replays the undo that `edit` records. If it undoes no known step, it counts as an ordinary edit.
    ///
    /// # Errors
    /// As [`Replay::edit`].
    pub fn undo(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp, id: u64) -> Result<(), Problem> {
        if self.tree.step(self.tree.here()).is_none_or(|last| last.inverse != *edit) {
            return self.edit(edit, inverse, stamp, id);
        }
        edit.patch_within(&mut self.json, &mut self.copies)?;
        self.revision += 1;
        self.tree.go_back();
        Ok(())
    }

    /// Replays the redo that `edit` records, as [`Replay::undo`] does.
    ///
    /// # Errors
    /// As [`Replay::edit`].
    pub fn redo(&mut self, edit: &Edit, inverse: &Edit, stamp: Stamp, id: u64) -> Result<(), Problem> {
        let Some(state) = self.tree.after_by(edit, id) else { return self.edit(edit, inverse, stamp, id) };
        edit.patch_within(&mut self.json, &mut self.copies)?;
        self.revision += 1;
        self.tree.arrive(state);
        Ok(())
    }

    /// The document as it is now.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// Notes that the document was written to its file.
    pub fn saved(&mut self) {
        self.saved = Some(self.tree.here());
        self.tree.close();
    }

    /// The history, with its last step closed. `migrate` brings the document to the current version; if it changes
    /// anything, undo starts from there.
    ///
    /// # Errors
    /// The problems of the resulting document.
    pub fn finish(
        self,
        rules: Rules,
        migrate: impl Fn(&mut Value) -> Result<(), Problem>,
    ) -> Result<Remade, Vec<Problem>> {
        let Replay { mut json, mut tree, revision, saved, .. } = self;
        let raw = json.clone();
        migrate(&mut json).map_err(|problem| vec![problem])?;
        let is_saved = saved == Some(tree.here());
        let migrated = raw.get("plica") != json.get("plica");
        let migration = migrated.then(|| (Edit::replace("", json.clone()), Edit::replace("", raw)));
        let document = Document::from_json_under(json, rules)?;
        tree.close();
        let (tree, saved) = if migrated { (tree.begun_anew(), is_saved.then_some(0)) } else { (tree, saved) };
        Ok(Remade { history: History { document, revision, saved, tree }, migration })
    }
}
