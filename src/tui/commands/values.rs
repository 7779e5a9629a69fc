//! Sets and shows values by their paths.

use crate::tui::text::plain;

use super::command::{Call, Command, Done, command};
use crate::base::error::Error;
use crate::ops::set;
use crate::scene::{address, field};
use crate::tui::state::{State, first};

pub const COMMANDS: &[Command] = &[
    command(
        "set",
        "PATH=VALUE ...",
        "Set values by their paths; PATH*=2 and PATH=v*2 compute, * in a path is all, .NAME is the nearest around the cursor",
        set,
    )
    .change(),
    command("get", "PATH", "Show the value at a path", get).inside(),
];

/// Sets values as `plica set` does, one or more.
fn set(state: &mut State, call: &Call) -> Done {
    let settings = set::settings(state.document(), call.text);
    if settings.is_empty() {
        return Err("set takes PATH=VALUE".into());
    }
    let scene = state.scene.path().to_owned();
    let at = state.here();
    let set = set::edit(state.document(), &settings, (&scene, &at)).map_err(|error| match error {
        // The name of the open scene would add nothing.
        Error::Scene { problems, .. } => first(&problems),
        other => other.to_string(),
    })?;
    let remarks = set.remarks(state.document(), &scene, state.scene.options());
    let places = set.places;
    state.edit(set.edit, false)?;
    let paths: Vec<String> = settings
        .iter()
        .map(|one| set::around(state.document(), &at, one).unwrap_or_else(|_| one.clone()))
        .filter_map(|one| Some(set::parse(&one).ok()?.0.trim_end_matches(['*', '/', '+']).to_owned()))
        .map(|path| match address::resolve(state.document(), &path) {
            Ok(pointer) => address::address(state.document(), &pointer),
            Err(_) => path,
        })
        .collect();
    state.say(match remarks.as_slice() {
        [] if places > paths.len() => format!("{places} places are set: {}", paths.join(", ")),
        [] => format!("{} {} set", paths.join(", "), if paths.len() == 1 { "is" } else { "are" }),
        remarks => plain(&remarks.join("; ")),
    });
    Ok(())
}

fn get(state: &mut State, call: &Call) -> Done {
    let pointer = state.resolve(call.text)?;
    let value = field::told(state.document(), &pointer);
    let value = value.ok_or_else(|| format!("{} is not set, and has no default", call.text))?;
    state.say(plain(&value.to_string()));
    Ok(())
}
