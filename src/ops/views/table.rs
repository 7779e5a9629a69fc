//! `plica views SCENE`: what the views of a scene tell its view maps.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::base::statistics;
use crate::base::text::short;
use crate::layers::parts::materials::Materials;
use crate::ops::Context;
use crate::ops::opened::Opened;
use crate::ops::scene_options::SceneOptions;
use crate::ops::sprites::none;
use crate::ops::watched::in_pieces;
use crate::scene::{Document, Scene, address};

/// What is listed.
#[derive(clap::Args)]
pub struct Listing {
    /// The scene; - is standard input
    #[arg(required = true)]
    scene: Option<PathBuf>,
    /// Name of the layer [default: all with views]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Print one JSON object per line: the views, then the map
    #[arg(long)]
    json: bool,
    /// Draw each view again from its own camera, and tell how well it comes back
    #[arg(long)]
    compare: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// A view that comes back so many dB worse than the median is probably not seen from where its camera says.
const OFF_DB: f64 = 6.0;
/// One whose share in what is seen from its camera is so much of the usual one is covered by others.
const COVERED: f64 = 0.5;

/// Prints the table or the lines.
pub fn run(args: &Listing, context: &mut Context) -> Result<()> {
    let scene = args.scene.as_ref().ok_or_else(|| Error::Usage("name a scene".into()))?;
    let opened = Opened::new(scene, &args.options, context)?;
    let scene = opened.document.scene();
    let synth = opened.synth_told(&mut *context.messages)?;
    let layers = scene.layers.iter().map(|layer| layer.technique().name()).zip(&synth.layers).enumerate();
    let named = layers.filter(|(_, (name, _))| args.layer.as_deref().is_none_or(|layer| layer == *name));
    let mut any = false;
    for (layer, (name, ready)) in named {
        let rows = match args.compare {
            true => in_pieces(context, "view", count(scene, layer), |watch| ready.lying(Some(watch)))?,
            false => ready.lying(None),
        };
        let Some(rows) = rows else { continue };
        let names = rows.iter().filter_map(|row| row["view"].as_str());
        let width = names.map(|name| name.chars().count()).fold(LEAST_WIDTH, usize::max);
        if !args.json {
            context.print(format!("{}{name}", if any { "\n" } else { "" }))?;
            context.print(head(width, args.compare))?;
        }
        any = true;
        for row in &rows {
            context.print(if args.json { line(name, row) } else { words(row, width) })?;
        }
        off(&rows).for_each(|told| context.messages.say(&told));
        let odd = odd(&opened.document, layer, &opened.materials);
        odd.iter().for_each(|problem| context.messages.say(&problem.to_string()));
    }
    if any { Ok(()) } else { Err(none(scene, args.layer.as_deref(), "views")) }
}

/// How many pictures lie on a layer.
pub fn count(scene: &Scene, layer: usize) -> usize {
    let lying = scene.layers.get(layer).and_then(|layer| layer.technique().lying());
    lying.map_or(0, |lying| lying.len())
}

/// What is odd about how pictures lie on a layer, as far as the files that it names tell.
pub fn odd(document: &Document, layer: usize, materials: &Materials) -> Vec<Problem> {
    let odd = document.scene().layers.get(layer).map(|layer| layer.technique().check_lying(materials));
    let odd = odd.unwrap_or_default().into_iter().map(|problem| problem.under(&format!("/layers/{layer}")));
    odd.map(|problem| address::of_problem(document, &problem)).collect()
}

fn line(layer: &str, row: &Value) -> String {
    let mut line = json!({ "layer": layer });
    if let (Some(line), Some(row)) = (line.as_object_mut(), row.as_object()) {
        line.extend(row.clone());
    }
    line.to_string()
}

/// How wide the names of views are at least.
const LEAST_WIDTH: usize = 16;

fn head(width: usize, compare: bool) -> String {
    let psnr = if compare { "psnr" } else { "" };
    laid_out(["view", "kind", "depth", "pixels", "beyond", "cells by layer", psnr], width)
}

/// A line of the table.
fn laid_out([view, kind, depth, pixels, beyond, cells, psnr]: [&str; 7], width: usize) -> String {
    let line = format!("{view:<width$} {kind:<11} {depth:>6} {pixels:>7} {beyond:>7}  {cells:<24} {psnr}");
    line.trim_end().to_owned()
}

/// A row of the table: a view, or the whole map.
fn words(row: &Value, width: usize) -> String {
    let text = |key: &str| row[key].as_str().unwrap_or_default();
    let number = |value: &Value, decimals: usize| value.as_f64().map_or("-".into(), |v| short(v, decimals));
    let list =
        |value: &Value| -> Vec<String> { value.as_array().into_iter().flatten().map(Value::to_string).collect() };
    if let Some(map) = row.get("map") {
        let cells = [("cells", "cells"), ("known", "known"), ("filled", "filled"), ("entries", "dependent entries")];
        let cells = cells.map(|(key, word)| format!("\n  {word} by layer: {}", list(&map[key]).join(" ")));
        let bytes = map["bytes"].as_f64().unwrap_or_default() / f64::from(1 << 20);
        return format!("charts {}, levels {}, {bytes:.1} MiB{}", map["charts"], map["levels"], cells.concat());
    }
    let told = row["cells"].as_array().into_iter().flatten().map(|layer| {
        let all = layer.as_object().into_iter().flatten().filter_map(|(_, count)| count.as_u64());
        all.sum::<u64>().to_string()
    });
    let told: Vec<String> = told.collect();
    let beyond = format!("{:.0}%", row["beyond"].as_f64().unwrap_or_default() * 100.0);
    let psnr = row.get("psnr").map(|psnr| number(psnr, 1)).unwrap_or_default();
    let (depth, pixels) = (number(&row["depth"], 2), number(&row["pixels"], 0));
    laid_out([text("view"), text("kind"), &depth, &pixels, &beyond, &told.join(" "), &psnr], width)
}

/// What is told of views that come back much worse than the others: by their cameras, or as others are seen in their place.
fn off(rows: &[Value]) -> impl Iterator<Item = String> {
    let median = |key: &str| {
        let mut all: Vec<f64> = rows.iter().filter_map(|row| row[key].as_f64()).collect();
        statistics::median(&mut all).unwrap_or_default()
    };
    let (median, usual) = (median("psnr"), median("share"));
    rows.iter().filter_map(move |row| {
        let psnr = row["psnr"].as_f64().filter(|psnr| *psnr < median - OFF_DB)?;
        let (view, share) = (row["view"].as_str().unwrap_or_default(), row["share"].as_f64().unwrap_or_default());
        let why = match share < usual * COVERED {
            true => format!("from its camera {:.0} % of what is seen are other views", 100.0 * (1.0 - share)),
            false => "its camera is off, or other views show something else there".to_owned(),
        };
        Some(format!("{view}: comes back with {psnr:.1} dB, the median is {median:.1}: {why}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_stands_over_what_is_told() {
        let mut row = json!({ "view": "a", "kind": "both", "depth": 1.5, "pixels": 64, "beyond": 0.25,
            "cells": [{ "both": 7 }, { "both": 30 }] });
        assert_eq!(head(4, false), "view kind         depth  pixels  beyond  cells by layer");
        assert_eq!(words(&row, 4), "a    both           1.5      64     25%  7 30");
        row["psnr"] = json!(38.5);
        for line in [head(4, true), words(&row, 4)] {
            assert_eq!(line.find("psnr").or(line.find("38.5")), Some(66), "{line}");
        }
    }

    #[test]
    fn what_comes_back_badly_is_off_or_covered() {
        let row = |view: &str, psnr: f64, share: f64| json!({ "view": view, "psnr": psnr, "share": share });
        let rows = [row("a", 38.0, 0.9), row("b", 37.0, 0.8), row("off", 20.0, 0.85), row("under", 20.0, 0.1)];
        let told: Vec<String> = off(&[&rows[..], &[row("c", 36.0, 0.9)]].concat()).collect();
        assert_eq!(
            told,
            [
                "off: comes back with 20.0 dB, the median is 36.0: its camera is off, or other views show something else there",
                "under: comes back with 20.0 dB, the median is 36.0: from its camera 90 % of what is seen are other views",
            ]
        );
    }
}
