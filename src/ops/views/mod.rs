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

use super::Context;
use crate::base::error::Result;

/// List the views of a view map and what they tell it, add more, import those of other programs
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    what: Option<What>,
    #[command(flatten)]
    listing: table::Listing,
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
        None => table::run(&args.listing, context),
    }
}
