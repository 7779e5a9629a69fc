//! `plica set`: scripted edits, by the same patches as the editor's.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::session::{Mode, Overwrite, Session};
use crate::preview::script;
use crate::scene::field::{self, Kind};
use crate::scene::{Document, Edit, address};

/// Set values in a scene, all of them or none.
#[derive(clap::Args)]
pub struct Args {
    /// The scene
    scene: PathBuf,
    /// What to set to what: layers.face.zones."left eye".feather=4; a value is JSON, else text; null takes an optional
    /// thing away
    #[arg(required = true, value_name = "PATH=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Sets them: in the editor that has the scene open, else in the file.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let make = |document: &Document| edit(document, &args.settings, &args.scene);
    if let Some(done) = script::edit(&args.scene, make) {
        done?;
        context.messages.say("set in the editor that has the scene open; save it there");
        return Ok(());
    }
    let mut session = Session::open(&args.scene, &args.reading.options()?, Mode::Edit)?;
    let edit = make(session.document())?;
    session.apply(edit, false).map_err(|problems| refused(&args.scene, problems))?;
    session.save(Overwrite::No)
}

/// The edit that puts all of `settings` (`PATH=VALUE`) in force, each seen after the ones before it.
pub fn edit(document: &Document, settings: &[String], scene: &Path) -> Result<Edit> {
    let mut document = document.clone();
    let mut edits = Vec::new();
    for setting in settings {
        let (path, value) = parse(setting)?;
        let pointer = address::resolve(&document, path)?;
        let edit = Edit::set(&document, &pointer, meant(&document, &pointer, value, setting, path));
        document = document.apply(&edit).map_err(|problems| refused(scene, problems))?;
        edits.push(edit);
    }
    Ok(Edit::all(edits))
}

/// What looks like another JSON value is text where only text fits (`title=2024`).
fn meant(document: &Document, pointer: &str, value: Value, setting: &str, path: &str) -> Value {
    let text = field::field(document, pointer).is_some_and(|field| field.kind == Kind::Text);
    if text && !value.is_string() && !value.is_null() { Value::from(&setting[path.len() + 1..]) } else { value }
}

fn refused(scene: &Path, problems: Vec<Problem>) -> Error {
    Error::Scene { file: scene.display().to_string(), problems }
}

/// Splits at the first `=` outside quotes; the value is JSON where it can be read as JSON, else text.
pub fn parse(setting: &str) -> Result<(&str, Value)> {
    let mut inside = false;
    let split = setting.char_indices().find(|&(_, c)| {
        inside ^= c == '"';
        c == '=' && !inside
    });
    let Some((at, _)) = split else {
        return Err(Error::Usage(format!("{setting}: write it as PATH=VALUE")));
    };
    let value = &setting[at + 1..];
    // A number that JSON cannot hold must not become text.
    match crate::scene::json::parse(value) {
        Ok(json) => Ok((&setting[..at], json)),
        Err(problem) if problem.message.contains("too large") => {
            Err(Error::at(&setting[..at], format!("{value} is not a finite number")))
        }
        Err(_) => Ok((&setting[..at], Value::from(value))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn settings() {
        for (setting, expected) in [
            ("a.b=1", Some(("a.b", json!(1)))),
            ("a=[1, 2]", Some(("a", json!([1, 2])))),
            ("a=once", Some(("a", json!("once")))),
            ("a=\"1\"", Some(("a", json!("1")))),
            ("a=", Some(("a", json!("")))),
            ("a=b=c", Some(("a", json!("b=c")))),
            ("zones.\"x=y\".name=z", Some(("zones.\"x=y\".name", json!("z")))),
            ("a", None),
            ("a=1e999", None),
        ] {
            assert_eq!(parse(setting).ok(), expected, "{setting}");
        }
    }
}
