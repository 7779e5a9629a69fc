//! `update` handles an event: it changes the state and returns the effects that others perform.

use crate::base::problem::Problem;
use crate::scene::{Document, address};
use crate::tui::commands::contexts::contexts;
use crate::tui::commands::pasting;
use crate::tui::events::{Effect, Event, Synthesis};
use crate::tui::layout;
use crate::tui::text::plain;
use crate::tui::text::said::quoted;
use ratatui::layout::Position;

use super::{camera, conflicts, picture, piping, tutor, views};
use crate::preview::editor::{self, Asked};
use crate::preview::wire::message::{Gesture, ToEditor};
use crate::tui::commands;
use crate::tui::document::tree;
use crate::tui::keys::{self, Meaning};
use crate::tui::layout::first_row;
use crate::tui::state::{Mode, Pages, Pane, State, looking, painting};

/// Handles an event, and returns what is to be done outside. What is typed while windows are asked something comes after that.
pub fn update(state: &mut State, event: Event) -> Vec<Effect> {
    if state.outside.asking.is_some() && waits(&event) {
        state.outside.postponed.push_back(event);
        return Vec::new();
    }
    handle(state, event);
    while state.outside.asking.is_none()
        && let Some(event) = state.outside.postponed.pop_front()
    {
        handle(state, event);
    }
    painting::follow(state);
    tutor::follow(state);
    state.ask_waiting();
    state.effects.drain(..).collect()
}

/// Whether it is something that a person asks for, but for Esc, which ends what is waited for.
fn waits(event: &Event) -> bool {
    match event {
        Event::Key(key) => key != "Esc",
        Event::Line(_) | Event::Paste(_) | Event::Click(..) => true,
        _ => false,
    }
}

fn handle(state: &mut State, event: Event) {
    match event {
        Event::Key(key) => press(state, &key),
        Event::Line(line) => {
            state.message = None;
            commands::run(state, &line, None);
        }
        Event::Completed(lines) => {
            if let Mode::Line(line) = &mut state.typing.mode {
                line.complete(|_| lines);
            }
        }
        Event::Paste(text) => paste(state, &text),
        Event::Resize(width, height) => state.size = (width, height),
        Event::Tick(seconds) => state.pass(seconds),
        Event::Synthesising => (state.picture.synthesising, state.picture.filled) = (true, None),
        Event::Reading(percent) => state.picture.read = Some(percent).filter(|percent| *percent < 100),
        Event::Filling(percent) => state.picture.filled = Some(percent).filter(|percent| *percent < 100),
        Event::Probed(probed) => state.picture.probed = Some(probed),
        Event::Counted(counts) => state.picture.counts = Some(counts),
        Event::Synthesised(result) => synthesised(state, *result),
        Event::Made(scene) => state.picture.made = Some(scene),
        Event::Picture(shown, ms) => (state.picture.latest, state.picture.frame_ms) = (Some(shown), Some(ms)),
        Event::Progress(line) => state.outside.work = Some(line),
        Event::Done(result) => {
            if let (Some(work), Ok(_)) = (state.outside.work.take(), &result) {
                tutor::ended(state, &work);
            }
            report(state, result);
        }
        Event::Drawn(result) => views::drawn(state, *result),
        Event::Piped(result) => piping::piped(state, &commands::TABLE, result),
        Event::Saved(result) => {
            if state.scene.is_saved() {
                state.outside.file = None;
            }
            report(state, result);
        }
        Event::Typed(_) => {}
        Event::Click(x, y) => click(state, x, y),
        Event::Window(said) => hear(state, said),
        Event::Fault(fault) => state.complain(fault),
        Event::Unlogged(why) => {
            state.memory.recorder.set_place(None);
            // Only `say`: the line that is running did not fail.
            state.say(format!("the log of this session cannot be written: {why}"));
        }
        Event::FilesChanged(files) => conflicts::follow(state, &files),
        Event::End => state.ask(Effect::Quit),
        Event::Stop => state.ask(Effect::Suspend),
        Event::Continue => state.ask(Effect::Return),
    }
}

/// Handles messages of windows and scripts.
fn hear(state: &mut State, event: editor::Event) {
    match event {
        editor::Event::Said(ToEditor::Gesture(gesture)) => follow_window(state, gesture),
        editor::Event::Answered(silent) => camera::answered(state, &commands::TABLE, &silent),
        editor::Event::Edit(asked) => answer(state, asked),
        // The link answers these. The loop on a screen asks for the status after every event.
        editor::Event::Said(
            ToEditor::Hello { .. }
            | ToEditor::Ack { .. }
            | ToEditor::WantScene
            | ToEditor::Report { .. }
            | ToEditor::Want { .. }
            | ToEditor::Alive
            | ToEditor::Answer(_)
            | ToEditor::Edit { .. },
        )
        | editor::Event::Status => {}
    }
}

fn follow_window(state: &mut State, gesture: Gesture) {
    match gesture {
        Gesture::Pointer { x, y } => state.outside.pointer = Some((x, y)),
        Gesture::Camera(camera) => state.outside.camera = camera,
        Gesture::Transport(transport) => state.follow(transport),
        Gesture::Command(name) => run_of_window(state, &name),
    }
}

/// Handles the result of a synthesis.
fn synthesised(state: &mut State, result: Result<Synthesis, Problem>) {
    (state.picture.synthesising, state.picture.read, state.picture.filled) = (false, None, None);
    let (problem, warning) = match &result {
        Ok(made) => (None, made.warning.as_ref()),
        Err(problem) => (Some(problem), None),
    };
    // What is wrong from the start would go unseen below the greeting.
    if state.picture.synth_ms.is_none() && state.outside.problem.is_none() {
        match (problem, warning) {
            (Some(problem), _) => state.complain(told(state.document(), problem)),
            (None, Some(warning)) => state.say(told(state.document(), warning)),
            (None, None) => {}
        }
    }
    match result {
        Ok(Synthesis { synth, ms, longest, warning }) => {
            state.picture.longest = longest;
            state.picture.synth = Some(synth);
            looking::look(state, state.picture.looking);
            state.picture.synth_ms = Some(ms);
            state.outside.problem = warning;
        }
        Err(problem) => state.outside.problem = Some(problem),
    }
}

/// A problem of the files that a scene names, with the address of its place.
fn told(document: &Document, problem: &Problem) -> String {
    address::of_problem(document, problem).to_string()
}

/// Applies an edit that a script asks for.
fn answer(state: &mut State, asked: Asked) {
    let allowed = state.unlocked(&asked.edit).map_err(|why| vec![Problem::error("", why)]);
    match allowed.and_then(|()| state.scene.apply(asked.edit.clone(), false)) {
        Ok(change) => {
            change.into_iter().for_each(|change| state.changed(change));
            asked.answer(Vec::new());
        }
        Err(problems) => asked.answer(problems),
    }
}

/// Shows the result of work, in the line or, if it has several lines, in pages.
fn report(state: &mut State, result: Result<String, String>) {
    let text = result.as_ref().unwrap_or_else(|text| text).trim_end();
    let lines: Vec<&str> = text.lines().collect();
    // While something is being typed no pages open; `:messages` has all lines.
    let opens = lines.len() > 1 && matches!(state.typing.mode, Mode::Normal | Mode::Pages(_));
    match &result {
        Ok(_) if opens => {}
        _ => state.tell_beside(result.as_ref().map(|_| text.to_owned()).map_err(|_| text.to_owned())),
    }
    if opens {
        let lines = lines.into_iter().map(plain).collect();
        state.typing.mode = Mode::Pages(Pages { title: "output".into(), lines, scroll: 0 });
    }
}

/// Handles a paste. If something is being typed, the text is typed into it, if it is one line.
fn paste(state: &mut State, text: &str) {
    state.typing.pressed.clear();
    state.typing.count = None;
    if state.is_small() && !matches!(state.typing.mode, Mode::Line(_)) {
        return state.complain(TOO_SMALL);
    }
    // Terminals send line ends as the Enter key does.
    let text = &text.replace("\r\n", "\n").replace('\r', "\n");
    match &state.typing.mode {
        Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) => type_pasted(state, text),
        Mode::Normal => {
            if let Err(why) = pasting::pasted(state, text) {
                state.complain(why);
            }
        }
        Mode::Choice(_) | Mode::Pages(_) | Mode::Aim => {
            state.complain("close this first (Esc): rows are pasted into lists, text into what is being typed")
        }
    }
}

fn type_pasted(state: &mut State, text: &str) {
    let single = text.lines().count() == 1;
    let mut lines = text.lines().filter(|line| single || !line.trim().is_empty());
    match (lines.next().unwrap_or_default(), lines.count()) {
        (line, 0) => type_text(state, line),
        (_, more) => {
            state.complain(format!("{} lines were pasted, but one is typed here: nothing was taken", more + 1))
        }
    }
}

fn type_text(state: &mut State, text: &str) {
    commands::run(state, &format!("type {}", quoted(text)), None);
}

/// Goes to the pane that was clicked, and in the tree to the row.
fn click(state: &mut State, x: u16, y: u16) {
    if !matches!(state.typing.mode, Mode::Normal) || state.is_small() {
        return;
    }
    let Some(pane) = layout::pane_at(state, Position::new(x, y)) else { return };
    if pane == Pane::Tree {
        let area = layout::areas_of(state).tree;
        let rows = tree::rows(state.document(), &state.cursor.collapsed);
        let first = first_row(tree::row_of(&rows, &state.cursor.node), rows.len(), area.height.saturating_sub(2));
        let row = rows.get(first + usize::from(y.saturating_sub(area.y + 1)));
        if let Some(row) = row {
            commands::run(state, &format!("go {}", row.pointer), None);
        }
    }
    let name = match pane {
        Pane::Tree => "tree",
        Pane::Table => "table",
        Pane::Picture => "picture",
    };
    commands::run(state, &format!("pane {name}"), None);
}

/// The message if the terminal is too small for a key.
const TOO_SMALL: &str = ":q leaves, :wq saves and leaves";

fn press(state: &mut State, key: &str) {
    let counting = matches!(state.typing.mode, Mode::Normal | Mode::Aim | Mode::Choice(_) | Mode::Pages(_));
    let counting = counting && state.typing.pressed.is_empty() && !state.is_small();
    if let (true, Some(digit)) =
        (counting, key.parse::<usize>().ok().filter(|&d| d < 10 && (d > 0 || state.typing.count.is_some())))
    {
        // A count that is too large is refused by its command.
        state.typing.count = Some(state.typing.count.unwrap_or(0).saturating_mul(10).saturating_add(digit));
        return;
    }
    let pressed =
        if state.typing.pressed.is_empty() { key.to_string() } else { format!("{} {key}", state.typing.pressed) };
    state.typing.pressed.clear();
    match state.keymap.find(&contexts(state), &pressed) {
        Meaning::Prefix => state.typing.pressed = pressed,
        Meaning::Line(line) => {
            let count = state.typing.count.take();
            state.begin_key(matches!(line.as_str(), "back" | "leave" | "cancel"));
            commands::run(state, &line, count);
        }
        Meaning::Nothing => {
            state.typing.count = None;
            match after_escape(key) {
                Some(after) => {
                    // After the first key of a sequence, Esc only ends the sequence.
                    if pressed == key {
                        press(state, "Esc");
                    }
                    press(state, &after);
                }
                None => unbound(state, key, &pressed),
            }
        }
    }
}

/// The key that was pressed right after Esc, because terminals send these two like one key with Alt.
fn after_escape(key: &str) -> Option<String> {
    match key.strip_prefix("Ctrl-Alt-") {
        Some(plain) => Some(format!("Ctrl-{plain}")),
        None => key.strip_prefix("Alt-").filter(|plain| !plain.is_empty()).map(str::to_owned),
    }
}

/// Handles a key without a binding: it is typed if something is being typed, else there is a message.
fn unbound(state: &mut State, key: &str, pressed: &str) {
    let typed = if key == "Space" { " " } else { key };
    let one = typed.chars().count() == 1;
    match &state.typing.mode {
        Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) if one => type_text(state, typed),
        Mode::Normal if pressed.contains(' ') && key == "Esc" => {}
        _ if state.is_small() => state.complain(TOO_SMALL),
        Mode::Aim => state.complain("aiming: only the cursor, Enter, Esc, : and ? act"),
        Mode::Normal => {
            let elsewhere =
                elsewhere(state, pressed).map(|context| format!(", but of the {context}")).unwrap_or_default();
            state.complain(format!("{pressed} is not a key here{elsewhere} (? shows the keys)"));
        }
        Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) | Mode::Choice(_) | Mode::Pages(_) => {}
    }
}

/// The context, narrower than that of the pane, in which it is a key.
fn elsewhere(state: &State, pressed: &str) -> Option<&'static str> {
    let here = contexts(state);
    let is_narrower =
        |other: &&str| here.iter().any(|own| other.strip_prefix(own).is_some_and(|rest| rest.starts_with(", ")));
    let narrower = keys::contexts().into_iter().filter(is_narrower);
    narrower.into_iter().find(|context| !matches!(state.keymap.find(&[context], pressed), Meaning::Nothing))
}

/// Runs a command of a window.
fn run_of_window(state: &mut State, name: &str) {
    match name {
        "mark-point" => commands::run(state, "pointer mark", None),
        "select-point" => commands::run(state, "pointer select", None),
        "copy-point" => commands::run(state, "pointer copy", None),
        told if told.starts_with("band ") => commands::run(state, &format!("pointer {told}"), None),
        "next-sight" => commands::run(state, "layout next", None),
        "undrag" => commands::run(state, "pointer undrag", None),
        told if ["drag ", "drop ", "take ", "file "].iter().any(|verb| told.starts_with(verb)) => {
            commands::run(state, &format!("pointer {told}"), None);
        }
        told => picture::follow_window(state, told),
    }
}
