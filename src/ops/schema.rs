//! `plica schema`: the JSON Schema of a scene, for other editors and for scripts.

use super::Context;
use crate::base::error::Result;

/// Print the JSON Schema of a scene.
#[derive(clap::Args)]
pub struct Args {}

/// Prints it.
pub fn run(_: Args, context: &mut Context) -> Result<()> {
    let schema = schemars::schema_for!(crate::scene::Scene);
    context.print(serde_json::to_string_pretty(&schema).unwrap_or_default())
}
