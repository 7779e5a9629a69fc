//! The palette: everything that can be run or gone to, in one list that typing narrows. Keys and commands come from their
//! tables, nodes and fields from the scene.

use crate::tui::text::plain;
use std::sync::Arc;

use nucleo_matcher::pattern::{CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};

use super::places::Listed;
use crate::tui::text::input::Text;

/// The list, and what is typed over it.
#[derive(Clone, Debug)]
pub struct Palette {
    /// What is typed.
    pub text: Text,
    /// The row under the cursor.
    pub at: usize,
    commands: Arc<[Action]>,
    places: Arc<[Listed]>,
    /// The indices of what matches, the best first; those of places follow those of commands.
    found: Vec<usize>,
    sought: String,
}

/// A command or the line of a key.
#[derive(Clone, Debug)]
pub struct Action {
    /// Its name, or the whole line.
    pub name: String,
    /// The keys that run it.
    pub key: String,
    /// What it does.
    pub help: String,
    /// What it runs.
    pub line: String,
}

/// One row of the list.
pub struct Row {
    /// What it is: command, node, field.
    pub sort: &'static str,
    /// The text that is searched.
    pub text: String,
    /// Its key.
    pub key: String,
    /// The line that it runs.
    pub line: String,
    /// Where it is in the scene; empty for a command.
    pub pointer: String,
}

impl Palette {
    /// Everything, commands first.
    pub fn new(commands: Vec<Action>, places: Arc<[Listed]>) -> Palette {
        let commands: Arc<[Action]> = commands.into();
        let found = (0..commands.len() + places.len()).collect();
        Palette { text: Text::default(), at: 0, commands, places, found, sought: String::new() }
    }

    /// How many rows match.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// One of the rows that match.
    pub fn row(&self, index: usize) -> Option<Row> {
        let index = *self.found.get(index)?;
        let Some(place) = index.checked_sub(self.commands.len()) else {
            let Action { name, key, help, line } = self.commands[index].clone();
            return Some(Row { sort: "command", text: format!("{name}  {help}"), key, line, pointer: String::new() });
        };
        let place = self.places.get(place)?;
        let line = format!("go {}", place.pointer);
        let sort = if place.node { "node" } else { "field" };
        Some(Row { sort, text: plain(&place.address), key: String::new(), line, pointer: place.pointer.clone() })
    }

    /// Moves the cursor, wrapping around at the ends.
    pub fn step(&mut self, by: i64) {
        let count = self.found.len().max(1) as i64;
        self.at = (self.at as i64 + by).rem_euclid(count) as usize;
    }

    /// Searches again after the text has changed: if it has only grown, among the last matches.
    pub fn narrow(&mut self) {
        let typed = self.text.value().trim().to_owned();
        if typed == self.sought {
            return;
        }
        if !typed.starts_with(&self.sought) {
            self.found = (0..self.commands.len() + self.places.len()).collect();
        }
        self.found.sort_unstable();
        self.at = 0;
        if !typed.is_empty() {
            let (pattern, mut matcher, mut buffer) = (pattern(&typed), Matcher::new(Config::DEFAULT), Vec::new());
            let mut scored: Vec<(u32, usize)> = Vec::new();
            for &index in &self.found {
                let mut score = |text: &str| pattern.score(Utf32Str::new(text, &mut buffer), &mut matcher);
                let scored_one = match index.checked_sub(self.commands.len()) {
                    // A match in the name of a command ranks above one in its help.
                    None => {
                        let Action { name, help, .. } = &self.commands[index];
                        score(name).map(|score| score + 20).or_else(|| score(&format!("{name}  {help}")))
                    }
                    Some(place) => score(&self.places[place].address),
                };
                scored.extend(scored_one.map(|score| (score, index)));
            }
            scored.sort_by_key(|&(score, index)| (std::cmp::Reverse(score), index));
            self.found = scored.into_iter().map(|(_, index)| index).collect();
        }
        self.sought = typed;
    }

    /// Which characters of a row's text match what is typed.
    pub fn matched(&self, text: &str) -> Vec<u32> {
        let (mut indices, mut buffer) = (Vec::new(), Vec::new());
        if !self.sought.is_empty() {
            let text = Utf32Str::new(text, &mut buffer);
            pattern(&self.sought).indices(text, &mut Matcher::new(Config::DEFAULT), &mut indices);
        }
        indices.sort_unstable();
        indices.dedup();
        indices
    }
}

fn pattern(typed: &str) -> Pattern {
    Pattern::parse(typed, CaseMatching::Smart, Normalization::Smart)
}
