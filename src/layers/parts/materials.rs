//! The materials of a layer: the files and images that it names, and their values.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::base::budget::Budget;
use crate::base::clip::Clip;
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::pixels::Grid;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::base::progress::Progress;

/// Something that a layer names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Use<'a> {
    /// Where it is named: a JSON pointer relative to the layer.
    pub at: String,
    /// How it is named.
    pub of: Of<'a>,
    /// What it is used as.
    pub what: What<'a>,
}

/// How a layer names something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of<'a> {
    /// By its name in a list of the scene.
    Name(List, &'a str),
    /// A file by its path.
    Path(&'a str),
}

/// The lists of a scene whose items have names that layers use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// Pictures.
    Images,
    /// Meshes.
    Meshes,
    /// Clips.
    Clips,
    /// Shapes.
    Shapes,
    /// The layers themselves.
    Layers,
}

impl List {
    /// Those whose items have names of their own.
    pub const NAMED: [List; 4] = [List::Images, List::Meshes, List::Clips, List::Shapes];

    /// Whether its items come from files.
    pub fn has_files(self) -> bool {
        matches!(self, List::Images | List::Meshes | List::Clips)
    }

    /// The list, and the name in it, that a pointer of the scene leads to; `None` for other places, and for layers, which
    /// are in a list by their order.
    pub fn entry(pointer: &str) -> Option<(List, String)> {
        let (list, name) = Pointer(pointer).split()?;
        let list = List::NAMED.into_iter().find(|known| list.strip_prefix('/') == Some(known.words().0))?;
        Some((list, name))
    }

    /// Its name in the document, and what an item of it is.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            List::Images => ("images", "image"),
            List::Meshes => ("meshes", "mesh"),
            List::Clips => ("clips", "clip"),
            List::Shapes => ("shapes", "shape"),
            List::Layers => ("layers", "layer"),
        }
    }
}

/// What a layer uses something as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What<'a> {
    /// A picture.
    Picture,
    /// A mask; if it has no alpha it is applied to the image `on` by its brightness.
    Mask {
        /// The name of the image in the scene.
        on: &'a str,
    },
    /// A field of vectors.
    Vectors,
    /// A mesh.
    Mesh,
    /// A clip.
    Clip,
    /// A path.
    Shape,
    /// A layer as a picture, at its own time.
    Layer,
}

/// Everything that a scene names and synthesis needs: decoded pictures and vector fields. Values, no handles.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// Pictures by their name in the scene's images.
    pub pictures: BTreeMap<String, Arc<Picture>>,
    /// Masks without alpha, applied to the pictures that they are for, by the names of both.
    pub masks: BTreeMap<(String, String), Arc<Picture>>,
    /// Sampled vector fields by their path in the scene, in pixels.
    pub fields: BTreeMap<String, Arc<Grid<[f32; 2]>>>,
    /// Meshes by their name in the scene's meshes.
    pub meshes: BTreeMap<String, Arc<Mesh>>,
    /// Clips by their name in the scene's clips.
    pub clips: BTreeMap<String, Arc<Clip>>,
    /// Cancellation flag: once set, a running synthesis ends with an error.
    pub stop: Option<Arc<AtomicBool>>,
    /// Where a synthesis counts how far it is, in pixels.
    pub progress: Option<Arc<Progress>>,
    /// The memory that is left for what is made from them.
    pub budget: Budget,
    /// Whether a layer for which there is too little of it shows what it can, and tells that ([`Ready::lacks`]); otherwise it
    /// cannot be made.
    ///
    /// [`Ready::lacks`]: crate::layers::ready::Ready::lacks
    pub leaves_out: bool,
}

impl Materials {
    /// Whether the synthesis has been cancelled.
    pub fn stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// `pixels` more pixels are to be made.
    pub fn expect(&self, pixels: u64) {
        self.progress.iter().for_each(|progress| progress.expect(pixels));
    }

    /// `pixels` more pixels have been made.
    pub fn made(&self, pixels: u64) {
        self.progress.iter().for_each(|progress| progress.done(pixels));
    }

    /// The picture that samplers read for the mask `name` of the picture `own`.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn mask(&self, name: &str, own: &str, path: &str) -> Result<Arc<Picture>, Problem> {
        match self.masks.get(&(name.to_owned(), own.to_owned())) {
            Some(laid) => Ok(laid.clone()),
            None => self.picture(name, path),
        }
    }

    /// The mesh of that name.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn mesh(&self, name: &str, path: &str) -> Result<Arc<Mesh>, Problem> {
        let missing = || Problem::error(path, format!("the mesh \"{name}\" is not there"));
        self.meshes.get(name).cloned().ok_or_else(missing)
    }

    /// The clip of that name.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn clip(&self, name: &str, path: &str) -> Result<Arc<Clip>, Problem> {
        let missing = || Problem::error(path, format!("the clip \"{name}\" is not there"));
        self.clips.get(name).cloned().ok_or_else(missing)
    }

    /// The picture of that name.
    ///
    /// # Errors
    /// It is not there; `path` tells where it is named.
    pub fn picture(&self, name: &str, path: &str) -> Result<Arc<Picture>, Problem> {
        let missing = || Problem::error(path, format!("the picture \"{name}\" is not there"));
        self.pictures.get(name).cloned().ok_or_else(missing)
    }
}
