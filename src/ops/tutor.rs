//! `plica tutor`: a first animation in the terminal editor, step by step. Like `plica edit` it stands above the
//! subcommands: what is here is for the command line, completions and the manual.

/// Learn the terminal editor: a first animation, step by step
#[derive(clap::Args)]
pub struct Args {}
