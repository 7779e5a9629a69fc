//! `plica profile`: presets of layers: which there are, what they set, and setting it.

use std::path::PathBuf;

use super::scene_options::{RecoveryOptions, SceneOptions};
use super::{Context, set};
use crate::base::error::{Error, Result};
use crate::scene::Document;
use crate::scene::presets;

/// List presets of layers, show one, or apply one to a layer
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// List all presets: the kind of layer, the name, when to use it
    List,
    /// Print what a preset sets in a layer: a JSON Merge Patch
    Show {
        /// The preset
        name: String,
    },
    /// Apply a preset to a layer of a scene
    Apply(Apply),
}

#[derive(clap::Args)]
struct Apply {
    /// The preset
    name: String,
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first that the preset is for]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Lists, shows or applies presets.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    match args.what {
        What::List => presets::all().try_for_each(|found| {
            let (kind, preset) = (found.kind.name, found.preset);
            context.print(format_args!("{kind:<12}{:<12}{}", preset.name, preset.help))
        }),
        What::Show { name } => {
            let preset = presets::find(&name).map_err(Error::Usage)?.preset;
            if !preset.wants.is_empty() {
                context.messages.say(&format!("{name} wants {}", preset.wants));
            }
            context.print(preset.patch.trim_end())
        }
        What::Apply(args) => apply(&args, context),
    }
}

fn apply(args: &Apply, context: &mut Context) -> Result<()> {
    let found = presets::find(&args.name).map_err(Error::Usage)?;
    let make = |document: &Document| found.apply(document, args.layer.as_deref());
    set::apply(&args.scene, (&args.recovery, &args.reading), make, context)
}
