//! `plica field`: the vector field of a scene or a zone as a plot or a table.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Deserialize;
use serde_json::Value;

use super::writing::Replacing;
use super::{Context, opened::Unloaded, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::problem::nearest;
use crate::export::field::{PlotLook, arrows, csv, overlays_of_fields, plot, png, svg};
use crate::files::draft::DraftFile;
use crate::files::outputs::{self, Kind};
use crate::files::write;
use crate::layers::parts::vectors::VectorLook;
use crate::render;
use crate::scene::{Document, Scene, named};

/// Plot the jump vectors, or write them as a table
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Only this zone: its name, or LAYER.ZONE if the name is not unique
    #[arg(long, value_name = "ZONE")]
    zone: Option<String>,
    /// An arrow or a row every N pixels; without it as many arrows as fit, and a row for every pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    step: Option<u32>,
    /// What a plot shows: arrows, streamlines or colors, or several
    #[arg(long, value_name = "WHAT", value_delimiter = ',', value_parser = overlay)]
    show: Vec<&'static str>,
    /// How a plot draws vectors: color=plain|direction|length|divergence|curl, length=TIMES, equal=on, longest=PX, steepest=N,
    /// opacity=N, as :vectors in the editor
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    look: Vec<String>,
    /// Leave the faint picture out of a plot
    #[arg(long)]
    no_picture: bool,
    /// Leave the legend out of a plot
    #[arg(long)]
    no_legend: bool,
    /// Where to: .svg and .png are plots, .csv is x,y,dx,dy,length,degrees, - writes the table to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    replacing: Replacing,
    #[command(flatten)]
    options: SceneOptions,
}

/// Writes the plot or the table.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let begun = Instant::now();
    let kind = kind(&args.output)?;
    let mut vectors = VectorLook::default();
    args.look.iter().try_for_each(|word| vectors.set(word)).map_err(|why| Error::Usage(format!("--look: {why}")))?;
    let to_stream = args.output == Path::new("-");
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let mut guard = args.replacing.guard(&args.scene, read.document.scene(), context);
    let place = if to_stream { None } else { Some(guard.file(&args.output, kind)?) };
    context.say_all(&guard.notes());
    let opened = read.load(context)?;
    let scene = match &args.zone {
        Some(name) => only_zone(&opened.document, name)?,
        None => Scene::clone(opened.document.scene()),
    };
    let synth = render::synth(&scene, &opened.materials, None).map_err(|problem| opened.failed(problem))?;
    context.check_cancelled()?;
    let step = args.step.map(|step| step as usize);
    // Bytes per row of the table, as numbers and as text.
    const ROW: u64 = 160;
    let every = if kind == outputs::CSV { step.unwrap_or(1) as u64 } else { u64::MAX };
    let rows = (synth.size.0 as u64).div_ceil(every) * (synth.size.1 as u64).div_ceil(every);
    let _share = opened.materials.budget.take(rows.saturating_mul(ROW), args.output.display())?;
    let Args { no_picture, no_legend, .. } = args;
    let plot = || plot(&scene, &synth, &PlotLook { step, overlays: args.show.clone(), vectors, no_picture, no_legend });
    if synth.layers.iter().all(|layer| layer.fields().is_empty()) {
        context.messages.say("no layer has a vector field, so there are no arrows and no rows");
    }
    let bytes = if kind == outputs::CSV {
        csv(&arrows(&synth, step.unwrap_or(1))).into_bytes()
    } else if kind == outputs::SVG {
        svg(&plot())?.into_bytes()
    } else {
        png(&plot())?
    };
    context.check_cancelled()?;
    match place {
        None => {
            context.out.write_all(&bytes).map_err(|e| write::failed("standard output", &e))?;
            context.done("standard output", bytes.len() as u64, begun);
        }
        Some(place) => {
            let mut draft = DraftFile::create(&place)?;
            draft.write_all(&bytes).map_err(|e| write::failed(args.output.display(), &e))?;
            draft.keep()?;
            context.done(&args.output.display().to_string(), outputs::size([place.path()]), begun);
        }
    }
    Ok(())
}

/// The overlay that a word of `--show` stands for.
fn overlay(word: &str) -> std::result::Result<&'static str, String> {
    let known = || overlays_of_fields().filter_map(|overlay| Some((overlay.legend?.word(), overlay.name)));
    let found = known().find(|(own, _)| *own == word).map(|(_, name)| name);
    found.ok_or_else(|| nearest(word, known().map(|(own, _)| own).collect::<Vec<_>>().into_iter()).unwrap_or_default())
}

fn kind(path: &Path) -> Result<Kind> {
    if path == Path::new("-") {
        return Ok(outputs::CSV);
    }
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => Ok(outputs::SVG),
        Some("png") => Ok(outputs::PNG),
        Some("csv") => Ok(outputs::CSV),
        _ => Err(Error::Usage(format!("{}: a field is written as .svg, .png or .csv", path.display()))),
    }
}

/// The scene with no zone but the one called `name`: of every layer's list of things with names, only that.
fn only_zone(document: &Document, name: &str) -> Result<Scene> {
    let called = |layer: &str, zone: &str| zone == name || format!("{layer}.{zone}") == name;
    let mut names = Vec::new();
    let mut found = 0;
    let mut json = document.json().clone();
    for layer in json.get_mut("layers").and_then(Value::as_array_mut).into_iter().flatten() {
        let own = named::name_of(Some(layer)).unwrap_or_default();
        let lists = layer.as_object_mut().into_iter().flat_map(|fields| fields.values_mut());
        for list in lists.filter_map(Value::as_array_mut) {
            let all: Option<Vec<String>> = list.iter().map(|item| named::name_of(Some(item))).collect();
            names.extend(all.into_iter().flatten());
            list.retain(|item| named::name_of(Some(item)).is_none_or(|zone| called(&own, &zone)));
            found += list.iter().filter(|item| named::name_of(Some(item)).is_some()).count();
        }
    }
    match found {
        1 => Scene::deserialize(json).map_err(|error| Error::at("--zone", error)),
        0 if names.is_empty() => Err(Error::Usage(format!("--zone {name}: the scene has no zones"))),
        0 => Err(Error::Usage(format!("--zone {name}: there is no such zone, only {}", names.join(", ")))),
        _ => Err(Error::Usage(format!("--zone {name}: several layers have one; write LAYER.ZONE"))),
    }
}
