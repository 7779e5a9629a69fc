//! Time: playing and going from frame to frame.

use super::command::{Call, Command, Done, command};
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::state::play::SPEEDS;

pub const COMMANDS: &[Command] = &[
    command("play", "", "Play or pause", play).inside(),
    command("frame", "next|previous|first|last|NUMBER", "Go to a frame", frame).counted_with(&["next", "previous"]),
    command("speed", "slower|faster|NUMBER", "Play slower or faster, 0.1 to 4 times", speed)
        .counted_with(&["slower", "faster"]),
    command("time", "T", "Go to a scene time t, 0 to 1", time),
];

fn play(state: &mut State, _: &Call) -> Done {
    state.play.playing = !state.play.playing;
    state.ask(Effect::Show);
    Ok(())
}

fn frame(state: &mut State, call: &Call) -> Done {
    let (at, frames) = state.play.frame(state.timeline());
    let by = |steps: i64| (at as i64 + steps).rem_euclid(frames as i64) as u64;
    let to = match call.text {
        "next" => by(call.times()),
        "previous" => by(-call.times()),
        "first" => 0,
        "last" => frames - 1,
        number => number.parse().map_err(|_| format!("there is no frame {number}"))?,
    };
    if to >= frames {
        return Err(match frames {
            1 => "there is 1 frame: 0".to_owned(),
            _ => format!("there are {frames} frames, from 0"),
        });
    }
    state.play.playing = false;
    state.play.time = state.timeline().time_of(to);
    state.ask(Effect::Show);
    Ok(())
}

fn speed(state: &mut State, call: &Call) -> Done {
    let times = call.steps();
    let slower = |here: f64| SPEEDS.iter().rfind(|&&speed| speed < here).copied().unwrap_or(here);
    let faster = |here: f64| SPEEDS.iter().find(|&&speed| speed > here).copied().unwrap_or(here);
    let to = match call.text {
        "slower" => times.fold(state.play.speed, |here, _| slower(here)),
        "faster" => times.fold(state.play.speed, |here, _| faster(here)),
        number => {
            let speed = number.parse().ok().filter(|speed| (SPEEDS[0]..=SPEEDS[SPEEDS.len() - 1]).contains(speed));
            speed.ok_or("speed takes slower, faster or a number from 0.1 to 4")?
        }
    };
    state.play.speed = to;
    state.say(format!("plays {to} times as fast"));
    state.ask(Effect::Show);
    Ok(())
}

fn time(state: &mut State, call: &Call) -> Done {
    let time = call.text.parse::<f64>().ok().filter(|time| (0.0..=1.0).contains(time));
    state.play.time = time.ok_or("time takes a number from 0 to 1")?;
    state.play.playing = false;
    state.ask(Effect::Show);
    Ok(())
}
