//! A waterfall layer ready for any time.

use std::ops::Range;
use std::sync::Arc;

use kurbo::Vec2;

use super::automatic::Values;
use super::births::Births;
use super::check::{crowd, with_sources};
use super::hash::Random;
use super::lines::{Line, lines};
use super::model::{Between, Mixing, WaterfallLayer};
use super::noise::Noise;
use super::sprites::cut::{Sources, pictures};
use super::sprites::model::{Sheet, Shows, Sprites};
use super::sprites::residue::Residues;
use super::sprites::{KeyPlace, Pictures, bytes_of};
use crate::base::budget::Share;
use crate::base::problem::Problem;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::Moment;
use crate::layers::ready::Making;

/// A layer with its lines and pictures.
#[derive(Clone, Debug)]
pub struct Synth {
    /// Everything that can be set.
    pub values: Values,
    /// Its random numbers.
    pub random: Random,
    /// All lines, by number.
    pub lines: Arc<Vec<Line>>,
    /// The births on a line of water, and on one of foam.
    pub births: [Births; 2],
    /// How clumps leave the lip.
    pub noise: Noise,
    /// How sprites change.
    pub between: Between,
    /// How sprites cover one another.
    pub blend: Mixing,
    /// What they show.
    pub pictures: Arc<Pictures>,
    /// The residues, by track and interval.
    pub residues: Arc<Residues>,
    /// The keys of all tracks of water, and of foam.
    pub keys: [Vec<KeyPlace>; 2],
    /// Where among them the keys of each track are.
    pub tracks: [Vec<Range<usize>>; 2],
    /// How many residues each track has.
    pub intervals: usize,
    /// Keys of a shuffled sprite.
    pub shuffled: usize,
    /// The place in each pixel that is looked at.
    pub place: Vec2,
    /// Whether it stands still as it is at the beginning.
    pub still: bool,
    /// What the pictures were made of.
    pub made_of: (Sprites, Sources),
    /// The memory that they take.
    pub share: Arc<Share>,
}

impl Synth {
    /// A layer made ready; pictures of `previous` are kept if they are the same.
    ///
    /// # Errors
    /// If something that the layer names is not there, nothing moves in its clip, or memory is short; the problem's path
    /// is relative to the layer.
    pub fn new(layer: &WaterfallLayer, making: &Making, previous: Option<&Synth>) -> Result<Synth, Problem> {
        let values = Values::of(layer);
        let random = Random(layer.seed);
        let period = period(layer, making);
        let made_of = (Sprites::clone(&layer.sprites), sources(layer, making.materials)?);
        let kept = previous.filter(|before| before.made_of.0 == made_of.0 && before.made_of.1.is(&made_of.1));
        let (pictures, share) = match kept {
            Some(before) => (before.pictures.clone(), before.share.clone()),
            // Where sprites are does not depend on what they show.
            None if !making.painted => (Arc::new(Pictures::blank(layer.sprites.size)), Arc::default()),
            None => cut(layer, &made_of, making)?,
        };
        let [(water, of_water), (foam, of_foam)] = [false, true].map(|foam| keys(&pictures, foam));
        let shuffled = layer.sprites.keys as usize;
        let longest = pictures.tracks.iter().map(|track| track.keys.len()).max().unwrap_or(0).max(shuffled);
        let intervals = if layer.between.noise > 0.0 { longest.saturating_sub(1) } else { 0 };
        let residues = match kept.filter(|before| (before.random, before.intervals) == (random, intervals)) {
            Some(before) => before.residues.clone(),
            None => Arc::new(pictures.residues(random, intervals)),
        };
        let surge = &values.surge;
        let lines = lines(&values, &layer.foam, random);
        let births = [0, 1].map(|kind| Births::new(values.kinds[kind].rate, period));
        if let Some(problem) = crowd(&lines, &births) {
            return Err(problem);
        }
        Ok(Synth {
            random,
            lines: Arc::new(lines),
            births,
            noise: Noise::new(random, [surge.width, surge.time], period),
            between: layer.between.clone(),
            blend: layer.blend,
            residues,
            pictures,
            keys: [water, foam],
            tracks: [of_water, of_foam],
            shuffled,
            intervals,
            place: making.place,
            still: false,
            made_of,
            share,
            values,
        })
    }

    /// The simulated time, in seconds.
    pub fn now(&self, moment: &Moment) -> f64 {
        if self.still { 0.0 } else { moment.t * self.noise.period }
    }
}

/// All keys that sprites of a kind show, and where among them those of each track are.
fn keys(pictures: &Pictures, foam: bool) -> (Vec<KeyPlace>, Vec<Range<usize>>) {
    let (mut keys, mut tracks) = (Vec::new(), Vec::new());
    for track in pictures.of(foam) {
        let first = keys.len();
        keys.extend((0..pictures.tracks[track].keys.len()).map(|key| (track, key)));
        tracks.push(first..keys.len());
    }
    (keys, tracks)
}

/// After how many simulated seconds the layer repeats. A timeline of no length has a single frame; it shows the beginning
/// of a second.
pub fn period(layer: &WaterfallLayer, making: &Making) -> f64 {
    layer.speed * if making.duration > 0.0 { making.duration } else { 1.0 }
}

/// The clip and the images of a layer.
///
/// # Errors
/// If one of them is not there.
pub fn sources(layer: &WaterfallLayer, materials: &Materials) -> Result<Sources, Problem> {
    let clip = layer.clip.as_ref().map(|name| materials.clip(name, "/clip")).transpose()?;
    let sheets = layer.sprites.sheets.iter().enumerate();
    let image = |(i, sheet): (usize, &Sheet)| materials.picture(&sheet.image, &format!("/sprites/sheets/{i}/image"));
    Ok(Sources { clip, sheets: sheets.map(image).collect::<Result<_, _>>()? })
}

fn cut(
    layer: &WaterfallLayer,
    (sprites, sources): &(Sprites, Sources),
    making: &Making,
) -> Result<(Arc<Pictures>, Arc<Share>), Problem> {
    if let Some(problem) = with_sources(layer, sources).into_iter().next() {
        return Err(problem);
    }
    let share = making.materials.budget.try_take(bytes_of(sprites)).map_err(|short| short.problem("/sprites"))?;
    let pictures = pictures(sprites, sources);
    if making.materials.stopped() {
        return Err(Problem::error("", "stopped"));
    }
    if !pictures.tracks.iter().any(|track| track.kind == Shows::Water) {
        let clip = layer.clip.as_deref().unwrap_or_default();
        let message = format!("nothing moves in the clip \"{clip}\": pick sprites by hand (sprites.picks)");
        return Err(Problem::error("/clip", message));
    }
    Ok((Arc::new(pictures), Arc::new(share)))
}
