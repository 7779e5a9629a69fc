//! The top of the command line: parse, run one subcommand, print one error, exit status.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;

use crate::base::error::{Error, Result};
use crate::files;
use crate::ops::{Command, Context};

mod process;

const EXAMPLES: &str = "\
Examples:
  plica edit photo.png                       make a scene beside the picture and edit it
  plica demo                                 open a built-in demo scene
  plica render scene.plica.json -o eye.gif   write the animation";

/// Animates still pictures from the keyboard.
#[derive(Parser)]
#[command(name = "plica", version, about, after_help = EXAMPLES, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Write the log here instead of to the state folder
    #[arg(long, global = true, value_name = "FILE")]
    log: Option<PathBuf>,
}

/// Runs the process.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let cancel = Arc::new(AtomicBool::new(false));
    let closed = Arc::new(AtomicBool::new(false));
    let mut context = Context::process(cancel.clone());
    context.out = Box::new(process::Output::new(closed.clone()));
    match run(cli, &mut context, cancel) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) if closed.load(Ordering::Relaxed) => ExitCode::SUCCESS,
        Err(error) => {
            context.messages.say(&format!("plica: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}

fn run(cli: Cli, context: &mut Context, cancel: Arc<AtomicBool>) -> Result<()> {
    let log = files::log::start(cli.log.as_deref())?;
    process::report_panics(log);
    let _registered = process::cancel_on_signals(cancel)?;
    cli.command.run(context)?;
    context.out.flush().map_err(|error| Error::at("standard output", error))
}
