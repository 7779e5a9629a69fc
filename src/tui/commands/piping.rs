//! Sends the selected rows through a program of the person's, and takes what it gives back.

use super::command::{Call, Command, Done, Table, command};
use super::yanking::table;
use crate::base::text::counted;
use crate::scene::address;
use crate::tui::document::sheet::Sheet;
use crate::tui::document::{csv, rows};
use crate::tui::events::Effect;
use crate::tui::state::outside::Piping;
use crate::tui::state::{Pane, State};
use crate::tui::text::plain;
use crate::tui::text::said::one_word;
use crate::tui::text::wrap::clipped;

pub const COMMANDS: &[Command] = &[command(
    "pipe",
    "COMMAND",
    "Send the selected rows as CSV, a header first, through a program, as sort or awk, and take what it gives back; Esc ends it",
    pipe,
)
// The log has what came back, so that running it again runs no program.
.inside()];

/// The most characters of the program that are told while it runs.
const MOST_TOLD: usize = 24;

fn pipe(state: &mut State, call: &Call) -> Done {
    if call.text.is_empty() {
        return Err("pipe takes a program: :pipe sort -t, -k2 -n, or :pipe awk -F, '{print}'".into());
    }
    state.outside.idle()?;
    state.scene.writable()?;
    let (sheet, selected) = table(state, call)?;
    if state.cursor.focus == Pane::Tree {
        state.cursor.focus = Pane::Table;
        state.cursor.pick(selected.clone());
    }
    let head = state.row().and_then(|row| state.cursor.cell(&row).map(|cell| cell.head.clone()));
    let text = rows::write(state.document(), &sheet, &selected);
    let program = call.text.to_owned();
    state.outside.work = Some(format!("pipe {}", clipped(&plain(&program), MOST_TOLD)));
    state.outside.piping = Some(Piping {
        program: program.clone(),
        revision: state.scene.revision(),
        node: state.cursor.node.clone(),
        columns: state.memory.columns.of(&state.cursor.node),
        head: head.unwrap_or_default(),
        rows: selected,
        sent: text.clone(),
    });
    state.ask(Effect::Pipe(program, text));
    Ok(())
}

/// What the program gave back, or why there is nothing.
pub fn piped(state: &mut State, commands: &'static Table, result: Result<String, String>) {
    state.outside.work = None;
    let Some(begun) = state.outside.piping.take() else { return };
    let told = match result.and_then(|text| take(state, commands, &begun, &text)) {
        Ok(()) => Ok(format!("{} came back from {}", counted(begun.rows.len(), "row"), begun.program)),
        Err(why) => Err(format!("pipe: {why}")),
    };
    state.tell_beside(told.map(|text| plain(&text)).map_err(|text| plain(&text)));
}

/// Takes a table into the rows that were sent, wherever the cursor is now.
fn take(state: &mut State, commands: &'static Table, begun: &Piping, text: &str) -> Done {
    if state.scene.revision() != begun.revision {
        let sheet = Sheet::of(state.document(), &begun.node).with(begun.columns.clone());
        if rows::write(state.document(), &sheet, &begun.rows) != begun.sent {
            return Err("the rows were changed meanwhile: nothing was taken".into());
        }
    }
    let mut table: Vec<Vec<String>> = csv::records(text)?.into_iter().map(|record| record.fields).collect();
    let sent = csv::records(&begun.sent)?.into_iter().next().map(|record| record.fields).unwrap_or_default();
    let header = match table.iter().position(|record| *record == sent) {
        // A program that sorts takes the header along.
        Some(at) => table.remove(at),
        None if table.first().is_some_and(|first| first.iter().all(|field| csv::number(field).is_none())) => {
            table.remove(0)
        }
        None => headed(&sent, &begun.head, table.first().map_or(0, Vec::len)),
    };
    let (out, back) = (begun.rows.len(), table.len());
    if out != back {
        let cure = "give back a row for each, delete with d, add with o (Y and p take any number)";
        let said = Some(header.join(",")).filter(|said| back == 0 && !said.is_empty() && header != sent);
        let said = said.map(|said| format!(" ({said})")).unwrap_or_default();
        return Err(format!(
            "{} went out and {back} came back{said}, so nothing was taken: {cure}",
            counted(out, "row")
        ));
    }
    table.insert(0, header);
    let place = one_word(&address::address(state.document(), &begun.node));
    let line = format!("fill {place} {} {}", rows::ranges(&begun.rows), serde_json::Value::from(table));
    commands.obey(state, &line, None)
}

/// The columns of rows that come back without a header: all of them, or so many from that of the cursor on.
fn headed(sent: &[String], head: &str, count: usize) -> Vec<String> {
    let from = sent.iter().position(|own| own == head).filter(|_| count != sent.len()).unwrap_or(0);
    sent.iter().skip(from).take(count).cloned().collect()
}
