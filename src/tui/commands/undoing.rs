//! Undo and redo: by steps and by time, said in words; and the list of the steps.

use std::time::Duration;

use super::{Call, Command, Done, command};
use crate::tui::app::{Mode, Pages, State};
use crate::tui::door::Door;
use crate::tui::terminal::plain;
use crate::tui::update::Change;

pub const COMMANDS: &[Command] = &[
    command("undo", "[STEPS]", "Undo", |state, call| steps(state, call, UNDO)),
    command("redo", "[STEPS]", "Redo", |state, call| steps(state, call, REDO)),
    command(
        "earlier",
        "STEPS|30s|3m|2h|1d",
        "Go back by steps, or to the scene as it was so long ago",
        |state, call| travel(state, call, UNDO, Door::earlier),
    ),
    command("later", "STEPS|30s|3m|2h|1d", "Go on again by steps, or by so long a time", |state, call| {
        travel(state, call, REDO, Door::later)
    }),
    command("history", "", "List what can be undone and redone", history).inside(),
];

/// The most steps that are listed each way.
const MOST_TOLD: usize = 500;

/// A way through the history.
#[derive(Clone, Copy)]
struct Way {
    step: fn(&mut Door) -> Option<Change>,
    /// What the next step does, in words.
    told: fn(&Door) -> Option<String>,
    done: &'static str,
    nothing: &'static str,
}

const UNDO: Way =
    Way { step: Door::undo, told: |door| door.history().told(1).pop(), done: "undone", nothing: "nothing to undo" };

const REDO: Way = Way {
    step: Door::redo,
    told: |door| door.history().told_ahead(1).pop(),
    done: "done again",
    nothing: "nothing to redo",
};

fn steps(state: &mut State, call: &Call, way: Way) -> Done {
    state.door.writable()?;
    let times = match call.text {
        "" => call.times(),
        text => text.parse().ok().filter(|&n: &i64| n > 0).ok_or_else(|| format!("{text} is no number of steps"))?,
    };
    let mut count = 0;
    let mut words = None;
    while count < times {
        let told = (way.told)(&state.door);
        let Some(change) = (way.step)(&mut state.door) else { break };
        (count, words) = (count + 1, told);
        state.changed(change);
    }
    let words = plain(&words.unwrap_or_default());
    match count {
        0 => return Err(way.nothing.into()),
        1 => state.say(format!("{}: {words}", way.done)),
        _ => state.say(format!("{count} steps {}, the last: {words}", way.done)),
    }
    Ok(())
}

/// By steps, or by time.
fn travel(state: &mut State, call: &Call, way: Way, by: fn(&mut Door, Duration) -> (usize, Option<Change>)) -> Done {
    if call.text.is_empty() || call.text.bytes().all(|b| b.is_ascii_digit()) {
        return steps(state, call, way);
    }
    state.door.writable()?;
    let time = duration(call.text).ok_or_else(|| format!("{} is no time: 30s, 3m, 2h or 1d", call.text))?;
    let (count, change) = by(&mut state.door, time);
    let change = change.ok_or_else(|| format!("{} within {}", way.nothing, call.text))?;
    state.changed(change);
    let steps = if count == 1 { "1 step".to_owned() } else { format!("{count} steps") };
    state.say(format!("{steps} {}", way.done));
    Ok(())
}

/// `30s`, `3m`, `2h`, `1d`.
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

/// What can be redone, the present, what can be undone: the numbers are what `:redo` and `:undo` take.
fn history(state: &mut State, _: &Call) -> Done {
    let history = state.door.history();
    let saved = history.since_saved();
    let line = |way: &str, number: usize, words: &str, age: String, saved: bool| {
        let mark = if saved { "  (as saved)" } else { "" };
        plain(&format!("{way} {number:<4} {age:>11}  {words}{mark}"))
    };
    let age = |time_ms| state.door.ago(time_ms);
    let ahead = history.told_ahead(MOST_TOLD).into_iter().zip(history.undone().iter().rev()).enumerate();
    let mut lines: Vec<String> = ahead
        .map(|(i, (words, step))| line("redo", i + 1, &words, age(step.time_ms), saved == Some((0, i + 1))))
        .collect();
    lines.reverse();
    let here = if saved == Some((0, 0)) { "-- now (saved) --" } else { "-- now --" };
    lines.push(here.into());
    let behind = history.told(MOST_TOLD).into_iter().zip(history.done().iter().rev()).enumerate();
    // The state after the step before is the one that `:undo N` leads to.
    lines.extend(
        behind.map(|(i, (words, step))| line("undo", i + 1, &words, age(step.time_ms), saved == Some((i + 1, 0)))),
    );
    let scroll = lines.iter().position(|line| line == here).unwrap_or(0).saturating_sub(3);
    state.mode = Mode::Pages(Pages { title: "history".into(), lines, scroll });
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
