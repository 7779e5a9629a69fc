//! The pixels of a zone: membership, jump vectors and thresholds, band by band on all cores. Each pixel's sums are always
//! made in the same order, so that the bytes do not depend on the number of threads.

use std::ops::Range;
use std::sync::Arc;

use kurbo::{Point, Rect, Vec2};
use rayon::prelude::*;

use super::anchors::{Dense, anchors, dense};
use super::fold::{Fold, Rule};
use super::interpolation::Cell;
use super::interpolation::area::{Area, Stretch};
use super::interpolation::{Interpolation, Interpolator};
use super::model::Zone;
use super::outline::Outline;
use super::regions::{Crossings, Regions};
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
    pub inside: Grid<bool>,
    /// Jump vectors in pixels; zero outside the zone.
    pub jumps: Grid<[f32; 2]>,
    /// Where paths meet the fold regions; `None` without regions.
    pub folds: Option<Folds>,
}

/// Where the paths of a zone's pixels meet the fold regions, over the whole range of s of the position function.
#[derive(Clone, Debug, PartialEq)]
pub struct Folds {
    /// The rule of the regions.
    pub rule: Rule,
    /// Whether each pixel of the box is itself in a region (s = 0).
    pub inside: Grid<bool>,
    /// Each pixel's crossings with s >= 0, ascending.
    pub ahead: Ragged,
    /// Each pixel's crossings with s <= 0, descending.
    pub behind: Ragged,
}

/// A list of numbers for every pixel of a box, row by row: pixel i has `values[starts[i]..starts[i + 1]]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ragged {
    /// Where each pixel's numbers begin, and where the last one's end: one entry more than there are pixels.
    pub starts: Vec<u32>,
    /// The numbers.
    pub values: Vec<f64>,
}

impl Ragged {
    /// The numbers of pixel `i`.
    pub fn of(&self, i: usize) -> &[f64] {
        &self.values[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// The lists of `pixels` pixels, from those that are not empty, in order.
    fn of_lists<'a>(pixels: usize, lists: impl Iterator<Item = (usize, &'a [f64])>) -> Self {
        let mut ragged = Ragged { starts: Vec::with_capacity(pixels + 1), values: Vec::new() };
        for (pixel, list) in lists {
            ragged.starts.resize(pixel + 1, ragged.values.len() as u32);
            ragged.values.extend_from_slice(list);
        }
        ragged.starts.resize(pixels + 1, ragged.values.len() as u32);
        ragged
    }

    fn bytes(&self) -> u64 {
        (size_of_val(&self.starts[..]) + size_of_val(&self.values[..])) as u64
    }

    /// The concatenation of several.
    fn concat<'a>(parts: impl Iterator<Item = &'a Ragged>) -> Self {
        let mut all = Ragged { starts: vec![0], values: Vec::new() };
        for part in parts {
            let before = all.values.len() as u32;
            all.values.extend_from_slice(&part.values);
            all.starts.extend(part.starts[1..].iter().map(|start| before + start));
        }
        all
    }
}

impl Folds {
    /// Whether pixel `i` of the box lies in a fold region or its path meets one.
    pub fn meets(&self, i: usize) -> bool {
        self.inside.cells()[i] || !self.ahead.of(i).is_empty()
    }

    /// The effective place e(s) of pixel `i` of the box; `None` if it is still.
    pub fn effective(&self, i: usize, s: f64) -> Option<f64> {
        let crossings = if s < 0.0 { self.behind.of(i) } else { self.ahead.of(i) };
        self.rule.effective(self.inside.cells()[i], crossings, s)
    }
}

/// How many neighboring pixels share one search for the sides of regions.
const FEW: usize = 16;

/// Everything that a field depends on; equal inputs make equal fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Inputs {
    outline: Outline,
    motion: Vec<Tool>,
    interpolation: Interpolation,
    feather: f64,
    fold: Option<Fold>,
    /// The smallest and largest s for which crossings are wanted.
    range: (f64, f64),
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
        Inputs {
            outline: outline.clone(),
            motion: motion.clone(),
            interpolation: interpolation.clone(),
            feather: *feather,
            fold: fold.clone().filter(|fold| fold.rule().is_some()),
            range: (low.min(0.0), high.max(1.0)),
            size,
            place,
        }
    }
}

/// How many pixels the field of `zone` has.
pub fn pixels(zone: &Zone, (width, height): (usize, usize)) -> u64 {
    let held = pixel_box(zone.outline.polygon().bounds(), (0..width, 0..height));
    held.map_or(0, |(_, _, width, height)| width as u64 * height as u64)
}

/// A zone prepared for evaluating any of its pixels.
pub struct Prepared {
    outline: Polygon,
    interpolator: Interpolator,
    dense: Vec<Dense>,
    feather: f64,
    fold: Option<(Rule, Regions)>,
    range: (f64, f64),
    place: Vec2,
}

/// One pixel of a zone, in double precision.
#[derive(Clone, Debug, Default)]
pub struct Pixel {
    /// Whether it belongs to the zone; if not, nothing else is computed.
    pub inside: bool,
    /// Jump vector in pixels.
    pub jump: Vec2,
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
        let Inputs { outline, motion, interpolation, feather, fold, range, size, place } = inputs;
        let size = [size.0 as u32, size.1 as u32];
        let anchors = anchors(motion, outline);
        Ok(Prepared {
            outline: outline.polygon(),
            interpolator: Interpolator::new(interpolation, &anchors, size, *place, materials)?,
            dense: dense(motion, materials),
            feather: *feather,
            fold: fold.as_ref().and_then(|fold| Some((fold.rule()?, Regions::new(fold.regions())))),
            range: *range,
            place: *place,
        })
    }

    /// The pixel in column `x`, row `y`.
    pub fn pixel(&self, x: usize, y: usize) -> Pixel {
        let from = [x as u32, y as u32];
        let area = Area { from, to: from.map(|first| first + 1) };
        let mut inside = [false];
        spans(&self.outline, &area, self.place, &mut inside);
        let mut pixel = Pixel { inside: inside[0], ..Pixel::default() };
        let cells = self.interpolator.cells(&area, &|| false).unwrap_or_default();
        for cell in cells.iter().filter(|_| inside[0]) {
            self.interpolator.fill(cell, &area, &|_| true, &mut |mut stretch| {
                self.move_densely(&mut stretch, &inside);
                pixel.jump = Vec2::new(stretch.x[0], stretch.y[0]);
                self.cross(&stretch, &inside, &mut |_, crossings| pixel.crossings = crossings);
            });
        }
        if let Some((_, regions)) = &self.fold {
            let q = Point::new(x as f64 + self.place.x, y as f64 + self.place.y);
            pixel.crossings.inside = regions.memberships(q, 1).iter().any(|member| member[0]);
        }
        pixel
    }

    /// Adds dense fields to interpolated jump vectors, and weakens both by the feather.
    fn move_densely(&self, stretch: &mut Stretch, inside: &[bool]) {
        if self.dense.is_empty() && self.feather <= 0.0 {
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
        Point::new(x + k as f64 + self.place.x, y + self.place.y)
    }

    /// Tells the crossings of pixels of a stretch that have any. Most stretches are far from all regions; of others few
    /// neighbors at a time: only the sides within reach of their paths are looked at.
    fn cross(&self, stretch: &Stretch, inside: &[bool], tell: &mut dyn FnMut(usize, Crossings)) {
        let Some((_, regions)) = &self.fold else { return };
        if inside.is_empty() || regions.sides_within(self.reach(stretch, 0..inside.len())).is_empty() {
            return;
        }
        for first in (0..inside.len()).step_by(FEW) {
            let few = first..inside.len().min(first + FEW);
            let sides = regions.sides_within(self.reach(stretch, few.clone()));
            if sides.is_empty() {
                continue;
            }
            let members = regions.memberships(self.q(stretch, first), FEW);
            let mut member = vec![false; regions.count()];
            for k in few.filter(|k| inside[*k]) {
                member.iter_mut().zip(&members).for_each(|(one, of_region)| *one = of_region[k - first]);
                let jump = Vec2::new(stretch.x[k], stretch.y[k]);
                let crossings = regions.crossings(self.q(stretch, k), jump, self.range, &sides, &member);
                if !(crossings.ahead.is_empty() && crossings.behind.is_empty()) {
                    tell(k, crossings);
                }
            }
        }
    }

    /// A box around the paths of pixels of a stretch, at least one.
    fn reach(&self, stretch: &Stretch, pixels: Range<usize>) -> Rect {
        let (low, high) = self.range;
        let along = |jumps: &[f64]| {
            let [least, most] = vectorised(
                #[inline(always)]
                || extremes(&jumps[pixels.clone()]),
            );
            [(least * high).min(most * low), (most * high).max(least * low)]
        };
        let ([left, right], [up, down]) = (along(stretch.x), along(stretch.y));
        let (first, last) = (self.q(stretch, pixels.start), self.q(stretch, pixels.end - 1));
        Rect::new(first.x + left, first.y + up, last.x + right, last.y + down)
    }

    /// The feather weight within `bounds`: only the outline's sides near it are looked at.
    fn feather_of(&self, bounds: Rect) -> impl Fn(Point) -> f64 {
        let near = bounds.inflate(self.feather, self.feather);
        let sides = if self.feather > 0.0 { self.outline.parts_near(near) } else { Vec::new() };
        let weight = |distance| smoothstep(0.0, self.feather, distance);
        move |q| if sides.is_empty() { 1.0 } else { weight(self.outline.distance_to(&sides, q)) }
    }
}

impl Field {
    /// The field of these inputs; `None` if no pixel of the picture is in its bounding box.
    ///
    /// # Errors
    /// If it needs too much memory or is cancelled; the problem's path is relative to the zone.
    pub fn new(inputs: &Inputs, materials: &Materials) -> Made {
        let (width, height) = inputs.size;
        Prepared::new(inputs, materials)?.field((0..width, 0..height), materials)
    }
}

/// A field and the memory that it takes, if there is one.
pub type Made = Result<Option<(Arc<Field>, Share)>, Problem>;

impl Prepared {
    /// The field in these columns and rows of the picture only; `None` and errors as for [`Field::new`].
    pub fn field(&self, part: (Range<usize>, Range<usize>), materials: &Materials) -> Made {
        let Some((x0, y0, width, height)) = pixel_box(self.outline.bounds(), part) else { return Ok(None) };
        let from = [x0 as u32, y0 as u32];
        let area = Area { from, to: [from[0] + width as u32, from[1] + height as u32] };
        let take = |bytes| materials.budget.try_take(bytes).map_err(|short| short.problem(""));
        let stopped = || Problem::error("", "stopped");
        let count = width * height;
        let (regions, one) = if self.fold.is_some() { (count, 2 * size_of::<u32>() + 1) } else { (0, 0) };
        let mut share = take((count * (size_of::<[f32; 2]>() + 1 + one)) as u64)?;
        let cells = self.interpolator.cells(&area, &|| materials.stopped()).ok_or_else(stopped)?;
        let _of_cells = take(cells.iter().map(Cell::bytes).sum())?;
        let (mut inside, mut jumps) = (vec![false; count], vec![[0.0; 2]; count]);
        let mut in_region = vec![false; regions];
        let bands = bands(&cells, &area, (&mut inside, &mut jumps, &mut in_region));
        let made = bands.into_par_iter().map(|band| {
            let folds = self.make(band, materials).ok_or_else(stopped)?;
            // The bands' and the whole field's are both in memory for a moment.
            let share = take(2 * folds.iter().map(Ragged::bytes).sum::<u64>())?;
            Ok((folds, share))
        });
        let made = made.collect::<Result<Vec<_>, Problem>>()?;
        let (folds, shares): (Vec<[Ragged; 2]>, Vec<Share>) = made.into_iter().unzip();
        let folds = self.fold.as_ref().map(|(rule, _)| Folds {
            rule: *rule,
            inside: Grid::from_cells(width, height, in_region),
            ahead: Ragged::concat(folds.iter().map(|[ahead, _]| ahead)),
            behind: Ragged::concat(folds.iter().map(|[_, behind]| behind)),
        });
        drop(shares);
        let lists = folds.iter().flat_map(|folds| [&folds.ahead, &folds.behind]);
        share = share.and(take(lists.map(|list| size_of_val(&list.values[..]) as u64).sum())?);
        let (inside, jumps) = (Grid::from_cells(width, height, inside), Grid::from_cells(width, height, jumps));
        Ok(Some((Arc::new(Field { x0, y0, inside, jumps, folds }), share)))
    }

    /// Makes a band, and lists the crossings ahead and behind; `None` if stopped.
    fn make(&self, band: Band, materials: &Materials) -> Option<[Ragged; 2]> {
        let Band { area, cells, inside, jumps, in_region } = band;
        spans(&self.outline, &area, self.place, inside);
        if let Some((_, regions)) = &self.fold {
            regions.polygons().iter().for_each(|polygon| spans(polygon, &area, self.place, in_region));
        }
        // Now in order: cells are far from each other in memory that was never used.
        jumps.fill([0.0; 2]);
        let inside = &*inside;
        let width = (area.to[0] - area.from[0]) as usize;
        let at = |[x, y]: [u32; 2]| (y - area.from[1]) as usize * width + (x - area.from[0]) as usize;
        let wanted = |part: &Area| {
            let columns = (part.to[0] - part.from[0]) as usize;
            (part.from[1]..part.to[1]).any(|y| inside[at([part.from[0], y])..][..columns].contains(&true))
        };
        let mut found: Vec<(usize, Crossings)> = Vec::new();
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
                self.cross(&stretch, inside, &mut |k, crossings| found.push((first + k, crossings)));
            });
            materials.made(cell.area().and(&area).map_or(0, |part| part.count()));
        }
        found.sort_unstable_by_key(|(pixel, _)| *pixel);
        let lists = |of: fn(&Crossings) -> &[f64]| {
            Ragged::of_lists(in_region.len(), found.iter().map(|(pixel, crossings)| (*pixel, of(crossings))))
        };
        Some([lists(|crossings| &crossings.ahead), lists(|crossings| &crossings.behind)])
    }
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

/// The least and the greatest of some numbers.
#[inline(always)]
fn extremes(numbers: &[f64]) -> [f64; 2] {
    const WIDE: usize = 8;
    let (mut least, mut most) = ([f64::INFINITY; WIDE], [f64::NEG_INFINITY; WIDE]);
    let (many, rest) = numbers.as_chunks::<WIDE>();
    for numbers in many {
        for k in 0..WIDE {
            least[k] = if numbers[k] < least[k] { numbers[k] } else { least[k] };
            most[k] = if numbers[k] > most[k] { numbers[k] } else { most[k] };
        }
    }
    let least = least.iter().chain(rest).fold(f64::INFINITY, |a, b| a.min(*b));
    [least, most.iter().chain(rest).fold(f64::NEG_INFINITY, |a, b| a.max(*b))]
}

/// Neighboring rows of a field, and the cells that they lie in.
struct Band<'a> {
    area: Area,
    cells: &'a [Cell],
    inside: &'a mut [bool],
    jumps: &'a mut [[f32; 2]],
    in_region: &'a mut [bool],
}

/// Membership, jump vectors and membership of the regions (or nothing), row by row.
type Rows<'a> = (&'a mut [bool], &'a mut [[f32; 2]], &'a mut [bool]);

/// The bands of a field: of each row of cells one.
fn bands<'a>(cells: &'a [Cell], area: &Area, mut rows: Rows<'a>) -> Vec<Band<'a>> {
    let mut bands = Vec::new();
    for cells in cells.chunk_by(|a, b| a.area().from[1] == b.area().from[1]) {
        let from = [area.from[0], cells[0].area().from[1].max(area.from[1])];
        let area = Area { from, to: [area.to[0], cells[0].area().to[1].min(area.to[1])] };
        let count = area.count() as usize;
        let (inside, jumps, in_region) = rows;
        let (inside, jumps) = (inside.split_at_mut(count), jumps.split_at_mut(count));
        let in_region = in_region.split_at_mut(count.min(in_region.len()));
        bands.push(Band { area, cells, inside: inside.0, jumps: jumps.0, in_region: in_region.0 });
        rows = (inside.1, jumps.1, in_region.1);
    }
    bands
}

/// Which pixels of a picture of `size` have their `place` inside the polygon.
pub fn mask(polygon: &Polygon, (width, height): (usize, usize), place: Vec2) -> Grid<bool> {
    let mut marked = vec![false; width * height];
    spans(polygon, &Area { from: [0; 2], to: [width as u32, height as u32] }, place, &mut marked);
    Grid::from_cells(width, height, marked)
}

/// Marks the pixels of `area`, row by row, whose `place` is inside the polygon.
fn spans(polygon: &Polygon, area: &Area, place: Vec2, marked: &mut [bool]) {
    let mut crossings = Vec::new();
    let (first, end) = (f64::from(area.from[0]), f64::from(area.to[0]));
    // The first column at or after a crossing, by the very sum that decides it.
    let column = |crossing: f64| {
        let reached = |x: f64| crossing <= x + place.x;
        let mut x = (crossing - place.x).ceil().clamp(first, end);
        while x > first && reached(x - 1.0) {
            x -= 1.0;
        }
        while x < end && !reached(x) {
            x += 1.0;
        }
        (x - first) as usize
    };
    let rows = marked.chunks_exact_mut((area.to[0] - area.from[0]) as usize);
    for (row, y) in rows.zip(area.from[1]..) {
        polygon.row_crossings(f64::from(y) + place.y, &mut crossings);
        for pair in crossings.chunks_exact(2) {
            row[column(pair[0])..column(pair[1])].fill(true);
        }
    }
}

/// The pixels that `bounds` touches in a part of a picture: first column and row, width, height.
fn pixel_box(bounds: Rect, part: (Range<usize>, Range<usize>)) -> Option<(usize, usize, usize, usize)> {
    let clip = |low: f64, high: f64, part: Range<usize>| {
        let (from, to) = (part.start as f64, part.end as f64);
        let first = low.floor().clamp(from, to) as usize;
        let end = high.ceil().clamp(from, to) as usize;
        (end > first).then(|| (first, end - first))
    };
    let (x0, w) = clip(bounds.x0, bounds.x1, part.0)?;
    let (y0, h) = clip(bounds.y0, bounds.y1, part.1)?;
    Some((x0, y0, w, h))
}
