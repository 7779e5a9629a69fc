//! `plica views`: pictures with cameras on the surface of a mesh: what they tell it, and laying more of them there.

mod add;
mod balance;
mod base;
mod beside;
mod feather;
mod guide;
mod import;
pub mod paint;
mod table;

use std::path::PathBuf;

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::Result;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use crate::scene::Scene;

/// List the views of a view map and what they tell it, add more, import those of other programs
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    what: Option<What>,
    /// The scene; - is standard input
    #[arg(required = true)]
    scene: Option<PathBuf>,
    /// Name of the layer [default: all with views]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Print one JSON object per line: the views, then the map
    #[arg(long)]
    json: bool,
    /// Draw each view again from its own camera, and tell how well it comes back
    #[arg(long)]
    compare: bool,
    #[command(flatten)]
    options: SceneOptions,
}

#[derive(clap::Subcommand)]
enum What {
    /// Lay a picture of the scene on a mesh, seen from a place
    Add(add::Args),
    /// Lay pictures with the cameras that another program found or rendered them with
    Import(import::Args),
    /// Draw what a view's camera sees of the surface without it, to paint over
    Guide(guide::Args),
    /// Set gains so that photographs agree in brightness
    Balance(balance::Args),
}

/// Lists, adds, imports or balances views.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    match args.what {
        Some(What::Add(args)) => add::run(args, context),
        Some(What::Import(args)) => import::run(args, context),
        Some(What::Guide(args)) => guide::run(args, context),
        Some(What::Balance(args)) => balance::run(args, context),
        None => table::run(&args, context),
    }
}

/// What is odd about how pictures lie on a layer, as far as the files that it names tell.
fn odd(scene: &Scene, layer: usize, materials: &Materials) -> Vec<Problem> {
    let odd = scene.layers.get(layer).map(|layer| layer.technique().check_lying(materials));
    odd.unwrap_or_default().into_iter().map(|problem| problem.under(&format!("/layers/{layer}"))).collect()
}

/// What a view can feed, in the document's words.
const KINDS: [&str; 3] = ["both", "independent", "dependent"];
