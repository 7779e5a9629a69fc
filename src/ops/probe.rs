//! `plica probe`: what pixels do, and why: zone, jump vector, thresholds, time, place, and what they read and show.

use std::path::PathBuf;

use serde_json::json;

use super::{Context, opened::Opened, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::maths;
use crate::layers::Layer;
use crate::layers::folding::model::PictureLayer;
use crate::layers::folding::probe::{Probe, probe};
use crate::scene::Scene;

/// Show what a pixel does at a time, and why
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// The pixel that holds the point X,Y; may be given again. The centre of the top-left pixel is 0.5,0.5
    #[arg(long, value_name = "X,Y", required = true, allow_hyphen_values = true, value_parser = parse_point)]
    at: Vec<[f64; 2]>,
    /// Scene time, 0 to 1
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_hyphen_values = true, value_parser = parse_time)]
    time: f64,
    /// Name of the layer [default: the first]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Prints one answer per `--at`, in order.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let opened = Opened::new(&args.scene, &args.options, context)?;
    let scene = opened.document.scene();
    let layer = find_layer(scene, args.layer.as_deref())?;
    // Only what the pixel needs is computed, not the whole frame.
    let shown = opened.bands(1)?;
    let picture = opened.materials.picture(&layer.image, "/image").map_err(|e| Error::at(args.scene.display(), e))?;
    let size = (picture.width(), picture.height());
    let pixels = args.at.iter().map(|at| pixel_at(*at, size)).collect::<Result<Vec<_>>>()?;
    for pixel in pixels {
        let probe = probe(layer, scene.timeline.wrap, &opened.materials, pixel, args.time);
        let probe = probe.map_err(|problem| Error::at(args.scene.display(), problem))?;
        // A layer larger than the first reaches beyond the frame, which shows nothing there.
        let color = shown.pixel(args.time, pixel).map_err(|problem| opened.failed(problem))?;
        let answer =
            if args.json { line(probe.as_ref(), color) } else { prose(probe.as_ref(), color, pixel, args.time) };
        context.print(answer)?;
    }
    Ok(())
}

fn find_layer<'a>(scene: &'a Scene, name: Option<&str>) -> Result<&'a PictureLayer> {
    let found = scene.layers.iter().find(|layer| name.is_none_or(|name| layer.technique().name() == name));
    match found {
        Some(Layer::Picture(layer)) => Ok(layer),
        None => {
            let names: Vec<&str> = scene.layers.iter().map(|layer| layer.technique().name()).collect();
            let wanted = name.unwrap_or("the first");
            Err(Error::at("--layer", format!("there is no layer {wanted}; there are: {}", names.join(", "))))
        }
    }
}

fn parse_point(text: &str) -> std::result::Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
        Some((Some(x), Some(y))) => Ok([x, y]),
        _ => Err("expected two numbers, as 150.5,100.5".into()),
    }
}

fn parse_time(text: &str) -> std::result::Result<f64, String> {
    let time = text.parse::<f64>().ok().filter(|time| time.is_finite());
    time.ok_or_else(|| "expected a number from 0 to 1".into())
}

/// The pixel that holds a point.
fn pixel_at([x, y]: [f64; 2], (width, height): (usize, usize)) -> Result<(usize, usize)> {
    let within = |v: f64, n: usize| (v >= 0.0 && v < n as f64).then_some(v as usize);
    match (within(x, width), within(y, height)) {
        (Some(column), Some(row)) => Ok((column, row)),
        _ => Err(Error::at(format!("--at {x},{y}"), format!("outside the picture of {width} x {height} pixels"))),
    }
}

fn line(probe: Option<&Probe>, color: [u8; 4]) -> String {
    match probe {
        None => json!({ "zone": null, "color": color }),
        Some(p) => json!({
            "zone": p.zone, "jump": [p.jump.x, p.jump.y], "thresholds": p.thresholds, "tau": p.tau, "s": p.s,
            "e": p.e, "active": p.active, "read": [p.read.x, p.read.y], "color": color,
        }),
    }
    .to_string()
}

fn prose(probe: Option<&Probe>, [r, g, b, a]: [u8; 4], (x, y): (usize, usize), time: f64) -> String {
    let color = format!("shows #{r:02x}{g:02x}{b:02x}, alpha {a}");
    let place = format!("pixel {x},{y} at t {time}");
    let Some(p) = probe else { return format!("{place}: in no zone\n  {color}") };
    let length = p.jump.hypot2().sqrt();
    let degrees = maths::atan2(0.0 - p.jump.y, p.jump.x).to_degrees() + 0.0;
    let thresholds = match &p.thresholds[..] {
        [] => "none".to_owned(),
        some => some.iter().map(|t| format!("{t:.4}")).collect::<Vec<_>>().join(", "),
    };
    let active = if p.active { "active" } else { "still" };
    format!(
        "{place}: zone \"{}\"\n  jump {:.3}, {:.3} px, length {length:.3} px, {degrees:.1} degrees\n  \
         thresholds {thresholds}\n  τ {:.4}, s {:.4}, e {:.4}, {active}\n  reads {:.3}, {:.3}\n  {color}",
        p.zone, p.jump.x, p.jump.y, p.tau, p.s, p.e, p.read.x, p.read.y
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_name_the_pixel_that_holds_them() {
        for (at, pixel) in
            [([0.0, 0.0], Some((0, 0))), ([3.99, 1.5], Some((3, 1))), ([4.0, 1.0], None), ([-0.1, 1.0], None)]
        {
            assert_eq!(pixel_at(at, (4, 2)).ok(), pixel, "{at:?}");
        }
        assert!(parse_point("1,2").is_ok() && parse_point("1").is_err() && parse_point("1,inf").is_err());
    }
}
