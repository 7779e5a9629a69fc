//! `plica schema`: the JSON Schema of a scene, for other editors and for scripts.

use super::Context;
use crate::base::error::Result;

/// Print the JSON Schema of a scene
#[derive(clap::Args)]
pub struct Args {}

/// Prints the schema.
pub fn run(_: Args, context: &mut Context) -> Result<()> {
    context.print(format_args!("{:#}", crate::scene::json_schema::json_schema()))
}
