//! `plica views guide`: what a view's own camera sees of the surface without that view, as a picture to paint over.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::beside;
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, encode};
use crate::base::problem::{nearest, quoted};
use crate::export::still;
use crate::files::draft::DraftFile;
use crate::files::{Options, disk, outputs, paths, picture, write};
use crate::layers::parts::shots::Lying;
use crate::ops::opened::Unloaded;
use crate::ops::scene_options::SceneOptions;
use crate::ops::watched::in_pieces;
use crate::ops::writing::Replacing;
use crate::ops::{Context, set};
use crate::render;
use crate::scene::{Document, shots};

/// How far a channel of a pixel may be from the guide's, in codes, where nothing is painted.
const UNPAINTED: u8 = 2;

#[derive(clap::Args)]
pub struct Args {
    /// The view
    name: String,
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first mesh with views]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Where to: a PNG [default: the view's guide, which `changed` names; what is not painted of its picture follows it]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    #[command(flatten)]
    replacing: Replacing,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Draws and writes it.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    set::refuse_input(&args.scene)?;
    let begun = Instant::now();
    let unloaded = Unloaded::read(&args.scene, &args.reading, context)?;
    let mut guard = args.replacing.guard(&args.scene, unloaded.document.scene(), context);
    let place = args.output.as_deref().map(|path| guard.file(path, outputs::PNG)).transpose()?;
    context.say_all(&guard.notes());
    let wrong = |why: String| Error::at(args.scene.display(), why);
    let layer = shots::layer(&unloaded.document, args.layer.as_deref()).map_err(wrong)?;
    let opened = unloaded.load(context)?;
    let technique = opened.document.scene().layers[layer].technique();
    let lying = technique.lying().unwrap_or_default();
    let index = lying.iter().position(|lying| lying.name == args.name).ok_or_else(|| {
        let hint = nearest(&args.name, lying.iter().map(|lying| lying.name));
        let hint = hint.unwrap_or_else(|| "none lies there yet: plica views add lays one".into());
        wrong(format!("there is no view {} ({hint})", quoted(&args.name)))
    })?;
    let synth = opened.synth_told(&mut *context.messages)?;
    let drawn = in_pieces(context, "view", lying.len(), |watch| synth.layers[layer].guide(index, watch))?;
    let drawn =
        drawn.ok_or_else(|| wrong(format!("{} does not count", quoted(&args.name))).cure("set active to true"))?;
    let frame = render::cpu::finish(&drawn);
    if let Some(place) = place {
        let mut draft = DraftFile::create(&place)?;
        let name = place.path().display().to_string();
        draft.write_all(&png(&name, &frame)?).map_err(|e| write::failed(&name, &e))?;
        draft.keep()?;
        context.done(&name, outputs::size([place.path()]), begun);
        return Ok(());
    }
    let told = renew((&args.scene, &opened.document), &lying[index], &frame, &args.reading.options()?)?;
    context.messages.say(&told);
    Ok(())
}

fn png(name: &str, frame: &Frame) -> Result<Vec<u8>> {
    still::frame(frame).map_err(|error| Error::at(name, error))
}

/// Writes the view's guide anew. What is not painted of its picture follows, or all that has changed since would count as paint.
fn renew((scene, document): (&Path, &Document), view: &Lying, frame: &Frame, options: &Options) -> Result<String> {
    let images = &document.scene().images;
    let path = |name: &str| images.get(name).map(|image| image.path.clone()).filter(|path| path.ends_with(".png"));
    let guide = view.guide.and_then(path);
    let name = guide.clone().unwrap_or_else(|| beside::file(view.name, true));
    let (folder, own) = (disk::folder_of(scene), path(view.image));
    let read = |name: &str| picture::read(&paths::beside(scene, name), &options.limits).ok();
    let mut told = format!("{name} is what is seen without {} from its camera", quoted(view.name));
    let painted = own.and_then(|own| Some((read(&own)?, own)));
    if let Some((before, (painted, own))) = guide.as_deref().and_then(read).zip(painted) {
        let [before, painted] = [before, painted].map(|found| found.picture.to_linear());
        let size = (frame.width(), frame.height());
        if [&before, &painted].iter().all(|picture| (picture.width(), picture.height()) == size) {
            let both = before.cells().iter().zip(painted.cells()).zip(frame.cells());
            let cells = both.map(|((before, painted), now)| {
                let (before, painted) = (encode(*before), encode(*painted));
                let is_paint = before.iter().zip(painted).any(|(a, b)| a.abs_diff(b) > UNPAINTED);
                if is_paint { painted } else { *now }
            });
            let renewed = Frame::from_cells(size.0, size.1, cells.collect());
            write::replace_into(folder, &own, &png(&own, &renewed)?)?;
            told = format!("{told}; what is not painted of {own} follows it");
        }
    }
    write::replace_into(folder, &name, &png(&name, frame)?)?;
    Ok(told)
}
