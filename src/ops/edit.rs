//! `plica edit`: the arguments of the terminal editor. It stands above the subcommands, since it runs them itself: what is
//! here is for the command line, completions and the manual.

use std::path::PathBuf;

use super::scene_options::{RecoveryOptions, SceneOptions};

/// Edit a scene, or a picture, in the terminal.
#[derive(clap::Args)]
pub struct Args {
    /// A scene, or a picture whose scene lies beside it (it is made where it is not there)
    #[arg(value_name = "SCENE | PICTURE")]
    pub path: PathBuf,
    /// Do not open the preview window
    #[arg(long)]
    pub no_view: bool,
    /// Only look: no lock, no journal, nothing is changed
    #[arg(long)]
    pub read_only: bool,
    /// Run the lines of a file at first, as `:source` does; where the output is no terminal or TERM is dumb, nothing else
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// How the picture is shown in the terminal: auto asks it
    #[arg(long, value_name = "PROTOCOL", default_value = "auto", value_parser = ["auto", "kitty", "iterm2", "sixel", "blocks"])]
    pub graphics: String,
    /// Unsaved edits that a session left behind.
    #[command(flatten)]
    pub recovery: RecoveryOptions,
    /// How files are read.
    #[command(flatten)]
    pub scene: SceneOptions,
}
