//! The far end of a window on another machine: follows the scene here, as a window would, and serves it over a pipe, as an
//! editor would. So edits are joined here for a slow link, and it makes no difference whether an editor or the file is followed.

use std::path::Path;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::base::error::{Error, Result};
use crate::files::Options;
use crate::files::originals::Originals;
use crate::preview::editor::Event;
use crate::preview::editor::host::{Shared, thread};
use crate::preview::editor::outbox::{Latest, Measured};
use crate::preview::follow::client;
use crate::preview::follow::news::News;
use crate::preview::wire::connection::{ALIVE, SILENCE, Wire};
use crate::preview::wire::frame;
use crate::preview::wire::handshake::HANDSHAKE;
use crate::preview::wire::message::{FromEditor, ToEditor};
use crate::scene::edit::Edit;

/// How long the scene may take to be read for the first time.
const FIRST: Duration = Duration::from_secs(30);
/// The same once there was a notice, which most likely says why there is no scene.
const AFTER_NOTICE: Duration = Duration::from_millis(300);

/// Serves the scene to the window at the other end of `wire` until that is gone.
///
/// # Errors
/// The other end is not a window of this version, or there is no scene to show; the other end was told so.
pub fn serve(scene: &Path, options: &Options, wire: Wire) -> Result<()> {
    let Wire { mut reader, mut writer, hang_up } = wire.watched(SILENCE);
    let (sender, greeted) = mpsc::channel();
    let most = options.limits.message;
    thread("greeting", move || {
        let hello = frame::read::<ToEditor>(&mut reader, most);
        drop(sender.send((hello, reader)));
    })?;
    let refused = match greeted.recv_timeout(HANDSHAKE) {
        Ok((Ok(Some(ToEditor::Hello { .. })), reader)) => match begin(scene, options) {
            Ok(far) => {
                return far.serve(scene, Wire { reader, writer, hang_up });
            }
            Err(error) => error,
        },
        Ok((Ok(Some(_)), _)) => Error::at("link", "the other end did not say hello"),
        Ok((Ok(None), _)) => return Ok(()),
        Ok((Err(error), _)) => error,
        Err(_) => Error::at("link", "the other end does not answer"),
    };
    // A courtesy: an end that does not understand it sees how this process ends.
    drop(frame::write(&mut writer, &FromEditor::Bye(refused.to_string())));
    Err(refused)
}

struct Far {
    news: Receiver<News>,
    replies: Sender<ToEditor>,
    latest: Latest,
    options: Options,
}

/// Follows the scene, as far as its first document.
fn begin(scene: &Path, options: &Options) -> Result<Far> {
    let (sender, news) = mpsc::channel();
    let replies = client::follow_with(scene, options, false, Box::new(move |news| sender.send(news).is_ok()));
    let mut why = format!("{} is not read in time", scene.display());
    let mut patience = FIRST;
    loop {
        match news.recv_timeout(patience) {
            Ok(News::Document { document, revision, .. }) => {
                let latest = Latest::new(document, revision);
                return Ok(Far { news, replies, latest, options: options.clone() });
            }
            Ok(News::Said(FromEditor::Notice(line))) => (why, patience) = (line, AFTER_NOTICE),
            Ok(News::Said(FromEditor::Problems(problems))) if !problems.is_empty() => {
                let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
                (why, patience) = (format!("{}: {}", scene.display(), lines.join("; ")), AFTER_NOTICE);
            }
            Ok(_) => {}
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) if scene.exists() => {
                return Err(Error::at("scene", why));
            }
            Err(_) => return Err(Error::at(scene.display(), "there is no such scene")),
        }
    }
}

impl Far {
    fn serve(self, scene: &Path, wire: Wire) -> Result<()> {
        let Far { news, replies, latest, options } = self;
        // A reply that cannot be delivered ends with this process.
        let replies = Mutex::new(replies);
        let deliver = move |event| {
            if let Event::Said(reply) = event {
                drop(replies.lock().unwrap_or_else(PoisonError::into_inner).send(reply));
            }
        };
        let shared = Arc::new(Shared::new(latest, Box::new(deliver)).alive(ALIVE));
        let (told, path) = (shared.clone(), scene.to_owned());
        thread("attach", move || {
            look_at_files(&told, &path, &options);
            for news in news {
                let files = matches!(news, News::Document { .. } | News::Files);
                publish(&told, news);
                if files {
                    look_at_files(&told, &path, &options);
                }
            }
        })?;
        shared.talk_with_window(wire, scene)
    }
}

fn publish(shared: &Shared, news: News) {
    match news {
        News::Document { document, revision, edit } => {
            let before = shared.lock().latest.document.clone();
            let edit = Measured::new(&edit.unwrap_or_else(|| Edit::between(&before, &document)));
            shared.change(|state| {
                (state.latest.document, state.latest.revision) = (document, revision);
                state.peers.values_mut().for_each(|peer| peer.outbox.edited(&edit));
            });
        }
        News::Said(FromEditor::View(name)) => shared.view(&name),
        News::Said(FromEditor::Views(names)) => shared.catch_up(&names),
        News::Said(message) => shared.say(message),
        // The caller looks at files; what is fetched here concerns nobody there.
        News::Files | News::Progress(_) => {}
    }
}

/// Tells the window what files the scene names, if that has changed.
fn look_at_files(shared: &Shared, scene: &Path, options: &Options) {
    let (latest, none) = (shared.lock().latest.clone(), Originals::default());
    let before = latest.originals.as_deref().unwrap_or(&none);
    let originals = Originals::of(scene, latest.document.scene(), options, before);
    if latest.originals.is_none() || originals.list() != before.list() {
        let list = originals.list();
        shared.change(|state| state.latest.originals = Some(Arc::new(originals)));
        shared.say(FromEditor::Images(list));
    }
}
