//! The top of the command line: parse, run one subcommand, print one error, exit status.

use std::io::Write;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{CommandFactory, Parser};

use crate::base::error::{Error, Result};
use crate::files;
use crate::ops::Context;
use crate::ops::command_line::CommandLine;
#[cfg(feature = "tui")]
use crate::{ops::Command, tui};

mod process;

/// Runs the process.
pub fn main() -> ExitCode {
    let line = CommandLine::parse();
    let cancel = Arc::new(AtomicBool::new(false));
    let closed = Arc::new(AtomicBool::new(false));
    let mut context = Context::process(cancel.clone());
    context.out = Box::new(process::Output::new(closed.clone()));
    match run(line, &mut context, cancel) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) if closed.load(Ordering::Relaxed) => ExitCode::SUCCESS,
        Err(error) => {
            context.messages.say(&format!("plica: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}

fn run(line: CommandLine, context: &mut Context, cancel: Arc<AtomicBool>) -> Result<()> {
    let log = files::log::start(line.log.as_deref())?;
    process::report_panics(log);
    let _registered = process::cancel_on_signals(cancel)?;
    match line.command {
        #[cfg(feature = "tui")]
        Some(Command::Edit(args)) => tui::run(tui::Options::of(&args)?)?,
        #[cfg(feature = "tui")]
        Some(Command::Tutor(_)) => tui::run(tui::Options::tutor()?)?,
        #[cfg(feature = "tui")]
        Some(Command::Demo(args)) if !args.list && process::is_interactive() => {
            tui::run(tui::Options::new(args.unpack()?))?;
        }
        Some(command) => command.run(context)?,
        None => context.print(CommandLine::command().render_help())?,
    }
    context.out.flush().map_err(|error| Error::at("standard output", error))
}
