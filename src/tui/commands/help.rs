//! The help: what is under the cursor, then the keys of this pane, then everything else. All of it is made from the tables
//! and the schema.

use super::cells::number;
use super::command::{Call, Command, Done, command};
use super::contexts::contexts;
use super::fields;
use crate::base::pointer::Pointer;
use crate::scene::field::{self, Child, Field, Kind};
use crate::scene::{Document, address};
use crate::tui::document::cell::{Cell, Part};
use crate::tui::document::{cell, derived};
use crate::tui::keys::OWN_FILE;
use crate::tui::state::{Mode, Pages, Pane, State};
use crate::tui::text::wrap::wrapped;
use crate::tui::text::{numbers, plain};

pub const COMMANDS: &[Command] = &[
    command(
        "help",
        "[COMMAND|FIELD]",
        "Show help for what is under the cursor, then keys and commands; or for one",
        help,
    )
    .inside(),
    command(
        "scroll",
        "LINES|next|previous",
        "Scroll the pages, also to the next line with what was searched for",
        scroll,
    )
    .inside()
    .counted(),
];

/// Width of the text, in columns.
const WIDTH: u16 = 70;

fn help(state: &mut State, call: &Call) -> Done {
    if !call.text.is_empty() {
        return help_of(state, call);
    }
    let here = contexts(state);
    let mut contexts = here.clone();
    for row in state.keymap.rows() {
        if !contexts.contains(&row.context) {
            contexts.push(row.context);
        }
    }
    let mut lines = under_cursor(state);
    for context in contexts {
        lines.push(format!("-- {context} --"));
        let rows = state.keymap.rows().iter().filter(|row| row.context == context);
        lines.extend(rows.map(|row| format!("{:<10} {}", row.key, row.help)));
        lines.push(String::new());
    }
    lines.push(format!("Your own keys are in {OWN_FILE}; :keys shows them"));
    lines.push(String::new());
    lines.push("-- entries --".into());
    lines.extend(entries());
    lines.push(String::new());
    lines.push("-- commands, after : --".into());
    lines.extend(
        call.table
            .all()
            .map(|command| format!("{:<28} {}", format!("{} {}", command.name, command.args), command.help)),
    );
    lines.extend(call.table.subcommands().map(|name| format!("{name:<28} As `plica {name}` on this scene")));
    open(state, here[0], lines);
    Ok(())
}

/// The help of one command: its line in the table; for `put` also what can be entered; for a subcommand the text of `--help`.
/// Otherwise that of a field; where one is called like a command, of both.
fn help_of(state: &mut State, call: &Call) -> Done {
    let name = call.text.trim_start_matches(':');
    let lines: Vec<String> = match (call.table.find(name), call.table.subcommands().find(|known| known == name)) {
        (Some(command), _) if command.name == "put" => {
            let line = format!(":{} {}", command.name, command.args);
            [line, command.help.to_owned(), String::new()].into_iter().chain(entries()).collect()
        }
        (Some(command), _) => {
            let line = format!(":{} {}  {}", command.name, command.args, command.help);
            match of_field(state, call, name) {
                Ok(lines) => [line, String::new()].into_iter().chain(lines).collect(),
                Err(_) => {
                    state.say(line);
                    return Ok(());
                }
            }
        }
        (None, Some(known)) => {
            let text = crate::ops::help(&known).unwrap_or_default();
            let fits = |line: &str| if line.len() > 100 { wrapped(line, WIDTH) } else { vec![line.to_owned()] };
            let field = of_field(state, call, name).unwrap_or_default();
            field.into_iter().chain(text.lines().flat_map(fits)).collect()
        }
        (None, None) => of_field(state, call, name)?,
    };
    open(state, name, lines);
    Ok(())
}

/// Shows pages. What is being typed or aimed comes back when they are closed.
fn open(state: &mut State, name: &str, lines: Vec<String>) {
    let stays = matches!(state.typing.mode, Mode::Entry(_) | Mode::Aim);
    state.memory.under = stays.then(|| state.typing.mode.clone()).into_iter().collect();
    state.typing.mode = Mode::Pages(Pages { title: format!("help: {name}"), lines, scroll: 0 });
}

/// Help, value, range, default, path and formula of the field under the cursor, in the tree of the node.
fn under_cursor(state: &State) -> Vec<String> {
    let row = (state.cursor.focus != Pane::Tree).then(|| state.row()).flatten();
    let cell = row.as_ref().and_then(|row| state.cursor.cell(row));
    let at = cell.map_or_else(|| state.cursor.node.clone(), |cell| cell.pointer.clone());
    let document = state.document();
    let derived = cell.filter(|cell| matches!(cell.part, Part::Derived(_)));
    let field = derived.map(|cell| (*cell.field).clone()).or_else(|| field::field(document, &at));
    field.map_or(Vec::new(), |field| told(state, &at, &field, cell))
}

/// The same of a field by its name.
fn of_field(state: &State, call: &Call, name: &str) -> Result<Vec<String>, String> {
    let found = fields::called(state, call.table, name)?;
    let field = found.field(state.document()).ok_or("nothing is known of it")?;
    Ok(told(state, &found.pointer, &field, None))
}

/// The same of the field at a place; of a cell, if it is in one.
fn told(state: &State, at: &str, field: &Field, cell: Option<&Cell>) -> Vec<String> {
    let document = state.document();
    let name = if at.is_empty() { "scene".to_owned() } else { plain(&field.name) };
    let part = cell.filter(|cell| cell.part != Part::Whole).map(|cell| cell.head.as_str()).unwrap_or_default();
    // Some columns begin with the name of their field.
    let part = part.strip_prefix(&*name).unwrap_or(part).trim_start();
    let mut lines = vec![format!("-- {} --", format!("{name} {part}").trim_end())];
    lines.extend(wrapped(field.help, WIDTH));
    lines.push(String::new());
    let mut say = |name: &str, text: String| {
        if text.is_empty() {
            return;
        }
        let mut parts = wrapped(&text, WIDTH - 10).into_iter();
        lines.push(format!("{name:<9} {}", parts.next().unwrap_or_default()));
        lines.extend(parts.map(|line| format!("{:<9} {line}", "")));
    };
    say("value", value(state, at, field, cell));
    // The range names the unit too.
    match (cell::told_range(field), field.unit) {
        (Some(range), _) => say("range", range),
        (None, Some(unit)) => say("unit", unit.to_owned()),
        (None, None) => {}
    }
    if let Some(default) = &field.default {
        say("default", cell::summary(field, default));
    }
    let place = match cell.map(|cell| cell.part) {
        Some(Part::Number(i)) => Pointer(at).join(i),
        _ => at.to_owned(),
    };
    let path = plain(&address::address(document, &place));
    let is_object = field.kind.is_object();
    let inside = if is_object { field::children(document, at) } else { Vec::new() };
    let inside: Vec<_> = inside.into_iter().filter(|child| !cell::is_node(&child.field.kind)).collect();
    if !path.is_empty() {
        let one = inside.first().map(|child| format!(".{}", plain(&child.name))).unwrap_or_default();
        say("path", format!("{path}   (:set {path}{one}=VALUE)"));
    }
    for (i, child) in inside.iter().enumerate() {
        say(if i == 0 { "fields" } else { "" }, line(document, child));
    }
    if let Some((kind, help, formula)) = formula(state, at) {
        say(&kind, help);
        say("formula", formula);
    }
    lines.push(String::new());
    lines
}

/// A field of an object in a line: name, value, unit, and what it is.
fn line(document: &Document, child: &Child) -> String {
    let value = derived::value(document, &child.pointer).unwrap_or_default();
    let value = cell::summary(&child.field, &value);
    let unit = child.field.unit.filter(|unit| *unit != "1").map(|unit| format!(" {unit}")).unwrap_or_default();
    let name = plain(&child.name);
    let what = if value.is_empty() { name } else { format!("{name} = {value}{unit}") };
    format!("{what}: {}", child.field.help)
}

fn value(state: &State, at: &str, field: &Field, cell: Option<&Cell>) -> String {
    let number = cell.filter(|cell| cell.is_number()).and_then(|cell| Some((cell, cell.number(state.document())?)));
    let Some((cell, number)) = number else {
        let value = derived::value(state.document(), at).unwrap_or_default();
        return cell::summary(field, &value);
    };
    let unit = if cell.part == Part::Degrees { Some("degrees, counter-clockwise") } else { field.unit };
    format!("{}{}", numbers::exact(number), unit.map(|unit| format!(" {unit}")).unwrap_or_default())
}

/// Name, help and formula of the innermost function, method or rule around the place.
fn formula(state: &State, at: &str) -> Option<(String, String, String)> {
    let mut at = at;
    loop {
        let field = field::field(state.document(), at)?;
        if let Kind::Tagged { tag, variants } = &field.kind {
            let formula = field::formula(state.document(), at)?;
            let word = field::value(state.document(), &Pointer(at).join(tag))?;
            let help = variants.iter().find(|one| word == one.name).map_or("", |one| one.help);
            return Some(((*tag).to_owned(), format!("{}: {help}", word.as_str()?), formula.to_owned()));
        }
        at = Pointer(at).split()?.0;
    }
}

/// What can be typed into a cell.
pub fn entries() -> Vec<String> {
    let functions: Vec<&str> = crate::base::expression::functions().collect();
    let rows: &[(&str, &str)] = &[
        ("5  -18  4,5", "The value; a comma is a decimal point, except between a function's arguments"),
        ("+=3  -=3  *=2  /=2", "Change the old value; so do *2 and /2"),
        ("w/2  sqrt(2)*r", "Computed, with + - * / % ^ ( ); an = may come first"),
        (
            "x>20  tool==point",
            "1 where it holds, else 0: < <= > >= == !=, joined by and, or, not; words as they are shown",
        ),
        ("if(x>20, v*2, v)", "The second where the first is not 0, else the third"),
        ("v", "The old value, for each selected row its own"),
        ("x y dx dy ...", "The other columns of the row, by their names (land x is land_x)"),
        ("r  a", "Length and direction of the row's jump vector, degrees counter-clockwise"),
        ("w  h", "Width and height of the picture"),
        ("i  n", "The row's index in the selection, from 0, and the number of selected rows"),
        ("pi", "3.14159..."),
        ("|J|  °", "A length for a jump without one points along x; a direction needs a length first"),
        (
            "p, or a paste",
            "JSON where it fits; rows (CSV, TSV, spaces; x y dx dy or a header) into the list; over a selection as many rows as are selected, or one; dx and dy override |J| and °; on a number, 7,5 is one number",
        ),
    ];
    let named = rows.iter().map(|&(what, help)| (what, help.to_owned()));
    let all = named.chain([("functions", format!("{} (angles in degrees)", functions.join(" ")))]);
    all.flat_map(|(what, help)| {
        let lines = wrapped(&help, WIDTH - 21).into_iter().enumerate();
        lines.map(move |(i, line)| format!("{:<20} {line}", if i == 0 { what } else { "" }))
    })
    .collect()
}

fn scroll(state: &mut State, call: &Call) -> Done {
    if matches!(call.text, "next" | "previous") {
        return call.steps().try_for_each(|_| scroll_to_match(state, call.text == "next"));
    }
    let by = number(call, "scroll")?.saturating_mul(call.times());
    if let Mode::Pages(Pages { lines, scroll, .. }) = &mut state.typing.mode {
        *scroll = (*scroll as i64).saturating_add(by).clamp(0, lines.len().saturating_sub(1) as i64) as usize;
    }
    Ok(())
}

/// Scrolls to the next or the previous line that has what was searched for, continuing at the other end.
fn scroll_to_match(state: &mut State, next: bool) -> Done {
    let sought = state.memory.sought_in_pages.clone();
    let Mode::Pages(Pages { lines, scroll, .. }) = &mut state.typing.mode else { return Ok(()) };
    if sought.is_empty() {
        return Err("there was no search yet: / searches".into());
    }
    let count = lines.len();
    let away = |k: usize| if next { (*scroll + k) % count } else { (*scroll + count - k) % count };
    let found = (1..=count).map(away).find(|&line| lines[line].to_lowercase().contains(&sought));
    *scroll = found.ok_or_else(|| format!("nothing here has {sought} in it"))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::commands::obey;
    use crate::tui::keys;

    #[test]
    fn the_help_holds_every_key_and_command() {
        let mut state = crate::tui::tests::support::state();
        obey(&mut state, "help", None).unwrap();
        let Mode::Pages(pages) = &state.typing.mode else { panic!("no pages") };
        let text = pages.lines.join("\n");
        assert!(keys::KEYS.iter().all(|row| text.contains(row.help)));
        assert!(super::super::all().all(|command| text.contains(command.help)));
        let (node, pane) = (text.find("-- left eye --"), text.find(&format!("-- {} --", keys::TREE)));
        assert!(node == Some(0) && node < pane && pane < text.find(&format!("-- {} --", keys::EVERYWHERE)), "{text}");
    }
}
