//! The whole command line, as clap knows it: the top of the program parses it, completions and the manual print it.

use std::path::PathBuf;

use super::Command;

const EXAMPLES: &str = "\
Examples:
  plica edit photo.png                       make a scene beside the picture and edit it
  plica demo                                 open a built-in demo scene
  plica render scene.plica.json -o eye.gif   write the animation";

/// Animates still pictures from the keyboard.
#[derive(clap::Parser)]
#[command(name = "plica", version, about, after_help = EXAMPLES)]
pub struct CommandLine {
    /// Write the log here instead of to the state folder
    #[arg(long, global = true, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// What to do; `None` prints the short help.
    #[command(subcommand)]
    pub command: Option<Command>,
}
