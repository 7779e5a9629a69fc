//! The top of the command line: parse, run one subcommand, print one error, exit status.

use std::borrow::Cow;
use std::ffi::OsString;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

use crate::base::error::{Error, Result};
use crate::base::{system, text};
use crate::files;
use crate::ops::demo;
use crate::ops::{CommandLine, Context};
#[cfg(feature = "tui")]
use crate::{ops::Command, tui};

mod process;

/// Runs the process.
pub fn main() -> ! {
    let line = CommandLine::try_parse().unwrap_or_else(|error| refuse(with_tip(error)));
    let cancel = Arc::new(AtomicBool::new(false));
    let closed = Arc::new(AtomicBool::new(false));
    let mut context = Context::process(cancel.clone());
    context.out = Box::new(process::Output::new(closed.clone()));
    let status = match run(line, &mut context, cancel) {
        Ok(()) => 0,
        Err(_) if closed.load(Ordering::Relaxed) => 0,
        Err(error) => {
            context.messages.say(&format!("plica: {}", quoting(&error)));
            error.exit_status()
        }
    };
    // Where nobody reads it there is nothing more to do.
    let _ = context.out.flush();
    drop(context);
    system::process::end(status)
}

/// The error, with the words of the command line that it quotes on one line each.
fn quoting(error: &Error) -> String {
    let words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
    let split = words.filter(|word| word.contains('\n'));
    split.fold(error.to_string(), |text, word| text.replace(&word, &text::line(&word)))
}

/// The error; where a file stands in the place of a subcommand, with what opens it, and where an empty word stands in the
/// place of a value, with that.
fn with_tip(mut error: clap::Error) -> clap::Error {
    let word = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(word)) => Some(word.clone()),
        _ => None,
    };
    let is_empty = error.kind() == ErrorKind::InvalidValue && std::env::args_os().any(|word| word.is_empty());
    let file = word.filter(|word| cfg!(feature = "tui") && Path::new(word).is_file());
    let file = file.map(|word| format!("there is a file of that name; 'plica edit {}' opens it", demo::quoted(&word)));
    let empty = || "a word of the line is empty, as \"\" is, or a variable that is not set".to_owned();
    if let Some(tip) = file.or_else(|| is_empty.then(empty)) {
        error.remove(ContextKind::SuggestedSubcommand);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

/// Says what is wrong in the command line, and ends. The message quotes words of it, which may be names that somebody else
/// chose: control characters in them are escaped.
fn refuse(error: clap::Error) -> ! {
    let steers = |word: &OsString| matches!(text::line(&word.to_string_lossy()), Cow::Owned(_));
    if !std::env::args_os().any(|word| steers(&word)) {
        error.exit();
    }
    let harmless = std::env::args_os().map(|word| text::line(&word.to_string_lossy()).into_owned());
    match CommandLine::try_parse_from(harmless) {
        Err(error) => with_tip(error).exit(),
        // As a name it would do: what is left to say is that it was not taken as it is.
        Ok(_) => {
            let first = error.to_string();
            let first = first.lines().next().unwrap_or_default();
            // Where nobody reads it there is nothing more to do.
            let _ = writeln!(std::io::stderr(), "{}", text::line(first));
            std::process::exit(Error::Usage(String::new()).exit_status().into())
        }
    }
}

fn run(line: CommandLine, context: &mut Context, cancel: Arc<AtomicBool>) -> Result<()> {
    let log = files::log::start(line.log.as_deref())?;
    process::report_panics(log);
    process::cancel_on_signals(cancel)?;
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
