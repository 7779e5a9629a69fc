//! The line at the bottom where commands and searches are typed, with completion and history.

use super::input::Text;

/// A line being typed.
#[derive(Clone, Debug)]
pub struct Line {
    /// `:` or `/`.
    pub kind: char,
    /// What has been typed.
    pub text: Text,
    /// How far back in the history the line is, and what was typed before.
    recalled: Option<(usize, String)>,
    /// What the last completion offered, and which of these is shown.
    offered: Option<(Vec<String>, usize)>,
}

impl Line {
    /// An empty line.
    pub fn new(kind: char) -> Self {
        Line { kind, text: Text::default(), recalled: None, offered: None }
    }

    /// A command line that begins with `text`.
    pub fn with(text: &str) -> Self {
        Line { text: Text::new(text, false), ..Line::new(':') }
    }

    /// What the completion offers, and which of these is shown.
    pub fn offered(&self) -> Option<(&[String], usize)> {
        self.offered.as_ref().map(|(all, at)| (all.as_slice(), *at))
    }

    /// Forgets the completion and the place in the history, because something was typed.
    pub fn typed(&mut self) {
        self.offered = None;
        self.recalled = None;
    }

    /// Goes to an older (1) or newer (-1) line of `lines`.
    pub fn recall(&mut self, lines: &[String], older: i64) {
        let (back, typed) = self.recalled.clone().unwrap_or((0, self.text.value().to_string()));
        let back = (back as i64 + older).clamp(0, lines.len() as i64) as usize;
        let line = if back == 0 { typed.clone() } else { lines[lines.len() - back].clone() };
        self.text = Text::new(line, false);
        self.recalled = Some((back, typed));
    }

    /// Shows the next of the `candidates` for the line, or of those already offered.
    pub fn complete(&mut self, candidates: impl FnOnce(&str) -> Vec<String>) {
        let (all, at) = match self.offered.take() {
            Some((all, at)) if !all.is_empty() => {
                let next = (at + 1) % all.len();
                (all, next)
            }
            _ => (candidates(self.text.value()), 0),
        };
        if let Some(line) = all.get(at) {
            self.text = Text::new(line.clone(), false);
        }
        self.offered = Some((all, at));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn history_and_back() {
        let lines = ["w".to_string(), "set a=1".to_string()];
        let mut line = Line::new(':');
        line.text.insert("q");
        for (older, expected) in [(1, "set a=1"), (1, "w"), (1, "w"), (-1, "set a=1"), (-1, "q"), (-1, "q")] {
            line.recall(&lines, older);
            assert_eq!(line.text.value(), expected);
        }
    }

    #[test]
    fn completion_goes_round() {
        let mut line = Line::new(':');
        line.text.insert("r");
        for expected in ["redo", "render", "redo"] {
            line.complete(|_| vec!["redo".into(), "render".into()]);
            assert_eq!(line.text.value(), expected);
        }
        line.typed();
        assert_eq!(line.offered(), None);
    }
}
