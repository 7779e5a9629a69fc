//! The top of the command line: parse, run one subcommand, print one error, exit status.

use std::process::ExitCode;
use std::sync::{Arc, atomic::AtomicBool};

use clap::Parser;

use crate::ops::{Command, Context};

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
}

/// Runs the process.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let cancel = Arc::new(AtomicBool::new(false));
    let mut context = Context::process(cancel);
    match cli.command.run(&mut context) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            context.messages.say(&format!("plica: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}
