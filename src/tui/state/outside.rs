//! What the editor knows of the file, the window and long work, and its questions about unsaved edits that were left behind
//! and about somebody else who is editing the scene.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use crate::base::problem::Problem;
use crate::layers::space::camera::Camera;
use crate::tui::document::choice::{About, Choice, Question, Then};
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::Event;
use crate::tui::text::plain;

/// How many changes are shown in a question. One of its answers shows all.
const FEW: usize = 5;

/// What the editor knows of the file, the window and long work.
#[derive(Default)]
pub struct Outside {
    /// A question that waits until nothing else is going on.
    pub waiting: Option<Choice>,
    /// What is wrong with the file, for the status line.
    pub file: Option<&'static str>,
    /// Why the scene cannot be shown.
    pub problem: Option<Problem>,
    /// The long work that is running, and its progress.
    pub work: Option<String>,
    /// The rows that a program has been given.
    pub piping: Option<Piping>,
    /// The state of the window, for the status line.
    pub window: String,
    /// Where the pointer is in the window, in pixels of the picture.
    pub pointer: Option<(f64, f64)>,
    /// What a window's mouse drags, and the revision of the scene when that began.
    pub dragged: Option<(String, u64)>,
    /// The camera that a window shows, where it is not the scene's: what was said last, if there are several windows.
    pub camera: Option<Camera>,
    /// What is to be done with that once the windows have told what they had not.
    pub asking: Option<Asking>,
    /// What was typed meanwhile, which comes after it.
    pub postponed: VecDeque<Event>,
}

impl Outside {
    /// Refuses to start something beside what is running.
    ///
    /// # Errors
    /// What that is.
    pub fn idle(&self) -> Result<(), String> {
        match &self.work {
            Some(work) => Err(format!("something is running already ({}): Esc ends it", plain(work))),
            None => Ok(()),
        }
    }
}

/// What the camera of the windows is wanted for.
#[derive(Clone, Debug)]
pub struct Asking {
    /// A word of `camera`.
    pub word: String,
    /// The scene time when that was typed.
    pub time: f64,
}

/// Rows that have been sent through a program.
#[derive(Clone, Debug)]
pub struct Piping {
    /// The program.
    pub program: String,
    /// The revision of the scene when it began.
    pub revision: u64,
    /// The node whose rows they are.
    pub node: String,
    /// The columns that were shown.
    pub columns: Arc<[String]>,
    /// The head of the column under the cursor.
    pub head: String,
    /// The rows.
    pub rows: BTreeSet<usize>,
    /// The table that was sent.
    pub sent: String,
}

impl Outside {
    /// For a scene that has just been opened, with a question if there is something to ask.
    pub fn new(scene: &OpenScene) -> Outside {
        let held = scene.held_by().map(|holder| {
            let text = vec![format!("The scene {}.", plain(&holder.in_words()))];
            let mut options = vec![("look", "Open it read-only; it follows what is saved there")];
            if !holder.certain {
                options.push(("edit", "Edit it anyway: nobody is there any more"));
            }
            options.push(("quit", "Leave"));
            question(About::Holder, "the scene is open elsewhere".into(), text, &options)
        });
        Outside { waiting: held.or_else(|| about_recovery(scene)), ..Outside::default() }
    }
}

/// The question about unsaved edits that were left behind.
pub fn about_recovery(scene: &OpenScene) -> Option<Choice> {
    let offer = scene.offered()?;
    let title = format!("{} left behind, {}", offer.in_words(), scene.ago(offer.time_ms));
    let mut text = few(&offer.words);
    if offer.file_changed {
        text.push("Another program has changed the file since then.".into());
    }
    let options = [
        ("keep", "Take the changes"),
        ("drop", "Leave the file as it is; u still brings the changes back"),
        ("difference", "Look at all of them"),
    ];
    Some(question(About::Recovery, title, text, &options))
}

/// A list of answers, below what one has to know for them.
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
