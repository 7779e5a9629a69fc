//! A [`Problem`] is something wrong *in* a scene. All problems are found at once, each with its place, and none of them
//! ever stops editing.

use std::fmt;

use crate::base::pointer::Pointer;
use crate::base::text::line;

/// How bad a [`Problem`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; the scene renders.
    Warning,
    /// The scene cannot be rendered until this is mended.
    Error,
}

/// What a program decides by; a person reads the message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Nothing is decided by it.
    #[default]
    Any,
    /// A number that is too large for 64 bits of floating point.
    TooLargeNumber,
    /// Something that does not move, which matters where nothing else does.
    Still,
}

/// What to do about a number that is too large.
pub const LARGEST: &str = "the largest is 1.7e308";

/// Something wrong in a scene: where, what, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Problem {
    /// How bad it is.
    pub severity: Severity,
    /// JSON pointer into the document (RFC 6901), empty for the whole of it; for people alone, an address.
    pub path: String,
    /// The same place with the names of what is there, for people, where those are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<String>,
    /// What was found and what was expected, one sentence without a full stop.
    pub message: String,
    /// How to mend it, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
    /// Its kind; not sent to other processes.
    #[serde(skip)]
    pub kind: Kind,
}

impl Problem {
    /// A problem that stops rendering.
    pub fn error(path: impl Into<String>, message: impl Into<String>) -> Self {
        let (path, message) = (path.into(), message.into());
        Problem { severity: Severity::Error, path, address: None, message, hint: None, kind: Kind::Any }
    }

    /// A problem that only deserves a word.
    pub fn warning(path: impl Into<String>, message: impl Into<String>) -> Self {
        Problem { severity: Severity::Warning, ..Problem::error(path, message) }
    }

    /// Adds how to mend it.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same problem seen from further out: `prefix` goes before the path.
    pub fn under(self, prefix: &str) -> Self {
        let path = format!("{prefix}{}", self.path);
        self.at(path)
    }

    /// The same problem at another path. An address would still lead to the old one, so it has none.
    pub fn at(self, path: impl Into<String>) -> Self {
        Problem { path: path.into(), address: None, ..self }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.severity {
            Severity::Warning => "warning: ",
            Severity::Error => "",
        };
        // Keys and names come from files: none of them may steer a terminal.
        match self.address.as_deref().unwrap_or(&self.path) {
            "" => {}
            pointer if pointer.starts_with('/') => write!(f, "{}: ", line(&Pointer(pointer).dotted()))?,
            told => write!(f, "{}: ", line(told))?,
        }
        write!(f, "{kind}{}", line(&self.message))?;
        match &self.hint {
            Some(hint) => write!(f, " ({})", line(hint)),
            None => Ok(()),
        }
    }
}

/// The name most like a word, if one is: a few letters are wrong, or both begin alike. Long words and long lists, which
/// only a hostile file has, are not compared.
pub fn like<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 100;
    const MOST: usize = 1000;
    /// The share of letters that have to agree: `rotation` is like `rotate`, `wind` is not like `wide`,
    const LEAST: f64 = 0.6;
    /// and where already the first is another: `rotation` is not like `position`.
    const LEAST_OTHER: f64 = 0.79;
    /// What each of the first letters counts beside that.
    const FIRST: (usize, f64) = (4, 0.1);
    /// Fewer letters than these are the beginning of too much.
    const BEGUN: usize = 3;
    let comparable = known.take(MOST).filter(|name| name.len().max(word.len()) <= LONGEST);
    let begins = |name: &str| {
        word.len().min(name.len()) >= BEGUN && (name.starts_with(word) || !name.is_empty() && word.starts_with(name))
    };
    let scored = comparable.filter_map(|name| {
        let alike = strsim::normalized_damerau_levenshtein(word, name);
        let first = word.chars().zip(name.chars()).take(FIRST.0).take_while(|(a, b)| a == b).count();
        let least = if first > 0 { LEAST } else { LEAST_OTHER };
        (alike > least || begins(name) || first == FIRST.0).then_some((alike + FIRST.1 * first as f64, name))
    });
    scored.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

/// `did you mean "this"?` where one is near, else all there are.
pub fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str> + Clone) -> Option<String> {
    match like(word, known.clone()) {
        Some(name) => Some(format!("did you mean {}?", quoted(name))),
        None => known.clone().next().map(|_| there_are(known)),
    }
}

/// All the names there are, or the first twenty.
pub fn there_are<'a>(known: impl Iterator<Item = &'a str>) -> String {
    let mut names: Vec<_> = known.take(21).map(quoted).collect();
    if names.len() > 20 {
        names[20] = "…".into();
    }
    format!("there {} {}", if names.len() == 1 { "is" } else { "are" }, names.join(", "))
}

/// `text` in quotes, with control characters escaped, truncated to 60 characters.
pub fn quoted(text: &str) -> String {
    const LONGEST: usize = 60;
    let short: String = text.chars().take(LONGEST).collect();
    let more = if short.len() < text.len() { "…" } else { "" };
    format!("{:?}", short + more)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guess_that_is_no_help_is_none() {
        let known = ["rotate", "position", "scale", "front view", "uv", "curvature"];
        for (word, guess) in [
            ("rotation", Some("rotate")),
            ("positon", Some("position")),
            ("front", Some("front view")),
            ("scales", Some("scale")),
            ("curve", Some("curvature")),
            ("relation", None),
            ("osition", Some("position")),
            ("scene", None),
            ("up", None),
            ("p", None),
            ("", None),
        ] {
            assert_eq!(like(word, known.into_iter()), guess, "{word}");
        }
        assert_eq!(nearest("hat", ["cow"].into_iter()).as_deref(), Some("there is \"cow\""));
    }

    #[test]
    fn a_problem_at_another_path_forgets_the_address_of_the_old_one() {
        let problem = Problem { address: Some("layers.cow".into()), ..Problem::error("/layers/0", "is odd") };
        assert_eq!(problem.to_string(), "layers.cow: is odd");
        assert_eq!(problem.clone().under("/a").to_string(), "a.layers.0: is odd");
        assert_eq!(problem.at("").to_string(), "is odd");
    }
}
