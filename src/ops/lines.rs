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
    Err(none(read.document.scene(), args.layer.as_deref(), "lines"))
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

/// The width of a column, and of each of three coordinates: a row fits into 80 columns.
const WIDE: usize = 6;
const OF_THREE: usize = 5;

fn header(entries: &[Entry]) -> String {
    let head = |entry: &Entry| {
        let (width, label) = (cell(&entry.value).0, entry.label);
        let unit = if let Value::Coordinates(_, unit) = &entry.value { format!(", {unit}") } else { String::new() };
        format!("{:>width$}", format!("{label}{unit}"))
    };
    columns(entries).map(head).collect::<Vec<_>>().join(" ")
}

/// A number with as many decimals as fit, two at most.
fn of_three(number: f64) -> String {
    let texts = [2, 1, 0].map(|decimals| short(number, decimals));
    texts.iter().find(|text| text.len() <= OF_THREE).unwrap_or(&texts[2]).clone()
}

fn row(entries: &[Entry]) -> String {
    let text = |entry: &Entry| {
        let (width, text) = cell(&entry.value);
        format!("{text:>width$}")
    };
    columns(entries).map(text).collect::<Vec<_>>().join(" ")
}

/// The width of a cell, and what it says.
fn cell(value: &Value) -> (usize, String) {
    match value {
        Value::Coordinates(numbers, _) => {
            let each: Vec<String> = numbers.iter().map(|v| format!("{:>OF_THREE$}", of_three(*v))).collect();
            ((numbers.len() * (OF_THREE + 1)).saturating_sub(1), each.join(" "))
        }
        Value::Index(index) => (OF_THREE, index.to_string()),
        Value::Number(number) => (WIDE, short(*number, 3)),
        Value::Of(word) => (WIDE, word.clone().unwrap_or_default()),
        // Nothing else is told of flow lines.
        Value::Vector(_) | Value::Place(_) | Value::List(_) | Value::Flag { .. } => (WIDE, String::new()),
        Value::Color(_) | Value::Indices(_) | Value::Shares(_) => (WIDE, String::new()),
        Value::Group(_) | Value::Items(_) => (WIDE, String::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_fits_into_a_narrow_terminal_under_its_heads() {
        let entry = |key, value| Entry { key, label: key, value };
        let place = || Value::Coordinates(vec![-12.345_67, 100.0, 0.5], "m");
        let entries = vec![
            entry("line", Value::Index(4000)),
            entry("kind", Value::Of(Some("water".into()))),
            entry("start", place()),
            entry("velocity", Value::Coordinates(vec![-1.234, 0.0, 10.25], "m/s")),
            entry("life", Value::Number(0.123_456)),
            entry("end", place()),
            entry("impact", Value::Number(12.5)),
        ];
        let (head, row) = (header(&entries), row(&entries));
        assert_eq!(head, " line   kind          start, m     velocity, m/s   life            end, m impact");
        assert_eq!(row, " 4000  water -12.3   100   0.5 -1.23     0 10.25  0.123 -12.3   100   0.5   12.5");
        assert!(head.len() == row.len() && row.len() <= 80);
    }
}
