//! Values by their paths.

use serde_json::Value;

use super::{Call, Command, Done, command};
use crate::scene::address;
use crate::scene::field::{self, Kind};
use crate::tui::app::State;
use crate::tui::entry;

pub const COMMANDS: &[Command] = &[
    command("set", "PATH=VALUE", "Set a value by its path", set).change(),
    command("get", "PATH", "Say the value at a path", get).inside(),
];

/// VALUE is JSON, else text.
fn set(state: &mut State, call: &Call) -> Done {
    let (path, value) = split_path(call.text).ok_or("set takes PATH=VALUE")?;
    let pointer = address::resolve(state.document(), path).map_err(|error| error.to_string())?;
    let text = field::field(state.document(), &pointer).is_some_and(|field| field.kind == Kind::Text);
    let value = match serde_json::from_str(value) {
        Ok(value) if !text => value,
        _ => Value::from(value),
    };
    let edit = entry::set(state.document(), &pointer, value);
    state.edit(edit, false)?;
    state.say(format!("{path} is set"));
    Ok(())
}

/// The path and the value around the first `=` outside quotes.
fn split_path(text: &str) -> Option<(&str, &str)> {
    let mut quoted = false;
    let equals = text.char_indices().find(|&(_, c)| {
        quoted ^= c == '"';
        c == '=' && !quoted
    })?;
    Some((text[..equals.0].trim(), text[equals.0 + 1..].trim()))
}

fn get(state: &mut State, call: &Call) -> Done {
    let pointer = address::resolve(state.document(), call.text).map_err(|error| error.to_string())?;
    let value = field::value(state.document(), &pointer).unwrap_or(Value::Null);
    state.say(crate::tui::terminal::plain(&value.to_string()));
    Ok(())
}
