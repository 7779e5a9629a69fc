//! One file per subcommand: its arguments and its function, used by the command line and by the editor's `:`.
//! [`Command`] is the only list of them; [`CommandLine`] is all that clap knows: the top of the program parses it, completions
//! and the manual print it.

use std::path::PathBuf;

use clap::{CommandFactory, FromArgMatches, Subcommand};

use crate::base::error::{Error, Result};

pub mod attach;
pub mod check;
pub mod completions;
mod context;
pub mod demo;
pub mod edit;
pub mod field;
pub mod get;
pub mod lines;
pub mod man;
pub mod measure;
pub mod new;
pub mod opened;
pub mod probe;
pub mod profile;
pub mod render;
pub mod scene_options;
pub mod schema;
pub mod set;
pub mod sprites;
pub mod style;
pub mod synth;
pub mod tutor;
#[cfg(feature = "window")]
pub mod view;
pub mod views;
mod watched;
mod writing;

pub use context::{Context, Open, Progress, left};

const EXAMPLES: &str = "\
Examples:
  plica edit photo.png                       make a scene beside the picture and edit it
  plica demo                                 open a built-in demo scene
  plica render scene.plica.json -o eye.gif   write the animation";

/// Animates still pictures from the keyboard.
#[derive(clap::Parser)]
#[command(name = "plica", version, about, after_help = EXAMPLES)]
pub struct CommandLine {
    /// Write the log here instead of to the state folder
    #[arg(long, global = true, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// What to do; `None` prints the short help.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// What `plica` can be asked to do.
#[derive(clap::Subcommand)]
#[allow(missing_docs, reason = "the comment on its arguments is the help of a subcommand")]
pub enum Command {
    Demo(demo::Args),
    New(new::Args),
    Edit(edit::Args),
    Tutor(tutor::Args),
    Set(set::Args),
    Profile(profile::Args),
    Style(style::Args),
    Get(get::Args),
    Check(check::Args),
    Probe(probe::Args),
    Measure(measure::Args),
    Lines(lines::Args),
    Sprites(sprites::Args),
    Views(views::Args),
    Render(render::Args),
    Synth(synth::Args),
    #[cfg(feature = "window")]
    View(view::Args),
    Attach(attach::Args),
    Field(field::Args),
    Schema(schema::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Command {
    /// Runs the subcommand.
    pub fn run(self, context: &mut Context) -> Result<()> {
        match self {
            Command::Demo(args) => demo::run(args, context),
            Command::New(args) => new::run(args, context),
            Command::Edit(_) => Err(Error::Usage("edit opens a terminal of its own: here :e opens a scene".into())),
            Command::Tutor(_) => Err(Error::Usage("tutor opens a terminal of its own".into())),
            Command::Set(args) => set::run(args, context),
            Command::Profile(args) => profile::run(args, context),
            Command::Style(args) => style::run(args, context),
            Command::Get(args) => get::run(args, context),
            Command::Check(args) => check::run(args, context),
            Command::Probe(args) => probe::run(args, context),
            Command::Measure(args) => measure::run(args, context),
            Command::Lines(args) => lines::run(args, context),
            Command::Sprites(args) => sprites::run(args, context),
            Command::Views(args) => views::run(args, context),
            Command::Render(args) => render::run(args, context),
            Command::Synth(args) => synth::run(args, context),
            Command::Field(args) => field::run(args, context),
            Command::Schema(args) => schema::run(args, context),
            Command::Completions(args) => completions::run(args, CommandLine::command(), context),
            Command::Man(args) => man::run(args, CommandLine::command(), context),
            Command::Attach(args) => attach::run(args, context),
            #[cfg(feature = "window")]
            Command::View(args) => view::run(args, context),
        }
    }
}

/// The names of all subcommands.
pub fn names() -> impl Iterator<Item = String> {
    let table = Command::augment_subcommands(clap::Command::new("plica"));
    table.get_subcommands().map(|one| one.get_name().to_owned()).collect::<Vec<_>>().into_iter()
}

/// Parses `words`, the subcommand's name first, as on the command line.
///
/// # Errors
/// If the words are wrong; the message says how.
pub fn parse(words: &[String]) -> Result<Command> {
    let table = Command::augment_subcommands(clap::Command::new("plica").no_binary_name(true));
    let usage = |error: clap::Error| {
        let text = error.to_string();
        let told = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let told = told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more information"));
        Error::Usage(told.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned())
    };
    table.try_get_matches_from(words).and_then(|found| Command::from_arg_matches(&found)).map_err(usage)
}

/// What `--help` prints about a subcommand; `None` if there is no such subcommand.
pub fn help(name: &str) -> Option<String> {
    let mut table = Command::augment_subcommands(clap::Command::new("plica"));
    table.build();
    Some(table.find_subcommand_mut(name)?.render_long_help().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_parsed_as_on_the_command_line() {
        assert!(names().any(|name| name == "schema"));
        assert!(matches!(parse(&["schema".into()]), Ok(Command::Schema(_))));
        let wrong = parse(&["schema".into(), "--no-such".into()]).err().unwrap();
        assert!(matches!(&wrong, Error::Usage(text) if text.contains("--no-such") && !text.contains('\n')), "{wrong}");
    }
}
