//! Comparisons in expressions, and what joins them.

use super::{Mistake, Parser, is_of_name};

/// The signs that compare; numbers that differ by less than a person writes are equal.
const COMPARISONS: &[(&str, fn(f64, f64) -> bool)] = &[
    ("<=", |a, b| a <= b || same(a, b)),
    (">=", |a, b| a >= b || same(a, b)),
    ("==", same),
    ("!=", |a, b| !same(a, b)),
    ("<", |a, b| a < b && !same(a, b)),
    (">", |a, b| a > b && !same(a, b)),
];

fn same(a: f64, b: f64) -> bool {
    const LEAST: f64 = 1e-9;
    (a - b).abs() < LEAST
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

impl Parser<'_> {
    /// Takes a word if it is the next one.
    fn word(&mut self, wanted: &str) -> bool {
        self.space();
        let found = self.rest().strip_prefix(wanted).is_some_and(|rest| !rest.starts_with(is_of_name));
        self.at += if found { wanted.len() } else { 0 };
        found
    }

    /// One or more that are joined by `or`; all of them are read, also when the first holds.
    pub(super) fn any(&mut self) -> Result<f64, Mistake> {
        let mut value = self.all()?;
        while self.word("or") {
            value = truth(self.all()? != 0.0 || value != 0.0);
        }
        Ok(value)
    }

    /// One or more that are joined by `and`.
    fn all(&mut self) -> Result<f64, Mistake> {
        let mut value = self.condition()?;
        while self.word("and") {
            value = truth(self.condition()? != 0.0 && value != 0.0);
        }
        Ok(value)
    }

    /// A sum, or a comparison, after any number of `not`.
    fn condition(&mut self) -> Result<f64, Mistake> {
        let mut turned = false;
        while self.word("not") {
            turned = !turned;
        }
        let negated = |value: f64| if turned { truth(value == 0.0) } else { value };
        if let Some(same) = self.comparison_of_words()? {
            return Ok(negated(truth(same)));
        }
        let left = self.sum()?;
        let Some(holds) = self.comparison() else { return Ok(negated(left)) };
        let right = self.sum()?;
        if self.comparison().is_some() {
            return Err(self.mistake("two are compared at a time: join with and"));
        }
        Ok(negated(truth(holds(left, right))))
    }

    /// Takes a sign that compares.
    fn comparison(&mut self) -> Option<fn(f64, f64) -> bool> {
        self.space();
        let (sign, holds) = COMPARISONS.iter().find(|(sign, _)| self.rest().starts_with(sign))?;
        self.at += sign.len();
        Some(*holds)
    }

    /// `tool == point`, where the name on the left is that of a word; whether it holds.
    fn comparison_of_words(&mut self) -> Result<Option<bool>, Mistake> {
        self.space();
        let start = self.at;
        let name = self.run(is_of_name);
        let Some(&(_, word)) = self.variables.words.iter().find(|(known, _)| *known == name) else {
            self.at = start;
            return Ok(None);
        };
        self.space();
        let equal = match self.rest().get(..2) {
            Some("==") => true,
            Some("!=") => false,
            _ => return Err(self.mistake(format!("expected == or !=: {name} is a word"))),
        };
        self.at += 2;
        self.space();
        let quoted = self.take('"');
        let other = self.run(|c| if quoted { c != '"' } else { is_of_name(c) || c == '-' });
        if quoted && !self.take('"') {
            return Err(self.mistake("expected `\"`"));
        }
        Ok(Some((word == other) == equal))
    }
}
