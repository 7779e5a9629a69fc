//! `plica synth`: the textures of a scene for other engines.

use std::path::PathBuf;

use super::{Context, opened::Opened, scene_options::SceneOptions};
use crate::base::error::Result;
use crate::export::textures::{self, Depth};

/// Write a scene's textures and their manifest for other engines.
#[derive(clap::Args)]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// The folder for colour, init, jump, function and thresholds textures and manifest.json; made where missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Bits a number: 32 is exact (EXR); 16 and 8 are PNG, their error in the manifest
    #[arg(long, value_name = "BITS", default_value = "32", value_parser = ["32", "16", "8"])]
    depth: String,
    #[command(flatten)]
    options: SceneOptions,
}

/// Writes them.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let opened = Opened::new(&args.scene, &args.options, context)?;
    let depth = match args.depth.as_str() {
        "16" => Depth::Sixteen,
        "8" => Depth::Eight,
        _ => Depth::Float,
    };
    let synth = opened.synth()?;
    let mut step = |done, total| {
        context.messages.step("zone", done, total);
        context.check_cancelled()
    };
    textures::write(opened.document.scene(), &synth, depth, &args.output, &mut step)
}
