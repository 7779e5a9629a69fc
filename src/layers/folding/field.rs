//! The pixels of a zone: membership and jump vectors, band by band on all cores, then thresholds. Each pixel's sums are always
//! made in the same order, so that the bytes do not depend on the number of threads.

use std::ops::Range;
use std::sync::Arc;

use kurbo::{Point, Rect, Vec2};
use rayon::prelude::*;

use super::anchor::Anchor;
use super::anchors::{Dense, anchors, dense};
use super::changed::Changed;
use super::fold::Fold;
use super::inside::{pixel_box, spans};
use super::interpolation::Cell;
use super::interpolation::area::{Area, Stretch};
use super::interpolation::{Interpolation, Interpolator};
use super::model::Zone;
use super::outline::Outline;
use super::regions::Crossings;
use super::thresholds::{Folding, Folds, Paths};
use super::tools::Tool;
use crate::base::budget::Share;
use crate::base::geometry::Polygon;
use crate::base::maths::smoothstep;
use crate::base::pixels::Grid;
use crate::base::problem::Problem;
use crate::base::simd::vectorised;
use crate::layers::parts::materials::Materials;

/// The pixels of a zone: membership, jump vectors, thresholds. Covers the outline's bounding box within the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Column of the box's first pixel in the picture.
    pub x0: usize,
    /// Row of the box's first pixel in the picture.
    pub y0: usize,
    /// Which pixels of the box belong to the zone.
    pub inside: Arc<Grid<bool>>,
    /// Jump vectors in pixels; zero outside the zone.
    pub jumps: Arc<Grid<[f32; 2]>>,
    /// Where paths meet the fold regions; `None` without regions.
    pub folds: Option<Folds>,
}

/// Everything that a field depends on; equal inputs make equal fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Inputs {
    moves: Moves,
    fold: Option<Fold>,
    /// The smallest and largest s for which crossings are wanted.
    range: (f64, f64),
}

/// What membership and jump vectors depend on.
#[derive(Clone, Debug, PartialEq)]
struct Moves {
    outline: Outline,
    motion: Vec<Tool>,
    interpolation: Interpolation,
    feather: f64,
    /// Width and height of the layer's picture.
    size: (usize, usize),
    /// The place in each pixel that is evaluated, from its top-left corner.
    place: Vec2,
}

impl Inputs {
    /// The inputs of the field of `zone`, on a picture of `size`, for a `place` in each pixel; (0.5, 0.5) is the
    /// center.
    pub fn new(zone: &Zone, size: (usize, usize), place: Vec2) -> Self {
        // Every field is named: a new one has to be placed, here or among those that a field does not depend on.
        let Zone { outline, motion, interpolation, feather, fold, position, name: _, sampler: _, speed: _, shift: _ } =
            zone;
        let (low, high) = position.range();
        let (outline, motion, interpolation) = (outline.clone(), motion.clone(), interpolation.clone());
        Inputs {
            moves: Moves { outline, motion, interpolation, feather: *feather, size, place },
            fold: fold.clone().filter(|fold| fold.rule().is_some()),
            range: (low.min(0.0), high.max(1.0)),
        }
    }

    fn folding(&self) -> Option<Folding> {
        self.fold.as_ref().and_then(|fold| Folding::new(fold, self.range, self.moves.place))
    }
}

/// A field, what it was made from, and the memory that it takes.
#[derive(Clone, Debug)]
pub struct Made {
    /// The field.
    pub field: Arc<Field>,
    /// What it was made from.
    pub inputs: Inputs,
    /// The memory of membership and jump vectors, and that of thresholds, counted until their last owners drop them.
    shares: [Arc<Share>; 2],
}

impl Made {
    /// The field of these inputs, with what is the same as `before`; `None` if no pixel of the picture is in its bounding
    /// box.
    ///
    /// # Errors
    /// If it needs too much memory or is cancelled; the problem's path is relative to the zone.
    pub fn new(inputs: &Inputs, before: Option<&Made>, materials: &Materials) -> Result<Option<Self>, Problem> {
        if let Some(before) = before.filter(|before| before.inputs.moves == inputs.moves) {
            let Made { field, shares: [share, _], .. } = before;
            materials.made(field.inside.cells().len() as u64);
            let (inside, jumps, share) = (field.inside.clone(), field.jumps.clone(), share.clone());
            let moved = Moved { corner: [field.x0, field.y0], inside, jumps, share };
            return moved.fold(inputs, inputs.folding().as_ref(), materials).map(Some);
        }
        let prepared = Prepared::new(inputs, materials)?;
        let changed = before.and_then(|before| prepared.changed(before, materials));
        let (width, height) = inputs.moves.size;
        prepared.part((0..width, 0..height), changed, materials)
    }
}

fn paths<'a>(corner: [usize; 2], inside: &'a Grid<bool>, jumps: &'a Grid<[f32; 2]>) -> Paths<'a> {
    let size = [inside.width(), inside.height()];
    let area = Area { from: corner.map(|k| k as u32), to: [0, 1].map(|k| (corner[k] + size[k]) as u32) };
    Paths { area, inside: inside.cells(), jumps: jumps.cells() }
}

/// A field without thresholds.
struct Moved {
    corner: [usize; 2],
    inside: Arc<Grid<bool>>,
    jumps: Arc<Grid<[f32; 2]>>,
    share: Arc<Share>,
}

impl Moved {
    /// Adds where paths meet the fold regions.
    fn fold(self, inputs: &Inputs, folding: Option<&Folding>, materials: &Materials) -> Result<Made, Problem> {
        let Moved { corner, inside, jumps, share } = self;
        let paths = paths(corner, &inside, &jumps);
        let folds = folding.map(|folding| folding.folds(&paths, &|| materials.stopped()).ok_or_else(stopped));
        let folds = folds.transpose()?;
        let of_folds = take(materials, folds.as_ref().map_or(0, Folds::bytes))?;
        let field = Arc::new(Field { x0: corner[0], y0: corner[1], inside, jumps, folds });
        Ok(Made { field, inputs: inputs.clone(), shares: [share, Arc::new(of_folds)] })
    }
}

/// How many pixels the field of `zone` has.
pub fn pixels(zone: &Zone, (width, height): (usize, usize)) -> u64 {
    let held = pixel_box(zone.outline.polygon().bounds(), (0..width, 0..height));
    held.map_or(0, |(_, _, width, height)| width as u64 * height as u64)
}

/// A zone prepared for evaluating any of its pixels.
pub struct Prepared {
    inputs: Inputs,
    outline: Polygon,
    anchors: Vec<Anchor>,
    interpolator: Interpolator,
    dense: Vec<Dense>,
    folding: Option<Folding>,
}

/// One pixel of a zone.
#[derive(Clone, Debug, Default)]
pub struct Pixel {
    /// Whether it belongs to the zone; if not, nothing else is computed.
    pub inside: bool,
    /// Jump vector in pixels.
    pub jump: [f32; 2],
    /// Where its path meets the fold regions.
    pub crossings: Crossings,
}

impl Prepared {
    /// Prepares a zone: anchors, the equations of its interpolation, outlines as polygons.
    ///
    /// # Errors
    /// As [`Interpolator::new`].
    pub fn new(inputs: &Inputs, materials: &Materials) -> Result<Self, Problem> {
        // From the inputs alone: what else it read could change without the field being made anew.
        let Moves { outline, motion, interpolation, feather: _, size, place } = &inputs.moves;
        let size = [size.0 as u32, size.1 as u32];
        let anchors = anchors(motion, outline);
        Ok(Prepared {
            outline: outline.polygon(),
            interpolator: Interpolator::new(interpolation, &anchors, size, *place, materials)?,
            anchors,
            dense: dense(motion, materials),
            folding: inputs.folding(),
            inputs: inputs.clone(),
        })
    }

    /// The pixel in column `x`, row `y`.
    pub fn pixel(&self, x: usize, y: usize) -> Pixel {
        let from = [x as u32, y as u32];
        let area = Area { from, to: from.map(|first| first + 1) };
        let mut inside = [false];
        spans(&self.outline, &area, self.inputs.moves.place, &mut inside);
        if !inside[0] {
            return Pixel::default();
        }
        let mut jump = [0.0; 2];
        for cell in &self.interpolator.cells(&area, &|_| true, &|| false).unwrap_or_default() {
            self.interpolator.fill(cell, &area, &|_| true, &mut |mut stretch| {
                self.move_densely(&mut stretch, &inside);
                jump = [stretch.x[0] as f32, stretch.y[0] as f32];
            });
        }
        let crossings = self.folding.as_ref().map(|folding| folding.crossings(from, jump));
        Pixel { inside: true, jump, crossings: crossings.unwrap_or_default() }
    }

    /// Adds dense fields to interpolated jump vectors, and weakens both by the feather.
    fn move_densely(&self, stretch: &mut Stretch, inside: &[bool]) {
        if self.dense.is_empty() && self.inputs.moves.feather <= 0.0 {
            return;
        }
        let feather = self.feather_of(Rect::from_points(self.q(stretch, 0), self.q(stretch, inside.len() - 1)));
        for k in (0..inside.len()).filter(|k| inside[*k]) {
            let q = self.q(stretch, k);
            let interpolated = Vec2::new(stretch.x[k], stretch.y[k]);
            let jump = self.dense.iter().fold(interpolated, |sum, dense| sum + dense.at(q)) * feather(q);
            (stretch.x[k], stretch.y[k]) = (jump.x, jump.y);
        }
    }

    /// The place that is evaluated in pixel `k` of a stretch.
    fn q(&self, stretch: &Stretch, k: usize) -> Point {
        let [x, y] = stretch.pixel.map(f64::from);
        Point::new(x + k as f64 + self.inputs.moves.place.x, y + self.inputs.moves.place.y)
    }

    /// The feather weight within `bounds`: only the outline's sides near it are looked at.
    fn feather_of(&self, bounds: Rect) -> impl Fn(Point) -> f64 {
        let near = bounds.inflate(self.inputs.moves.feather, self.inputs.moves.feather);
        let sides = if self.inputs.moves.feather > 0.0 { self.outline.parts_near(near) } else { Vec::new() };
        let weight = |distance| smoothstep(0.0, self.inputs.moves.feather, distance);
        move |q| if sides.is_empty() { 1.0 } else { weight(self.outline.distance_to(&sides, q)) }
    }
}

impl Prepared {
    /// Where jump vectors may differ from those of a field that was made before; `None` if anywhere.
    fn changed<'a>(&self, before: &'a Made, materials: &Materials) -> Option<Changed<'a>> {
        // Outline and motion are looked at below.
        let (Moves { outline, motion, .. }, then) = (&self.inputs.moves, &before.inputs.moves);
        let alike = Moves { outline: outline.clone(), motion: motion.clone(), ..then.clone() } == self.inputs.moves;
        let is_feathered_alike = then.feather <= 0.0 || then.outline == *outline;
        if !(alike && is_feathered_alike && dense(&then.motion, materials) == self.dense) {
            return None;
        }
        let anchors = then.interpolation.changed(&anchors(&then.motion, &then.outline), &self.anchors)?;
        let Field { x0, y0, inside, jumps, .. } = &*before.field;
        Some(Changed::new(paths([*x0, *y0], inside, jumps), anchors))
    }

    /// The field in these columns and rows of the picture only; `None` and errors as for [`Made::new`].
    pub fn field(&self, part: (Range<usize>, Range<usize>), materials: &Materials) -> Result<Option<Made>, Problem> {
        self.part(part, None, materials)
    }

    fn part(
        &self,
        part: (Range<usize>, Range<usize>),
        mut changed: Option<Changed>,
        materials: &Materials,
    ) -> Result<Option<Made>, Problem> {
        let Some((x0, y0, width, height)) = pixel_box(self.outline.bounds(), part) else { return Ok(None) };
        let from = [x0 as u32, y0 as u32];
        let area = Area { from, to: [from[0] + width as u32, from[1] + height as u32] };
        let count = width * height;
        let share = take(materials, (count * (size_of::<[f32; 2]>() + size_of::<bool>())) as u64)?;
        let mut inside = vec![false; count];
        spans(&self.outline, &area, self.inputs.moves.place, &mut inside);
        let taken_over = changed.as_mut().map(|changed| changed.take_over(&area, &inside));
        let mut jumps = taken_over.unwrap_or_else(|| vec![[0.0; 2]; count]);
        let changed = changed.as_ref();
        let touched = |part: &Area| changed.is_none_or(|changed| changed.touches(part));
        let cells = self.interpolator.cells(&area, &touched, &|| materials.stopped()).ok_or_else(stopped)?;
        let _of_cells = take(materials, cells.iter().map(Cell::bytes).sum())?;
        materials.made(count as u64 - cells.iter().map(|cell| pixels_of(cell, &area)).sum::<u64>());
        let bands = bands(&cells, &area, &inside, &mut jumps);
        let make = |band| self.make(band, changed, materials);
        bands.into_par_iter().map(make).collect::<Option<()>>().ok_or_else(stopped)?;
        let inside = Arc::new(Grid::from_cells(width, height, inside));
        let jumps = Arc::new(Grid::from_cells(width, height, jumps));
        let moved = Moved { corner: [x0, y0], inside, jumps, share: Arc::new(share) };
        moved.fold(&self.inputs, self.folding.as_ref(), materials).map(Some)
    }

    /// Makes what has changed of a band, or all of it; `None` if stopped.
    fn make(&self, band: Band, changed: Option<&Changed>, materials: &Materials) -> Option<()> {
        let Band { area, cells, inside, jumps } = band;
        if changed.is_none() {
            // Now in order: cells are far from each other in memory that was never used.
            jumps.fill([0.0; 2]);
        }
        let width = (area.to[0] - area.from[0]) as usize;
        let at = |[x, y]: [u32; 2]| (y - area.from[1]) as usize * width + (x - area.from[0]) as usize;
        let wanted = |part: &Area| {
            let columns = (part.to[0] - part.from[0]) as usize;
            let any = |y: u32| inside[at([part.from[0], y])..][..columns].contains(&true);
            changed.is_none_or(|changed| changed.touches(part)) && (part.from[1]..part.to[1]).any(any)
        };
        for cell in cells {
            if materials.stopped() {
                return None;
            }
            self.interpolator.fill(cell, &area, &wanted, &mut |mut stretch| {
                let first = at(stretch.pixel);
                let inside = &inside[first..first + stretch.x.len()];
                self.move_densely(&mut stretch, inside);
                let jumps = &mut jumps[first..first + inside.len()];
                vectorised(
                    #[inline(always)]
                    || narrow(&stretch, inside, jumps),
                );
            });
            materials.made(pixels_of(cell, &area));
        }
        Some(())
    }
}

/// How many pixels of `area` are in a cell.
fn pixels_of(cell: &Cell, area: &Area) -> u64 {
    cell.area().and(area).map_or(0, |part| part.count())
}

fn stopped() -> Problem {
    Problem::error("", "stopped")
}

fn take(materials: &Materials, bytes: u64) -> Result<Share, Problem> {
    materials.budget.try_take(bytes).map_err(|short| short.problem(""))
}

/// Jump vectors in single precision, those outside the zone 0.
#[inline(always)]
fn narrow(stretch: &Stretch, inside: &[bool], jumps: &mut [[f32; 2]]) {
    for (jump, (x, y)) in jumps.iter_mut().zip(stretch.x.iter().zip(&*stretch.y)) {
        *jump = [*x as f32, *y as f32];
    }
    if inside.contains(&false) {
        jumps.iter_mut().zip(inside).filter(|(_, inside)| !**inside).for_each(|(jump, _)| *jump = [0.0; 2]);
    }
}

/// Neighboring rows of a field, and the cells that they lie in.
struct Band<'a> {
    area: Area,
    cells: &'a [Cell],
    inside: &'a [bool],
    jumps: &'a mut [[f32; 2]],
}

/// The bands of a field, without rows that are in no cell: of each row of cells one.
fn bands<'a>(cells: &'a [Cell], area: &Area, mut inside: &'a [bool], mut jumps: &'a mut [[f32; 2]]) -> Vec<Band<'a>> {
    let (mut bands, mut y, width) = (Vec::new(), area.from[1], (area.to[0] - area.from[0]) as usize);
    for cells in cells.chunk_by(|a, b| a.area().from[1] == b.area().from[1]) {
        let rows = cells[0].area();
        let from = [area.from[0], rows.from[1].max(area.from[1])];
        let band = Area { from, to: [area.to[0], rows.to[1].min(area.to[1])] };
        let (skipped, count) = ((from[1] - y) as usize * width, band.count() as usize);
        let (own, rest) = std::mem::take(&mut jumps)[skipped..].split_at_mut(count);
        bands.push(Band { area: band, cells, inside: &inside[skipped..][..count], jumps: own });
        (inside, jumps, y) = (&inside[skipped + count..], rest, band.to[1]);
    }
    bands
}
