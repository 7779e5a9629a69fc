//! `plica lines`: the flow lines of a layer, as a table or as JSON.

use std::path::PathBuf;

use super::probe::object;
use super::sprites::none;
use super::{Context, opened::Unloaded, scene_options::SceneOptions};
use crate::base::error::Result;
use crate::base::text::short;
use crate::layers::parts::readout::{Entry, Value};
use crate::layers::technique::Technique;

/// List the flow lines of a waterfall
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Name of the layer [default: the first with lines]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Places along each line, evenly over the life, with both ends
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    samples: u32,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Prints the lines, in order.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let layers = read.document.scene().layers.iter().map(|layer| layer.technique());
    let named = layers.filter(|layer| args.layer.as_deref().is_none_or(|name| layer.name() == name));
    for layer in named {
        if print(layer, &args, context)? {
            return Ok(());
        }
    }
    Err(none(args.layer.as_deref(), "lines"))
}

/// Prints the lines of a layer; whether it has any.
fn print(layer: &dyn Technique, args: &Args, context: &mut Context) -> Result<bool> {
    let mut result = Ok(());
    let mut headed = args.json;
    let samples = if args.json { args.samples as usize } else { 0 };
    let mut each = |entries: Vec<Entry>| {
        if result.is_err() {
            return;
        }
        let text = if args.json { object(&entries).to_string() } else { row(&entries) };
        let header = (!std::mem::replace(&mut headed, true)).then(|| header(&entries));
        result = header.map_or(Ok(()), |header| context.print(header)).and_then(|()| context.print(text));
    };
    let has = layer.flow_lines(samples, &mut each);
    result.map(|()| has)
}

/// The entries that a table has.
fn columns(entries: &[Entry]) -> impl Iterator<Item = &Entry> {
    entries.iter().filter(|entry| !matches!(entry.value, Value::Items(_)))
}

fn header(entries: &[Entry]) -> String {
    let heads = columns(entries).map(|entry| match &entry.value {
        Value::Coordinates(..) => format!("{:>26}", entry.key),
        _ => format!("{:>8}", entry.key),
    });
    heads.collect::<Vec<_>>().join(" ")
}

fn row(entries: &[Entry]) -> String {
    let cells = columns(entries).map(|entry| match &entry.value {
        Value::Coordinates(numbers, _) => {
            numbers.iter().map(|v| format!("{:>8}", short(*v, 3))).collect::<Vec<_>>().join(" ")
        }
        Value::Number(number) => format!("{:>8}", short(*number, 4)),
        Value::Index(index) => format!("{index:>8}"),
        Value::Of(Some(word)) => format!("{word:>8}"),
        _ => format!("{:>8}", ""),
    });
    cells.collect::<Vec<_>>().join(" ")
}
