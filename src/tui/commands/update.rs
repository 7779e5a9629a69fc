//! What comes in and what goes out: `update` takes an event, changes the state and gives effects, for others to perform.

use std::path::PathBuf;
use std::sync::Arc;

use ratatui::layout::Position;

use super::life;
use crate::preview::Transport;
use crate::preview::editor::Asked;
use crate::render::Synth;
use crate::scene::{Document, Edit};
use crate::tui::document::tree;
use crate::tui::graphics::Shown;
use crate::tui::keys::Found;
use crate::tui::layout::seeing::Probed;
use crate::tui::panes::first_row;
use crate::tui::panes::view;
use crate::tui::state::{Mode, Pages, State};
use crate::tui::{commands, tutor};

/// Something that happened.
pub enum Event {
    /// A key, by its name in the table.
    Key(String),
    /// A line of a script.
    Line(String),
    /// A line of the line mode, none at the end of the input; lines.rs takes it before it comes here.
    Typed(Option<String>),
    /// The lines that the one being typed could become.
    Completed(Vec<String>),
    /// Text pasted by the terminal.
    Paste(String),
    /// The terminal has another size.
    Resize(u16, u16),
    /// This much time has passed while playing, in seconds.
    Tick(f64),
    /// A synthesis has ended: what it made and how long it took, or what kept it.
    Synthesised(Result<Synthesis, String>),
    /// A synthesis has begun.
    Synthesising,
    /// What a pixel does.
    Probed(Arc<Probed>),
    /// A picture is there.
    Framed(Arc<Shown>),
    /// Long work has got on.
    Progress(String),
    /// Long work has ended; what it said last.
    Done(Result<String, String>),
    /// A save has ended.
    Saved(Result<String, String>),
    /// The windows have something new to say about themselves.
    WindowChanged,
    /// The pointer in a window, in pixels of the picture.
    Pointer(f64, f64),
    /// A window plays or stands like this.
    Transport(Transport),
    /// A window asks for a command, by its name in the window's table.
    Command(String),
    /// A script asks for an edit.
    Asked(Asked),
    /// A thread beside the editor had a fault of its own.
    Fault(String),
    /// The log of the session cannot be written.
    Unlogged(String),
    /// Files of the scene have changed on the disk.
    FilesChanged(Vec<PathBuf>),
    /// The system asks for an end, or the terminal has gone away.
    End,
    /// The shell's Ctrl-Z came from outside.
    Stop,
    /// A click, in cells of the terminal.
    Click(u16, u16),
}

/// What a synthesis has made.
pub struct Synthesis {
    /// What a frame needs.
    pub synth: Arc<Synth>,
    /// How long it took, in milliseconds.
    pub ms: f64,
    /// The longest jump vector of every zone, by layer and zone.
    pub longest: Vec<(usize, usize, f64)>,
    /// What of its pictures could not be followed, or is odd about them.
    pub warning: Option<String>,
}

/// A change of the document, as the windows want it.
#[derive(Clone, Debug)]
pub struct Change {
    /// The document after it.
    pub document: Document,
    /// Its revision.
    pub revision: u64,
    /// What was changed.
    pub edit: Edit,
}

/// Something to be done outside.
#[derive(Clone, Debug)]
pub enum Effect {
    /// The document has changed: show it everywhere.
    Publish(Box<Change>),
    /// The time or the selection has changed.
    Show,
    /// The time has passed, or a window has changed it: the windows know.
    Pass,
    /// Write the document; to the scene's own file where no other is given.
    Save {
        /// Another file.
        to: Option<PathBuf>,
        /// Whether another program's version may be lost.
        overwrite: bool,
        /// Whether to leave once it is safe.
        leave: bool,
    },
    /// Write a text to a new file.
    Write(PathBuf, String),
    /// Run the lines of a file.
    Source(PathBuf),
    /// Read the person's own keys anew.
    Keymap,
    /// Open another scene.
    Open(PathBuf),
    /// Open this scene to edit it, although somebody may do so elsewhere.
    TakeOver,
    /// Begin the tutor, on a scene of its own.
    Tutor,
    /// Load the pictures again.
    Reload,
    /// The pixel that these arguments of `plica probe` are about was asked for: its read-out is open where there is a screen.
    Probe(Vec<String>),
    /// Run a subcommand of the command line with these arguments.
    Run(Vec<String>),
    /// Look for the files that a path could become.
    Complete {
        /// The command that takes the path.
        name: String,
        /// What has been typed of it.
        path: String,
        /// The folder it is relative to; the present one where none is given.
        beside: Option<PathBuf>,
    },
    /// Hand a text to the terminal's clipboard.
    Copy(String),
    /// End long work.
    Cancel,
    /// Open the preview window, or give it a command of its table.
    View(Option<String>),
    /// Open a picture in another program.
    EditImage(PathBuf),
    /// Draw everything anew.
    Redraw,
    /// Stop the process as Ctrl-Z does in a shell.
    Suspend,
    /// Leave.
    Quit,
}

/// Takes an event and gives what is to be done outside.
pub fn update(state: &mut State, event: Event) -> Vec<Effect> {
    match event {
        Event::Key(key) => press(state, &key),
        Event::Line(line) => {
            state.message = None;
            commands::run(state, &line, None);
        }
        Event::Completed(lines) => {
            if let Mode::Line(line) = &mut state.mode {
                line.complete(|_| lines);
            }
        }
        Event::Paste(text) => paste(state, &text),
        Event::Resize(width, height) => state.size = (width, height),
        Event::Tick(seconds) => state.pass(seconds),
        Event::Synthesising => state.seeing.synthesising = true,
        Event::Probed(probed) => state.seeing.probed = Some(probed),
        Event::Synthesised(Ok(Synthesis { synth, ms, longest, warning })) => {
            state.seeing.synthesising = false;
            state.seeing.longest = longest;
            state.picture_size = Some(synth.size);
            state.seen.synth = Some(synth);
            state.seen.synth_ms = Some(ms);
            state.seen.problem = warning;
        }
        Event::Synthesised(Err(problem)) => {
            state.seeing.synthesising = false;
            state.seen.problem = Some(problem);
        }
        Event::Framed(shown) => state.seeing.shown = Some(shown),
        Event::Progress(line) => state.seen.work = Some(line),
        Event::Done(result) => {
            if let (Some(work), Ok(_)) = (state.seen.work.take(), &result) {
                tutor::ended(state, &work);
            }
            report(state, result);
        }
        Event::Saved(result) => {
            if state.door.is_saved() {
                state.life.file = None;
            }
            report(state, result);
        }
        Event::WindowChanged | Event::Typed(_) => {}
        Event::Pointer(x, y) => state.seen.pointer = Some((x, y)),
        Event::Click(x, y) => click(state, x, y),
        Event::Transport(transport) => state.follow(transport),
        Event::Command(name) => commands::run_of_window(state, &name),
        Event::Asked(asked) => answer(state, asked),
        Event::Fault(fault) => state.complain(fault),
        Event::Unlogged(why) => {
            state.recorder.set_place(None);
            // A line that is running is not to blame.
            state.say(format!("the log of this session is not kept: {why}"));
        }
        Event::FilesChanged(files) => life::follow(state, &files),
        Event::End => state.ask(Effect::Quit),
        Event::Stop => state.ask(Effect::Suspend),
    }
    tutor::follow(state);
    life::ask(state);
    state.effects.drain(..).collect()
}

/// An edit that a script asks for goes through the same door.
fn answer(state: &mut State, asked: Asked) {
    match state.door.apply(asked.edit.clone(), false) {
        Ok(change) => {
            change.into_iter().for_each(|change| state.changed(change));
            asked.answer(Vec::new());
        }
        Err(problems) => asked.answer(problems),
    }
}

/// Says how something ended: in the line, or in pages of its own where it is longer.
fn report(state: &mut State, result: Result<String, String>) {
    match result {
        // Nobody who is typing is interrupted: `:messages` has it then.
        Ok(text) if text.trim_end().contains('\n') && matches!(state.mode, Mode::Normal | Mode::Pages(_)) => {
            let lines = text.lines().map(crate::tui::outside::terminal::plain).collect();
            state.mode = Mode::Pages(Pages { title: "output".into(), lines, scroll: 0 });
        }
        Ok(text) => state.say(text.trim_end()),
        Err(text) => state.complain(text),
    }
}

/// Pasted text is typed where something is typed; a line end ends it.
fn paste(state: &mut State, text: &str) {
    state.pressed.clear();
    state.count = None;
    if state.is_small() && !matches!(state.mode, Mode::Line(_)) {
        return state.complain(TOO_SMALL);
    }
    // Terminals send the ends of lines as the Enter key does.
    let text = &text.replace("\r\n", "\n").replace('\r', "\n");
    let first = text.lines().next().unwrap_or_default();
    match &state.mode {
        Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) => type_text(state, first),
        Mode::Normal => {
            if let Err(why) = commands::pasted(state, text) {
                state.complain(why);
            }
        }
        _ => state.complain("end this first (Esc): pasted rows go into lists, and text into what is being typed"),
    }
}

fn type_text(state: &mut State, text: &str) {
    commands::run(state, &format!("type {}", commands::quoted(text)), None);
}

/// A click goes to the pane under it, and in the tree to the row.
fn click(state: &mut State, x: u16, y: u16) {
    if !matches!(state.mode, Mode::Normal) || state.is_small() {
        return;
    }
    let areas = view::areas(view::screen(state), state.seeing.probing);
    let at = Position::new(x, y);
    if areas.tree.contains(at) {
        let rows = tree::rows(state.document(), &state.folded);
        let first = first_row(tree::row_of(&rows, &state.node), rows.len(), areas.tree.height.saturating_sub(2));
        let row = rows.get(first + usize::from(y.saturating_sub(areas.tree.y + 1)));
        if let Some(row) = row {
            commands::run(state, &format!("go {}", row.pointer), None);
        }
        commands::run(state, "pane tree", None);
    } else if areas.right.is_some_and(|[.., picture]| picture.contains(at)) {
        commands::run(state, "pane picture", None);
    } else if areas.table.contains(at) {
        commands::run(state, "pane table", None);
    }
}

/// Said where the terminal is too small for a key.
const TOO_SMALL: &str = ":q leaves, :wq saves and leaves";

fn press(state: &mut State, key: &str) {
    let counting = matches!(state.mode, Mode::Normal | Mode::Aim | Mode::Choice(_) | Mode::Pages(_));
    let counting = counting && state.pressed.is_empty() && !state.is_small();
    if let (true, Some(digit)) =
        (counting, key.parse::<usize>().ok().filter(|&d| d < 10 && (d > 0 || state.count.is_some())))
    {
        state.count = Some((state.count.unwrap_or(0) * 10 + digit).min(1_000_000));
        return;
    }
    let pressed = if state.pressed.is_empty() { key.to_string() } else { format!("{} {key}", state.pressed) };
    state.pressed.clear();
    match state.keymap.find(&state.contexts(), &pressed) {
        Found::Prefix => state.pressed = pressed,
        Found::Line(line) => {
            let count = state.count.take();
            state.message = None;
            commands::run(state, &line, count);
        }
        Found::Nothing => {
            state.count = None;
            match after_escape(key) {
                Some(after) => {
                    // An Esc after the first key of several only ends those.
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

/// The key that was pressed right after Esc: terminals send the two as they send one key with Alt.
fn after_escape(key: &str) -> Option<String> {
    match key.strip_prefix("Ctrl-Alt-") {
        Some(plain) => Some(format!("Ctrl-{plain}")),
        None => key.strip_prefix("Alt-").filter(|plain| !plain.is_empty()).map(str::to_owned),
    }
}

/// A key without a binding: typed where something is typed, else said to mean nothing.
fn unbound(state: &mut State, key: &str, pressed: &str) {
    let typed = if key == "Space" { " " } else { key };
    let one = typed.chars().count() == 1;
    match &state.mode {
        Mode::Entry(_) | Mode::Line(_) | Mode::Palette(_) if one => type_text(state, typed),
        Mode::Normal if pressed.contains(' ') && key == "Esc" => {}
        _ if state.is_small() => state.complain(TOO_SMALL),
        Mode::Normal | Mode::Aim => state.complain(format!("{pressed} is not a key here (? shows the keys)")),
        _ => {}
    }
}
