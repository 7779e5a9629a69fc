//! Every place of a scene in its order, by name and by value: what search and palette look through. Made once a document
//! and only when asked for; it costs a walk over everything.

use serde_json::Value;

use crate::scene::schema::{Body, Place};
use crate::scene::{Document, address, field, pointer};
use crate::tui::text::numbers;

/// One place of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// Where it is.
    pub pointer: String,
    /// The same, as people write it.
    pub address: String,
    /// Whether it has an inside of its own.
    pub node: bool,
    /// Its name (an item without one has none) and the word that it says, in small letters.
    words: String,
    /// The numbers that it holds.
    numbers: Vec<f64>,
}

/// What is looked for: a part of a name or of a word, or a number.
#[derive(Clone, Debug)]
pub struct Sought {
    text: String,
    number: Option<f64>,
}

impl Sought {
    /// As it was typed.
    pub fn new(text: &str) -> Sought {
        Sought { text: text.to_lowercase(), number: text.trim().parse().ok().filter(|number: &f64| number.is_finite()) }
    }
}

impl Listed {
    /// Whether this is looked for, and if so by which of its numbers; the first one where it is by name.
    pub fn matched(&self, sought: &Sought) -> Option<usize> {
        if self.words.contains(&sought.text) {
            return Some(0);
        }
        let number = sought.number?;
        self.numbers.iter().position(|&own| own == number || numbers::short(own) == sought.text)
    }
}

/// Every place of the document, from the top down.
pub fn list(document: &Document) -> Vec<Listed> {
    let mut all = Vec::new();
    below(Place::root(document.json()), "", "", &mut all);
    all
}

fn below(place: Place, at: &str, address: &str, all: &mut Vec<Listed>) {
    let body = place.shape.body();
    let items = matches!(body, Body::List(..));
    for (token, inner) in field::steps(place) {
        let (pointer, address) =
            (pointer::join(at, &token), address::below(address, (place.shape, body), &token, inner));
        let mut words = match field::name_of(inner.value) {
            Some(name) => name.to_lowercase(),
            None if items => String::new(),
            None => token.to_lowercase(),
        };
        let mut numbers = Vec::new();
        let node = match inner.value {
            Some(Value::String(text)) => {
                words.push('\n');
                words.push_str(&text.to_lowercase());
                false
            }
            Some(Value::Number(number)) => {
                numbers.extend(number.as_f64());
                false
            }
            Some(Value::Array(items)) if matches!(inner.shape.body(), Body::Numbers(_)) => {
                numbers.extend(items.iter().filter_map(Value::as_f64));
                false
            }
            Some(Value::Array(_) | Value::Object(_)) => true,
            _ => false,
        };
        all.push(Listed { pointer: pointer.clone(), address: address.clone(), node, words, numbers });
        if node {
            below(inner, &pointer, &address, all);
        }
    }
}
