//! Rules shared by the checks of all techniques: names, file paths, ascending lists.

use std::collections::HashMap;

use crate::base::color;
use crate::base::problem::{Problem, quoted};

/// Problems with the names of siblings, each with its pointer: they must be non-empty, without control characters, and
/// unique.
pub fn names<'a>(siblings: impl Iterator<Item = (String, &'a str)>) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut first: HashMap<&str, usize> = HashMap::new();
    for (i, (path, name)) in siblings.enumerate() {
        if let Some(earlier) = first.get(name) {
            let message = format!("the name {} is taken", quoted(name));
            problems.push(Problem::error(&path, message).hint(format!("number {earlier} of the list has it")));
        }
        problems.extend(plain_text(name, &path));
        first.entry(name).or_insert(i);
    }
    problems
}

/// A problem if a name is empty or has control characters.
pub fn plain_text(text: &str, path: &str) -> Option<Problem> {
    if text.trim().is_empty() {
        Some(Problem::error(path, "a name is empty"))
    } else if text.chars().any(char::is_control) {
        Some(Problem::error(path, format!("{} holds a control character", quoted(text))))
    } else {
        None
    }
}

/// A problem if a text is not a color.
pub fn color(text: &str, path: &str) -> Option<Problem> {
    let problem = || Problem::error(path, format!("{} is no color", quoted(text))).hint("as #20304a, or #20304a80");
    color::parse(text).is_none().then(problem)
}

/// A problem with the path of a file, judged by the text alone: it must have no control characters and, unless
/// `outside` is allowed, be relative and not lead upwards.
pub fn file_path(text: &str, path: &str, outside: bool) -> Option<Problem> {
    let upwards = text.split(['/', '\\']).any(|part| part == "..");
    let what = if text.chars().any(char::is_control) {
        return Some(Problem::error(path, format!("{} holds a control character", quoted(text))));
    } else if outside {
        return None;
    } else if text.starts_with('/') {
        "is an absolute path"
    } else if upwards {
        "leads out of the scene's folder"
    } else {
        return None;
    };
    let hint = "copy the file beside the scene, or give --allow-outside";
    Some(Problem::error(path, format!("{} {what}", quoted(text))).hint(hint))
}

/// Problems with numbers that must strictly ascend; `path(i)` is the path of number i.
pub fn ascending(what: &str, numbers: impl Iterator<Item = f64>, path: impl Fn(usize) -> String) -> Vec<Problem> {
    let numbers: Vec<f64> = numbers.collect();
    let pairs = numbers.windows(2).enumerate().filter(|(_, pair)| pair[1] <= pair[0]);
    pairs
        .map(|(i, pair)| {
            let message = format!("{what} must ascend: {} does not come after {}", pair[1], pair[0]);
            Problem::error(path(i + 1), message).hint("put them in order, or change this one")
        })
        .collect()
}
