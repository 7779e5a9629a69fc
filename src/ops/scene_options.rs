//! Options of every command that opens a scene.

use crate::base::error::Result;
use crate::files::{self, Limits, limits};

/// What a scene may consume, and which files it may refer to.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct SceneOptions {
    /// Raise or lower a limit; may be given again
    #[arg(long = "limit", value_name = "NAME=VALUE", long_help = limit_help())]
    pub limits: Vec<String>,
    /// Let paths in the scene leave its folder
    #[arg(long)]
    pub allow_outside: bool,
}

impl SceneOptions {
    /// As options for reading files.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::base::error::Error::Usage) if a limit is wrong.
    pub fn options(&self) -> Result<files::Options> {
        Ok(files::Options { limits: Limits::from_settings(&self.limits)?, allow_outside: self.allow_outside })
    }
}

/// What to do about unsaved edits that a session left behind, when nobody can be asked.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct RecoveryOptions {
    /// Take over unsaved edits that a session left behind (keep), or leave the file as it is, with the edits in undo
    /// (drop)
    #[arg(long, value_name = "keep | drop", value_parser = ["keep", "drop"])]
    pub after_recovery: Option<String>,
}

impl RecoveryOptions {
    /// Whether they are taken over; `None` if the option is not given.
    pub fn keep(&self) -> Option<bool> {
        self.after_recovery.as_ref().map(|word| word == "keep")
    }
}

fn limit_help() -> String {
    let rows = limits::TABLE.iter().map(|row| format!("\n  {:<18}{} [{}]", row.name, row.help, row.default));
    format!("Raise or lower a limit; may be given again. A value may end in K, M or G.{}", rows.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        scene: SceneOptions,
    }

    #[test]
    fn limits_come_from_the_command_line() {
        let line = Line::parse_from(["x", "--limit", "side=7", "--limit=pixels=2K", "--allow-outside"]);
        let options = line.scene.options().unwrap();
        assert_eq!((options.limits.side, options.limits.pixels, options.allow_outside), (7, 2048, true));
        assert!(Line::parse_from(["x", "--limit", "side"]).scene.options().is_err());
        assert!(limit_help().contains("memory"));
    }
}
