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
        problems.extend(made(scene, &materials));
        context.check_cancelled()?;
    }
    // A frame needs memory beside what the layers take.
    let room = if is_broken(&problems) { None } else { Some(room(scene, &materials)) };
    problems.extend(room.iter().filter_map(|room| room.as_ref().err()).cloned());
    let (broken, mut failed) = (is_broken(&problems), None);
    let loops = render::seams::warnings(scene, &materials, || {
        let made = (!broken).then(|| render::synth(scene, &materials, None));
        made?.map_err(|problem| failed = Some(problem)).ok()
    });
    problems.extend(failed);
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    Ok((problems, loops, Some(document)))
}
