//! Undo and redo by steps and by time, and the list of steps.

use crate::base::text::counted;
use crate::tui::text::plain;
use std::time::Duration;

use super::command::{Call, Command, Done, command};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::Published;
use crate::tui::state::{Mode, Pages, State};

pub const COMMANDS: &[Command] = &[
    command("undo", "[STEPS|#STATE]", "Undo; #STATE goes to a state that :history lists", |state, call| {
        match call.text.strip_prefix('#') {
            Some(number) => go_to(state, number),
            None => steps(state, call, UNDO),
        }
    })
    .counted_with(&[""]),
    command("redo", "[STEPS]", "Redo", |state, call| steps(state, call, REDO)).counted_with(&[""]),
    command(
        "earlier",
        "STEPS|30s|3m|2h|1d",
        "Go back in time, through all branches: by a number of states, or to the scene as it was so long ago",
        |state, call| travel(state, call, UNDO, OpenScene::earlier),
    )
    .counted_with(&[""]),
    command(
        "later",
        "STEPS|30s|3m|2h|1d",
        "Go forward in time, through all branches: by a number of states, or by a time",
        |state, call| travel(state, call, REDO, OpenScene::later),
    )
    .counted_with(&[""]),
    command("history", "", "List what can be undone and redone, and the other branches", history).inside(),
];

/// The most steps that are listed in each direction.
const MOST_TOLD: usize = 500;

/// A direction in the history.
#[derive(Clone, Copy)]
struct Way {
    back: bool,
    step: fn(&mut OpenScene) -> Option<Published>,
    /// A step in words, by its distance; 1 is the next one.
    told: fn(&OpenScene, usize) -> Option<String>,
    done: &'static str,
    nothing: &'static str,
}

const UNDO: Way = Way {
    back: true,
    step: OpenScene::undo,
    told: |scene, away| scene.history().told(away).pop(),
    done: "undone",
    nothing: "nothing to undo",
};

const REDO: Way = Way {
    back: false,
    step: OpenScene::redo,
    told: |scene, away| scene.history().told_ahead(away).pop(),
    done: "done again",
    nothing: "nothing to redo",
};

fn steps(state: &mut State, call: &Call, way: Way) -> Done {
    state.scene.writable()?;
    let times = match call.text {
        "" => call.times(),
        text => text.parse().ok().filter(|&n: &i64| n > 0).ok_or_else(|| format!("{text} is not a number of steps"))?,
    };
    let mut count = 0;
    let mut words = None;
    while count < times {
        let told = (way.told)(&state.scene, 1);
        let Some(change) = (way.step)(&mut state.scene) else { break };
        (count, words) = (count + 1, told);
        state.changed(change);
    }
    let words = plain(&words.unwrap_or_default());
    match count {
        0 => return Err(way.nothing.into()),
        1 => state.say(format!("{}: {words}", way.done)),
        _ => state.say(format!("{} {}, the last: {words}", counted(count, "step"), way.done)),
    }
    Ok(())
}

/// Goes by states in the order in which they were made, or by time.
fn travel(
    state: &mut State,
    call: &Call,
    way: Way,
    by: fn(&mut OpenScene, Duration) -> (usize, Option<Published>),
) -> Done {
    state.scene.writable()?;
    if call.text.is_empty() || call.text.bytes().all(|b| b.is_ascii_digit()) {
        let times = if call.text.is_empty() { call.times() } else { call.text.parse().unwrap_or(i64::MAX) };
        return by_states(state, usize::try_from(times).unwrap_or(1), way);
    }
    let time = duration(call.text).ok_or_else(|| format!("{} is not a time: write 30s, 3m, 2h or 1d", call.text))?;
    let (count, change) = by(&mut state.scene, time);
    let change = change.ok_or_else(|| format!("{} within {}", way.nothing, call.text))?;
    state.changed(change);
    let steps = counted(count, "step");
    state.say(format!("{steps} {}", way.done));
    Ok(())
}

fn by_states(state: &mut State, times: usize, way: Way) -> Done {
    let history = state.scene.history();
    let (here, newest) = (history.state(), history.newest());
    let to = if way.back { here.saturating_sub(times) } else { here.saturating_add(times).min(newest) };
    if to == here {
        return Err(way.nothing.into());
    }
    let route = history.route(to).ok_or(way.nothing)?;
    // Within the branch it is the same as undo or redo, with the same message.
    let straight = match (way.back, route.back, route.on.len()) {
        (true, back, 0) => Some(back),
        (false, 0, on) => history.undone().map(|(state, _)| state).take(on).eq(route.on).then_some(on),
        _ => None,
    };
    let words = straight.and_then(|count| (way.told)(&state.scene, count));
    let change = state.scene.go_to(to).ok_or(way.nothing)?;
    state.changed(change);
    match (straight, words) {
        (Some(1), Some(words)) => state.say(format!("{}: {}", way.done, plain(&words))),
        (Some(count), Some(words)) => {
            state.say(format!("{} {}, the last: {}", counted(count, "step"), way.done, plain(&words)))
        }
        _ => say_state(state),
    }
    Ok(())
}

/// Goes to a state by its number.
fn go_to(state: &mut State, number: &str) -> Done {
    state.scene.writable()?;
    let newest = state.scene.history().newest();
    let to = number.parse().ok().filter(|to| *to <= newest);
    let to =
        to.ok_or_else(|| format!("there is no state #{number}: there are #0 to #{newest} (:history lists them)"))?;
    if let Some(change) = state.scene.go_to(to) {
        state.changed(change);
    }
    say_state(state);
    Ok(())
}

/// Shows which state this is.
fn say_state(state: &mut State) {
    let history = state.scene.history();
    let (here, newest) = (history.state(), history.newest());
    let words = history.told(1).pop().unwrap_or_else(|| "the beginning".into());
    state.say(plain(&format!("at #{here} of {newest}: {words}")));
}

/// Parses `30s`, `3m`, `2h` or `1d`.
fn duration(text: &str) -> Option<Duration> {
    let unit = match text.chars().last()? {
        's' => 1,
        'm' => 60,
        'h' => 3600,
        'd' => 86_400,
        _ => return None,
    };
    let number: u64 = text[..text.len() - 1].parse().ok()?;
    Some(Duration::from_secs(number.checked_mul(unit)?))
}

/// Lists what can be redone, the present, and what can be undone, with the numbers that `:redo` and `:undo` take; then the
/// steps of other branches. `#` numbers are the states in the order in which they were made.
fn history(state: &mut State, _: &Call) -> Done {
    let history = state.scene.history();
    let saved = history.saved();
    let line = |way: String, state_of: usize, ago: String, words: &str| {
        let mark = if saved == Some(state_of) { "  (as saved)" } else { "" };
        plain(&format!("{way:<10} #{state_of:<5} {ago:>11}  {words}{mark}"))
    };
    let ago = |time_ms: u64| state.scene.ago(time_ms);
    let ahead = history.told_ahead(MOST_TOLD).into_iter().zip(history.undone()).zip(1..);
    let mut lines: Vec<String> =
        ahead.map(|((words, (state, step)), n)| line(format!("redo {n}"), state, ago(step.time_ms), &words)).collect();
    lines.reverse();
    let here = if history.is_saved() { "-- now (saved) --" } else { "-- now --" };
    let scroll = lines.len().saturating_sub(3);
    lines.push(here.into());
    let behind = history.told(MOST_TOLD).into_iter().zip(history.done()).zip(1..);
    // A row shows the state that its step led to; `:undo N` leads to the one below it.
    lines.extend(behind.map(|((words, (state, step)), n)| line(format!("undo {n}"), state, ago(step.time_ms), &words)));
    if history.depth().0 <= MOST_TOLD {
        lines.push(line(String::new(), 0, String::new(), "the beginning"));
    }
    let mut aside = history.told_aside(MOST_TOLD);
    aside.sort_by_key(|told| std::cmp::Reverse(told.state));
    if !aside.is_empty() {
        lines.push(String::new());
        lines.push("-- other branches: :undo #STATE goes there, g- and g+ go through all states --".into());
    }
    lines.extend(
        aside.iter().map(|told| line(format!("after #{}", told.before), told.state, ago(told.time_ms), &told.words)),
    );
    state.typing.mode = Mode::Pages(Pages { title: "history".into(), lines, scroll });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_numbers_with_a_unit() {
        for (text, seconds) in [
            ("30s", Some(30)),
            ("3m", Some(180)),
            ("2h", Some(7200)),
            ("1d", Some(86_400)),
            ("3", None),
            ("m", None),
            ("-1s", None),
        ] {
            assert_eq!(duration(text).map(|time| time.as_secs()), seconds, "{text}");
        }
    }
}
