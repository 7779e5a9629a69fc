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
use crate::files::{outputs, scene, write};
use crate::scene::styles::{self, Source};
use crate::scene::{Document, json};

/// List the styles that meshes can be drawn in, show one, put a layer into one, or keep that of a layer
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// List all styles: the name, what it is for
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
    /// The style, or a file that `style save` wrote
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
        What::List => {
            styles::all().try_for_each(|style| context.print(format_args!("{:<16}{}", style.name, style.help)))
        }
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
    let named = styles::find(&args.name);
    let table = match &named {
        Err(_) if Path::new(&args.name).is_file() => Some(read(Path::new(&args.name), &args.reading)?),
        _ => None,
    };
    let source = match (&table, named) {
        (Some(table), _) => Source::Own(table, &args.name),
        (None, Ok(style)) => Source::Named(style),
        (None, Err(why)) => return Err(Error::Usage(format!("{why}, and no such file"))),
    };
    let make = |document: &Document| styles::apply(document, args.layer.as_deref(), source, args.whole);
    set::apply(&args.scene, (&args.recovery, &args.reading), make, context)
}

/// The table in a file.
fn read(path: &Path, reading: &SceneOptions) -> Result<Value> {
    let text = scene::read_text(path, &reading.options()?.limits)?;
    let table = json::parse(&text).map_err(|problem| Error::at(path.display(), problem))?;
    if !table.is_object() || table.get("plica").is_some() {
        return Err(Error::at(path.display(), "is no style").cure("plica style save writes one"));
    }
    Ok(table)
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
