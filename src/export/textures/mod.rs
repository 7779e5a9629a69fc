//! The textures of a scene for other engines: what its techniques give, encoded, in a folder with a manifest that says all
//! the rest.

use std::collections::HashSet;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, Linear};
use crate::export::{floats, still};
use crate::files::draft::DraftFolder;
use crate::files::outputs::ClearedFolder;
use crate::layers::KINDS;
use crate::layers::parts::bundle::{FileNote, FloatNote, Halves, HalvesNote, PictureNote, Sink, Texture, TextureNote};
use crate::layers::technique::Bundled;
use crate::layers::timeline::Timeline;
use crate::render::{Synth, cpu};
use crate::scene::Scene;

mod data;
mod names;
#[cfg(test)]
mod tests;

pub use data::Depth;
pub use names::{Names, earlier};

use names::{MANIFEST, MESHES, PICTURES, of_kind};

/// The version of the format of manifests; a player refuses a larger one.
const VERSION: u32 = 1;

/// How textures are written.
#[derive(Clone, Copy, Debug, Default)]
pub struct Forms {
    /// How many bits a number takes.
    pub depth: Depth,
    /// The side of pictures that surfaces are baked into, if they are.
    pub baked_px: Option<usize>,
}

impl From<Depth> for Forms {
    fn from(depth: Depth) -> Self {
        Forms { depth, baked_px: None }
    }
}

/// What was written.
pub struct Written {
    /// The names of the files.
    pub names: Vec<String>,
    /// The largest error of a place or a jump vector, in pixels.
    pub error_px: f64,
}

/// What `manifest.json` holds.
#[derive(Debug, Serialize)]
struct Manifest {
    /// [`VERSION`].
    plica_textures: u32,
    /// The scene's title.
    title: String,
    /// Width and height of a frame, in pixels.
    size: [usize; 2],
    /// Length, frame rate and what follows the end.
    timeline: Timeline,
    /// Number of frames.
    frames: u64,
    /// What each technique says about its layers.
    #[serde(flatten)]
    techniques: Map<String, Value>,
}

/// Writes the textures of `scene`, whose synthesis is `synth`, to the folder at `place`, all of them or none; other files of
/// an earlier run are removed. `step` is called with the steps done and their number, and ends the work by an error.
///
/// # Errors
/// The folder cannot be written, a depth cannot hold the scene, or `step` returns an error.
pub fn write(
    scene: &Scene,
    synth: &Synth,
    forms: Forms,
    place: &ClearedFolder,
    step: &mut dyn FnMut(u64, u64) -> Result<()>,
) -> Result<Written> {
    let mut techniques = Map::new();
    let draft = DraftFolder::create(place)?;
    let may = Names::of(scene, forms.depth);
    let mut folder = Folder { draft, may, names: Vec::new(), forms, error_px: 0.0, step, done: (0, 0) };
    for kind in KINDS {
        let Some(bundle) = &kind.bundle else { continue };
        let layers = of_kind(scene, kind).filter_map(|(i, layer)| Some((layer, &**synth.layers.get(i)?)));
        let layers: Vec<Bundled> = layers.map(|(layer, ready)| Bundled { layer, ready }).collect();
        if !layers.is_empty() {
            techniques.extend((bundle.write)(&layers, &mut folder)?);
        }
    }
    let manifest = Manifest {
        plica_textures: VERSION,
        title: scene.title.clone(),
        size: synth.size.into(),
        timeline: scene.timeline.clone(),
        frames: scene.timeline.frames(),
        techniques,
    };
    let text = serde_json::to_string_pretty(&manifest).map_err(|e| Error::at(MANIFEST, e))?;
    folder.put(MANIFEST.into(), text.as_bytes())?;
    let (_, all) = folder.done;
    folder.step(all, all)?;
    folder.draft.keep(&folder.names)?;
    Ok(Written { names: folder.names, error_px: folder.error_px })
}

/// The folder being written.
struct Folder<'a> {
    draft: DraftFolder,
    may: Names,
    names: Vec<String>,
    forms: Forms,
    /// The largest error of a place or a jump vector so far.
    error_px: f64,
    step: &'a mut dyn FnMut(u64, u64) -> Result<()>,
    /// The last step, and the number of steps.
    done: (u64, u64),
}

impl Folder<'_> {
    fn put(&mut self, name: String, bytes: &[u8]) -> Result<()> {
        if !self.may.may_be(&name) {
            return Err(Error::at(name, "is a name that was not checked beforehand"));
        }
        self.draft.write(&name, bytes)?;
        self.names.push(name);
        Ok(())
    }

    /// A picture in floats, if it holds light that 8 bits cannot: brighter than white, or negative.
    fn float(&mut self, name: &str, colors: &Linear) -> Result<Option<FloatNote>> {
        let beyond = |&[r, g, b, a]: &[f32; 4]| [r, g, b].iter().any(|&c| c > a + 1e-6 || c < -1e-6);
        if !colors.cells().iter().any(beyond) {
            return Ok(None);
        }
        let file = format!("{name}.{}", PICTURES[1]);
        let bytes = floats::rgba(colors).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        Ok(Some(FloatNote { file }))
    }
}

impl Sink for Folder<'_> {
    fn baked_px(&self) -> Option<usize> {
        self.forms.baked_px
    }

    fn largest_code(&self) -> Option<u16> {
        self.forms.depth.largest()
    }

    fn step(&mut self, done: u64, all: u64) -> Result<()> {
        self.done = (done, all);
        (self.step)(done, all)
    }

    fn stem(&self, layer: Option<&str>, item: &str, end: &str) -> String {
        let stem = names::stem(layer, item);
        let taken: HashSet<String> = self.names.iter().map(|name| names::folded(name)).collect();
        let file = |stem: &String| names::folded(&format!("{stem}{end}.{}", self.forms.depth.extension()));
        let numbered = (2..).map(|n| format!("{stem}{n}-"));
        std::iter::once(stem.clone()).chain(numbered).find(|stem| !taken.contains(&file(stem))).unwrap_or(stem)
    }

    fn texture(&mut self, name: &str, texture: &Texture) -> Result<TextureNote> {
        let Forms { depth, .. } = self.forms;
        let (bytes, note) = texture.encode(format!("{name}.{}", depth.extension()), depth)?;
        self.put(note.file.clone(), &bytes)?;
        self.error_px = note.channels.iter().filter_map(|channel| channel.error_px).fold(self.error_px, f64::max);
        Ok(note)
    }

    fn picture(&mut self, name: &str, colors: &Linear, finish: &dyn Fn(&mut Frame)) -> Result<PictureNote> {
        let file = format!("{name}.{}", PICTURES[0]);
        let mut codes = cpu::finish(colors);
        finish(&mut codes);
        let bytes = still::frame(&codes).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        Ok(PictureNote { file, float: self.float(name, colors)? })
    }
    fn halves(&mut self, name: &str, size: (usize, usize), texel: Halves) -> Result<HalvesNote> {
        let file = format!("{name}.{}", PICTURES[1]);
        let bytes = floats::halves(size, texel).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        Ok(HalvesNote { file, width: size.0, height: size.1 })
    }

    fn mesh(&mut self, name: &str, text: &str) -> Result<FileNote> {
        let file = format!("{name}.{}", MESHES[0]);
        self.put(file.clone(), text.as_bytes())?;
        Ok(FileNote { file })
    }
}
