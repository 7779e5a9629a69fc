//! What the editor knows of its surroundings, and what it asks about them: unsaved edits that were left behind, somebody
//! else who edits the scene.

use crate::tui::document::choice::{About, Choice, Question, Then};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::text::plain;

/// So many changes are shown in a question; the rest can be looked at.
const FEW: usize = 5;

/// What the editor knows of its surroundings.
#[derive(Clone, Debug, Default)]
pub struct Outside {
    /// A question that waits until nothing else is going on.
    pub waiting: Option<Choice>,
    /// How the file differs from what it should be, in a word for the status line.
    pub file: Option<&'static str>,
    /// What keeps the scene from being shown.
    pub problem: Option<String>,
    /// Long work that runs: what, and how far it is.
    pub work: Option<String>,
    /// How the window is doing.
    pub window: String,
    /// Where the pointer is in the window, in pixels of the picture.
    pub pointer: Option<(f64, f64)>,
}

impl Outside {
    /// With what is to be asked when a scene has been opened.
    pub fn new(scene: &OpenScene) -> Outside {
        let held = scene.held_by().map(|holder| {
            let text = vec![format!("The scene {}.", plain(&holder.in_words()))];
            let mut options = vec![("look", "Open it to read only; it follows what is saved there")];
            if !holder.certain {
                options.push(("edit", "Edit it all the same: nobody is there any more"));
            }
            options.push(("quit", "Leave"));
            question(About::Holder, "the scene is open elsewhere".into(), text, &options)
        });
        Outside { waiting: held.or_else(|| about_recovery(scene)), ..Outside::default() }
    }
}

/// What is asked about unsaved edits that were left behind.
pub fn about_recovery(scene: &OpenScene) -> Option<Choice> {
    let offer = scene.offered()?;
    let title = format!("{} left behind, {}", offer.in_words(), scene.ago(offer.time_ms));
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
