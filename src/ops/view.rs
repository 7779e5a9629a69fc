//! `plica view`: the preview window alone. It joins the editor that has the scene open, otherwise follows the file; a
//! scene on another machine is reached through ssh.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::files::cache::Cache;
use crate::files::{Options, materials};
use crate::preview::follow::client::{self, Link};
use crate::preview::remote::address::{Address, SCHEME};
use crate::preview::remote::ssh::Way;
use crate::preview::remote::{far, fetch};
use crate::preview::window;

/// Open the preview window
#[derive(clap::Args)]
pub struct Args {
    /// The scene, here or on another machine
    #[arg(value_name = "SCENE | ssh://[USER@]HOST[:PORT]/PATH")]
    pub scene: PathBuf,
    /// The plica program on the other machine, if it cannot be found [env: PLICA_REMOTE]
    #[arg(long, value_name = "PATH")]
    pub remote_plica: Option<String>,
    /// Close with the editor that opened the window
    #[arg(long, hide = true)]
    pub joined: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Runs the window until it is closed.
///
/// # Errors
/// If there is no display, nothing that can draw on it, or the other machine cannot be reached. A broken scene is no
/// error: the window says what is wrong and waits until it is repaired.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let options = args.options.options()?;
    let most = usize::try_from(options.limits.texture).unwrap_or(usize::MAX);
    let screenshots = screenshots(&args.scene);
    let (name, link, load) = match args.scene.to_str().filter(|text| text.starts_with(SCHEME)) {
        Some(address) => there(Way::to(Address::parse(address)?, args.remote_plica, &options), context)?,
        None => here(&args.scene, args.joined, options)?,
    };
    context.check_cancelled()?;
    window::run(window::Setup {
        // The editor reports problems itself.
        options: window::WindowOptions {
            name,
            screenshots,
            most,
            takes_keyboard: !args.joined,
            complains: !args.joined,
        },
        updates: link.updates,
        replies: link.replies,
        cancel: context.cancel.clone(),
        load,
    })
}

/// What the names of screenshots begin with: they lie beside the scene, or here if that is on another machine.
fn screenshots(scene: &Path) -> PathBuf {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let stem = [".plica.json", ".json"].into_iter().find_map(|end| name.strip_suffix(end)).unwrap_or(&name);
    if scene.to_string_lossy().starts_with(SCHEME) { stem.into() } else { scene.with_file_name(stem) }
}

type Source = (String, Link, window::Load);

fn here(scene: &Path, joined: bool, options: Options) -> Result<Source> {
    if !joined && !scene.exists() {
        return Err(Error::at(scene.display(), "there is no such scene").cure("plica edit PICTURE makes one"));
    }
    let link = client::follow(scene, &options, joined);
    let (path, mut cache) = (scene.to_owned(), materials::Cache::default());
    let load = move |scene: &_, progress| {
        cache.progress = Some(Arc::new(progress));
        materials::gather(&path, scene, &options, &mut cache)
    };
    let name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok((name, link, Box::new(load)))
}

fn there(way: Way, context: &Context) -> Result<Source> {
    let kept = Cache::of_user(&way.options.limits)?;
    let name = format!("{} on {}", way.address.file_name(), way.address.host);
    let (copies, options) = (fetch::Shared::default(), way.options.clone());
    // Ctrl-C at a prompt of ssh ends ssh first.
    if std::io::stderr().is_terminal() {
        // It is no failure if nobody reads it.
        drop(writeln!(std::io::stderr(), "connecting to {} (Ctrl-C gives up)", way.address.host));
    }
    let connected = way.connect(drop).or_else(|error| context.check_cancelled().and(Err(error)))?;
    let link = far::follow(way, connected, kept, copies.clone())?;
    let mut cache = materials::Cache::default();
    let load = move |scene: &_, progress| {
        cache.progress = Some(Arc::new(progress));
        let copies = copies.lock().unwrap_or_else(PoisonError::into_inner).clone();
        materials::gather_copies(&copies, scene, &options, &mut cache)
    };
    Ok((name, link, Box::new(load)))
}
