//! `plica synth`: the textures of a scene for other engines.

use std::path::PathBuf;
use std::time::Instant;

use super::writing::Replacing;
use super::{Context, opened::Unloaded, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::text::counted;
use crate::export::textures::{self, Depth, Forms, Names};
use crate::files::outputs;

/// Write a scene's textures and their manifest for other engines
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// The folder for textures, meshes and manifest.json; created if missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Bits per number: 32 is exact (EXR); 16 and 8 are PNG, their error in the manifest
    #[arg(long, value_name = "BITS", default_value = "32", value_parser = ["32", "16", "8"])]
    depth: String,
    /// Also bake what view maps show from everywhere into one picture of so many texels a side, by the mesh's own texture
    /// coordinates
    #[arg(long, value_name = "TEXELS", value_parser = clap::value_parser!(u32).range(16..=8192))]
    bake: Option<u32>,
    #[command(flatten)]
    replacing: Replacing,
    #[command(flatten)]
    options: SceneOptions,
}

/// Writes the textures.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let begun = Instant::now();
    let depth = match args.depth.as_str() {
        "16" => Depth::Sixteen,
        "8" => Depth::Eight,
        _ => Depth::Float,
    };
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let scene = read.document.scene();
    let names = Names::of(scene, depth);
    if args.bake.is_some() && !names.bakes() {
        return Err(Error::at("--bake", "no layer shows a view map").cure("leave it out"));
    }
    let mut guard = args.replacing.guard(&args.scene, scene, context);
    let place = guard.folder(&args.output, &|name| names.may_be(name), textures::earlier(&args.output))?;
    context.say_all(&guard.notes());
    let opened = read.load(context)?;
    let synth = opened.synth()?;
    let mut step = |done, total| {
        context.messages.step("step", done, total);
        context.check_cancelled()
    };
    let forms = Forms { depth, baked_px: args.bake.map(|side| side as usize) };
    let written = textures::write(opened.document.scene(), &synth, forms, &place, &mut step)?;
    if depth != Depth::Float {
        let (bits, error) = (&args.depth, written.error_px);
        let off = if error < 0.0005 { "less than 0.001 px off".into() } else { format!("up to {error:.3} px off") };
        context.messages.say(&format!(
            "{bits} bits: places and jump vectors are {off}; a player that takes each zone's origin from the \
             manifest shows still pixels exactly"
        ));
    }
    let files: Vec<_> = written.names.iter().map(|name| args.output.join(name)).collect();
    if files.len() == 1 {
        context.messages.say("no layer has textures for other engines, so there is only the manifest");
    }
    let count = counted(files.len(), "file");
    let what = format!("{}, {count}", args.output.display());
    context.done(&what, outputs::size(files.iter().map(PathBuf::as_path)), begun);
    Ok(())
}
