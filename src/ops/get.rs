//! `plica get`: one value of a scene, or what counts where it is not set, as the editor that has the scene open sees it.

use std::path::PathBuf;

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::files;
use crate::preview::editor::script;
use crate::scene::{address, field};

/// Print a value of a scene
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// What to print: layers.face.zones."left eye".interpolation.radius, or a JSON pointer
    path: String,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Prints the value.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let document = match script::document(&args.scene) {
        Some(document) => document?,
        None => files::scene::open(&args.scene, &args.reading.options()?)?,
    };
    let pointer = address::resolve(&document, &args.path)?;
    let value =
        field::told(&document, &pointer).ok_or_else(|| Error::at(&args.path, "is not set, and has no default"))?;
    let text = crate::scene::json::to_text(&value);
    context.print(text.trim_end())
}
