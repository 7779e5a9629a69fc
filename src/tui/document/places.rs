//! All places of a scene in order, with their names and values, for the search and the palette. The list costs a walk over
//! the whole document, so it is made only when needed, once for each document.

use serde_json::Value;

use crate::base::pointer::Pointer;
use crate::scene::schema::{Body, Place};
use crate::scene::{Document, field, named};
use crate::tui::text::numbers;

/// One place of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// Where it is.
    pub pointer: String,
    /// Its address, as people write it.
    pub address: String,
    /// Whether it is a node.
    pub node: bool,
    /// Its name, if it has one, and its value if that is a word; in lower case.
    words: String,
    /// The numbers in its value.
    numbers: Vec<f64>,
}

/// What is searched for: a part of a name or of a word, or a number.
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
    /// Whether the place matches, and by which of its numbers (0 for a match by name).
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
    below(document, Place::root(document.json()), ("", ""), &mut all);
    all
}

fn below(document: &Document, place: Place, (at, address): (&str, &str), all: &mut Vec<Listed>) {
    let body = place.shape.body();
    let items = body.is_list();
    for (token, inner) in steps(document, place, at) {
        let (pointer, address) = (Pointer(at).join(&token), named::below(address, (place.shape, body), &token, inner));
        let mut words = match named::name_of(inner.value) {
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
            _ => inner.shape.laid().is_some() && field::laid(document, &pointer).is_some(),
        };
        all.push(Listed { pointer: pointer.clone(), address: address.clone(), node, words, numbers });
        if node {
            below(document, inner, (&pointer, &address), all);
        }
    }
}

/// The places directly below one, also those that stand there though they are not written.
fn steps<'a>(document: &'a Document, place: Place<'a>, at: &str) -> Vec<(String, Place<'a>)> {
    let laid = place.shape.laid().and_then(|_| field::laid(document, at));
    let step = |token: String| field::standing(document, &Pointer(at).join(&token)).map(|inner| (token, inner));
    laid.map_or_else(|| field::steps(place), |tokens| tokens.into_iter().filter_map(step).collect())
}
