//! Names of numbered files, as patterns: `%04d.png`.

/// A file name, in which the place of a number may be left open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    /// The least number of digits; `None` in a name without a number.
    digits: Option<usize>,
    after: String,
}

impl Pattern {
    /// The pattern in a file's `name`: `%d`, or `%04d` for at least four digits; `%%` is a `%`.
    ///
    /// # Errors
    /// What is wrong with it, in words: more than one number, or something else after a `%`.
    pub fn of(name: &str) -> Result<Pattern, String> {
        let (mut texts, mut digits) = ([String::new(), String::new()], None);
        let mut rest = name.chars();
        while let Some(c) = rest.next() {
            let text = &mut texts[usize::from(digits.is_some())];
            if c != '%' {
                text.push(c);
                continue;
            }
            let mut spec = String::new();
            for c in rest.by_ref() {
                spec.push(c);
                if !c.is_ascii_digit() {
                    break;
                }
            }
            match spec.strip_suffix('d') {
                _ if spec == "%" => text.push('%'),
                Some(_) if digits.is_some() => return Err("the name holds two frame numbers".into()),
                Some(width) => digits = Some(width.parse().unwrap_or(0).clamp(1, 20)),
                None => return Err(format!("\"%{spec}\" is no frame number")),
            }
        }
        let [before, after] = texts;
        Ok(Pattern { before, digits, after })
    }

    /// Whether it names a file for each number.
    pub fn is_numbered(&self) -> bool {
        self.digits.is_some()
    }

    /// What follows the number.
    pub fn after(&self) -> &str {
        &self.after
    }

    /// The name of the file with this number.
    pub fn name(&self, number: u64) -> String {
        match self.digits {
            Some(digits) => format!("{}{number:0digits$}{}", self.before, self.after),
            None => self.before.clone(),
        }
    }
}
