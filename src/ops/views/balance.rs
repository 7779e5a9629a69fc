//! `plica views balance`: gains with which photographs agree in brightness.

use std::path::PathBuf;

use crate::base::error::Result;
use crate::base::text::counted;
use crate::ops::opened::Opened;
use crate::ops::scene_options::{RecoveryOptions, SceneOptions};
use crate::ops::sprites::none;
use crate::ops::{Context, set};
use crate::scene::{Document, Edit};

#[derive(clap::Args)]
pub struct Args {
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first with views]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Multiplies the gains, as one edit.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    set::refuse_input(&args.scene)?;
    let opened = Opened::new(&args.scene, &args.reading, context)?;
    let scene = opened.document.scene();
    let synth = opened.synth_told(&mut *context.messages)?;
    let layers = scene.layers.iter().map(|layer| layer.technique().name()).zip(&synth.layers).enumerate();
    let mut named = layers.filter(|(_, (name, _))| args.layer.as_deref().is_none_or(|layer| layer == *name));
    let found = named.find_map(|(i, (_, ready))| Some((i, ready.balanced()?)));
    let (layer, gains) = found.ok_or_else(|| none(scene, args.layer.as_deref(), "views"))?;
    if gains.is_empty() {
        context.messages.say("no two views show enough of the same: nothing is changed");
        return Ok(());
    }
    let make = |document: &Document| {
        let edit = |(path, value): &(String, serde_json::Value)| {
            Edit::set(document, &format!("/layers/{layer}{path}"), value.clone())
        };
        Ok(Edit::all(gains.iter().map(edit)))
    };
    let elsewhere = set::change(&args.scene, (&args.recovery, &args.reading), make)?;
    context.messages.say(&format!("the gains of {} are set", counted(gains.len(), "view")));
    if elsewhere {
        context.messages.say("that was in the editor that has the scene open; save it there");
    }
    Ok(())
}
