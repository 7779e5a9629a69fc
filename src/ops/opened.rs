//! A scene opened for a command: its document and everything it names. Used by every command that looks at pixels.

use std::path::{Path, PathBuf};

use super::{Context, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::problem::Problem;
use crate::files::{self, materials};
use crate::layers::parts::materials::Materials;
use crate::render::{self, Synth, bands::Bands};
use crate::scene::Document;

/// A scene and what it names.
pub struct Opened {
    /// Where it lies.
    pub path: PathBuf,
    /// The scene.
    pub document: Document,
    /// Its pictures and fields.
    pub materials: Materials,
}

/// A scene of which nothing is loaded yet, so that what is wrong with a command is told before that.
pub struct Unloaded {
    path: PathBuf,
    options: files::Options,
    /// The scene.
    pub document: Document,
}

impl Unloaded {
    /// Reads the scene at `path`; warnings are said.
    ///
    /// # Errors
    /// It cannot be read; every problem of the scene.
    pub fn read(path: &Path, options: &SceneOptions, context: &mut Context) -> Result<Self> {
        let options = options.options()?;
        let document = context.document(path, &options)?;
        for warning in document.warnings() {
            context.messages.say(&format!("{}: {warning}", path.display()));
        }
        Ok(Unloaded { path: path.to_path_buf(), options, document })
    }

    /// Loads what it names.
    ///
    /// # Errors
    /// What cannot be read.
    pub fn load(self, context: &mut Context) -> Result<Opened> {
        let Unloaded { path, options, document } = self;
        let mut cache = materials::Cache::until(context.cancel.clone());
        let loaded = materials::load(&path, document.scene(), &options, &mut cache);
        context.check_cancelled()?;
        let (materials, warnings) =
            loaded.map_err(|problems| Error::Scene { file: path.display().to_string(), problems })?;
        for warning in warnings {
            context.messages.say(&format!("{}: {warning}", path.display()));
        }
        Ok(Opened { path, document, materials })
    }
}

impl Opened {
    /// Opens the scene at `path` and loads what it names; warnings are said.
    ///
    /// # Errors
    /// As [`Unloaded::read`] and [`Unloaded::load`].
    pub fn new(path: &Path, options: &SceneOptions, context: &mut Context) -> Result<Self> {
        Unloaded::read(path, options, context)?.load(context)
    }

    /// The scene made ready for frames at any time.
    ///
    /// # Errors
    /// As [`render::synth`].
    pub fn synth(&self) -> Result<Synth> {
        render::synth(self.document.scene(), &self.materials, None).map_err(|problem| self.failed(problem))
    }

    /// The same band by band, for n x n samples a pixel.
    ///
    /// # Errors
    /// As [`Bands::new`].
    pub fn bands(&self, n: u32) -> Result<Bands<'_>> {
        Bands::new(self.document.scene(), &self.materials, n).map_err(|problem| self.failed(problem))
    }

    /// The same for n x n samples a pixel.
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
        Error::Scene { file: self.path.display().to_string(), problems: vec![problem] }
    }
}
