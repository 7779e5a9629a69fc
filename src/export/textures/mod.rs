//! The textures of a scene for other engines (folding.md, section 6): a colour atlas, init and jump a zone, the position
//! functions, thresholds where paths need them, and a manifest that says all the rest.

use std::collections::HashSet;

use crate::base::error::{Error, Result};
use crate::base::pixels::{Beyond, Grid};
use crate::export::still;
use crate::files::draft::DraftFolder;
use crate::files::outputs::FolderPlace;
use crate::layers::Layer;
use crate::layers::folding::atlas::{Area, Atlas, Need, Piece, reach};
use crate::layers::folding::fold::Fold;
use crate::layers::folding::model::{PictureLayer, Zone};
use crate::layers::folding::synth::ZoneSynth;
use crate::render::{LayerSynth, Synth};
use crate::scene::Scene;

mod data;
mod folds;
mod function;
mod manifest;
mod names;
#[cfg(test)]
mod tests;

pub use data::Depth;
pub use names::{Names, earlier};

use data::{Channel, Texture, TextureNote};
use names::{COLOUR, MANIFEST};

use manifest::{CONVENTIONS, Colour, Function, Manifest, PieceNote, Slots, ThresholdsNote, VERSION};

/// How far beyond a crossing s must be to have passed it: a 32-bit float is that exact.
const TOLERANCE: f64 = 1e-6;

/// Writes the textures of `scene`, whose synthesis is `synth`, to the folder at `place`, all of them or none; the files of an
/// earlier run that are none of these go. `step` is told how many of how many zones are done and ends the work by an error.
/// Gives the names of the files.
///
/// # Errors
/// The folder cannot be written, a depth cannot hold the scene, or `step`'s.
pub fn write(
    scene: &Scene,
    synth: &Synth,
    depth: Depth,
    place: &FolderPlace,
    step: &mut dyn FnMut(u64, u64) -> Result<()>,
) -> Result<Vec<String>> {
    let plan = Plan::new(scene, synth);
    plan.fits(depth)?;
    let mut folder =
        Folder { draft: DraftFolder::create(place)?, may: Names::of(scene, depth), names: Vec::new(), depth };
    let mut layers: Vec<manifest::Layer> = Vec::new();
    let all = plan.zones.len();
    for (row, zone) in plan.zones.iter().enumerate() {
        step(row as u64, all as u64)?;
        plan.layers_up_to(zone.layer, &mut layers);
        let note = folder.zone(&plan, zone, row)?;
        layers[zone.layer].zones.push(note);
    }
    plan.layers_up_to(scene.layers.len().saturating_sub(1), &mut layers);
    let manifest = Manifest {
        plica_textures: VERSION,
        title: scene.title.clone(),
        size: synth.size.into(),
        timeline: scene.timeline.clone(),
        frames: scene.timeline.frames(),
        conventions: CONVENTIONS,
        colour: folder.colour(&plan.atlas)?,
        function: folder.function(&plan)?,
        layers,
    };
    let text = serde_json::to_string_pretty(&manifest).map_err(|e| Error::at("manifest.json", e))?;
    folder.put(MANIFEST.into(), text.as_bytes())?;
    step(all as u64, all as u64)?;
    folder.draft.keep(&folder.names)?;
    Ok(folder.names)
}

/// The atlas, and what each zone reads of it.
struct Plan<'a> {
    atlas: Atlas,
    /// The piece and the name of each layer.
    layers: Vec<(usize, &'a str)>,
    zones: Vec<Planned<'a>>,
}

/// A zone with pixels.
struct Planned<'a> {
    layer: usize,
    model: &'a Zone,
    synth: &'a ZoneSynth,
    piece: usize,
}

impl<'a> Plan<'a> {
    fn new(scene: &'a Scene, synth: &'a Synth) -> Self {
        let (mut needs, mut zones) = (Vec::new(), Vec::new());
        let mut layer_needs = Vec::new();
        for (index, (Layer::Picture(model), LayerSynth::Picture(layer))) in
            scene.layers.iter().zip(&synth.layers).enumerate()
        {
            let area = Area::whole(&layer.picture);
            let picture = layer.picture.clone();
            layer_needs.push((needs.len(), model.name.as_str()));
            needs.push(Need { image: model.image.clone(), picture, beyond: Beyond::Clamp, area });
            for zone in &layer.zones {
                let Some(area) = reach(zone) else { continue };
                let source = &zone.source;
                let image = source_name(model, &model.zones[zone.index]).to_owned();
                // `piece` is the need's number until the atlas is packed.
                zones.push(Planned { layer: index, model: &model.zones[zone.index], synth: zone, piece: needs.len() });
                needs.push(Need { image, picture: source.picture.clone(), beyond: source.beyond, area });
            }
        }
        let (atlas, piece_of) = Atlas::new(needs);
        zones.iter_mut().for_each(|zone| zone.piece = piece_of[zone.piece]);
        let layers = layer_needs.into_iter().map(|(need, name)| (piece_of[need], name)).collect();
        Plan { atlas, layers, zones }
    }

    /// Adds the layers up to `last` that are not there yet.
    fn layers_up_to(&self, last: usize, layers: &mut Vec<manifest::Layer>) {
        for &(piece, name) in self.layers.iter().take(last + 1).skip(layers.len()) {
            layers.push(manifest::Layer { name: name.to_owned(), piece, zones: Vec::new() });
        }
    }

    /// Whether `depth` can number the zones in init A, where 0 means outside.
    fn fits(&self, depth: Depth) -> Result<()> {
        match depth.largest() {
            Some(largest) if self.zones.len() >= usize::from(largest) => {
                let what = format!("{largest} codes cannot number {} zones", self.zones.len());
                Err(Error::at("--depth", what).cure("take more bits"))
            }
            _ => Ok(()),
        }
    }
}

/// The name of the image that the samplers of a zone read.
fn source_name<'a>(layer: &'a PictureLayer, zone: &'a Zone) -> &'a str {
    match (&zone.fold, &zone.sampler) {
        (Some(Fold::Mask { image }), _) => image,
        (_, Some(sampler)) => &sampler.image,
        _ => &layer.image,
    }
}

/// The rule of a zone's fold, as in the document.
fn rule_name(zone: &Zone) -> &'static str {
    match &zone.fold {
        None => "none",
        Some(Fold::Cover { .. }) => "cover",
        Some(Fold::Return { .. }) => "return",
        Some(Fold::FlyOver { .. }) => "fly-over",
        Some(Fold::Mask { .. }) => "mask",
    }
}

/// The folder being written.
struct Folder {
    draft: DraftFolder,
    may: Names,
    names: Vec<String>,
    depth: Depth,
}

impl Folder {
    fn put(&mut self, name: String, bytes: &[u8]) -> Result<()> {
        if !self.may.may_be(&name) {
            return Err(Error::at(name, "is a name that nobody has looked at before the work"));
        }
        self.draft.write(&name, bytes)?;
        self.names.push(name);
        Ok(())
    }

    fn texture(&mut self, name: String, texture: &Texture) -> Result<TextureNote> {
        let (bytes, note) = texture.encode(format!("{name}.{}", self.depth.extension()), self.depth)?;
        self.put(note.file.clone(), &bytes)?;
        Ok(note)
    }

    fn zone(&mut self, plan: &Plan, zone: &Planned, row: usize) -> Result<manifest::Zone> {
        let field = &*zone.synth.field;
        let clock = &zone.synth.clock;
        let stem = self.stem(plan, zone);
        let piece = &plan.atlas.pieces[zone.piece];
        let size = (plan.atlas.colors.width() as f64, plan.atlas.colors.height() as f64);
        let init = self.texture(format!("{stem}init"), &init(zone.synth, piece, size, (row, plan.zones.len())))?;
        let jump = self.texture(format!("{stem}jump"), &jump(zone.synth, size))?;
        let range = clock.position.range();
        let thresholds = match folds::thresholds(field, range) {
            None => None,
            Some(found) => {
                let texture = self.texture(format!("{stem}thresholds"), &found.texture)?;
                let error = texture.channels.iter().map(|c| c.error).fold(0.0, f64::max);
                let slots = Slots { ahead: found.ahead, behind: found.behind };
                Some(ThresholdsNote { texture, slots, tolerance: TOLERANCE.max(error) })
            }
        };
        let (width, height) = (field.inside.width(), field.inside.height());
        Ok(manifest::Zone {
            name: zone.model.name.clone(),
            row,
            piece: zone.piece,
            bounds: manifest::Box { x: field.x0, y: field.y0, width, height },
            rule: rule_name(zone.model),
            lay: if zone.synth.source.over { "over" } else { "replace" },
            wrap: clock.wrap,
            speed: clock.speed,
            shift: clock.shift,
            range: range.into(),
            breaks: clock.position.breaks(),
            init,
            jump,
            thresholds,
        })
    }

    /// How the files of a zone begin: its name in plain letters, the layer's before it where there are several.
    fn stem(&self, plan: &Plan, zone: &Planned) -> String {
        let layer = (plan.layers.len() > 1).then_some(plan.layers[zone.layer].1);
        let stem = names::stem(layer, &zone.model.name);
        let taken: HashSet<&str> = self.names.iter().map(String::as_str).collect();
        let is_free = |stem: &String| !taken.contains(format!("{stem}init.{}", self.depth.extension()).as_str());
        let numbered = (2..).map(|n| format!("{stem}{n}-"));
        std::iter::once(stem.clone()).chain(numbered).find(is_free).unwrap_or(stem)
    }

    fn colour(&mut self, atlas: &Atlas) -> Result<Colour> {
        let file = COLOUR.to_owned();
        let bytes = still::frame(&crate::render::cpu::finish(&atlas.colors)).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        let note = |piece: &Piece| {
            let area = piece.need.area;
            let (width, height) = (area.width() as usize, area.height() as usize);
            let image = piece.need.image.clone();
            PieceNote { image, x: piece.x, y: piece.y, width, height, from: [area.x0, area.y0] }
        };
        let pieces = atlas.pieces.iter().map(note).collect();
        Ok(Colour { file, width: atlas.colors.width(), height: atlas.colors.height(), pieces })
    }

    fn function(&mut self, plan: &Plan) -> Result<Function> {
        let rows: Vec<_> = plan.zones.iter().map(|zone| &zone.synth.clock.position).collect();
        let texture = self.texture("function".into(), &function::texture(&rows))?;
        Ok(Function { texture, error_between: function::error_between(&rows) })
    }
}

/// Where each sampler stands at s = 0 in the atlas, its temporal shift, and its zone's row; 0 outside the zone.
fn init(zone: &ZoneSynth, piece: &Piece, (width, height): (f64, f64), (row, rows): (usize, usize)) -> Texture {
    let field = &*zone.field;
    let origin = zone.source.offset + piece.atlas_from_image();
    let columns = field.inside.width();
    let row = (row as f64 + 0.5) / rows as f64;
    let cell = |(i, inside): (usize, &bool)| {
        let (x, y) = ((field.x0 + i % columns) as f64 + 0.5, (field.y0 + i / columns) as f64 + 0.5);
        if *inside { [(x + origin.x) / width, (y + origin.y) / height, zone.clock.shift, row] } else { [0.0; 4] }
    };
    let cells = field.inside.cells().iter().enumerate().map(cell).collect();
    let channels = vec![
        Channel { pixels: Some(width), ..Channel::new("u0", "where the sampler stands at s = 0, in atlas widths", 0) },
        Channel {
            pixels: Some(height),
            ..Channel::new("v0", "where the sampler stands at s = 0, in atlas heights", 1)
        },
        Channel::new("shift", "temporal shift, in timelines", 2),
        Channel::new("row", "0 outside the zone, else (row + 0.5) / rows of the function texture", 3),
    ];
    Texture { values: Grid::from_cells(columns, field.inside.height(), cells), channels }
}

/// Jump vectors in atlas widths and heights, and the first stretch on which each pixel moves.
fn jump(zone: &ZoneSynth, (width, height): (f64, f64)) -> Texture {
    let field = &*zone.field;
    let cell = |(i, [x, y]): (usize, &[f32; 2])| {
        let [s0, s1] = if field.inside.cells()[i] { folds::stretch(field, i) } else { [1.0, 1.0] };
        [f64::from(*x) / width, f64::from(*y) / height, s0, s1]
    };
    let cells = field.jumps.cells().iter().enumerate().map(cell).collect();
    let channels = vec![
        Channel { pixels: Some(width), ..Channel::new("x", "jump vector, in atlas widths", 0) },
        Channel { pixels: Some(height), ..Channel::new("y", "jump vector, in atlas heights, downward", 0) },
        Channel::new("s0", "the pixel moves where s0 < s <= s1", 1),
        Channel::new("s1", "the pixel moves where s0 < s <= s1", 1),
    ];
    Texture { values: Grid::from_cells(field.inside.width(), field.inside.height(), cells), channels }
}
