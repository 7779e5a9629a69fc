//! `plica measure`: how what is drawn on a surface moves with it, in numbers.

use std::fmt::Write;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::{Context, opened::Opened, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::number;
use crate::base::problem::quoted;
use crate::layers::parts::measures::{Figures, Measures, Moved};
use crate::render::{self, stage::Stage};
use crate::scene::Scene;

/// Measure how strokes move with their surface, with each anchor
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Measure strokes: how flat they are, and how they go with the surface while the camera moves
    #[arg(long, required = true)]
    strokes: bool,
    /// Name of the layer [default: the first that has strokes]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// How many steps the camera goes in each way
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=64))]
    steps: u32,
    /// Print a JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Prints the measures.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let opened = Opened::new(&args.scene, &args.options, context)?;
    let scene = opened.document.scene();
    let making = render::making(scene, &opened.materials);
    let moment = Stage::of(scene).moment(0.0, making.size_px);
    for index in wanted(scene, args.layer.as_deref())? {
        let layer = scene.layers[index].technique();
        let (cancel, messages) = (context.cancel.clone(), &mut context.messages);
        let mut step = |done: u64, total: u64| {
            messages.step("frame", done, total);
            !cancel.load(std::sync::atomic::Ordering::Relaxed)
        };
        let found = layer.measure(&making, &moment, args.steps, &mut step);
        context.check_cancelled()?;
        let found = found.map_err(|problem| opened.failed(problem.under(&format!("/layers/{index}"))))?;
        if let Some(found) = found {
            let text = if args.json { object(layer.name(), &found).to_string() } else { table(layer.name(), &found) };
            return context.print(text);
        }
    }
    Err(match &args.layer {
        Some(name) => Error::at("--layer", format!("the layer {} has no strokes", quoted(name))),
        None => Error::at(args.scene.display(), "no layer has strokes").cure("plica style apply draws one with them"),
    })
}

/// The layers that may be measured: the one of this name, or all.
fn wanted(scene: &Scene, name: Option<&str>) -> Result<Vec<usize>> {
    match name {
        Some(name) => Ok(vec![scene.layer_called(name).map_err(|why| Error::at("--layer", why))?]),
        None => Ok((0..scene.layers.len()).collect()),
    }
}

/// Six decimals tell more than enough.
fn told(value: Option<f64>) -> Value {
    value.map_or(Value::Null, |value| number::json(number::rounded(value, 6)))
}

fn object(layer: &str, found: &Measures) -> Value {
    let moved = |Moved { coherence, slide, continuity }: &Moved| json!({ "coherence": told(*coherence), "slide": told(*slide), "continuity": told(*continuity) });
    let figures = |figures: &Figures| {
        let mut object = json!({ "flatness": told(figures.flatness) });
        figures.moves.iter().for_each(|(name, figures)| object[*name] = moved(figures));
        object
    };
    let mut anchors = json!({});
    found.ways.iter().for_each(|(name, own)| anchors[*name] = figures(own));
    json!({ "layer": layer, "noise": found.of, "anchors": anchors })
}

/// What the numbers mean, after the table. The first is of people who were asked.
const READING: &str = "flatness    1: of the same size everywhere in the frame; the eye is not sure about it
coherence   1: goes with the surface; people like best what does (rank correlation 0.58)
slide       px that it slides over the surface in a step
continuity  1: nothing but motion happens; below, it fades, pops or boils, which people notice at once";

fn table(layer: &str, found: &Measures) -> String {
    let mut text = format!("layer {}, noise {}\n{:<9}{:>9}", quoted(layer), quoted(&found.of), "", "flatness");
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2}"));
    let moves = found.ways.first().map_or(&[] as &[_], |(_, figures)| &figures.moves);
    for (name, _) in moves {
        let _ = write!(text, "{:>16}{:>7}{:>12}", format!("{name}: coherence"), "slide", "continuity"); // text takes everything
    }
    for (name, figures) in &found.ways {
        let _ = write!(text, "\n{name:<9}{:>9}", number(figures.flatness));
        for (_, Moved { coherence, slide, continuity }) in &figures.moves {
            let _ = write!(text, "{:>16}{:>7}{:>12}", number(*coherence), number(*slide), number(*continuity));
        }
    }
    format!("{text}\n\n{READING}")
}
