//! `plica probe`: what pixels do, and why: zone, jump vector, thresholds, time, place, and what they read and show.

use std::path::PathBuf;

use serde_json::{Value as Json, json};

use super::{Context, opened::Opened, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::maths;
use crate::base::pixels::{encode, texture_place};
use crate::base::text::{self, hex};
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::readout::{Entry, ReadOut, Value};
use crate::render::{self, Synth, bands::Bands, passes, stage::Stage};
use crate::scene::Scene;

/// Show what a pixel does at a time, and why
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// The pixel that holds the point X,Y; may be given again. The center of the top-left pixel is 0.5,0.5
    #[arg(long, value_name = "X,Y", required = true, allow_hyphen_values = true, value_parser = parse_point)]
    at: Vec<[f64; 2]>,
    /// Scene time, 0 to 1
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_hyphen_values = true, value_parser = parse_time)]
    time: f64,
    /// Name of the layer [default: what is seen there of the layers in space, otherwise the first layer; then the others
    /// that have something there]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Prints one answer per `--at`, in order. Points outside the picture are told, and fail once the others are answered.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let opened = Opened::new(&args.scene, &args.options, context)?;
    let scene = opened.document.scene();
    let asked = find_layer(scene, args.layer.as_deref())?;
    // In space, what hides the others is meant first.
    let synth = scene.camera.is_some().then(|| opened.synth()).transpose()?;
    let all = synth.as_ref().filter(|_| args.layer.is_none());
    // Only what the pixel needs is computed, not the whole frame.
    let shown = Bands::after(scene, &opened.materials, 1, synth.as_ref()).map_err(|problem| opened.failed(problem))?;
    let own = own_size(scene, asked, &opened.materials).filter(|_| all.is_none());
    let size = own.unwrap_or_else(|| render::frame_size(scene, &opened.materials));
    let moment = Stage::of(scene).moment(args.time, size);
    let making = render::making(scene, &opened.materials);
    let look = |index: usize, pixel, moment: &Moment| {
        let ready = synth.as_ref().and_then(|synth| synth.layers.get(index)).map(|ready| &**ready);
        let read = scene.layers[index].technique().probe(&making, ready, pixel, moment);
        read.map_err(|problem| Error::at(args.scene.display(), problem))
    };
    let textures = scene.textures();
    let mut outside = None;
    for at in &args.at {
        let pixel = match pixel_at(*at, size) {
            Ok(pixel) => pixel,
            Err(error) => {
                // In its place among the answers, and what fails in the end.
                let told = error.to_string();
                match args.json {
                    true => context.print(json!({ "error": told }))?,
                    false if args.at.len() > 1 => context.print(told)?,
                    false => {}
                }
                outside = Some(error);
                continue;
            }
        };
        let seen = all.and_then(|synth| passes::topmost(synth, args.time, pixel));
        let layer = seen.unwrap_or(asked);
        let mut read = vec![look(layer, pixel, &moment)?.unwrap_or_default()];
        if let Some(Texel { layer, pixel, size_px }) = texel(scene, layer, &read[0], &opened.materials) {
            read.push(told(&scene.layers[layer], pixel));
            read.extend(look(layer, pixel, &Moment { size_px, ..moment })?);
        }
        if args.layer.is_none() {
            let others = others(scene, layer, pixel, &opened.materials).map(|i| look(i, pixel, &moment));
            let others = others.collect::<Result<Vec<_>>>()?;
            read.extend(others.into_iter().flatten().filter(ReadOut::is_of_something));
        }
        // A layer larger than the first reaches beyond the frame, which shows nothing there.
        let alone =
            synth.as_ref().filter(|_| textures.contains(&layer)).map(|synth| alone(synth, layer, pixel, &moment));
        let color =
            alone.map_or_else(|| shown.pixel(args.time, pixel), Ok).map_err(|problem| opened.failed(problem))?;
        let answer = if args.json { line(&read, color) } else { prose(&read, color, pixel, args.time) };
        context.print(answer)?;
    }
    outside.map_or(Ok(()), Err)
}

/// The index of the layer `name`, or of the first one.
fn find_layer(scene: &Scene, name: Option<&str>) -> Result<usize> {
    match name {
        Some(name) => scene.layer_called(name).map_err(|why| Error::at("--layer", why)),
        None if scene.layers.is_empty() => Err(Error::at("--at", "the scene has no layers")),
        None => Ok(0),
    }
}

/// The layers that may show something else in a pixel, the uppermost first: not those that are only seen on others, nor
/// pictures that do not reach so far.
fn others<'a>(
    scene: &'a Scene,
    layer: usize,
    (x, y): (usize, usize),
    materials: &'a Materials,
) -> impl Iterator<Item = usize> + 'a {
    let textures = scene.textures();
    let reaches = move |i: &usize| own_size(scene, *i, materials).is_none_or(|(width, height)| x < width && y < height);
    (0..scene.layers.len()).rev().filter(move |i| *i != layer && !textures.contains(i)).filter(reaches)
}

/// A pixel of a layer that another shows as a texture.
struct Texel {
    layer: usize,
    pixel: (usize, usize),
    size_px: (usize, usize),
}

/// What a layer shows of another one where `read` was read.
fn texel(scene: &Scene, layer: usize, read: &ReadOut, materials: &Materials) -> Option<Texel> {
    let (layer, _) = scene.shown_by(layer).into_iter().next()?;
    let size_px = own_size(scene, layer, materials)?;
    let (x, y) = texture_place(read.uv?, size_px);
    Some(Texel { layer, pixel: (x as usize % size_px.0, y as usize % size_px.1), size_px })
}

/// Which pixel of which layer is read next.
fn told(layer: &Layer, (x, y): (usize, usize)) -> ReadOut {
    let name = Entry { key: "layer", label: "layer", value: Value::Of(Some(layer.technique().name().to_owned())) };
    let pixel = Entry { key: "pixel", label: "pixel", value: Value::Indices(vec![x, y]) };
    ReadOut { entries: vec![name, pixel], ..ReadOut::default() }
}

/// What a layer by itself shows in one of its pixels.
fn alone(synth: &Synth, layer: usize, (x, y): (usize, usize), moment: &Moment) -> [u8; 4] {
    let mut row = vec![[0.0; 4]; moment.size_px.0];
    synth.layers[layer].at(moment).row(y, Columns::All, &mut row);
    encode(row[x])
}

/// Width and height of the picture that gives a layer its size, if there is one.
fn own_size(scene: &Scene, layer: usize, materials: &Materials) -> Option<(usize, usize)> {
    let image = scene.layers.get(layer)?.technique().frame_of()?;
    materials.pictures.get(image).map(|picture| (picture.width(), picture.height()))
}

fn parse_point(text: &str) -> std::result::Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
        Some((Some(x), Some(y))) => Ok([x, y]),
        _ => Err("expected two numbers, as 150.5,100.5".into()),
    }
}

fn parse_time(text: &str) -> std::result::Result<f64, String> {
    let time = text.parse::<f64>().ok().filter(|time| (0.0..=1.0).contains(time));
    time.ok_or_else(|| "expected a number from 0 to 1".into())
}

/// The pixel that holds a point.
fn pixel_at([x, y]: [f64; 2], (width, height): (usize, usize)) -> Result<(usize, usize)> {
    let within = |v: f64, n: usize| (v >= 0.0 && v < n as f64).then_some(v as usize);
    match (within(x, width), within(y, height)) {
        (Some(column), Some(row)) => Ok((column, row)),
        _ => Err(Error::at(format!("--at {x},{y}"), format!("outside the picture of {width} x {height} pixels"))
            .cure(format!("from 0,0 to less than {width},{height}"))),
    }
}

/// What is read of a pixel, the layer that is meant first, as a JSON object.
fn line(read: &[ReadOut], color: [u8; 4]) -> String {
    let mut objects = read.iter().map(|read| object(&read.entries));
    let mut line = objects.next().unwrap_or_else(|| json!({}));
    line["color"] = json!(color);
    let others: Vec<Json> = objects.collect();
    if !others.is_empty() {
        line["others"] = others.into();
    }
    line.to_string()
}

/// Entries as a JSON object.
pub fn object(entries: &[Entry]) -> Json {
    Json::Object(entries.iter().map(|entry| (entry.key.to_owned(), value(&entry.value))).collect())
}

fn value(value: &Value) -> Json {
    match value {
        Value::Of(name) => json!(name),
        Value::Vector(vector) => json!([vector.x, vector.y]),
        Value::Place(place) => json!([place.x, place.y]),
        Value::List(numbers) => json!(numbers),
        Value::Number(number) => json!(number),
        Value::Index(index) => json!(index),
        Value::Coordinates(numbers, _) => json!(numbers),
        Value::Flag { on, .. } => json!(on),
        Value::Color(codes) => json!(codes),
        Value::Indices(indices) => json!(indices),
        Value::Shares(shares) => {
            Json::Object(shares.iter().map(|(name, share)| (name.clone(), json!(share))).collect())
        }
        Value::Group(entries) => object(entries),
        Value::Items(items) => items.iter().map(|entries| object(entries)).collect(),
    }
}

fn prose(read: &[ReadOut], [r, g, b, a]: [u8; 4], (x, y): (usize, usize), time: f64) -> String {
    let mut text = format!("pixel {x},{y} at t {time}");
    // Numbers and flags that follow one another share a line.
    let mut shares = false;
    let entries = read.iter().enumerate().flat_map(|(i, read)| read.entries.iter().map(move |entry| (i, entry)));
    let is_empty = |value: &Value| matches!(value, Value::Items(items) if items.is_empty());
    let is_told = |entry: &Entry| !entry.label.is_empty() && !is_empty(&entry.value);
    // What is seen is that of the layer that is meant: what else is there lies behind it.
    let shows = format!("\n  shows #{}, alpha {a}", hex(&[r, g, b]));
    let mut shown = false;
    for (i, Entry { label, value, .. }) in entries.filter(|(_, entry)| is_told(entry)) {
        if i > 0 && !shown {
            text += &shows;
            shown = true;
        }
        let short = matches!(value, Value::Number(_) | Value::Flag { .. });
        text += match value {
            Value::Of(_) if i == 0 => ": ",
            Value::Of(_) => "\nalso: ",
            _ if short && shares => ", ",
            _ => "\n  ",
        };
        text += &said(label, value);
        shares = short;
    }
    if shown { text } else { text + &shows }
}

/// An entry in words.
fn said(label: &str, value: &Value) -> String {
    match value {
        Value::Of(None) => format!("in no {label}"),
        Value::Of(Some(name)) => format!("{label} \"{name}\""),
        Value::Vector(v) => {
            let length = v.hypot2().sqrt();
            let degrees = maths::atan2(0.0 - v.y, v.x).to_degrees() + 0.0;
            format!("{label} {:.3}, {:.3} px, length {length:.3} px, {degrees:.1} degrees", v.x, v.y)
        }
        Value::Place(place) => format!("{label} {:.3}, {:.3}", place.x, place.y),
        Value::List(numbers) if numbers.is_empty() => format!("{label} none"),
        Value::List(numbers) => {
            let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:.4}")).collect();
            format!("{label} {}", numbers.join(", "))
        }
        Value::Number(number) => format!("{label} {number:.4}"),
        Value::Index(index) => format!("{label} {index}"),
        Value::Coordinates(numbers, unit) => {
            let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:.4}")).collect();
            format!("{label} {} {unit}", numbers.join(", ")).trim_end().to_owned()
        }
        Value::Flag { on, off } => if *on { label } else { off }.to_owned(),
        Value::Color([r, g, b, a]) => format!("{label} #{}, alpha {a}", hex(&[*r, *g, *b])),
        Value::Indices(indices) => {
            let indices: Vec<String> = indices.iter().map(ToString::to_string).collect();
            format!("{label} {}", indices.join(" "))
        }
        Value::Shares(shares) if shares.is_empty() => format!("{label} none"),
        Value::Shares(shares) => {
            let shares: Vec<String> = shares.iter().map(|(name, share)| format!("\"{name}\" {share:.3}")).collect();
            format!("{label} {}", shares.join(", "))
        }
        Value::Group(entries) => {
            let told = entries.iter().filter(|entry| !entry.label.is_empty());
            let told: Vec<String> = told.map(|entry| said(entry.label, &entry.value)).collect();
            format!("{label}: {}", told.join(", "))
        }
        Value::Items(items) => format!("listed {}, {label}:\n  {}", items.len(), table(items).join("\n  ")),
    }
}

/// Several things as a table: the labels, then a line for each.
fn table(items: &[Vec<Entry>]) -> Vec<String> {
    let told = |entries: &[Entry]| entries.iter().filter(|entry| !entry.label.is_empty()).cloned().collect();
    let items: Vec<Vec<Entry>> = items.iter().map(|entries| told(entries)).collect();
    let heads = items.first().map(|entries| entries.iter().map(|entry| entry.label.to_owned()).collect());
    let cells = items.iter().map(|entries| entries.iter().map(|entry| brief(&entry.value)).collect());
    let rows: Vec<Vec<String>> = heads.into_iter().chain(cells).collect();
    let wide = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(i, cell)| format!("{cell:>0$}", wide(i).unwrap_or(0)));
        cells.collect::<Vec<_>>().join(" ")
    };
    rows.iter().map(line).collect()
}

/// A value in as little room as can be.
fn brief(value: &Value) -> String {
    match value {
        Value::Of(name) => name.clone().unwrap_or_default(),
        Value::Number(number) => brief_number(*number),
        Value::Index(index) => index.to_string(),
        Value::Coordinates(numbers, _) | Value::List(numbers) => {
            numbers.iter().map(|number| brief_number(*number)).collect::<Vec<_>>().join(" ")
        }
        Value::Color(codes) => format!("#{}", hex(codes)),
        Value::Flag { on, off } => if *on { "yes" } else { off }.to_owned(),
        other => said("", other).trim().to_owned(),
    }
}

/// A number with three digits that count.
fn brief_number(number: f64) -> String {
    let digits = [1.0, 10.0, 100.0].iter().filter(|least| number.abs() >= **least).count();
    text::short(number, [3, 2, 1, 1][digits])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(key: &'static str, label: &'static str, value: Value) -> Entry {
        Entry { key, label, value }
    }

    fn sprites() -> Vec<Entry> {
        let sprite = |age, at: [f64; 2], level, color| {
            vec![
                entry("age", "age", Value::Number(age)),
                entry("at", "at", Value::Coordinates(at.to_vec(), "m")),
                entry("level", "", Value::Index(level)),
                entry("color", "color", Value::Color(color)),
            ]
        };
        let items =
            vec![sprite(0.12345, [-0.5, 12.25], 1, [255, 0, 16, 128]), sprite(2.0, [1.0, 250.04], 0, [1, 2, 3, 4])];
        vec![
            entry("count", "sprites", Value::Index(2)),
            entry("listed", "", Value::Index(2)),
            entry("sprites", "the oldest first", Value::Items(items)),
            entry("none", "none", Value::Items(Vec::new())),
        ]
    }

    #[test]
    fn a_read_out_as_json_and_in_words() {
        let read = |on| {
            let entries = vec![
                entry("zone", "zone", Value::Of(Some("eye".into()))),
                entry("jump", "jump", Value::Vector((3.0, -4.0).into())),
                entry("thresholds", "thresholds", Value::List(if on { vec![0.25, 0.5] } else { Vec::new() })),
                entry("tau", "τ", Value::Number(0.125)),
                entry("active", "active", Value::Flag { on, off: "still" }),
                entry("read", "reads", Value::Place((1.5, 2.0).into())),
            ];
            vec![ReadOut { entries, ..ReadOut::default() }]
        };
        let water =
            ReadOut { entries: vec![entry("layer", "layer", Value::Of(Some("falls".into())))], ..ReadOut::default() };
        let sprites = vec![ReadOut { entries: sprites(), ..ReadOut::default() }];
        let outside = vec![ReadOut { entries: vec![entry("zone", "zone", Value::Of(None))], ..ReadOut::default() }];
        for (read, json, words) in [
            (
                read(true),
                r#"{"zone":"eye","jump":[3.0,-4.0],"thresholds":[0.25,0.5],"tau":0.125,"active":true,"read":[1.5,2.0],"color":[1,2,3,255]}"#,
                "pixel 7,8 at t 0.5: zone \"eye\"\n  jump 3.000, -4.000 px, length 5.000 px, 53.1 degrees\n  \
                 thresholds 0.2500, 0.5000\n  τ 0.1250, active\n  reads 1.500, 2.000\n  shows #010203, alpha 255",
            ),
            (
                read(false),
                r#"{"zone":"eye","jump":[3.0,-4.0],"thresholds":[],"tau":0.125,"active":false,"read":[1.5,2.0],"color":[1,2,3,255]}"#,
                "pixel 7,8 at t 0.5: zone \"eye\"\n  jump 3.000, -4.000 px, length 5.000 px, 53.1 degrees\n  \
                 thresholds none\n  τ 0.1250, still\n  reads 1.500, 2.000\n  shows #010203, alpha 255",
            ),
            (
                outside.clone(),
                r#"{"zone":null,"color":[1,2,3,255]}"#,
                "pixel 7,8 at t 0.5: in no zone\n  shows #010203, alpha 255",
            ),
            (
                [outside, vec![water]].concat(),
                r#"{"zone":null,"color":[1,2,3,255],"others":[{"layer":"falls"}]}"#,
                "pixel 7,8 at t 0.5: in no zone\n  shows #010203, alpha 255\nalso: layer \"falls\"",
            ),
            (
                sprites.clone(),
                r#"{"count":2,"listed":2,"sprites":[{"age":0.12345,"at":[-0.5,12.25],"level":1,"color":[255,0,16,128]},{"age":2.0,"at":[1.0,250.04],"level":0,"color":[1,2,3,4]}],"none":[],"color":[1,2,3,255]}"#,
                "pixel 7,8 at t 0.5\n  sprites 2\n  listed 2, the oldest first:\n    age        at     color\n  0.123 -0.5 12.2 #ff001080\n      2     1 250 #01020304\n  \
                 shows #010203, alpha 255",
            ),
            (Vec::new(), r#"{"color":[1,2,3,255]}"#, "pixel 7,8 at t 0.5\n  shows #010203, alpha 255"),
        ] {
            assert_eq!(line(&read, [1, 2, 3, 255]), json);
            assert_eq!(prose(&read, [1, 2, 3, 255], (7, 8), 0.5), words);
        }
    }

    #[test]
    fn points_name_the_pixel_that_holds_them() {
        for (at, pixel) in
            [([0.0, 0.0], Some((0, 0))), ([3.99, 1.5], Some((3, 1))), ([4.0, 1.0], None), ([-0.1, 1.0], None)]
        {
            assert_eq!(pixel_at(at, (4, 2)).ok(), pixel, "{at:?}");
        }
        for (text, is_time) in [("0", true), ("1", true), ("0.25", true), ("7", false), ("-0.1", false), ("NaN", false)]
        {
            assert_eq!(parse_time(text).is_ok(), is_time, "{text}");
        }
        assert!(parse_point("1,2").is_ok() && parse_point("1").is_err() && parse_point("1,inf").is_err());
    }
}
