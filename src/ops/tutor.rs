//! `plica tutor`: a first animation in the terminal editor, step by step. As with `plica edit`, the editor is a layer
//! above the subcommands; what is here is for the command line, completions and the manual.

/// Learn the terminal editor: a first animation, step by step
#[derive(clap::Args)]
pub struct Args {}
