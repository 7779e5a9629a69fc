//! What the window has to say, as a value: how it is connected, how far something is, and all that is wrong.

use std::fmt;

use crate::base::problem::Problem;

/// Something that takes long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// What is being done.
    pub what: &'static str,
    /// Whether it has taken a while already.
    pub is_long: bool,
    /// How far it is then, where that is known.
    pub percent: Option<u8>,
}

impl fmt::Display for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.percent {
            Some(percent) => write!(f, "{}: {percent} %", self.what),
            None => write!(f, "{}", self.what),
        }
    }
}

/// See the top of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words {
    /// How the scene is followed.
    pub notice: Option<String>,
    /// What a key has to say, until the next key or button.
    pub told: Option<String>,
    /// Progress of something that takes long.
    pub progress: Option<String>,
    /// That the picture is not shown as it is.
    pub reduced: Option<String>,
    /// What is wrong with the link, or with the scene as it was read.
    link: Vec<Problem>,
    /// What is wrong with what the scene names, or with its synthesis.
    scene: Vec<Problem>,
    /// The list of problems is closed until there is another problem.
    put_away: bool,
}

impl Words {
    /// Takes what is wrong with the link; an empty list means that all is well again.
    pub fn follow_link(&mut self, problems: Vec<Problem>) {
        self.put_away &= self.link == problems;
        self.link = problems;
    }

    /// Takes what is wrong with the scene that is shown, or was to be.
    pub fn follow_scene(&mut self, problems: Vec<Problem>) {
        self.put_away &= self.scene == problems;
        self.scene = problems;
    }

    /// All that is wrong, the link first.
    pub fn problems(&self) -> impl Iterator<Item = &Problem> {
        self.link.iter().chain(&self.scene)
    }

    /// What the list shows.
    pub fn listed(&self) -> Vec<&Problem> {
        if self.put_away { Vec::new() } else { self.problems().collect() }
    }

    /// Closes the list; returns whether it was shown.
    pub fn put_away(&mut self) -> bool {
        let shown = !self.listed().is_empty();
        self.put_away |= shown;
        shown
    }

    /// What is wrong, in one line, if anything is.
    pub fn in_one_line(&self) -> Option<String> {
        let count = self.problems().count();
        let first = self.problems().next().map(ToString::to_string);
        let first = first.map(|first| if count > 1 { format!("{first} (and {} more)", count - 1) } else { first });
        first.or_else(|| self.reduced.clone())
    }

    /// What the editor is told in one line: what is wrong with the scene (it knows by itself how the link is), or how far a
    /// capture is, or what the last key had to say.
    pub fn for_editor(&self, captures: bool) -> Option<String> {
        let words = Words { link: Vec::new(), ..self.clone() };
        let progress = self.progress.clone().filter(|_| captures);
        words.in_one_line().or(progress).or_else(|| self.told.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_put_away_comes_back_with_the_next_problem() {
        let problem = |path: &str| Problem::error(path, "wrong");
        let mut words = Words::default();
        assert!(!words.put_away() && words.in_one_line().is_none());
        words.follow_scene(vec![problem("/a"), problem("/b")]);
        assert_eq!(words.in_one_line().unwrap(), "a: wrong (and 1 more)");
        assert!(words.put_away() && words.listed().is_empty() && !words.put_away());
        words.follow_scene(vec![problem("/a"), problem("/b")]);
        assert!(words.listed().is_empty(), "the same ones");
        words.follow_link(vec![problem("/c")]);
        assert_eq!(words.listed().len(), 3);
        assert_eq!(words.for_editor(false).as_deref(), Some("a: wrong (and 1 more)"));
        words.follow_link(Vec::new());
        words.follow_scene(Vec::new());
        words.reduced = Some("reduced".into());
        assert_eq!((words.in_one_line().as_deref(), words.listed().len()), (Some("reduced"), 0));
    }
}
