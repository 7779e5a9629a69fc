//! A document: the JSON as written, with its order and the spelling of its numbers, together with the scene it means. A
//! document never contains errors: what cannot be rendered is refused, with all its problems.

use std::sync::Arc;

use serde_json::Value;

use super::check::Rules;
use super::{Scene, check, json, migrate, named};
use crate::base::budget::Budget;
use crate::base::change::Change;
use crate::base::problem::{Problem, Severity};

/// A scene as written and as meant. A clone shares both.
#[derive(Clone, Debug)]
pub struct Document {
    json: Arc<Value>,
    read: check::Read,
    rules: Rules,
}

impl Document {
    /// Reads the text of a scene file.
    ///
    /// # Errors
    /// All problems that can be found at once.
    pub fn parse(text: &str) -> Result<Document, Vec<Problem>> {
        Document::parse_under(text, Rules::default())
    }

    /// The same under other rules than the default ones; later edits are checked by them too.
    pub fn parse_under(text: &str, rules: Rules) -> Result<Document, Vec<Problem>> {
        let json = Document::json_of(text, &rules).map_err(|problem| vec![problem])?;
        Document::from_json_under(json, rules)
    }

    /// The files that a text names which is no document, so that what is wrong with them can be told too.
    pub fn files_of(text: &str, rules: &Rules) -> Option<Scene> {
        Document::json_of(text, rules).ok().and_then(|json| check::files(&json, rules))
    }

    /// The JSON of a text, in the current version.
    fn json_of(text: &str, rules: &Rules) -> Result<Value, Problem> {
        let needed = Budget::new(rules.memory).try_take(json::bytes_of_text(text.as_bytes()));
        let _share = needed.map_err(|short| short.problem(""))?;
        let mut json = json::parse(text)?;
        migrate::migrate(&mut json)?;
        Ok(json)
    }

    /// The document that `json` means; it must be of the current version.
    pub fn from_json(json: Value) -> Result<Document, Vec<Problem>> {
        Document::from_json_under(json, Rules::default())
    }

    /// The same under other rules.
    pub fn from_json_under(json: Value, rules: Rules) -> Result<Document, Vec<Problem>> {
        let read = check::read(&json, &rules).map_err(|problems| named::problems(&json, problems))?;
        Ok(Document { json: Arc::new(json), read, rules })
    }

    /// From now on edits are checked by these rules.
    pub fn govern(&mut self, rules: Rules) {
        self.rules = rules;
    }

    /// The scene that the document means.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.read.scene
    }

    /// The JSON as written.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// The text of the file.
    pub fn to_text(&self) -> String {
        json::to_text(&self.json)
    }

    /// Its warnings; the scene renders all the same.
    pub fn warnings(&self) -> &[Problem] {
        &self.read.warnings
    }

    /// The document that `json` means after a change of this one, under the same rules; `None` if it is the same. Only what
    /// has changed is read and checked again, with the same result as a check of the whole.
    pub(super) fn changed(&self, json: Value) -> Result<Option<Document>, Vec<Problem>> {
        let change = Change::of(&self.json, &json);
        if change == Change::Same {
            return Ok(None);
        }
        let needed = Budget::new(self.rules.memory).try_take(json::bytes(&json));
        let _share = needed.map_err(|short| vec![short.problem("")])?;
        let errors = |mut problems: Vec<Problem>| {
            problems.retain(|problem| problem.severity == Severity::Error);
            named::problems(&json, problems)
        };
        let read = check::reread(&json, &change, &self.read, &self.rules).map_err(errors)?;
        if json.get("plica") != self.json.get("plica") {
            let problem = Problem::error("/plica", "the version of the format cannot be edited");
            return Err(vec![problem.hint("a newer plica brings a scene to its own version by itself")]);
        }
        Ok(Some(Document { json: Arc::new(json), read, rules: self.rules.clone() }))
    }
}
