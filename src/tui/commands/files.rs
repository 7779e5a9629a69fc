//! Saving, opening, leaving, the window, and other programs.

use super::command::{Call, Command, Done, command};
use super::picture::switch;
use crate::base::problem::quoted;
use crate::files::paths;
use crate::layers::parts::vectors;
use crate::preview::keys as window;
use crate::preview::views;
use crate::tui::events::Effect;
use crate::tui::state::State;

pub const COMMANDS: &[Command] = &[
    command("w", "[PATH]", "Save; with a path, save a copy there", |state, call| save(state, call, false, false)),
    command(
        "w!",
        "[PATH]",
        "Save, overwriting another program's changes, a read-only file, or the file at the path",
        |state, call| save(state, call, true, false),
    ),
    command("wq", "[PATH]", "Save, or save a copy at the path, and leave", |state, call| {
        save(state, call, false, true)
    }),
    command("q", "", "Leave; refused with unsaved edits", quit),
    command("q!", "", "Leave without saving; undo still has the edits", |state, _| {
        state.scene.give_up();
        state.ask(Effect::Quit);
        Ok(())
    }),
    command("e", "[PATH]", "Open another scene; refused with unsaved edits", |state, call| {
        refuse_unsaved(state, ":e!")?;
        open(state, call)
    }),
    command("e!", "[PATH]", "Open another scene, or go back to the saved version of this one", open),
    command("view", "[COMMAND]", "Open the preview window, or change what it shows", view).counted(),
    command("shot", "", "Save what the window shows as a picture beside the scene", |state, _| {
        state.ask(Effect::View(Some("shot".into())));
        Ok(())
    }),
    command(
        window::CAPTURE,
        "[gif|apng|webp|png|mp4]",
        "Save one round of what the window shows, overlays too, as a moving picture beside the scene",
        capture,
    ),
    command("image", "edit [NAME]", "Open a picture of the scene in another program", image).inside(),
    command("redraw", "", "Redraw the screen", |state, _| {
        state.ask(Effect::Redraw);
        Ok(())
    })
    .inside(),
    command("suspend", "", "Go to the shell", |state, _| {
        state.ask(Effect::Suspend);
        Ok(())
    })
    .inside(),
];

fn refuse_unsaved(state: &State, instead: &str) -> Done {
    if state.scene.is_saved() {
        return Ok(());
    }
    Err(format!("there are unsaved edits: :w saves them, {instead} gives them up"))
}

fn save(state: &mut State, call: &Call, overwrite: bool, leave: bool) -> Done {
    let to = call.path()?;
    if state.scene.read_only() && to.is_none() {
        return state.scene.writable();
    }
    state.ask(Effect::Save { to, overwrite, leave });
    Ok(())
}

fn quit(state: &mut State, _: &Call) -> Done {
    refuse_unsaved(state, ":q!")?;
    state.ask(Effect::Quit);
    Ok(())
}

fn open(state: &mut State, call: &Call) -> Done {
    if let Some(path) = call.path()? {
        state.ask(Effect::Open(path));
    } else if let Some(change) = state.scene.revert().map_err(|error| error.to_string())? {
        state.changed(change);
        state.say("this is the saved version; u brings back the edits");
    }
    Ok(())
}

fn view(state: &mut State, call: &Call) -> Done {
    let known = |name: &str| window::KEYS.iter().any(|row| row.context == window::VIEW && row.command == name);
    match call.text {
        "" if call.count.is_some() => return Err("view takes no count".into()),
        "" => state.ask(Effect::View(None)),
        words if words.split(' ').next() == Some(vectors::COMMAND) => call.obey(state, words)?,
        command if known(views::wanted(command).0) => {
            let (name, wanted) = views::wanted(command);
            // A switch is told as what it is set to here.
            for _ in call.steps() {
                let told = switch(state, command);
                if wanted.is_some() && told.is_none() {
                    return Err(format!("{} is no switch, to be on or off", quoted(name)));
                }
                if told.as_deref().is_some_and(|told| told.starts_with(vectors::COMMAND)) {
                    state.say(state.picture.switches.vectors.to_string());
                } else if let Some(on) = told.as_deref().and_then(|told| told.strip_prefix(name)) {
                    let row = window::KEYS.iter().find(|row| row.command == name);
                    state.say(format!("{}:{on}", row.map_or(name, |row| row.help)));
                }
                state.ask(Effect::View(Some(told.unwrap_or_else(|| name.to_owned()))));
            }
        }
        name => return Err(format!("the window has no command {}", quoted(name))),
    }
    Ok(())
}

fn capture(state: &mut State, call: &Call) -> Done {
    let command = format!("{} {}", window::CAPTURE, call.text).trim_end().to_owned();
    if views::captured(&command).is_none() {
        let known = views::captures().collect::<Vec<_>>().join(", ");
        return Err(format!("nothing is captured as {}: there are {known}", quoted(call.text)));
    }
    state.ask(Effect::View(Some(command)));
    Ok(())
}

/// `:image edit cat`; the name may be left out if there is only one picture.
fn image(state: &mut State, call: &Call) -> Done {
    let name = match call.text.split_once(' ').unwrap_or((call.text, "")) {
        ("edit", name) => name.trim(),
        _ => return Err("image edit NAME opens a picture in another program".into()),
    };
    let images = &state.document().scene().images;
    let names = || images.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
    let image = match (name, images.len()) {
        (_, 0) => return Err("the scene has no pictures".into()),
        ("", 1) => images.values().next(),
        ("", _) => return Err(format!("which picture: {}", names())),
        (name, _) => images.get(name),
    };
    let path = &image.ok_or_else(|| format!("there is no picture {name}: {}", names()))?.path;
    // Only a path that the scene is allowed to name is opened.
    paths::open(state.scene.path(), path, state.scene.options()).map_err(|error| error.to_string())?;
    let path = std::path::absolute(paths::beside(state.scene.path(), path)).map_err(|error| error.to_string())?;
    state.ask(Effect::EditImage { path, after: None });
    Ok(())
}
