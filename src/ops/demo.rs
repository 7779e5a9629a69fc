//! `plica demo`: a scene that ships with the program, unpacked into a folder that is kept. The command line opens it in
//! the editor if there is a terminal for it.

use std::path::PathBuf;

use super::Context;
use crate::base::error::Result;
use crate::files::outputs;
use crate::files::profiles::{self, Profile};

/// Open a built-in demo scene
#[derive(clap::Args)]
pub struct Args {
    /// The demo to open
    #[arg(default_value = profiles::TABLE[0].name)]
    name: String,
    /// Where to unpack it; an existing scene there is opened unchanged
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// List the demo scenes
    #[arg(long)]
    pub list: bool,
}

impl Args {
    /// Unpacks the scene and returns its path.
    ///
    /// # Errors
    /// If the name is unknown or the folder cannot be written.
    pub fn unpack(&self) -> Result<PathBuf> {
        let profile = profiles::find(&self.name)?;
        self.output.iter().try_for_each(|folder| outputs::no_stream(folder))?;
        profile.unpack(&self.output.clone().unwrap_or_else(|| profile.scratch()))
    }
}

/// Lists the demo scenes, or unpacks one and says where and what to type next.
///
/// # Errors
/// As [`Args::unpack`].
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    if args.list {
        let mut row = |profile: &Profile| context.print(format_args!("{:<10}{}", profile.name, profile.help));
        return profiles::TABLE.iter().try_for_each(&mut row);
    }
    let scene = args.unpack()?;
    context.print(scene.display())?;
    let next = if cfg!(feature = "tui") { ("edit", "") } else { ("render", " -o demo.gif") };
    let path = quoted(&scene.display().to_string());
    context.messages.say(&format!("It stays there until you delete it. Next: plica {} {path}{}", next.0, next.1));
    Ok(())
}

/// A path as it is typed in a shell.
pub fn quoted(path: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+@%".contains(c);
    if path.chars().all(plain) { path.to_owned() } else { format!("'{}'", path.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_quoted_where_a_shell_needs_it() {
        for (path, typed) in [("/a/b-1.json", "/a/b-1.json"), ("/a b", "'/a b'"), ("it's", r"'it'\''s'")] {
            assert_eq!(quoted(path), typed);
        }
    }
}
