//! `plica check`: every problem in a scene, with its path.

use std::path::PathBuf;

use super::Context;
use super::render::room;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::base::problem::{Problem, Severity};
use crate::base::text::counted;
use crate::files::{self, materials::Cache};
use crate::layers::parts::materials::Materials;
use crate::render;
use crate::scene::{Document, Scene, address, named};

/// Find every problem in a scene; warnings alone fail too, unless --lenient is given
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Print one list of JSON objects: severity, path, address, message, hint
    #[arg(long)]
    json: bool,
    /// Do not fail if there are only warnings
    #[arg(long)]
    lenient: bool,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Prints the problems; fails if there are any (with `--lenient`, if one of them is an error: a loop that snaps, for one,
/// may be meant).
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let (mut problems, loops, document) = problems(&args, context)?;
    let failing = problems.len();
    problems.extend(loops);
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error).count();
    if args.json {
        let problems = match &document {
            Some(document) => named::problems(document.json(), problems.clone()),
            None => problems.clone(),
        };
        let list = serde_json::to_value(&problems).map_err(|e| Error::at("the list of problems", e))?;
        context.print(format_args!("{list:#}"))?;
    } else {
        let told = |problem| document.as_ref().map(|document| address::of_problem(document, problem));
        problems.iter().try_for_each(|problem| context.print(told(problem).as_ref().unwrap_or(problem)))?;
    }
    let warnings = problems.len() - errors;
    let what = match (errors, warnings) {
        (0, 0) => "no problems".to_owned(),
        (0, _) => counted(warnings, "warning"),
        (_, 0) => counted(errors, "error"),
        _ => format!("{}, {}", counted(errors, "error"), counted(warnings, "warning")),
    };
    if errors > 0 || failing > 0 && !args.lenient {
        return Err(Error::at(args.scene.display(), what));
    }
    context.messages.say(&what);
    Ok(())
}

/// What is wrong with layers that only shows once they are made from what they read.
pub fn made(scene: &Scene, materials: &Materials) -> Vec<Problem> {
    let making = render::making(scene, materials);
    let layers = scene.layers.iter().enumerate().flat_map(|(i, layer)| {
        let made = layer.technique().check_made(&making).into_iter();
        made.map(move |problem| problem.under(&format!("/layers/{i}")))
    });
    layers.collect()
}

/// What is wrong with the files of a scene whose text has `problems`, where those do not tell.
fn of_files(problems: &[Problem], args: &Args, options: &files::Options, context: &Context) -> Vec<Problem> {
    let Some(scene) = files::scene::lists(&args.scene, options) else { return Vec::new() };
    let mut cache = Cache::until(context.cancel.clone());
    let (_, mut found) = files::materials::gather(&args.scene, &scene, options, &mut cache);
    found.retain(|found| problems.iter().all(|known| known.path != found.path));
    found
}

/// The problems, the warnings about loops that snap, and the document if it is one.
fn problems(args: &Args, context: &Context) -> Result<(Vec<Problem>, Vec<Problem>, Option<Document>)> {
    let options = args.reading.options()?;
    let document = match context.document(&args.scene, &options) {
        Ok(document) => document,
        Err(Error::Scene { problems, .. }) => {
            let found = of_files(&problems, args, &options, context);
            return Ok((problems.into_iter().chain(found).collect(), Vec::new(), None));
        }
        Err(error) => return Err(error),
    };
    let scene = document.scene();
    // Each file is read completely, not only its header: a truncated picture is a problem too.
    let mut cache = Cache::until(context.cancel.clone());
    let (materials, found) = files::materials::gather(&args.scene, scene, &options, &mut cache);
    context.check_cancelled()?;
    let mut problems = document.warnings().to_vec();
    problems.extend(found);
    let is_broken = |problems: &[Problem]| problems.iter().any(|problem| problem.severity == Severity::Error);
    if !is_broken(&problems) {
        // A frame needs memory beside what the layers take; where both lack some, the layers' cure is enough for it too.
        let room = room(scene, &materials);
        problems.extend(made(scene, &materials));
        context.check_cancelled()?;
        problems.extend(room.err().filter(|_| !is_broken(&problems)));
    }
    let (broken, mut failed) = (is_broken(&problems), None);
    let loops = render::seams::warnings(scene, &materials, || {
        let made = (!broken).then(|| render::synth(scene, &materials, None));
        made?.map_err(|problem| failed = Some(problem)).ok()
    });
    problems.extend(failed);
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    Ok((problems, loops, Some(document)))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use serde_json::{Value, json};

    use super::*;
    use crate::base::clip::Clip;
    use crate::base::pixels::Frame;

    /// So many frames of 96 x 80 in which a pattern falls by so many pixels a frame.
    fn clip(frames: usize, speed: usize) -> Clip {
        let code = |x: usize, y: usize| ((x / 4 * 2_654_435_761 + y / 4 * 2_246_822_519) >> 13) as u8;
        let frame = |number: usize| {
            let pixel = |i: usize| [code(i % 96, i / 96 + 1000 - speed * number); 3];
            let cells = (0..96 * 80).map(pixel).map(|[r, g, b]| [r, g, b, 255]).collect();
            Arc::new(Frame::from_cells(96, 80, cells).to_linear().into())
        };
        Clip { fps: 25.0, frames: (0..frames).map(frame).collect() }
    }

    /// What is wrong with a waterfall of which this is set, over such a clip and a sheet of 128 x 96.
    fn told(set: Value, clip: Clip) -> String {
        let mut layer = json!({ "kind": "waterfall", "name": "falls", "clip": "water" });
        layer.as_object_mut().unwrap().extend(set.as_object().unwrap().clone());
        layer.as_object_mut().unwrap().retain(|_, value| !value.is_null());
        let scene = json!({
            "plica": 1, "size": [64, 48], "camera": {}, "clips": { "water": { "path": "%d.png" } },
            "images": { "sheet": { "path": "s.png" } }, "layers": [layer],
        });
        let lines = |problems: Vec<Problem>| problems.iter().map(|one| one.to_string()).collect::<Vec<_>>().join("\n");
        let document = match Document::from_json(scene) {
            Ok(document) => document,
            Err(problems) => return lines(problems),
        };
        let sheet = Arc::new(Frame::from_cells(128, 96, vec![[255; 4]; 128 * 96]).to_linear().into());
        let materials = Materials {
            pictures: [("sheet".to_owned(), sheet)].into(),
            clips: [("water".to_owned(), Arc::new(clip))].into(),
            ..Materials::default()
        };
        let mut problems = document.warnings().to_vec();
        problems.extend(crate::scene::check::check_materials(document.scene(), &materials));
        if problems.is_empty() {
            problems = made(document.scene(), &materials);
        }
        lines(problems.iter().map(|problem| address::of_problem(&document, problem)).collect())
    }

    /// What is set, and what is told of it below the layer.
    type Case = (Value, &'static str);

    fn wrong_sprites() -> Vec<Case> {
        let sheet = |kind: &str| json!({ "sprites": { "sheets": [{ "image": "sheet", "kind": kind }] } });
        let pick =
            |frame: usize, x: f64| json!({ "sprites": { "size": 32, "picks": [{ "frame": frame, "at": [x, 40] }] } });
        vec![
            (json!({ "clip": null }), ": a waterfall needs a clip or sprites.sheets (name a clip of the scene)"),
            (json!({ "sprites": { "size": 50 } }), ".sprites.size: 50 is no multiple of 16 (48, 64)"),
            (
                json!({ "sprites": { "size": 96 } }),
                ".sprites.size: sprites of 96 px do not fit in the clip's 96 x 80 (make it 80)",
            ),
            (
                json!({ "sprites": { "step": 4 } }),
                ".sprites: 6 keys 4 frames apart need 21 frames; the clip \"water\" has 12 (make step 2)",
            ),
            (
                json!({ "sprites": { "keys": 20 } }),
                ".sprites: 20 keys 2 frames apart need 39 frames; the clip \"water\" has 12 (make keys 12 and step 1)",
            ),
            (
                pick(0, 90.0),
                ".sprites.picks.0: its window, 74 px to 106 px, leaves the clip's 96 px (its middle can be from 16 to 80 px)",
            ),
            (
                pick(7, 40.0),
                ".sprites.picks.0: frame 7 and its track of 11 frames pass the clip's end (12) (the last that it can be is 1)",
            ),
            (sheet("water"), ".sprites.sheets.0: cells of 128 x 96; sprites.size is 64 (give columns and rows as"),
            (
                json!({ "sprites": { "matte": { "low": 60, "high": 40 } } }),
                ".sprites.matte.low: low is not below high (60 and 40) (make it smaller)",
            ),
            (
                json!({ "sprites": { "size": 256, "keys": 32, "growth": { "max": 32 } } }),
                ".sprites: its keys take 1.4 GiB, and 1.0 GiB is the most (lower one of them: size 208 or keys 23 or growth.max 23",
            ),
        ]
    }

    fn wrong_lines_and_looks() -> Vec<Case> {
        vec![
            (json!({ "lip": [] }), ".lip: expected at least 1 item, found 0 (add one)"),
            (
                json!({ "lip": [{ "at": [0, 1, 0], "flow": 0 }] }),
                ".lip: no water flows at any node (give a node a flow above 0)",
            ),
            (
                json!({ "lip": [{ "at": [-1, -1, 0] }, { "at": [1, -1, 0] }] }),
                ".lip: warning: no line leaves the lip: it lies under the pool (y -1, pool 0) (raise the lip, or lower the pool)",
            ),
            (
                json!({ "look": { "tint": [{ "at": 0.5, "color": "#fff" }, { "at": 0.2, "color": "#fff" }] } }),
                ".look.tint.1.at: ",
            ),
            (json!({ "foam": { "look": { "tint": [{ "at": 0, "color": "blau" }] } } }), ".foam.look.tint.0.color: "),
            (
                json!({ "lines": 20000, "rate": 1000 }),
                ".lines: 13998575 sprites at once, at most 2000000 are allowed (lower lines, rate or life)",
            ),
        ]
    }

    #[test]
    fn what_is_wrong_with_a_waterfall_is_told_with_its_place_and_the_cure() {
        for (set, told_of) in wrong_sprites().into_iter().chain(wrong_lines_and_looks()) {
            let expected = format!("layers.falls{told_of}");
            let told = told(set.clone(), clip(12, 3));
            assert!(told.contains(&expected), "{set}:\n{told}\n{expected}");
        }
        assert_eq!(
            told(json!({}), clip(12, 0)),
            "layers.falls.clip: nothing moves in the clip \"water\": pick sprites by hand (sprites.picks)"
        );
        assert_eq!(told(json!({}), clip(12, 3)), "");
    }
}
