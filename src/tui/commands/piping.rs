//! Sends the selected rows through a program of the person's, and takes what it gives back.

use super::command::{Call, Command, Done, command};
use super::obey;
use super::yanking::{counted, table};
use crate::base::problem::quoted;
use crate::tui::document::{csv, rows};
use crate::tui::events::Effect;
use crate::tui::state::outside::Piping;
use crate::tui::state::{Pane, State};
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[command(
    "pipe",
    "COMMAND",
    "Send the selected rows as CSV through a program, as awk or a script, and take what it gives back; Esc ends it",
    pipe,
)
// The log has what came back, so that running it again runs no program.
.inside()];

fn pipe(state: &mut State, call: &Call) -> Done {
    if call.text.is_empty() {
        return Err("pipe takes a program: :pipe sort -t, -k2 -n".into());
    }
    if state.outside.work.is_some() {
        return Err("something is running already: Esc ends it".into());
    }
    state.scene.writable()?;
    let (sheet, selected) = table(state, call)?;
    if state.cursor.focus == Pane::Tree {
        state.cursor.focus = Pane::Table;
        state.cursor.pick(selected.clone());
    }
    let text = rows::write(state.document(), &sheet, &selected);
    let program = call.text.to_owned();
    state.outside.work = Some(format!("pipe {program}"));
    let (revision, node) = (state.scene.revision(), state.cursor.node.clone());
    state.outside.piping = Some(Piping { program: program.clone(), revision, node, rows: selected });
    state.ask(Effect::Pipe(program, text));
    Ok(())
}

/// What the program gave back, or why there is nothing.
pub fn piped(state: &mut State, result: Result<String, String>) {
    state.outside.work = None;
    let Some(begun) = state.outside.piping.take() else { return };
    match result.and_then(|text| take(state, &begun, &text)) {
        Ok(()) => state.say(plain(&format!("{} came back from {}", counted(begun.rows.len(), "row"), begun.program))),
        Err(why) => state.complain(plain(&format!("pipe: {why}"))),
    }
}

fn take(state: &mut State, begun: &Piping, text: &str) -> Done {
    let now = (state.scene.revision(), &state.cursor.node, state.cursor.rows());
    if now != (begun.revision, &begun.node, begun.rows.clone()) {
        return Err("the rows or the selection were changed meanwhile: nothing was taken".into());
    }
    let table: Vec<Vec<String>> = csv::records(text)?.into_iter().map(|record| record.fields).collect();
    let header = table.first().is_some_and(|first| first.iter().all(|field| csv::number(field).is_none()));
    let (out, back) = (begun.rows.len(), table.len() - usize::from(header));
    if out != back {
        let said = table.first().filter(|_| back == 0).map(|first| format!(" ({})", quoted(&first.join(","))));
        let said = said.unwrap_or_default();
        return Err(format!("{} went out and {back} came back{said}: nothing was taken", counted(out, "row")));
    }
    obey(state, &format!("fill {}", serde_json::Value::from(table)), None)
}
