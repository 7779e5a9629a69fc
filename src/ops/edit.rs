//! `plica edit`: the arguments of the terminal editor. The editor itself is a layer above the subcommands, since it
//! runs them; what is here is for the command line, completions and the manual.

use std::path::PathBuf;

use super::scene_options::{RecoveryOptions, SceneOptions};

/// Edit a scene, a picture or a model in the terminal
#[derive(clap::Args)]
pub struct Args {
    /// A scene; or a picture or a model: its scene is the one beside it, which is made if missing
    #[arg(value_name = "SCENE | PICTURE | MODEL")]
    pub path: PathBuf,
    /// Do not open the preview window
    #[arg(long)]
    pub no_view: bool,
    /// Open without changing anything: no lock, no journal
    #[arg(long)]
    pub read_only: bool,
    /// First run the lines of a file or of a pipe, as `:source` does; if the output is not a terminal or TERM is dumb, do
    /// nothing else
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// How the picture is shown in the terminal: auto asks the terminal
    #[arg(long, value_name = "PROTOCOL", default_value = "auto", value_parser = ["auto", "kitty", "iterm2", "sixel", "blocks"])]
    pub graphics: String,
    /// Unsaved edits that a session left behind.
    #[command(flatten)]
    pub recovery: RecoveryOptions,
    /// How files are read.
    #[command(flatten)]
    pub scene: SceneOptions,
}
