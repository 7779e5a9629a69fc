//! `plica view`: the preview window alone. It joins the editor that has the scene open, else follows the file.

use std::path::PathBuf;

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::files::materials;
use crate::preview::{client, window};

/// Open the preview window
#[derive(clap::Args)]
pub struct Args {
    /// The scene
    pub scene: PathBuf,
    /// Close with the editor that opened the window
    #[arg(long, hide = true)]
    pub joined: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Runs the window until it is closed.
///
/// # Errors
/// There is no display, or nothing that can draw on it. A broken scene is no error: the window says what is wrong and
/// waits until it is mended.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let options = args.options.options()?;
    if !args.joined && !args.scene.exists() {
        return Err(Error::at(args.scene.display(), "there is no such scene").cure("plica edit PICTURE makes one"));
    }
    let link = client::follow(&args.scene, &options, args.joined);
    let (path, mut cache) = (args.scene.clone(), materials::Cache::default());
    window::run(window::Setup {
        title: format!("{} - plica", args.scene.file_name().unwrap_or_default().to_string_lossy()),
        updates: link.updates,
        replies: link.replies,
        cancel: context.cancel.clone(),
        load: Box::new(move |scene| materials::gather(&path, scene, &options, &mut cache)),
    })
}
