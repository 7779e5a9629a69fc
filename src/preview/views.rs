//! The overlay and zoom commands in force, so that a window which joins late shows what the others show, and one that comes
//! back is not switched over.

/// The most commands kept; the oldest go first.
const MOST: usize = 64;

/// Commands given so far, without those that a later one made void.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Views(Vec<String>);

impl Views {
    /// Takes a command. A switch given twice is as if never given; fitting the picture forgets earlier zooming.
    pub fn take(&mut self, command: &str) {
        if is_switch(command)
            && let Some(at) = self.0.iter().position(|given| given == command)
        {
            self.0.remove(at);
            return;
        }
        if ["zoom-fit", "zoom-one"].contains(&command) {
            self.0.retain(|given| is_switch(given));
        }
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(command.to_owned());
    }

    /// All of them, in order.
    pub fn list(&self) -> &[String] {
        &self.0
    }

    /// Takes what is in force at the other end: returns the commands that were not given here yet. A window that was
    /// zoomed already keeps its place.
    pub fn catch_up(&mut self, list: &[String]) -> Vec<String> {
        let fresh = self.0.is_empty();
        let missing: Vec<String> =
            list.iter().filter(|command| fresh || is_switch(command) && !self.0.contains(command)).cloned().collect();
        missing.iter().for_each(|command| self.take(command));
        missing
    }
}

fn is_switch(command: &str) -> bool {
    command.starts_with("view-")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views(given: &[&str]) -> Views {
        let mut views = Views::default();
        given.iter().for_each(|command| views.take(command));
        views
    }

    #[test]
    fn only_what_is_in_force_is_kept() {
        let table: [(&[&str], &[&str]); 4] = [
            (&["view-field", "view-grid", "view-field"], &["view-grid"]),
            (&["zoom-in", "view-grid", "zoom-in", "zoom-one", "zoom-out"], &["view-grid", "zoom-one", "zoom-out"]),
            (&["zoom-in", "zoom-in"], &["zoom-in", "zoom-in"]),
            (&[], &[]),
        ];
        for (given, kept) in table {
            assert_eq!(views(given).list(), kept, "{given:?}");
        }
        assert_eq!(views(&["zoom-in"; 100]).list().len(), MOST);
    }

    #[test]
    fn who_comes_back_is_told_what_is_new() {
        let list = ["view-field", "zoom-in", "zoom-in", "view-grid"].map(String::from);
        let table: [(&[&str], &[&str]); 3] = [
            (&[], &["view-field", "zoom-in", "zoom-in", "view-grid"]),
            (&["view-grid"], &["view-field"]),
            (&["zoom-in"], &["view-field", "view-grid"]),
        ];
        for (given, told) in table {
            let mut here = views(given);
            assert_eq!(here.catch_up(&list), told, "{given:?}");
            assert!(here.catch_up(&list).is_empty(), "once");
        }
    }
}
