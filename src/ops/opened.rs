//! A scene opened for a command: its document and every file it refers to. Used by every command that looks at pixels.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Context, Progress, scene_options::SceneOptions, watched};
use crate::base::error::{Error, Result};
use crate::base::problem::{Problem, Severity};
use crate::base::progress;
use crate::files::{self, materials};
use crate::layers::parts::materials::Materials;
use crate::render::{self, Synth, bands::Bands};
use crate::scene::{Document, Scene, address};

/// A scene and the files it refers to.
pub struct Opened {
    /// Its file.
    pub path: PathBuf,
    /// The scene.
    pub document: Document,
    /// Its pictures and fields.
    pub materials: Materials,
    /// What was loaded counts against the limit on memory for as long as it is kept.
    _loaded: Arc<materials::Cache>,
}

/// A scene whose pictures are not loaded yet: a wrong command is reported before that.
pub struct Unloaded {
    path: PathBuf,
    options: files::Options,
    /// The scene.
    pub document: Document,
}

impl Unloaded {
    /// Reads the scene at `path` and prints its warnings.
    ///
    /// # Errors
    /// If it cannot be read, or the scene has problems: all of them.
    pub fn read(path: &Path, options: &SceneOptions, context: &mut Context) -> Result<Self> {
        let options = options.options()?;
        let document = context.document(path, &options)?;
        for warning in document.warnings() {
            context.messages.say(&format!("{}: {}", path.display(), address::of_problem(&document, warning)));
        }
        Ok(Unloaded { path: path.to_path_buf(), options, document })
    }

    /// Loads the files that the scene refers to.
    ///
    /// # Errors
    /// If some cannot be read: all of them.
    pub fn load(self, context: &mut Context) -> Result<Opened> {
        let Unloaded { path, options, document } = self;
        let mut cache = materials::Cache::until(context.cancel.clone());
        let loaded = materials::load(&path, document.scene(), &options, &mut cache);
        context.check_cancelled()?;
        let (materials, warnings) = loaded.map_err(|problems| refused(&path, &document, &problems))?;
        for warning in warnings {
            context.messages.say(&format!("{}: {}", path.display(), address::of_problem(&document, &warning)));
        }
        Ok(Opened { path, document, materials, _loaded: Arc::new(cache) })
    }
}

impl Opened {
    /// Opens the scene at `path`, loads the files it refers to, and prints the warnings.
    ///
    /// # Errors
    /// As [`Unloaded::read`] and [`Unloaded::load`].
    pub fn new(path: &Path, options: &SceneOptions, context: &mut Context) -> Result<Self> {
        Unloaded::read(path, options, context)?.load(context)
    }

    /// The scene in each of its ways, as [`Scene::compared`] has them.
    ///
    /// # Errors
    /// If the scene cannot be compared so.
    pub fn compared(self, by: &str) -> Result<Vec<Opened>> {
        let ways = self.document.scene().compared(by).map_err(|why| Error::at(self.path.display(), why))?;
        let opened = |(_, scene): (&str, Scene)| {
            let json = serde_json::to_value(scene).map_err(|error| Error::at(self.path.display(), error))?;
            let document =
                Document::from_json(json).map_err(|problems| refused(&self.path, &self.document, &problems))?;
            Ok(Opened {
                path: self.path.clone(),
                document,
                materials: self.materials.clone(),
                _loaded: self._loaded.clone(),
            })
        };
        ways.into_iter().map(opened).collect()
    }

    /// From now on what there is no memory for is left out where that is told ([`Opened::tell_lacks`]).
    pub fn leaving_out(mut self) -> Opened {
        self.materials.leaves_out = true;
        self
    }

    /// Says what a synthesis leaves out.
    pub fn tell_lacks(&self, synth: &Synth, context: &mut Context) {
        for lack in synth.lacks() {
            let lack = address::of_problem(&self.document, &Problem { severity: Severity::Warning, ..lack });
            context.messages.say(&format!("{}: {lack}", self.path.display()));
        }
    }

    /// Prepares the scene for rendering frames at any time.
    ///
    /// # Errors
    /// As [`render::synth`].
    pub fn synth(&self) -> Result<Synth> {
        render::synth(self.document.scene(), &self.materials, None).map_err(|problem| self.failed(problem))
    }

    /// The same, which tells how far it is.
    ///
    /// # Errors
    /// As [`render::synth`].
    pub fn synth_told(&self, messages: &mut dyn Progress) -> Result<Synth> {
        let percent = Arc::new(AtomicUsize::new(0));
        let done = percent.clone();
        let tell = progress::Progress::new(move |percent| done.store(percent.into(), Ordering::Relaxed));
        let materials = Materials { progress: Some(Arc::new(tell)), ..self.materials.clone() };
        let synth = || render::synth(self.document.scene(), &materials, None);
        let made = watched::told(messages, ("synthesis", 100), || percent.load(Ordering::Relaxed), synth);
        made.map_err(|problem| self.failed(problem))
    }

    /// The same for data passes alone.
    ///
    /// # Errors
    /// As [`render::synth`].
    pub fn unpainted(&self) -> Result<Synth> {
        render::unpainted(self.document.scene(), &self.materials).map_err(|problem| self.failed(problem))
    }

    /// The same band by band, for n x n samples per pixel.
    ///
    /// # Errors
    /// As [`Bands::new`].
    pub fn bands(&self, n: u32) -> Result<Bands<'_>> {
        Bands::new(self.document.scene(), &self.materials, n).map_err(|problem| self.failed(problem))
    }

    /// The same for n x n samples per pixel.
    ///
    /// # Errors
    /// As [`render::samples`].
    pub fn samples(&self, n: u32) -> Result<Vec<Synth>> {
        render::samples(self.document.scene(), &self.materials, n).map_err(|problem| self.failed(problem))
    }

    /// Why a synthesis failed.
    pub fn failed(&self, problem: Problem) -> Error {
        if self.materials.stopped() {
            return Error::Interrupted;
        }
        refused(&self.path, &self.document, &[problem])
    }
}

/// Problems of the scene in a file, with their addresses.
fn refused(path: &Path, document: &Document, problems: &[Problem]) -> Error {
    let problems = problems.iter().map(|problem| address::of_problem(document, problem)).collect();
    Error::Scene { file: path.display().to_string(), problems }
}
