//! Which part of the picture is visible, how it is sent to the terminal, and the read-out of a pixel.

use kurbo::Vec2;

use super::command::{Call, Command, Done, command};
use crate::base::problem;
use crate::layers::parts::pass::COLOR;
use crate::preview::views;
use crate::render::passes::Asked;
use crate::tui::events::Effect;
use crate::tui::graphics::{Graphics, Protocol, viewport};
use crate::tui::layout::picture;
use crate::tui::state::painting::Sees;
use crate::tui::state::picture::Picture;
use crate::tui::state::{Pane, State};
use crate::tui::text::numbers::short;

pub const COMMANDS: &[Command] = &[
    command("zoom", "in|out|fit|one", "Zoom the picture, here and in the window", zoom).counted_with(&["in", "out"]),
    command("pan", "left|right|up|down|cursor", "Show another part of the picture", pan)
        .counted_with(&["left", "right", "up", "down"]),
    command(
        "graphics",
        "[auto|kitty|iterm2|sixel|blocks|bytes N|rate N]",
        "Show or set how the picture is sent to the terminal, and how many bytes it takes: a frame, a second of playing blocks",
        graphics,
    ),
    command(
        "pass",
        "[NAME[:LAYER]]",
        "Show depth, normals or another pass in place of the picture, here and in the window",
        pass,
    ),
    command("probe", "[X,Y|off]", "Open or close the read-out of a pixel", probe),
    command(
        "vectors",
        "[NAME=VALUE...|default]",
        "Show or set how the vector field is drawn: color, length, equal, longest, steepest, opacity",
        vectors,
    ),
];

fn zoom(state: &mut State, call: &Call) -> Done {
    let known = [("in", "zoom-in"), ("out", "zoom-out"), ("fit", "zoom-fit"), ("one", "zoom-one")];
    let (_, same) = known.iter().find(|(way, _)| *way == call.text).ok_or("zoom takes in, out, fit or one")?;
    let steps = call.steps();
    steps.clone().for_each(|_| state.ask(Effect::View(Some((*same).to_string()))));
    let (Some(before), Some(size)) = (picture::part(state), state.picture.size) else { return Ok(()) };
    let fit = viewport::fit(size, before.dots);
    state.picture.viewport.zoom = match call.text {
        "fit" => None,
        "one" => (fit > 1.0).then_some(1.0),
        way => {
            steps.fold(state.picture.viewport.zoom, |zoom, _| viewport::zoomed(zoom.unwrap_or(fit), fit, way == "in"))
        }
    };
    // The pixel under the cursor stays in its place.
    let (cursor, scale) = (state.picture.cursor, state.picture.viewport.zoom.unwrap_or(fit));
    state.picture.viewport.center = cursor + (before.corner + before.extent() / 2.0 - cursor) * (scale / before.scale);
    picture::settle(state);
    Ok(())
}

fn pan(state: &mut State, call: &Call) -> Done {
    let (x, y) = match call.text {
        "left" => (-1.0, 0.0),
        "right" => (1.0, 0.0),
        "up" => (0.0, -1.0),
        "down" => (0.0, 1.0),
        "cursor" => {
            state.picture.viewport.center = state.picture.cursor;
            return Ok(());
        }
        _ => return Err("pan takes left, right, up, down or cursor".into()),
    };
    for _ in call.steps() {
        if let (Some(part), Some(size)) = (picture::part(state), state.picture.size) {
            let Picture { viewport, cursor, .. } = &mut state.picture;
            viewport::pan(viewport, cursor, &part, size, Vec2::new(x, y));
        }
    }
    state.picture.step(Vec2::ZERO);
    picture::settle(state);
    Ok(())
}

fn graphics(state: &mut State, call: &Call) -> Done {
    let mut words = call.text.split_whitespace();
    let graphics = &mut state.picture.graphics;
    match (words.next(), words.next()) {
        (None, _) => {}
        (Some("auto"), None) => graphics.forced = None,
        (Some("bytes"), Some(bytes)) => {
            let bytes = bytes.parse::<usize>().ok().filter(|bytes| (1000..=100_000_000).contains(bytes));
            let bytes = bytes.ok_or("graphics bytes takes a number from 1000 to 100000000")?;
            graphics.bytes = (bytes, bytes);
        }
        (Some("rate"), Some(rate)) => {
            let rate = rate.parse::<usize>().ok().filter(|rate| (1000..=100_000_000).contains(rate));
            graphics.rate = rate.ok_or("graphics rate takes a number of bytes a second from 1000 to 100000000")?;
        }
        (Some(name), None) => {
            let known = Protocol::NAMES.iter().map(|(name, _)| *name).chain(["auto", "bytes", "rate"]);
            let near = problem::nearest(name, known).map(|near| format!(": {near}")).unwrap_or_default();
            let protocol = Protocol::named(name).ok_or_else(|| format!("there are no graphics {name}{near}"))?;
            graphics.forced = Some(protocol);
        }
        _ => return Err("graphics takes auto, kitty, iterm2, sixel, blocks, bytes N or rate N".into()),
    }
    let Graphics { bytes: (playing, still), cell: (width, height), rate, .. } = state.picture.graphics;
    let taken =
        state.picture.latest.as_ref().map(|shown| format!(", the last took {}", shown.bytes)).unwrap_or_default();
    state.say(format!(
        "graphics: {} (the terminal: {}), cells of {width} x {height} px, at most {playing} bytes a frame while playing, \
         {still} still, {rate} a second while blocks play{taken}",
        picture::protocol(state).name(),
        state.picture.graphics.found.name(),
    ));
    Ok(())
}

/// Shows a pass in the picture's pane and in the windows; without a name, or by the name color, the picture again.
fn pass(state: &mut State, call: &Call) -> Done {
    let asked = match call.text {
        "" => None,
        text => Some(Asked::parse(text, state.document().scene())?),
    };
    let empty = asked.as_ref().and_then(|asked| asked.emptiness(state.document().scene()));
    empty.into_iter().for_each(|told| state.say(told));
    take_pass(state, asked);
    let words = state.picture.pass.as_ref().map(|asked| asked.words(state.document().scene()));
    state.ask(Effect::View(Some(views::show_pass(words.as_deref()))));
    Ok(())
}

/// Takes a command that turns something on or off, or over, here; returns it as it is told to windows, if it is one.
pub fn switch(state: &mut State, command: &str) -> Option<String> {
    let told = state.picture.switches.take(command)?;
    match views::wanted(&told) {
        (name, Some(false)) => drop(state.picture.off.insert(name.to_owned())),
        (name, Some(true)) => drop(state.picture.off.remove(name)),
        (_, None) => {}
    }
    Some(told)
}

/// Shows here what a window was told to show.
pub fn follow_window(state: &mut State, command: &str) {
    switch(state, command);
    // The window's scene may be a step behind, and have other layers.
    if let Some(pass) = views::pass_in(command)
        && let Ok(asked) = pass.map(|pass| Asked::parse(&pass, state.document().scene())).transpose()
    {
        take_pass(state, asked);
    }
}

/// Sets how the vector field is drawn, here and in the windows, and says how it is.
fn vectors(state: &mut State, call: &Call) -> Done {
    let look = &mut state.picture.switches.vectors;
    let before = look.clone();
    look.set(call.text).inspect_err(|_| *look = before.clone())?;
    let (told, all) = ((*look != before).then(|| look.command()), look.to_string());
    told.into_iter().for_each(|told| state.ask(Effect::View(Some(told))));
    state.say(all);
    Ok(())
}

fn take_pass(state: &mut State, asked: Option<Asked>) {
    state.picture.pass = asked.filter(|asked| *asked.pass != COLOR || asked.layer.is_some());
    state.picture.switches.under_pass(state.picture.pass.is_some());
}

/// Opens the read-out of the pixel under the cursor, or of X,Y; closes it if it is open.
fn probe(state: &mut State, call: &Call) -> Done {
    if call.text == "off" || (call.text.is_empty() && state.picture.probing) {
        state.picture.probing = false;
        picture::settle(state);
        return Ok(());
    }
    if picture::sees(state) != Sees::Results {
        return Err("the read-out is of the results: :layout results shows them".into());
    }
    if !call.text.is_empty() {
        let numbers: Vec<f64> = call.text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
        let [x, y] = numbers[..] else { return Err("probe takes X,Y or off".into()) };
        if let Some((width, height)) = state.picture.size
            && !((0.0..width as f64).contains(&x) && (0.0..height as f64).contains(&y))
        {
            return Err(format!("{} is outside the picture of {width} x {height} pixels", call.text));
        }
        state.picture.cursor = (x, y).into();
        state.picture.step(Vec2::ZERO);
    } else {
        state.cursor.focus = Pane::Picture;
    }
    state.picture.probing = true;
    picture::settle(state);
    let at = state.picture.cursor;
    let words = ["probe", "--at", &format!("{},{}", short(at.x), short(at.y)), "--time", &state.play.time.to_string()];
    state.ask(Effect::Probe(words.map(str::to_owned).to_vec()));
    Ok(())
}
