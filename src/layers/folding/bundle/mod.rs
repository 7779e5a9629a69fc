//! Layers that fold as textures for other engines (docs/folding.md, section 6): a color atlas, init and jump a zone, the
//! position functions, thresholds where paths need them, and what the manifest says about them.

use std::any::Any;

use serde_json::{Map, Value};

use super::atlas::{Area, Atlas, Need, Piece, reach};
use super::fold::Fold;
use super::model::{PictureLayer, Zone};
use super::synth::{Synth, ZoneSynth};
use crate::base::error::{Error, Result};
use crate::base::pixels::{Beyond, Grid};
use crate::base::problem::quoted;
use crate::layers::parts::bundle::{Channel, Form, Names, Sink, Texture};
use crate::layers::technique::{Bundled, Technique};

mod folds;
mod function;
mod manifest;

use function::{Row, Table};
use manifest::{CONVENTIONS, ColorNote, Function, Manifest, PieceNote, Slots, ThresholdsNote};

/// The color atlas.
const COLOR: &str = "colour";

/// The position functions.
const FUNCTION: &str = "function";

/// What the names of a zone's textures end in.
const ENDS: [&str; 3] = ["init", "jump", "thresholds"];

/// How far off a sampler may be because a position function is interpolated, in pixels: at the hardest edge that is half a
/// code.
const UNSEEN_PX: f64 = 5e-4;

/// How far beyond a crossing s must be to have passed it: a 32-bit float is that exact.
const TOLERANCE: f64 = 1e-6;

/// The names that the files of these layers may have.
pub fn names(layers: &[&dyn Technique]) -> Names {
    let several = layers.len() > 1;
    let items = layers
        .iter()
        .filter_map(|layer| model(*layer))
        .flat_map(|layer| layer.zones.iter().map(move |zone| (several.then(|| layer.name.clone()), zone.name.clone())));
    Names {
        pictures: vec![COLOR.into()],
        textures: vec![FUNCTION.into()],
        items: items.collect(),
        ends: ENDS.map(|end| (Form::Texture, end.to_owned())).to_vec(),
        bakes: false,
    }
}

/// Writes the textures of these layers, and gives what the manifest says about them.
///
/// # Errors
/// Those of `to`, or its codes cannot number the zones.
pub fn write(layers: &[Bundled], to: &mut dyn Sink) -> Result<Map<String, Value>> {
    still(layers)?;
    let plan = Plan::new(layers);
    plan.fits(to.largest_code())?;
    let rows = plan.rows();
    let table = Table::new(&rows, to.largest_code().is_none());
    let mut noted: Vec<manifest::Layer> = Vec::new();
    let all = plan.zones.len();
    for (row, planned) in plan.zones.iter().enumerate() {
        to.step(row as u64, all as u64)?;
        plan.layers_up_to(planned.layer, &mut noted);
        let note = zone(to, &plan, &table, planned, row)?;
        noted[planned.layer].zones.push(note);
    }
    plan.layers_up_to(layers.len().saturating_sub(1), &mut noted);
    let color = color(to, &plan.atlas)?;
    let texture = to.texture(FUNCTION, &table.texture())?;
    let function = Function { texture, error_between: table.error_between() };
    let manifest = Manifest { conventions: CONVENTIONS, color, function, layers: noted };
    match serde_json::to_value(manifest) {
        Ok(Value::Object(fields)) => Ok(fields),
        Ok(_) => Ok(Map::new()),
        Err(error) => Err(Error::at("manifest.json", error)),
    }
}

/// Refuses zones that read clips: an atlas holds pictures that do not change.
fn still(layers: &[Bundled]) -> Result<()> {
    for (layer, zone) in layers
        .iter()
        .filter_map(|layer| model(layer.layer))
        .flat_map(|layer| layer.zones.iter().map(move |zone| (layer, zone)))
    {
        if let Some(clip) = zone.clip() {
            let place = format!("layer {}, zone {}", quoted(&layer.name), quoted(&zone.name));
            let what = format!("reads the clip {}, and textures hold still pictures only", quoted(clip));
            return Err(Error::at(place, what).cure("let its sampler read the image of one frame, or render frames"));
        }
    }
    Ok(())
}

/// The layer of the document, which is one of this technique.
fn model(layer: &dyn Technique) -> Option<&PictureLayer> {
    (layer as &dyn Any).downcast_ref()
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
    fn new(layers: &[Bundled<'a>]) -> Self {
        let (mut needs, mut zones) = (Vec::new(), Vec::new());
        let mut layer_needs = Vec::new();
        let layers = layers.iter().filter_map(|layer| Some((model(layer.layer)?, layer.ready.downcast::<Synth>()?)));
        for (index, (model, layer)) in layers.enumerate() {
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

    /// Whether codes up to `largest` can number the zones in init A, where 0 means outside.
    fn fits(&self, largest: Option<u16>) -> Result<()> {
        match largest {
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
    let mask = zone.fold.as_ref().and_then(Fold::mask);
    let own = || zone.sampler.as_ref().and_then(|sampler| sampler.image.as_deref());
    mask.or_else(own).unwrap_or(&layer.image)
}

fn zone(to: &mut dyn Sink, plan: &Plan, table: &Table, zone: &Planned, row: usize) -> Result<manifest::Zone> {
    let field = &*zone.synth.field;
    let clock = &zone.synth.clock;
    let layer = (plan.layers.len() > 1).then_some(plan.layers[zone.layer].1);
    let stem = to.stem(layer, &zone.model.name, ENDS[0]);
    let piece = &plan.atlas.pieces[zone.piece];
    let size = (plan.atlas.colors.width() as f64, plan.atlas.colors.height() as f64);
    let init = to.texture(&format!("{stem}init"), &init(zone.synth, piece, size, (row, plan.zones.len())))?;
    let jump = to.texture(&format!("{stem}jump"), &jump(zone.synth, size))?;
    let range = clock.position.range();
    let thresholds = match folds::thresholds(field, range) {
        None => None,
        Some(found) => {
            let texture = to.texture(&format!("{stem}thresholds"), &found.texture)?;
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
        rule: zone.model.fold.as_ref().map_or("none", Fold::name),
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

fn color(to: &mut dyn Sink, atlas: &Atlas) -> Result<ColorNote> {
    let files = to.picture(COLOR, &atlas.colors, &|codes| atlas.keep_clear_colors(codes))?;
    let note = |piece: &Piece| {
        let area = piece.need.area;
        let (width, height) = (area.width() as usize, area.height() as usize);
        let image = piece.need.image.clone();
        PieceNote { image, x: piece.x, y: piece.y, width, height, from: [area.x0, area.y0] }
    };
    let pieces = atlas.pieces.iter().map(note).collect();
    Ok(ColorNote { files, width: atlas.colors.width(), height: atlas.colors.height(), pieces })
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
