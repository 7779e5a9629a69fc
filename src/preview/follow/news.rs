//! Updates of a scene that is followed, and how they become what a window shows.

use std::sync::mpsc::Sender;

use crate::preview::views::Views;
use crate::preview::wire::message::FromEditor;
use crate::scene::Document;
use crate::scene::edit::Edit;

/// What reaches a window, from the editor that has the scene open or from the file.
#[derive(Clone, Debug)]
pub enum Update {
    /// The scene to show from now on. A window answers it with [`ToEditor::Ack`]; until then further edits are joined.
    ///
    /// [`ToEditor::Ack`]: crate::preview::wire::message::ToEditor::Ack
    Scene {
        /// The scene.
        document: Document,
        /// Its revision in the editor; the number of loads if the file is followed.
        revision: u64,
    },
    /// What the editor says to its windows, or what the follower says in its place: never a document.
    Said(FromEditor),
    /// Progress of something that takes long, in one line; empty once it is done.
    Progress(String),
}

/// An update of a scene that is followed.
pub(in crate::preview) enum News {
    /// The document of this revision.
    Document {
        /// The document.
        document: Document,
        /// As in [`Update::Scene`].
        revision: u64,
        /// The edit that made it of the previous document; `None` if that is not known.
        edit: Option<Edit>,
    },
    /// Files that the document names have changed.
    Files,
    /// As [`Update::Said`].
    Said(FromEditor),
    /// As [`Update::Progress`].
    Progress(String),
}

/// Takes news; returns false once nobody listens any more.
pub(in crate::preview) type Sink = Box<dyn FnMut(News) -> bool + Send>;

/// Tells a window. After a lost link, the window is told only the view commands that it does not follow yet.
pub(in crate::preview) fn window_sink(updates: Sender<Update>) -> Sink {
    let mut views = Views::default();
    let mut shown = None;
    Box::new(move |news| {
        let send = |update| updates.send(update).is_ok();
        let say = |message| send(Update::Said(message));
        match news {
            News::Document { document, revision, .. } => {
                shown = Some((document.clone(), revision));
                send(Update::Scene { document, revision })
            }
            News::Files => shown.clone().is_none_or(|(document, revision)| send(Update::Scene { document, revision })),
            News::Said(FromEditor::Views(list)) => {
                views.catch_up(&list).into_iter().all(|name| say(FromEditor::View(name)))
            }
            News::Said(FromEditor::View(name)) => say(FromEditor::View(views.take(&name))),
            News::Said(message) => say(message),
            News::Progress(line) => send(Update::Progress(line)),
        }
    })
}
