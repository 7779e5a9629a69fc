//! Addresses for people: `layers.face.zones."left eye".interpolation.radius`, with names, quotes and indices from 0; or
//! a JSON pointer. Conversion in both directions follows the schema, so that fields that are not written yet have an
//! address too.

use serde_json::Value;

use super::Document;
use super::field;
use super::named::{self, name_of};
use super::schema::{Body, Place};
use crate::base::error::{Error, Result};
use crate::base::pointer::{self, Pointer};
use crate::base::problem::{Problem, nearest, quoted};

/// The JSON pointer of an address.
///
/// # Errors
/// If a part of it is unknown, or stands for several; the message names it, and the nearest known one.
pub fn resolve(document: &Document, address: &str) -> Result<String> {
    if address.is_empty() || address.starts_with('/') {
        let tokens = Pointer(address).tokens().map(|text| Token { text, quoted: false });
        return follow(document, address, tokens.collect());
    }
    follow(document, address, split(address)?)
}

/// The whole of an address that begins with a dot: `.feather` is the nearest feather around the place at `here`, looked for from
/// inside out; where there is none, that of something that stands beside these, as `.duration` of the timeline. Any other stays as it is.
///
/// # Errors
/// If there is no such thing around the place, or beside that in several things.
pub fn around(document: &Document, here: &str, address: &str) -> Result<String> {
    let Some(way) = address.strip_prefix('.') else { return Ok(address.to_owned()) };
    let first = split(way)?.into_iter().next();
    let has = |at: &&str| {
        let place = Place::of(document.json(), at).filter(|place| !matches!(place.shape.body(), Body::Map(_)));
        place.zip(first.as_ref()).is_some_and(|(place, first)| step(document, address, at, place, first).is_ok())
    };
    let beside = |at: &str| -> Vec<String> {
        let fields = Place::of(document.json(), at).map(|place| field::below(place, at)).unwrap_or_default();
        fields.into_iter().map(|(child, _)| child.pointer).filter(|at| has(&&**at)).collect()
    };
    let found = match Pointer(here).upward().find(has) {
        Some(at) => vec![at.to_owned()],
        None => Pointer(here).upward().map(beside).find(|found| !found.is_empty()).unwrap_or_default(),
    };
    let whole = |at: &String| match self::address(document, at) {
        at if at.is_empty() => way.to_owned(),
        at => format!("{at}.{way}"),
    };
    match found.as_slice() {
        [] => {
            let error = Error::at(address, "there is no such thing around the cursor");
            Err(error.cure("a whole path begins with no dot"))
        }
        [at] => Ok(whole(at)),
        several => {
            let all: Vec<String> = several.iter().map(whole).collect();
            Err(Error::at(address, "there are several").cure(all.join(" or ")))
        }
    }
}

/// The JSON pointers of all places that an address means in which `*` stands for every item, entry or field; those that
/// have nothing of the rest of its name are left out.
///
/// # Errors
/// If there is none; the message is that of the first.
pub fn resolve_all(document: &Document, address: &str) -> Result<Vec<String>> {
    if address.is_empty() || address.starts_with('/') {
        return resolve(document, address).map(|pointer| vec![pointer]);
    }
    let mut found = Vec::new();
    spread(document, address, (String::new(), Place::root(document.json())), &split(address)?, &mut found)?;
    Ok(found)
}

/// Collects the places that the rest of an address means below one.
fn spread(
    document: &Document,
    address: &str,
    (path, place): (String, Place),
    rest: &[Token],
    found: &mut Vec<String>,
) -> Result<()> {
    let Some((first, rest)) = rest.split_first() else {
        found.push(path);
        return Ok(());
    };
    if first.quoted || first.text != "*" {
        return spread(document, address, step(document, address, &path, place, first)?, rest, found);
    }
    let before = found.len();
    let tokens = field::laid(document, &path).unwrap_or_else(|| match place.shape.body() {
        Body::Numbers(count) => (0..count).map(|i| i.to_string()).collect(),
        Body::Row(_) | Body::List(..) | Body::Map(_) | Body::Object | Body::Tagged(_) => {
            field::steps(place).into_iter().map(|(token, _)| token).collect()
        }
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => Vec::new(),
    });
    let mut why = None;
    for token in tokens {
        let Some(below) = place.step(&token) else { continue };
        let below = (Pointer(&path).join(&token), below);
        if let Err(error) = spread(document, address, below, rest, found) {
            why.get_or_insert(error);
        }
    }
    if found.len() > before {
        return Ok(());
    }
    Err(why.unwrap_or_else(|| Error::at(address, format!("{} has nothing in it", self::address(document, &path)))))
}

/// The address of a JSON pointer, with names where there are any. A pointer that leads nowhere is returned as it is.
pub fn address(document: &Document, pointer: &str) -> String {
    named::address(document.json(), pointer)
}

/// The address of a JSON pointer, even if only its beginning leads anywhere: the rest is then written token by token.
pub fn told(document: &Document, pointer: &str) -> String {
    named::told(document.json(), pointer)
}

/// A problem with the address of its place, for people.
pub fn of_problem(document: &Document, problem: &Problem) -> Problem {
    problem.clone().at(told(document, &problem.path))
}

/// One step of an address.
struct Token {
    text: String,
    quoted: bool,
}

/// Splits at dots outside quotes; in quotes a backslash takes the next character as it is.
fn split(address: &str) -> Result<Vec<Token>> {
    let mut tokens = vec![Token { text: String::new(), quoted: false }];
    let mut inside = false;
    let mut chars = address.chars();
    while let Some(c) = chars.next() {
        let token = tokens.last_mut().expect("there is always a last token");
        match c {
            '"' => {
                inside = !inside;
                token.quoted = true;
            }
            '\\' if inside => token.text.extend(chars.next()),
            '.' if !inside => tokens.push(Token { text: String::new(), quoted: false }),
            c => token.text.push(c),
        }
    }
    if inside {
        return Err(Error::at(address, "a quote is not closed"));
    }
    Ok(tokens)
}

fn follow(document: &Document, address: &str, tokens: Vec<Token>) -> Result<String> {
    let mut place = Place::root(document.json());
    let mut path = String::new();
    for token in tokens {
        (path, place) = step(document, address, &path, place, &token)?;
    }
    Ok(path)
}

/// The place one step further.
fn step<'a>(
    document: &'a Document,
    address: &str,
    path: &str,
    place: Place<'a>,
    token: &Token,
) -> Result<(String, Place<'a>)> {
    let laid = || field::laid(document, path).is_some_and(|names| names.contains(&token.text));
    let key = key(place, token).or_else(|| (!token.text.is_empty() && laid()).then(|| token.text.clone()));
    let below = key.and_then(|key| Some((Pointer(path).join(&key), place.step(&key)?)));
    if below.is_none() && !token.quoted && token.text == "*" {
        return Err(Error::at(address, "* stands for all of them, and here one is asked for").cure("only set takes *"));
    }
    below.ok_or_else(|| unknown(document, address, path, place, &token.text))
}

/// The pointer token for a step of an address.
fn key(place: Place, token: &Token) -> Option<String> {
    match place.shape.body() {
        Body::List(..) => {
            let items = place.value.and_then(Value::as_array).map_or(&[] as &[_], Vec::as_slice);
            let named = || items.iter().position(|item| name_of(Some(item)).as_deref() == Some(token.text.as_str()));
            let bare = |known: bool| (known && !token.quoted).then(|| token.text.clone());
            let index = bare(within(&token.text, items.len())).or_else(|| named().map(|index| index.to_string()));
            index.or_else(|| bare(token.text == "-"))
        }
        Body::Numbers(count) | Body::Row(count) => {
            // x and y are understood even if the columns have other names (dx, dy).
            let named = (0..count).find(|&i| place.shape.column(i) == Some(&token.text));
            let named = named.or_else(|| ["x", "y"].iter().position(|axis| *axis == token.text && count == 2));
            Some(named.map_or_else(|| token.text.clone(), |index| index.to_string()))
        }
        Body::Map(_) | Body::Object | Body::Tagged(_) => Some(token.text.clone()),
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => Some(token.text.clone()),
    }
}

fn within(text: &str, count: usize) -> bool {
    pointer::index(text).is_some_and(|index| index < count)
}

fn unknown(document: &Document, address: &str, path: &str, place: Place, token: &str) -> Error {
    let names = field::laid(document, path).unwrap_or_else(|| names_below(place));
    // Of what is not there, the first step is what is missing.
    let missing = |at: &str| {
        let (parent, name) = Pointer(at).split()?;
        let above = Place::of(document.json(), parent).filter(|above| matches!(above.shape.body(), Body::Map(_)))?;
        let stands = document.json().pointer(at).is_some()
            || field::laid(document, parent).is_some_and(|names| names.contains(&name));
        (!stands).then(|| unknown(document, address, parent, above, &name))
    };
    if let Some(error) = Pointer(path).upward().find_map(missing) {
        return error;
    }
    let inside = if path.is_empty() { "a scene".into() } else { self::address(document, path) };
    let what = match place.shape.body() {
        Body::List(..) if names.is_empty() => format!("{inside} is empty"),
        Body::List(..) | Body::Map(_) => format!("there is no {} in {inside}", quoted(token)),
        Body::Object | Body::Tagged(_) | Body::Numbers(_) | Body::Row(_) => {
            format!("there is no field {} in {inside}", quoted(token))
        }
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => format!("{inside} has no parts"),
    };
    let error = Error::at(address, what);
    match nearest(token, names.iter().map(String::as_str)) {
        Some(hint) => error.cure(hint),
        None => error,
    }
}

/// The names that could have been meant below a place.
fn names_below(place: Place) -> Vec<String> {
    match place.shape.body() {
        Body::List(..) => {
            let items = place.value.and_then(Value::as_array).into_iter().flatten().enumerate();
            items.map(|(i, item)| name_of(Some(item)).unwrap_or_else(|| i.to_string())).collect()
        }
        Body::Numbers(count) | Body::Row(count) => {
            (0..count).map(|i| place.shape.column(i).map_or_else(|| i.to_string(), str::to_owned)).collect()
        }
        Body::Map(_) => {
            place.value.and_then(Value::as_object).into_iter().flat_map(|map| map.keys().cloned()).collect()
        }
        Body::Object | Body::Tagged(_) => {
            place.shape.properties(place.value).into_iter().map(|(name, _)| name.to_owned()).collect()
        }
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => Vec::new(),
    }
}
