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
use crate::layers::folding::{self, synth::ZoneSynth};
use crate::render::Synth;
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
use function::{Row, Table};
use manifest::{CONVENTIONS, Colour, Function, Light, Manifest, PieceNote, Slots, ThresholdsNote, VERSION};
use names::{COLOUR, LIGHT, MANIFEST};

/// How far off a sampler may be because a position function is interpolated, in pixels: at the hardest edge that is half a
/// code.
const UNSEEN_PX: f64 = 5e-4;

/// How far beyond a crossing s must be to have passed it: a 32-bit float is that exact.
const TOLERANCE: f64 = 1e-6;

/// What was written.
pub struct Written {
    /// The names of the files.
    pub names: Vec<String>,
    /// The largest error of a place or a jump vector, in pixels.
    pub error_px: f64,
}

/// Writes the textures of `scene`, whose synthesis is `synth`, to the folder at `place`, all of them or none; other files of
/// an earlier run are removed. `step` is called with the zones done and their number, and ends the work by an error.
///
/// # Errors
/// The folder cannot be written, a depth cannot hold the scene, or `step`'s.
pub fn write(
    scene: &Scene,
    synth: &Synth,
    depth: Depth,
    place: &FolderPlace,
    step: &mut dyn FnMut(u64, u64) -> Result<()>,
) -> Result<Written> {
    let plan = Plan::new(scene, synth);
    plan.fits(depth)?;
    let rows = plan.rows();
    let table = Table::new(&rows, depth.largest().is_none());
    let draft = DraftFolder::create(place)?;
    let mut folder = Folder { draft, may: Names::of(scene, depth), names: Vec::new(), depth, error_px: 0.0 };
    let mut layers: Vec<manifest::Layer> = Vec::new();
    let all = plan.zones.len();
    for (row, zone) in plan.zones.iter().enumerate() {
        step(row as u64, all as u64)?;
        plan.layers_up_to(zone.layer, &mut layers);
        let note = folder.zone(&plan, &table, zone, row)?;
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
        function: folder.function(&table)?,
        layers,
    };
    let text = serde_json::to_string_pretty(&manifest).map_err(|e| Error::at("manifest.json", e))?;
    folder.put(MANIFEST.into(), text.as_bytes())?;
    step(all as u64, all as u64)?;
    folder.draft.keep(&folder.names)?;
    Ok(Written { names: folder.names, error_px: folder.error_px })
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
        for (index, (model, layer)) in scene.layers.iter().zip(&synth.layers).enumerate() {
            let Layer::Picture(model) = model else { continue };
            let Some(layer) = layer.downcast::<folding::synth::Synth>() else { continue };
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

    /// The position functions, each as exact as the longest jump vector of its zone requires.
    fn rows(&self) -> Vec<Row<'_>> {
        let row = |zone: &Planned<'a>| {
            let square = |&[x, y]: &[f32; 2]| f64::from(x) * f64::from(x) + f64::from(y) * f64::from(y);
            let longest = zone.synth.field.jumps.cells().iter().map(square).fold(0.0, f64::max).sqrt();
            Row { position: &zone.model.position, tolerance: (UNSEEN_PX / longest).clamp(1e-9, 1e-4) }
        };
        self.zones.iter().map(row).collect()
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
    /// The largest error of a place or a jump vector so far.
    error_px: f64,
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
        self.error_px = note.channels.iter().filter_map(|channel| channel.error_px).fold(self.error_px, f64::max);
        Ok(note)
    }

    fn zone(&mut self, plan: &Plan, table: &Table, zone: &Planned, row: usize) -> Result<manifest::Zone> {
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
        let origin = piece.atlas_from_image() + zone.synth.source.offset;
        let origin = [field.x0 as f64 + 0.5 + origin.x, field.y0 as f64 + 0.5 + origin.y];
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
            knots: table.knots[row].clone(),
            origin,
            init,
            jump,
            thresholds,
        })
    }

    /// How the files of a zone begin: its name in plain letters, the layer's before it where there are several.
    fn stem(&self, plan: &Plan, zone: &Planned) -> String {
        let layer = (plan.layers.len() > 1).then_some(plan.layers[zone.layer].1);
        let stem = names::stem(layer, &zone.model.name);
        let taken: HashSet<String> = self.names.iter().map(|name| names::folded(name)).collect();
        let is_free =
            |stem: &String| !taken.contains(&names::folded(&format!("{stem}init.{}", self.depth.extension())));
        let numbered = (2..).map(|n| format!("{stem}{n}-"));
        std::iter::once(stem.clone()).chain(numbered).find(is_free).unwrap_or(stem)
    }

    fn colour(&mut self, atlas: &Atlas) -> Result<Colour> {
        let file = COLOUR.to_owned();
        let mut codes = crate::render::cpu::finish(&atlas.colors);
        atlas.keep_clear_colors(&mut codes);
        let bytes = still::frame(&codes).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        let float = self.float_colour(atlas)?;
        let note = |piece: &Piece| {
            let area = piece.need.area;
            let (width, height) = (area.width() as usize, area.height() as usize);
            let image = piece.need.image.clone();
            PieceNote { image, x: piece.x, y: piece.y, width, height, from: [area.x0, area.y0] }
        };
        let pieces = atlas.pieces.iter().map(note).collect();
        Ok(Colour { file, float, width: atlas.colors.width(), height: atlas.colors.height(), pieces })
    }

    /// The atlas in floats, where a picture holds light that 8 bits cannot: brighter than white, or negative.
    fn float_colour(&mut self, atlas: &Atlas) -> Result<Option<Light>> {
        let beyond = |&[r, g, b, a]: &[f32; 4]| [r, g, b].iter().any(|&c| c > a + 1e-6 || c < -1e-6);
        if !atlas.colors.cells().iter().any(beyond) {
            return Ok(None);
        }
        let file = LIGHT.to_owned();
        let bytes = data::exr(&atlas.colors).map_err(|e| Error::at(&file, e))?;
        self.put(file.clone(), &bytes)?;
        Ok(Some(Light { file }))
    }

    fn function(&mut self, table: &Table) -> Result<Function> {
        let texture = self.texture("function".into(), &table.texture())?;
        Ok(Function { texture, error_between: table.error_between() })
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
