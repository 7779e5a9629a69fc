//! What a person allows a scene to do and to consume.

use super::limits::Limits;
use crate::scene::check::Rules;

/// What a person allows a scene to do and to consume.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// How much a file may take.
    pub limits: Limits,
    /// Whether paths in a scene may leave its folder.
    pub allow_outside: bool,
}

impl Options {
    /// The rules for the check of a scene.
    pub fn rules(&self) -> Rules {
        let Limits { frames, memory, ref counted, .. } = self.limits;
        Rules { allow_outside: self.allow_outside, counted: counted.clone(), frames, memory }
    }

    /// The equivalent command line options, for another process that opens the same scene.
    pub fn arguments(&self) -> Vec<String> {
        let limits = self.limits.settings().into_iter().flat_map(|setting| ["--limit".to_owned(), setting]);
        limits.chain(self.allow_outside.then(|| "--allow-outside".to_owned())).collect()
    }
}
