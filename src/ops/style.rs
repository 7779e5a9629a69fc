//! `plica style`: styles that layers are drawn in: which there are, what is in them, and setting and keeping one.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::Value;

use super::scene_options::{RecoveryOptions, SceneOptions};
use super::writing::Replacing;
use super::{Context, opened::Unloaded, set};
use crate::base::error::{Error, Result};
use crate::files::draft::DraftFile;
use crate::files::limits::Limits;
use crate::files::styles as own;
use crate::files::{outputs, write};
use crate::layers::starts::Style;
use crate::scene::styles::{self, NOTHING, Source};
use crate::scene::{Document, json};

/// List the styles that meshes can be drawn in, show one, put a layer into one, or keep that of a layer
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// List all styles, your own in ~/.config/plica/styles too: the name, what it is for
    List,
    /// Print the table of a style
    Show {
        /// The style
        name: String,
        /// On a single line
        #[arg(long)]
        json: bool,
    },
    /// Draw a layer of a scene in a style
    Apply(Apply),
    /// Write everything that is in force in a layer as a style of one's own
    Save(Save),
}

#[derive(clap::Args)]
struct Apply {
    /// The style, a file that `style save` wrote, or none, which takes the style away
    name: String,
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first that can be drawn so]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// Write every field, so that nothing refers to the style any more
    #[arg(long)]
    whole: bool,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

#[derive(clap::Args)]
struct Save {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Name of the layer [default: the first that can be drawn in a style]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// The file; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    replacing: Replacing,
    #[command(flatten)]
    options: SceneOptions,
}

/// Lists, shows, applies or saves styles.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    match args.what {
        What::List => names().iter().try_for_each(|(name, help)| context.print(format_args!("{name:<16}{help}"))),
        What::Show { name, json } => {
            let style = styles::find(&name).map_err(Error::Usage)?;
            if !json {
                return context.print(style.table.trim_end());
            }
            let table = json::parse(style.table).map_err(|problem| Error::at(&name, problem))?;
            context.print(table)
        }
        What::Apply(args) => apply(&args, context),
        What::Save(args) => save(&args, context),
    }
}

fn apply(args: &Apply, context: &mut Context) -> Result<()> {
    let meant = Meant::of(&args.name, Path::new(&args.name), &args.reading.options()?.limits)?;
    let make = |document: &Document| styles::apply(document, args.layer.as_deref(), meant.source(), args.whole);
    set::apply(&args.scene, (&args.recovery, &args.reading), make, context)
}

/// What a layer is to be drawn in, by what a person calls it.
pub enum Meant {
    /// A style of the program.
    Named(&'static Style),
    /// A table, and where it is from.
    Own(Value, String),
    /// No style.
    Nothing,
}

impl Meant {
    /// A style of the program, one of the person's own, or a `file`.
    ///
    /// # Errors
    /// There is none, or the file is no style.
    pub fn of(name: &str, file: &Path, limits: &Limits) -> Result<Meant> {
        let own = |path: &Path| Ok(Meant::Own(own::read(path, limits)?, path.display().to_string()));
        let why = match styles::find(name) {
            Ok(style) => return Ok(Meant::Named(style)),
            Err(_) if name == NOTHING => return Ok(Meant::Nothing),
            Err(why) => why,
        };
        match own::own().iter().find(|(known, _)| known == name) {
            Some((_, path)) => own(path),
            None if file.is_file() => own(file),
            None => Err(Error::Usage(format!("{why}, and no such file"))),
        }
    }

    /// As the edit wants it.
    pub fn source(&self) -> Source<'_> {
        match self {
            Meant::Named(style) => Source::Named(style),
            Meant::Own(table, place) => Source::Own(table, place),
            Meant::Nothing => Source::Nothing,
        }
    }
}

/// The names of all styles, each with what it is for.
pub fn names() -> Vec<(String, String)> {
    let known = styles::all().map(|style| (style.name.to_owned(), style.help.to_owned()));
    let own = own::own().into_iter().map(|(name, path)| (name, format!("your own: {}", path.display())));
    let nothing = (NOTHING.to_owned(), "without a style: takes it away".to_owned());
    known.chain(own).chain([nothing]).collect()
}

fn save(args: &Save, context: &mut Context) -> Result<()> {
    let begun = Instant::now();
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let table = styles::in_force(&read.document, args.layer.as_deref());
    let text = json::to_text(&table.map_err(|why| Error::at(args.scene.display(), why))?);
    if args.output == Path::new("-") {
        return context.print(text.trim_end());
    }
    let mut guard = args.replacing.guard(&args.scene, read.document.scene(), context);
    let place = guard.file(&args.output, outputs::STYLE)?;
    context.say_all(&guard.notes());
    let mut draft = DraftFile::create(&place)?;
    draft.write_all(text.as_bytes()).map_err(|error| write::failed(args.output.display(), &error))?;
    draft.keep()?;
    context.done(&args.output.display().to_string(), outputs::size([place.path()]), begun);
    Ok(())
}
