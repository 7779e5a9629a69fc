//! Synthesis: from a picture layer and its materials to everything that a frame needs except the time. A pure function.

use std::ops::Range;
use std::sync::Arc;

use kurbo::Vec2;

use super::clock::Clock;
use super::field::{self, Field, Inputs, Made, Prepared};
use super::model::{PictureLayer, Sampler, Zone};
use crate::base::clip::Clip;
use crate::base::geometry::vector;
use crate::base::picture::Picture;
use crate::base::pixels::Beyond;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use crate::layers::ready::{self, Making, Ready};

/// Everything that a frame of a picture layer needs except the time.
#[derive(Clone, Debug)]
pub struct Synth {
    /// The layer's own picture.
    pub picture: Arc<Picture>,
    /// The zones that overlap the picture, in the layer's order.
    pub zones: Vec<ZoneSynth>,
}

/// One zone, ready to be shown at any time.
#[derive(Clone, Debug)]
pub struct ZoneSynth {
    /// The zone's name.
    pub name: String,
    /// Its index in the layer.
    pub index: usize,
    /// Jump vectors and thresholds of its pixels; shared with earlier syntheses while its inputs stay the same.
    pub field: Arc<Field>,
    /// What samplers read.
    pub source: Source,
    /// When they read it.
    pub clock: Clock,
    made: Made,
}

/// What the samplers of a zone read, and how it is blended with what is beneath.
#[derive(Clone, Debug)]
pub struct Source {
    /// The sampler image: the layer's own picture, a named one, a mask, or the first frame of a clip.
    pub picture: Arc<Picture>,
    /// The clip that it is the first frame of.
    pub clip: Option<Playing>,
    /// Added to where every sampler reads, in pixels.
    pub offset: Vec2,
    /// The result of a read beyond the edge.
    pub beyond: Beyond,
    /// Whether the read is drawn over what is beneath (a named image or a mask) or replaces it (the layer's own
    /// picture).
    pub over: bool,
}

/// A clip on the timeline of its scene.
#[derive(Clone, Debug)]
pub struct Playing {
    /// The clip; its frames are of one size.
    pub clip: Arc<Clip>,
    /// How long the timeline is, in seconds.
    pub duration: f64,
}

impl Playing {
    /// The number of the frame that is read at scene time `t`.
    pub fn frame_at(&self, t: f64) -> usize {
        self.clip.frame_at(t * self.duration)
    }
}

impl Source {
    /// What samplers read at scene time `t`.
    pub fn picture_at(&self, t: f64) -> &Arc<Picture> {
        let frame = self.clip.as_ref().and_then(|playing| playing.clip.frames.get(playing.frame_at(t)));
        frame.unwrap_or(&self.picture)
    }
}

/// Prepares a layer for rendering at any time. Fields of `previous` with equal inputs are reused.
///
/// # Errors
/// If a picture that the layer names is not among the materials, or the synthesis is cancelled; the problem's path is
/// relative to the layer.
pub fn synth(layer: &PictureLayer, making: &Making, previous: Option<&Synth>) -> Result<Synth, Problem> {
    let &Making { wrap, materials, place, .. } = making;
    let picture = materials.picture(&layer.image, "/image")?;
    let size = (picture.width(), picture.height());
    let before = |zone: &Zone| previous.filter(|_| !reads_file(zone)).map_or(&[][..], |previous| &previous.zones);
    let known = |zone: &Zone, inputs: &Inputs| before(zone).iter().find(|known| known.made.inputs == *inputs);
    let inputs: Vec<Inputs> = layer.zones.iter().map(|zone| Inputs::new(zone, size, place)).collect();
    let to_make = layer.zones.iter().zip(&inputs).filter(|(zone, inputs)| known(zone, inputs).is_none());
    materials.expect(to_make.map(|(zone, _)| field::pixels(zone, size)).sum());
    let mut zones = Vec::with_capacity(layer.zones.len());
    for (index, (zone, inputs)) in layer.zones.iter().zip(inputs).enumerate() {
        let source = source(layer, index, &picture, making)?;
        let made = match known(zone, &inputs) {
            Some(known) => Some(known.made.clone()),
            None => {
                let before = before(zone).iter().find(|known| known.name == zone.name).map(|known| &known.made);
                Made::new(&inputs, before, materials).map_err(|problem| problem.under(&format!("/zones/{index}")))?
            }
        };
        if materials.stopped() {
            return Err(Problem::error("", "stopped"));
        }
        let (name, clock) = (zone.name.clone(), zone.clock(wrap));
        zones.extend(made.map(|made| ZoneSynth { name, index, field: made.field.clone(), source, clock, made }));
    }
    Ok(Synth { picture, zones })
}

/// A layer whose parts can be prepared without the rest.
pub struct PreparedLayer {
    picture: Arc<Picture>,
    zones: Vec<(ZoneParts, Prepared)>,
}

/// A zone without its field.
struct ZoneParts {
    name: String,
    index: usize,
    source: Source,
    clock: Clock,
}

impl PreparedLayer {
    /// Prepares everything that the parts share.
    ///
    /// # Errors
    /// As [`synth`].
    pub fn new(layer: &PictureLayer, making: &Making) -> Result<Self, Problem> {
        let &Making { wrap, materials, place, .. } = making;
        let picture = materials.picture(&layer.image, "/image")?;
        let size = (picture.width(), picture.height());
        let ready = |(index, zone): (usize, &Zone)| {
            let source = source(layer, index, &picture, making)?;
            let inputs = Inputs::new(zone, size, place);
            let prepared = Prepared::new(&inputs, materials);
            let prepared = prepared.map_err(|problem| problem.under(&format!("/zones/{index}")))?;
            Ok((ZoneParts { name: zone.name.clone(), index, source, clock: zone.clock(wrap) }, prepared))
        };
        let zones = layer.zones.iter().enumerate().map(ready).collect::<Result<_, _>>()?;
        Ok(PreparedLayer { picture, zones })
    }
}

impl ready::Prepared for PreparedLayer {
    fn part(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        materials: &Materials,
    ) -> Result<Arc<dyn Ready>, Problem> {
        let within = |range: &Range<usize>, most: usize| range.start.min(most)..range.end.min(most);
        let (width, height) = (self.picture.width(), self.picture.height());
        let zones = self.zones.iter().map(|(zone, prepared)| {
            let made = prepared.field((within(&columns, width), within(&rows, height)), materials);
            let made = made.map_err(|problem| problem.under(&format!("/zones/{}", zone.index)))?;
            Ok(made.map(|made| ZoneSynth {
                name: zone.name.clone(),
                index: zone.index,
                field: made.field.clone(),
                source: zone.source.clone(),
                clock: zone.clock.clone(),
                made,
            }))
        });
        let zones = zones.filter_map(Result::transpose).collect::<Result<_, Problem>>()?;
        Ok(Arc::new(Synth { picture: self.picture.clone(), zones }))
    }
}

/// Whether the zone's field depends on more than its inputs, namely on the content of a file.
fn reads_file(zone: &Zone) -> bool {
    zone.motion.iter().any(|tool| tool.facts().file.is_some())
}

/// What the samplers of zone `index` read; `own` is the layer's picture.
///
/// # Errors
/// If a picture that the zone names is not among the materials; the problem's path is relative to the layer.
pub fn source(layer: &PictureLayer, index: usize, own: &Arc<Picture>, making: &Making) -> Result<Source, Problem> {
    let materials = making.materials;
    let own = Source { picture: own.clone(), clip: None, offset: Vec2::ZERO, beyond: Beyond::Clamp, over: false };
    let zone = &layer.zones[index];
    if let Some(image) = zone.fold.as_ref().and_then(|fold| fold.mask()) {
        let picture = materials.mask(image, &layer.image, &format!("/zones/{index}/fold/image"))?;
        return Ok(Source { picture, over: true, ..own });
    }
    let Some(Sampler { image, clip, offset }) = &zone.sampler else { return Ok(own) };
    let named = Source { offset: vector(*offset), beyond: Beyond::Transparent, over: true, ..own };
    let at = |field: &str| format!("/zones/{index}/sampler{field}");
    Ok(match (image, clip) {
        (Some(image), _) => Source { picture: materials.picture(image, &at("/image"))?, ..named },
        (None, Some(clip)) => {
            let clip = materials.clip(clip, &at("/clip"))?;
            let first =
                clip.frames.first().cloned().ok_or_else(|| Problem::error(at("/clip"), "the clip has no frames"))?;
            Source { picture: first, clip: Some(Playing { clip, duration: making.duration }), ..named }
        }
        (None, None) => return Err(Problem::error(at(""), "neither an image nor a clip is named")),
    })
}
