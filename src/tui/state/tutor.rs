//! How far the tutor is.

/// The lesson that is on.
#[derive(Clone, Debug)]
pub struct Tutor {
    /// Which one, from 0.
    pub at: usize,
    /// Whether it is over once it is done: not while one that was done before is looked at again.
    pub armed: bool,
    /// Long work that ended well since then.
    pub ended: Vec<String>,
}

impl Tutor {
    /// The first lesson.
    pub fn begin() -> Tutor {
        Tutor { at: 0, armed: true, ended: Vec::new() }
    }

    /// Whether long work of this name ended well since the lesson began.
    pub fn has_ended(&self, name: &str) -> bool {
        self.ended.iter().any(|work| work.starts_with(name))
    }
}
