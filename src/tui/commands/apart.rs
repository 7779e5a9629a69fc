//! Layers and zones that are looked at alone, not looked at, or kept from edits, and a scene that is looked at in several ways,
//! in this session.

use std::collections::BTreeSet;

use super::command::{Call, Command, Done, command};
use super::items::targets;
use crate::base::text::counted;
use crate::scene::{address, compared};
use crate::tui::events::Effect;
use crate::tui::state::State;
use crate::tui::state::apart::Apart;
use crate::tui::text::plain;
use crate::tui::text::said::words;

pub const COMMANDS: &[Command] = &[
    command("mute", "[PATH|none]", "Do not show the layer or the zone here, or show it again; exports have it", mute),
    command("solo", "[PATH|none]", "Show only the layer or the zone here, or all again; exports have all", solo),
    command(
        "lock",
        "[PATH|none]",
        "Refuse edits of the layer or the zone here, or allow them again; undo goes on",
        lock,
    ),
    command(
        "compare",
        "[anchor|style|none]",
        "Show what is drawn with each anchor, or in each style, side by side",
        compare,
    ),
    command("seen", "SUBCOMMAND ...", "Run a subcommand, as render, on what is shown, without what is muted", seen)
        .inside(),
];

/// The sets, and what is said of something that comes into one or out of it.
type Set = (fn(&mut Apart) -> &mut BTreeSet<String>, [&'static str; 2]);

fn mute(state: &mut State, call: &Call) -> Done {
    turn(state, call, (|apart| &mut apart.muted, ["muted: not shown, but exported", "shown again"]))
}

fn solo(state: &mut State, call: &Call) -> Done {
    turn(state, call, (|apart| &mut apart.solo, ["shown alone; exports have all", "shown with the others again"]))
}

fn lock(state: &mut State, call: &Call) -> Done {
    turn(state, call, (|apart| &mut apart.locked, ["locked against edits", "unlocked"]))
}

/// Puts what is selected, or what is at a path, into a set, or takes it out if all of it is in it.
fn turn(state: &mut State, call: &Call, (set, [done, undone]): Set) -> Done {
    let pointers = match call.text {
        "none" => {
            let count = std::mem::take(set(&mut state.apart)).len();
            state.ask(Effect::Mute);
            state.say(format!("{} {undone}", counted(count, "thing")));
            return Ok(());
        }
        "" => targets(state, call)?,
        path => vec![state.resolve(path)?],
    };
    let scene = state.document().scene();
    let found: BTreeSet<String> = pointers.iter().filter_map(|pointer| scene.mutable(pointer)).collect();
    if found.is_empty() {
        return Err("only layers and zones: go to one".into());
    }
    let names: Vec<String> = found.iter().map(|pointer| plain(&address::address(state.document(), pointer))).collect();
    let own = set(&mut state.apart);
    let on = !found.is_subset(own);
    if on {
        own.extend(found.iter().cloned());
    } else {
        own.retain(|pointer| !found.contains(pointer));
    }
    state.ask(Effect::Mute);
    let (what, are) =
        if let [one] = names.as_slice() { (one.clone(), "is") } else { (counted(names.len(), "thing"), "are") };
    let Apart { muted, solo, .. } = &state.apart;
    let nothing = if found.iter().any(|one| solo.contains(one) && muted.contains(one)) {
        "; but it is muted, so it is not shown: x shows it"
    } else {
        ""
    };
    state.say(format!("{what} {are} {}{nothing}", if on { done } else { undone }));
    Ok(())
}

/// Without an argument as one again, or by the first thing that there is.
fn compare(state: &mut State, call: &Call) -> Done {
    let by = match call.text {
        "" if state.apart.compared.is_some() => None,
        "" => compared::names().first().copied(),
        by => compared::names().into_iter().find(|own| *own == by),
    };
    let Some(by) = by else {
        let was = state.apart.compared.take();
        state.say(if was.is_some() { "the scene as it is" } else { "nothing is compared" });
        state.ask(Effect::Compare);
        return Ok(());
    };
    let ways = state.document().scene().compared(by)?;
    let names: Vec<&str> = ways.iter().map(|(name, _)| *name).collect();
    state.say(format!("from left to right: {}; :compare ends it", names.join(", ")));
    state.apart.compared = Some(by.to_owned());
    state.ask(Effect::Compare);
    Ok(())
}

fn seen(state: &mut State, call: &Call) -> Done {
    let words = words(call.text)?;
    let Some(name) = words.first() else { return Err("seen takes a subcommand: :seen render -o a.gif".into()) };
    if !call.table.subcommands().any(|known| known == *name) {
        return Err(format!("seen takes a subcommand, as render, synth or field, not {name}"));
    }
    if state.apart.compared.is_some() {
        return Err("what is compared is not one scene: :compare none, or render --compare".into());
    }
    state.ask(Effect::RunSeen(words));
    Ok(())
}
