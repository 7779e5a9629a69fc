//! `plica sprites`: the pictures that the sprites of a layer show, as files; or the automatic choice of them as picks.

use std::path::PathBuf;
use std::time::Instant;

use super::writing::Replacing;
use super::{Context, opened::Unloaded, scene_options::SceneOptions};
use super::{scene_options::RecoveryOptions, set};
use crate::base::error::{Error, Result};
use crate::base::problem;
use crate::base::text::counted;
use crate::export::album;
use crate::files::outputs;
use crate::layers::parts::album::Album;
use crate::scene::{Document, Edit, Scene};

/// Write the pictures of a waterfall's sprites, or take their automatic choice into the scene
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Name of the layer [default: the first with sprites]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// The folder for the pictures, sheet.png and sprites.json; created if missing
    #[arg(short, long, value_name = "DIR", conflicts_with = "take")]
    output: Option<PathBuf>,
    /// Also write this many pictures between each two keys
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..100))]
    between: u32,
    /// Write the automatic choice into the scene as picks, to be changed by hand
    #[arg(long)]
    take: bool,
    #[command(flatten)]
    replacing: Replacing,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    options: SceneOptions,
}

/// Writes the pictures, or the picks.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let begun = Instant::now();
    if args.take {
        set::refuse_input(&args.scene)?;
    } else if args.output.is_none() {
        let what = "sprites: name a folder for the pictures by -o DIR, or take the choice into the scene by --take";
        return Err(Error::Usage(what.into()));
    }
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let mut place = None;
    if let Some(folder) = &args.output {
        let mut guard = args.replacing.guard(&args.scene, read.document.scene(), context);
        place = Some(guard.folder(folder, &album::may_be, album::earlier(folder))?);
        context.say_all(&guard.notes());
    }
    let opened = read.load(context)?;
    let synth = opened.synth()?;
    context.check_cancelled()?;
    let layers = opened.document.scene().layers.iter().map(|layer| layer.technique().name()).zip(&synth.layers);
    let named = layers.enumerate().filter(|(_, (name, _))| args.layer.as_deref().is_none_or(|layer| layer == *name));
    let mut albums = named.filter_map(|(i, (_, ready))| Some((i, ready.album(args.between as usize)?)));
    let (layer, found) =
        albums.next().ok_or_else(|| none(opened.document.scene(), args.layer.as_deref(), "sprites"))?;
    match (&args.output, place) {
        (Some(folder), Some(place)) => {
            let names = album::write(&found, &place)?;
            let files: Vec<_> = names.iter().map(|name| folder.join(name)).collect();
            let what = format!("{}, {}", folder.display(), counted(files.len(), "file"));
            context.done(&what, outputs::size(files.iter().map(PathBuf::as_path)), begun);
            Ok(())
        }
        _ => take(&args, layer, &found, context),
    }
}

/// The error that no layer, or not the one that is named, has something.
pub fn none(scene: &Scene, name: Option<&str>, what: &str) -> Error {
    match name.map(|name| (name, scene.layer_called(name))) {
        Some((_, Err(why))) => Error::at("--layer", why),
        Some((name, Ok(_))) => Error::at("--layer", format!("the layer {} has no {what}", problem::quoted(name))),
        None => Error::Usage(format!("no layer of the scene has {what}")),
    }
}

/// The edit that turns the automatic choice of a layer into picks.
pub fn taken(document: &Document, layer: usize, album: &Album) -> Edit {
    let edit = |(path, value): &(String, serde_json::Value)| {
        Edit::set(document, &format!("/layers/{layer}{path}"), value.clone())
    };
    Edit::all(album.taken.iter().map(edit))
}

fn take(args: &Args, layer: usize, album: &Album, context: &mut Context) -> Result<()> {
    if album.taken.is_empty() {
        context.messages.say("nothing to take: sprites.picks and sprites.sheets have all sprites already");
        return Ok(());
    }
    let make = |document: &Document| Ok(taken(document, layer, album));
    let elsewhere = set::change(&args.scene, (&args.recovery, &args.options), make)?;
    context.messages.say(if elsewhere {
        "taken in the editor that has the scene open; save it there"
    } else {
        "the automatic choice is in sprites.picks now"
    });
    Ok(())
}
