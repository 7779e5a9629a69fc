//! How windows show the picture: a value, so that it can be sent to a window that joins late, and one that comes back is told only
//! what it does not show yet. Switches are told as what they are set to (`view-field on`), so that windows cannot drift apart.

use std::collections::{BTreeMap, BTreeSet};
use std::iter::repeat_n;
use std::ops::RangeInclusive;

use super::keys::{CAPTURE, KEYS, VIEW};
use crate::export::animation::formats::FORMATS;
use crate::layers::parts::pass::COLOR;
use crate::layers::parts::vectors::VectorLook;
use crate::render::overlay::overlays;
use crate::render::shown::Shown;
use crate::render::sight::Sight;

/// Switches that are on in a new window.
const ON_AT_FIRST: [&str; 2] = ["view-checkerboard", "view-legends"];
/// What stands for a comparison by nothing.
const NOTHING: &str = "none";
/// Commands that fit the picture anew and so undo earlier zooming.
const FITS: [&str; 3] = ["zoom-fit", "zoom-whole", "zoom-one"];
const ZOOM: Steps = Steps { down: "zoom-out", up: "zoom-in", most: -64..=64 };
/// How often the spacing of the field is doubled.
pub(super) const FIELD: Steps = Steps { down: "field-closer", up: "field-wider", most: -2..=4 };
/// The border between still and moving, in steps from the middle of the picture, of as many to each side.
pub(super) const WIPE: Steps = Steps { down: "wipe-left", up: "wipe-right", most: -10..=10 };

/// Two commands that move a number up and down.
pub(super) struct Steps {
    down: &'static str,
    up: &'static str,
    /// How far they move it.
    pub most: RangeInclusive<i32>,
}

impl Steps {
    /// The number after a step.
    pub fn step(&self, from: i32, by: i32) -> i32 {
        (from + by).clamp(*self.most.start(), *self.most.end())
    }
}

/// Which switches of the view are on, by their commands, and how the vectors look that some of them show.
#[derive(Clone, Debug, PartialEq)]
pub struct Switches {
    /// How vectors of pixels are drawn.
    pub vectors: VectorLook,
    on: BTreeSet<&'static str>,
    /// The overlays that lie over the pass that is shown, which comes bare, and go with it; `None` over the frame.
    over: Option<BTreeSet<&'static str>>,
}

impl Default for Switches {
    fn default() -> Self {
        Switches { vectors: VectorLook::default(), on: ON_AT_FIRST.into(), over: None }
    }
}

impl Switches {
    /// Whether what a switch is for is shown.
    pub fn is_on(&self, name: &str) -> bool {
        match &self.over {
            Some(over) if is_overlay(name) => over.contains(name),
            _ => self.on.contains(name),
        }
    }

    /// Takes whether a pass is shown.
    pub fn under_pass(&mut self, is_pass: bool) {
        self.over = is_pass.then(|| self.over.take().unwrap_or_default());
    }

    /// Whether a switch was turned on to lie over the pass that is shown.
    fn is_over_pass(&self, name: &str) -> bool {
        self.over.as_ref().is_some_and(|over| over.contains(name))
    }

    /// Takes a command that sets a switch, or turns it over, or sets how vectors look; returns it as it is sent to windows, if
    /// it is one.
    pub fn take(&mut self, command: &str) -> Option<String> {
        if self.vectors.take(command) {
            return Some(self.vectors.command());
        }
        let (name, wanted) = wanted(command);
        self.set(name, wanted).map(|on| set(name, on))
    }

    /// The commands that set what is not as in a new window.
    pub fn changed(&self) -> impl Iterator<Item = String> {
        let at_first = |name: &&'static str| ON_AT_FIRST.contains(name);
        let off = ON_AT_FIRST.into_iter().filter(|name| !self.on.contains(name)).map(|name| set(name, false));
        let on = self.on.iter().filter(move |name| !at_first(name)).map(|name| set(name, true));
        let vectors = (self.vectors != VectorLook::default()).then(|| self.vectors.command());
        off.chain(on).chain(vectors)
    }

    /// Turns a switch on or off, or over if `wanted` is `None`; returns what it is then. `None` if there is no such switch.
    pub fn set(&mut self, name: &str, wanted: Option<bool>) -> Option<bool> {
        let name = switch(name)?;
        let on = wanted.unwrap_or(!self.is_on(name));
        let those = match &mut self.over {
            Some(over) if is_overlay(name) => over,
            _ => &mut self.on,
        };
        if on {
            those.insert(name)
        } else {
            those.remove(name)
        };
        Some(on)
    }
}

/// See the top of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Views {
    switches: Switches,
    /// The pass that is shown in place of the frame, as `NAME` or `NAME:LAYER`.
    pass: Option<String>,
    /// How the scene is shown.
    shown: Shown,
    /// How the picture was fitted last, if it was.
    fit: Option<&'static str>,
    /// Steps taken since then, or since the beginning, by the command that counts them up.
    steps: BTreeMap<&'static str, i32>,
}

impl Views {
    /// Takes a command; returns it as it is sent to windows: a switch is set. Commands that leave nothing behind, as
    /// `view-full-screen`, pass through.
    pub fn take(&mut self, command: &str) -> String {
        if let Some(told) = self.switches.take(command) {
            return told;
        }
        if let Some(pass) = pass_in(command) {
            self.switches.under_pass(pass.is_some());
            self.pass = pass;
        }
        shows_otherwise(&mut self.shown, command);
        if let Some(fit) = FITS.into_iter().find(|fit| *fit == command) {
            self.fit = Some(fit);
            self.steps.remove(ZOOM.up);
        }
        for steps in [ZOOM, FIELD, WIPE] {
            let by = i32::from(command == steps.up) - i32::from(command == steps.down);
            if by != 0 {
                let number = self.steps.entry(steps.up).or_default();
                *number = steps.step(*number, by);
            }
        }
        if [WIPE.up, WIPE.down].contains(&command) {
            self.switches.set("view-wipe", Some(true));
        }
        command.to_owned()
    }

    /// The commands that make a new window look like this.
    pub fn list(&self) -> Vec<String> {
        let mut list = self.changes(&Views::default());
        list.extend(self.fit.map(str::to_owned));
        for steps in [ZOOM, FIELD, WIPE] {
            let number = self.steps.get(steps.up).copied().unwrap_or(0);
            let command = if number < 0 { steps.down } else { steps.up };
            list.extend(repeat_n(command.to_owned(), number.unsigned_abs() as usize));
        }
        // Moving the border shows it, and so would turn on what may be off again.
        let wipe = self.switches.is_on("view-wipe");
        let moved = self.steps.get(WIPE.up).is_some_and(|&steps| steps != 0);
        list.extend((moved && !wipe).then(|| set("view-wipe", false)));
        list
    }

    /// The commands that set the switches, and the pass, that are otherwise in `before`.
    fn changes(&self, before: &Views) -> Vec<String> {
        let rows = || KEYS.iter().filter_map(|row| switch(row.command));
        let (own, other) = (&self.switches, &before.switches);
        let differs = |name: &&str| own.on.contains(name) != other.on.contains(name);
        // What lies over the frame is set without a pass, and what lies over a pass goes with it.
        let bare = before.pass.is_some() && rows().any(|name| is_overlay(name) && differs(&name));
        let shown = before.pass.as_ref().filter(|_| !bare);
        let over = |name: &&str| {
            let lies = shown.is_some() && other.is_over_pass(name);
            self.pass.is_some() && own.is_over_pass(name) != lies
        };
        let bare = bare.then(|| show_pass(None));
        let pass = (self.pass.as_ref() != shown).then(|| show_pass(self.pass.as_deref()));
        let Shown { muted, compared, sight } = &self.shown;
        let compared = (*compared != before.shown.compared).then(|| show_compared(compared.as_deref()));
        let muted = (*muted != before.shown.muted).then(|| show_muted(muted));
        let sight = (*sight != before.shown.sight).then(|| show_sight(sight.as_ref()));
        let vectors = (own.vectors != other.vectors).then(|| own.vectors.command());
        let switches = rows().filter(differs).map(|name| set(name, own.on.contains(name)));
        let over = rows().filter(over).map(|name| set(name, own.is_over_pass(name)));
        let switches = bare.into_iter().chain(switches).chain(vectors).chain(pass).chain(over);
        switches.chain(muted).chain(compared).chain(sight).collect()
    }

    /// Takes what is in force at the other end; returns the commands that lead there. A window that was zoomed already keeps
    /// its zoom and its place.
    pub fn catch_up(&mut self, list: &[String]) -> Vec<String> {
        let mut wanted = Views::default();
        list.iter().for_each(|command| drop(wanted.take(command)));
        if *self == Views::default() {
            *self = wanted;
            return self.list();
        }
        let changes = wanted.changes(self);
        (self.switches, self.pass, self.shown) = (wanted.switches, wanted.pass, wanted.shown);
        changes
    }
}

/// The name in a command, and what is wanted of a switch: on, off, or the other of the two.
pub fn wanted(command: &str) -> (&str, Option<bool>) {
    match command.split_once(' ') {
        Some((name, "on")) => (name, Some(true)),
        Some((name, "off")) => (name, Some(false)),
        _ => (command, None),
    }
}

/// The extensions of files in which windows capture what they show; `png` is one numbered file a frame.
pub fn captures() -> impl Iterator<Item = &'static str> {
    ["png"].into_iter().chain(FORMATS.iter().flat_map(|format| format.extensions).copied())
}

/// The extension in a command that captures, `gif` if it names none; `None` if it is another command or there is no such format.
pub fn captured(command: &str) -> Option<&'static str> {
    let named = command.strip_prefix(CAPTURE)?;
    let extension = if named.is_empty() { "gif" } else { named.strip_prefix(' ')? };
    captures().find(|known| *known == extension)
}

/// The command that sets what another has set to what it is now; `None` if it set nothing that all windows show alike.
pub fn setting(command: &str, switches: &Switches) -> Option<String> {
    let of_vectors = switches.vectors.clone().take(command).then(|| switches.vectors.command());
    of_vectors.or_else(|| switch(command).map(|name| set(name, switches.is_on(name))))
}

/// A command that sets a switch.
fn set(name: &str, on: bool) -> String {
    format!("{name} {}", if on { "on" } else { "off" })
}

/// The command that shows a pass in place of the frame; the frame again for `None`.
pub fn show_pass(pass: Option<&str>) -> String {
    format!("pass {}", pass.unwrap_or(COLOR.name))
}

/// The pass that a command shows, `None` for the frame; if it is such a command.
pub fn pass_in(command: &str) -> Option<Option<String>> {
    let pass = command.strip_prefix("pass ")?;
    Some((pass != COLOR.name).then(|| pass.to_owned()))
}

/// The command that leaves out what is at these pointers of the scene.
pub fn show_muted(pointers: &[String]) -> String {
    format!("mute {}", serde_json::Value::from(pointers))
}

/// The command that shows the scene in all its ways by something; as one again for `None`.
pub fn show_compared(by: Option<&str>) -> String {
    format!("compare {}", by.unwrap_or(NOTHING))
}

/// The command that shows something in place of what the camera sees; that again for `None`.
pub fn show_sight(sight: Option<&Sight>) -> String {
    format!("sight {}", serde_json::json!(sight))
}

/// Takes a command that changes how a scene is shown; whether it is one.
pub fn shows_otherwise(shown: &mut Shown, command: &str) -> bool {
    match command.split_once(' ') {
        Some(("mute", pointers)) => serde_json::from_str(pointers).map(|muted| shown.muted = muted).is_ok(),
        Some(("compare", by)) => {
            shown.compared = (by != NOTHING).then(|| by.to_owned());
            true
        }
        Some(("sight", sight)) => serde_json::from_str(sight).map(|sight| shown.sight = sight).is_ok(),
        _ => false,
    }
}

/// Whether a command sets what all windows show alike, a switch or the pass, and does nothing else: any window may ask for
/// it.
pub(super) fn is_for_all(command: &str) -> bool {
    pass_in(command).is_some()
        || VectorLook::default().take(command) && command.contains(' ')
        || matches!(wanted(command), (name, Some(_)) if switch(name).is_some())
}

fn is_overlay(name: &str) -> bool {
    overlays().any(|overlay| overlay.name == name)
}

/// The switch of that name, which all windows are to show alike; `None` if there is none.
fn switch(name: &str) -> Option<&'static str> {
    let is_switch = |command: &&str| command.starts_with("view-") && *command != "view-full-screen";
    let rows = KEYS.iter().filter(|row| row.context == VIEW).map(|row| row.command);
    rows.filter(is_switch).find(|command| *command == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views(given: &[&str]) -> Views {
        let mut views = Views::default();
        given.iter().for_each(|command| drop(views.take(command)));
        views
    }

    #[test]
    fn only_what_is_in_force_is_listed() {
        const PAINTING: &str = r#"sight {"painting":{"layer":0,"picture":2,"share":0.5}}"#;
        let table: [(&[&str], &[&str]); 21] = [
            (
                &["arrows-equal", "view-grid", "next-coloring"],
                &["view-grid on", "vectors default color=direction equal=on"],
            ),
            (&["vectors length=2", "pass depth", "vectors default"], &["pass depth"]),
            (&["view-field", "pass depth", "view-paths"], &["view-field on", "pass depth", "view-paths on"]),
            (&["view-field", "pass depth", "view-field", "pass color"], &["view-field on"]),
            (&["pass depth", "view-grid", "pass normal:face"], &["view-grid on", "pass normal:face"]),
            (&["pass depth", "view-paths", "pass color"], &[]),
            (&["mute [\"/layers/0\"]", "view-grid"], &["view-grid on", "mute [\"/layers/0\"]"]),
            (&["mute [\"/layers/0\"]", "mute []"], &[]),
            (&["compare anchor", "compare style", "pass depth"], &["pass depth", "compare style"]),
            (&["compare anchor", "compare none"], &[]),
            (&[PAINTING, "sight {}", "view-grid"], &["view-grid on", PAINTING]),
            (&[PAINTING, "sight null"], &[]),
            (&["view-field", "view-grid", "view-field"], &["view-grid on"]),
            (&["view-field on", "view-field on"], &["view-field on"]),
            (&["view-checkerboard", "view-legends off", "view-legends"], &["view-checkerboard off"]),
            (&["zoom-in", "view-grid", "zoom-in", "zoom-one", "zoom-out"], &["view-grid on", "zoom-one", "zoom-out"]),
            (&["zoom-in", "zoom-in"], &["zoom-in", "zoom-in"]),
            (&["field-closer", "field-wider", "field-wider"], &["field-wider"]),
            (&["wipe-left"], &["view-wipe on", "wipe-left"]),
            (&["wipe-left", "view-wipe"], &["wipe-left", "view-wipe off"]),
            (&["view-full-screen"], &[]),
        ];
        for (given, listed) in table {
            assert_eq!(views(given).list(), listed, "{given:?}");
            let again = views(&views(given).list().iter().map(String::as_str).collect::<Vec<_>>());
            assert_eq!(again.list(), listed, "{given:?}, from its list");
        }
        assert_eq!(views(&["field-closer"; 100]).list().len(), 2, "as far as a window goes");
    }

    #[test]
    fn windows_are_told_what_a_switch_is_set_to() {
        let mut views = Views::default();
        for (given, told) in [
            ("view-field", "view-field on"),
            ("view-field", "view-field off"),
            ("view-field on", "view-field on"),
            ("view-full-screen", "view-full-screen"),
            ("zoom-in", "zoom-in"),
            ("zoom-in on", "zoom-in on"),
        ] {
            assert_eq!(views.take(given), told, "{given}");
        }
        for (command, sets) in [
            ("view-field on", true),
            ("pass depth", true),
            ("view-field", false),
            ("quit on", false),
            ("view-x on", false),
            ("next-pass", false),
        ] {
            assert_eq!(is_for_all(command), sets, "{command}");
        }
    }

    #[test]
    fn a_pass_is_bare_but_for_what_is_turned_on_over_it() {
        let mut views = Views::default();
        for (command, told, shown) in [
            ("view-field", "view-field on", &["view-field"][..]),
            ("view-grid", "view-grid on", &["view-field", "view-grid"]),
            ("pass depth", "pass depth", &["view-grid"]),
            ("view-paths", "view-paths on", &["view-grid", "view-paths"]),
            ("pass normal", "pass normal", &["view-grid", "view-paths"]),
            ("view-field", "view-field on", &["view-field", "view-grid", "view-paths"]),
            ("view-field", "view-field off", &["view-grid", "view-paths"]),
            ("pass color", "pass color", &["view-field", "view-grid"]),
            ("view-paths on", "view-paths on", &["view-field", "view-grid", "view-paths"]),
            ("pass depth", "pass depth", &["view-grid"]),
            ("pass color", "pass color", &["view-field", "view-grid", "view-paths"]),
        ] {
            assert_eq!(views.take(command), told);
            let on = ["view-field", "view-grid", "view-paths"].into_iter().filter(|name| views.switches.is_on(name));
            assert_eq!(on.collect::<Vec<_>>(), shown, "{command}");
        }
    }

    #[test]
    fn who_comes_back_is_told_what_is_new() {
        let list = ["view-field on", "zoom-in", "zoom-in", "view-grid on"].map(String::from);
        let table: [(&[&str], &[&str]); 5] = [
            (&["pass depth", "view-paths"], &["pass color", "view-field on", "view-grid on"]),
            (&[], &["view-field on", "view-grid on", "zoom-in", "zoom-in"]),
            (&["view-grid"], &["view-field on"]),
            (&["view-paths on"], &["view-field on", "view-paths off", "view-grid on"]),
            (&["zoom-in"], &["view-field on", "view-grid on"]),
        ];
        for (given, told) in table {
            let mut here = views(given);
            assert_eq!(here.catch_up(&list), told, "{given:?}");
            assert!(here.catch_up(&list).is_empty(), "once");
        }
    }
}
