//! Scripts: files of lines that the editor runs one after the other, as if they were typed after `:`. They run between
//! events, so that keys never wait for a long script. A mistake ends them.

use crate::base::error::{Error, Result};

/// How deep scripts may run scripts.
const DEEPEST: usize = 16;

/// The scripts that are running, the innermost last.
#[derive(Debug, Default)]
pub struct Scripts {
    running: Vec<Script>,
    /// The next line, with its place, if it waits for what is shown.
    held: Option<(String, String)>,
    /// The place of the line whose long work is still running.
    pub waits: Option<String>,
}

#[derive(Debug)]
struct Script {
    file: String,
    lines: Vec<String>,
    next: usize,
}

impl Scripts {
    /// Begins a script; the one that is running continues after it.
    ///
    /// # Errors
    /// Scripts run one another endlessly.
    pub fn begin(&mut self, file: &str, text: &str) -> Result<()> {
        if self.running.len() >= DEEPEST {
            let what = format!("there are {DEEPEST} scripts inside one another already");
            return Err(Error::at(file, what).cure("let none of them run itself"));
        }
        self.running.push(Script { file: file.into(), lines: text.lines().map(str::to_owned).collect(), next: 0 });
        Ok(())
    }

    /// The next line, and its place as FILE:LINE. Comments (`#`) and blank lines are skipped.
    pub fn next(&mut self) -> Option<(String, String)> {
        if let Some(held) = self.held.take() {
            return Some(held);
        }
        while let Some(script) = self.running.last_mut() {
            while let Some(line) = script.lines.get(script.next) {
                script.next += 1;
                let line = line.trim();
                if !line.is_empty() && !line.starts_with('#') {
                    return Some((format!("{}:{}", script.file, script.next), line.to_owned()));
                }
            }
            self.running.pop();
        }
        None
    }

    /// Takes a line back, which comes next again.
    pub fn hold(&mut self, place: String, line: String) {
        self.held = Some((place, line));
    }

    /// Whether a line was taken back.
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// Whether nothing is left to run.
    pub fn is_empty(&self) -> bool {
        self.running.is_empty() && self.waits.is_none() && self.held.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_with_their_places() {
        let mut scripts = Scripts::default();
        scripts.begin("a", "# first\n\n  move down \nput 5\n").unwrap();
        let place = |scripts: &mut Scripts| scripts.next().map(|(place, line)| format!("{place} {line}"));
        assert_eq!(place(&mut scripts).as_deref(), Some("a:3 move down"));
        scripts.begin("b", "undo").unwrap();
        assert_eq!(place(&mut scripts).as_deref(), Some("b:1 undo"));
        assert_eq!(place(&mut scripts).as_deref(), Some("a:4 put 5"));
        assert_eq!(place(&mut scripts), None);
        assert!(scripts.is_empty());
        scripts.hold("a:4".into(), "put 5".into());
        assert!(scripts.holds() && !scripts.is_empty());
        assert_eq!(place(&mut scripts).as_deref(), Some("a:4 put 5"));
        assert!(scripts.is_empty());
    }

    #[test]
    fn a_script_that_runs_itself_ends() {
        let mut scripts = Scripts::default();
        let begun = (0..100).take_while(|_| scripts.begin("a", "source a").is_ok()).count();
        assert_eq!(begun, DEEPEST);
    }
}
