//! How far the tutor is.

/// The current lesson.
#[derive(Clone, Debug)]
pub struct Tutor {
    /// Its index.
    pub at: usize,
    /// Whether the next lesson follows once this one is done. Not at once if it is looked at again after it was done.
    pub armed: bool,
    /// Long work that has succeeded since the lesson began.
    pub ended: Vec<String>,
}

impl Tutor {
    /// The first lesson.
    pub fn begin() -> Tutor {
        Tutor { at: 0, armed: true, ended: Vec::new() }
    }

    /// Whether long work of this name has succeeded since the lesson began.
    pub fn has_ended(&self, name: &str) -> bool {
        self.ended.iter().any(|work| work.starts_with(name))
    }
}
