//! What places of a document are called for people: by names where there are any, also in JSON that is no document.

use serde_json::Value;

use super::schema::{Body, Place, Shape};
use crate::base::pointer::{self, Pointer, spelled};
use crate::base::problem::Problem;

/// The name of an item of a list, if it has one.
pub fn name_of(value: Option<&Value>) -> Option<String> {
    Some(value?.as_object()?.get("name")?.as_str()?.to_owned())
}

/// The address of a JSON pointer; a pointer that leads nowhere is returned as it is.
pub fn address(json: &Value, pointer: &str) -> String {
    let mut place = Place::root(json);
    let mut address = String::new();
    for token in Pointer(pointer).tokens() {
        let Some(below) = place.step(&token) else { return pointer.to_owned() };
        address = self::below(&address, (place.shape, place.shape.body()), &token, below);
        place = below;
    }
    address
}

/// The same, even if only its beginning leads anywhere: the rest is then written token by token.
pub fn told(json: &Value, pointer: &str) -> String {
    let tokens: Vec<String> = Pointer(pointer).tokens().collect();
    let known = (0..=tokens.len())
        .rev()
        .map(|n| (n, tokens[..n].iter().fold(String::new(), |at, token| Pointer(&at).join(token))));
    let there = known.map(|(n, at)| (n, address(json, &at))).find(|(n, address)| *n == 0 || !address.starts_with('/'));
    let (n, address) = there.unwrap_or_default();
    let rest = tokens[n..].iter().map(|token| spelled(token, false));
    std::iter::once(address).filter(|address| !address.is_empty()).chain(rest).collect::<Vec<_>>().join(".")
}

/// Problems with their addresses in a document that may have errors, as JSON.
pub fn problems(json: &Value, mut problems: Vec<Problem>) -> Vec<Problem> {
    for problem in problems.iter_mut().filter(|problem| problem.path.starts_with('/')) {
        problem.address = Some(told(json, &problem.path));
    }
    problems
}

/// The address of `below`, which is `token` below the place with that address and shape.
pub fn below(address: &str, (shape, body): (Shape, Body), token: &str, below: Place) -> String {
    let step = match body {
        Body::List(..) => name_of(below.value).map(|name| spelled(&name, true)),
        Body::Numbers(_) | Body::Row(_) => pointer::index(token).and_then(|i| shape.column(i)).map(str::to_owned),
        Body::Map(_) | Body::Object | Body::Tagged(_) => None,
        Body::Number { .. } | Body::Text | Body::Bool | Body::Choice => None,
    };
    let step = step.unwrap_or_else(|| spelled(token, false));
    if address.is_empty() { step } else { format!("{address}.{step}") }
}
