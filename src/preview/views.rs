//! The overlay and zoom commands in force, so that a window which joins late shows what the others show, and one that comes
//! back is not switched over. Switches are kept and told as what they are set to (`view-field on`), so that windows cannot
//! drift apart.

use super::keys::{KEYS, VIEW};

/// The most commands kept; the oldest go first.
const MOST: usize = 64;

/// Switches that are on in a new window.
const ON_AT_FIRST: [&str; 2] = ["view-checkerboard", "view-legends"];

/// Commands given so far, without those that a later one made void.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Views(Vec<String>);

impl Views {
    /// Takes a command; returns it as windows are to be told it. A switch is set, and no longer what it was set to before;
    /// fitting the picture forgets earlier zooming.
    pub fn take(&mut self, command: &str) -> String {
        let told = match wanted(command) {
            (name, None) if is_switch(name) => set(name, !self.is_on(name)),
            _ => command.to_owned(),
        };
        let (name, _) = wanted(&told);
        if is_switch(name) {
            self.0.retain(|given| wanted(given).0 != name);
        }
        if ["zoom-fit", "zoom-whole", "zoom-one"].contains(&name) {
            self.0.retain(|given| given.starts_with("view-"));
        }
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(told.clone());
        told
    }

    fn is_on(&self, name: &str) -> bool {
        let given = self.0.iter().map(|given| wanted(given)).find(|(given, _)| *given == name);
        given.and_then(|(_, on)| on).unwrap_or(ON_AT_FIRST.contains(&name))
    }

    /// All of them, in order.
    pub fn list(&self) -> &[String] {
        &self.0
    }

    /// Takes what is in force at the other end: returns the commands that were not given here yet. A window that was
    /// zoomed already keeps its place.
    pub fn catch_up(&mut self, list: &[String]) -> Vec<String> {
        let fresh = self.0.is_empty();
        let is_new = |command: &&String| fresh || is_switch(wanted(command).0) && !self.0.contains(command);
        let missing: Vec<String> = list.iter().filter(is_new).cloned().collect();
        missing.iter().for_each(|command| drop(self.take(command)));
        missing
    }
}

/// The name in a command, and what is wanted of a switch: on, off, or the other of the two.
pub(super) fn wanted(command: &str) -> (&str, Option<bool>) {
    match command.split_once(' ') {
        Some((name, "on")) => (name, Some(true)),
        Some((name, "off")) => (name, Some(false)),
        _ => (command, None),
    }
}

/// A command that sets a switch.
pub(super) fn set(name: &str, on: bool) -> String {
    format!("{name} {}", if on { "on" } else { "off" })
}

/// Whether a command sets a switch of the view, and does nothing else: any window may ask for it.
pub(super) fn sets_a_switch(command: &str) -> bool {
    matches!(wanted(command), (name, Some(_)) if is_switch(name))
}

/// Whether a command switches something on and off that every window is to show alike.
pub(super) fn is_switch(name: &str) -> bool {
    name.starts_with("view-")
        && name != "view-full-screen"
        && KEYS.iter().any(|row| row.context == VIEW && row.command == name)
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
    fn only_what_is_in_force_is_kept() {
        let table: [(&[&str], &[&str]); 6] = [
            (&["view-field", "view-grid", "view-field"], &["view-grid on", "view-field off"]),
            (&["view-field on", "view-field on"], &["view-field on"]),
            (&["view-checkerboard", "view-legends off", "view-legends"], &["view-checkerboard off", "view-legends on"]),
            (&["zoom-in", "view-grid", "zoom-in", "zoom-one", "zoom-out"], &["view-grid on", "zoom-one", "zoom-out"]),
            (&["zoom-in", "zoom-in"], &["zoom-in", "zoom-in"]),
            (&[], &[]),
        ];
        for (given, kept) in table {
            assert_eq!(views(given).list(), kept, "{given:?}");
        }
        assert_eq!(views(&["zoom-in"; 100]).list().len(), MOST);
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
        for (command, sets) in
            [("view-field on", true), ("view-field", false), ("quit on", false), ("view-x on", false)]
        {
            assert_eq!(sets_a_switch(command), sets, "{command}");
        }
    }

    #[test]
    fn who_comes_back_is_told_what_is_new() {
        let list = ["view-field on", "zoom-in", "zoom-in", "view-grid on"].map(String::from);
        let table: [(&[&str], &[&str]); 4] = [
            (&[], &["view-field on", "zoom-in", "zoom-in", "view-grid on"]),
            (&["view-grid"], &["view-field on"]),
            (&["view-grid off"], &["view-field on", "view-grid on"]),
            (&["zoom-in"], &["view-field on", "view-grid on"]),
        ];
        for (given, told) in table {
            let mut here = views(given);
            assert_eq!(here.catch_up(&list), told, "{given:?}");
            assert!(here.catch_up(&list).is_empty(), "once");
        }
    }
}
