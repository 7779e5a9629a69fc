//! What is asked about a scene's life outside the editor: unsaved edits that were left behind, somebody else who edits it.

use crate::tui::document::choice::{About, Choice, Question, Then};
use crate::tui::document::door::Door;
use crate::tui::text::plain;

/// So many changes are shown in a question; the rest can be looked at.
const FEW: usize = 5;

/// What the editor knows about the outside.
#[derive(Clone, Debug, Default)]
pub struct Life {
    /// A question that waits until nothing else is going on.
    pub waiting: Option<Choice>,
    /// How the file differs from what it should be, in a word for the status line.
    pub file: Option<&'static str>,
}

impl Life {
    /// What is to be asked when a scene has been opened.
    pub fn begin(door: &Door) -> Life {
        let held = door.held_by().map(|holder| {
            let text = vec![format!("The scene {}.", plain(&holder.in_words()))];
            let mut options = vec![("look", "Open it to read only; it follows what is saved there")];
            if !holder.certain {
                options.push(("edit", "Edit it all the same: nobody is there any more"));
            }
            options.push(("quit", "Leave"));
            question(About::Holder, "the scene is open elsewhere".into(), text, &options)
        });
        Life { waiting: held.or_else(|| about_recovery(door)), file: None }
    }
}

/// What is asked about unsaved edits that were left behind.
pub fn about_recovery(door: &Door) -> Option<Choice> {
    let offer = door.offered()?;
    let title = format!("{} left behind, {}", offer.in_words(), door.ago(offer.time_ms));
    let mut text = few(&offer.words);
    if offer.file_changed {
        text.push("Another program has changed the file since.".into());
    }
    let options = [
        ("recover", "Take the changes"),
        ("leave", "Leave the file as it is; u still gives the changes"),
        ("difference", "Look at all of them"),
    ];
    Some(question(About::Recovery, title, text, &options))
}

/// A list with what is to be known above it.
pub fn question(about: About, title: String, text: Vec<String>, options: &[(&str, &str)]) -> Choice {
    let options = options.iter().map(|(word, help)| (word.to_string(), help.to_string())).collect();
    Choice { title, options, at: 0, then: Then::Answer(Question { about, text }) }
}

/// The first few lines, and how many more there are.
pub fn few(lines: &[String]) -> Vec<String> {
    let mut text: Vec<String> = lines.iter().take(FEW).map(|line| plain(line)).collect();
    if lines.len() > FEW {
        text.push(format!("and {} more", lines.len() - FEW));
    }
    text
}
