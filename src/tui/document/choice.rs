//! A list to choose from: the words of a choice, the kinds of a tagged object, the scene's images.

use super::cell::Cell;
use crate::base::pointer::Pointer;
use crate::scene::Document;
use crate::scene::field::{self, Kind};
use crate::tui::text::plain;

/// A list to choose from, and what the choice is for.
#[derive(Clone, Debug)]
pub struct Choice {
    /// What is chosen.
    pub title: String,
    /// The words that can be chosen, each with a line of help.
    pub options: Vec<(String, String)>,
    /// The index of the word under the cursor.
    pub at: usize,
    /// What is done with the chosen word.
    pub then: Then,
}

/// What is done with the chosen word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Then {
    /// It becomes the value of these places.
    Set(Vec<String>),
    /// The tagged object here becomes one of the chosen kind.
    Become(String),
    /// This preset is applied to the layer.
    Preset,
    /// The layer is drawn in this style.
    Style,
    /// The cursor goes to the chosen address.
    Go,
    /// What a line of `replace` asks for is replaced: in the chosen place, or in all.
    Replace(String),
    /// It answers a question.
    Answer(Question),
}

impl Choice {
    /// Moves the cursor, stopping at the ends of the list.
    pub fn step(&mut self, by: i64) {
        let last = self.options.len().saturating_sub(1) as i64;
        self.at = (self.at as i64).saturating_add(by).clamp(0, last) as usize;
    }

    /// Moves the cursor to the next word that begins with a letter, continuing at the top; false if there is none.
    pub fn seek(&mut self, letter: char) -> bool {
        let begins = |i: &usize| self.options[*i].0.to_lowercase().starts_with(letter.to_ascii_lowercase());
        let found = (self.at + 1..self.options.len()).chain(0..=self.at).find(|i| *i < self.options.len() && begins(i));
        self.at = found.unwrap_or(self.at);
        found.is_some()
    }

    /// The same with only the words that have these letters in them, or in their help; `None` if there are none.
    pub fn narrowed(&self, letters: &str) -> Option<Choice> {
        let letters = letters.to_lowercase();
        let has =
            |(word, help): &&(String, String)| [word, help].iter().any(|text| text.to_lowercase().contains(&letters));
        let options: Vec<(String, String)> = self.options.iter().filter(has).cloned().collect();
        (!options.is_empty()).then(|| Choice { options, at: 0, ..self.clone() })
    }

    /// The word under the cursor.
    pub fn taken(&self) -> Option<&str> {
        self.options.get(self.at).map(|(word, _)| word.as_str())
    }
}

/// The words that a cell can have; `None` if its value is typed.
pub fn options(document: &Document, kind: &Kind) -> Vec<(String, String)> {
    match kind {
        Kind::Choice(all) | Kind::Tagged { variants: all, .. } => {
            all.iter().map(|one| (one.name.to_string(), one.help.to_string())).collect()
        }
        Kind::Bool => [("false", "no"), ("true", "yes")].map(|(word, help)| (word.into(), help.into())).to_vec(),
        Kind::Reference(list) => {
            let entries = field::children(document, &format!("/{list}"));
            let path = |pointer: &str| {
                let value = field::value(document, &format!("{pointer}/path"));
                value.and_then(|path| path.as_str().map(plain)).unwrap_or_default()
            };
            entries.into_iter().map(|entry| (entry.name, path(&entry.pointer))).collect()
        }
        Kind::Number { .. } | Kind::Text | Kind::Numbers(_) | Kind::List(_) | Kind::Map(_) | Kind::Object => Vec::new(),
    }
}

/// The list for a cell, with the cursor on its present word; `None` if its value is typed.
pub fn of_cell(document: &Document, cell: &Cell, others: Vec<String>) -> Option<Choice> {
    let options = options(document, &cell.field.kind);
    let at = options.iter().position(|(word, _)| *word == cell.text).unwrap_or(0);
    let (parent, last) = Pointer(&cell.pointer).split().unwrap_or_default();
    let tag = field::field(document, parent)
        .is_some_and(|field| matches!(field.kind, Kind::Tagged { tag, .. } if last == tag));
    let then = if tag { Then::Become(parent.to_owned()) } else { Then::Set(others) };
    (!options.is_empty()).then(|| Choice { title: cell.field.name.clone(), options, at, then })
}

/// Something that only the person can decide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// What it is about.
    pub about: About,
    /// What one has to know for the answer, in lines.
    pub text: Vec<String>,
}

/// What a question is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// Unsaved edits that a session left behind.
    Recovery,
    /// Somebody else is editing the scene.
    Holder,
    /// Another program has changed the same places in the file that were changed here.
    File,
}
