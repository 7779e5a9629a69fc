//! The pixels of a zone: membership, jump vectors and thresholds, row by row on all cores. Each pixel's sums are always
//! made in the same order, so that the bytes do not depend on the number of threads.

use std::ops::Range;
use std::sync::Arc;

use kurbo::{Point, Rect, Vec2};
use rayon::prelude::*;

use super::anchors::{Dense, anchors, dense};
use super::fold::{Fold, Rule};
use super::interpolation::{Interpolation, Interpolator, Jumps, RUN, Run};
use super::model::Zone;
use super::outline::Outline;
use super::regions::{Crossings, Regions};
use super::tools::Tool;
use crate::base::budget::Share;
use crate::base::geometry::Polygon;
use crate::base::maths::smoothstep;
use crate::base::pixels::Grid;
use crate::base::problem::Problem;
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

    fn of_lists<'a>(lists: impl Iterator<Item = &'a [f64]>) -> Self {
        let mut ragged = Ragged { starts: vec![0], values: Vec::new() };
        for list in lists {
            ragged.values.extend_from_slice(list);
            ragged.starts.push(ragged.values.len() as u32);
        }
        ragged
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
    /// centre.
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
        let Inputs { outline, motion, interpolation, feather, fold, range, size: _, place } = inputs;
        Ok(Prepared {
            outline: outline.polygon(),
            interpolator: Interpolator::new(interpolation, anchors(motion, outline), materials)?,
            dense: dense(motion, materials),
            feather: *feather,
            fold: fold.as_ref().and_then(|fold| Some((fold.rule()?, Regions::new(fold.regions())))),
            range: *range,
            place: *place,
        })
    }

    /// The pixels of row `y`, from column `x0` on.
    pub fn row(&self, x0: usize, y: usize, width: usize) -> Vec<Pixel> {
        let mut crossings = Vec::new();
        self.outline.row_crossings(y as f64 + self.place.y, &mut crossings);
        let inside = |x: usize| crossings.partition_point(|&c| c <= x as f64 + self.place.x) % 2 == 1;
        let mut pixels: Vec<Pixel> =
            (x0..x0 + width).map(|x| Pixel { inside: inside(x), ..Pixel::default() }).collect();
        for (i, run) in pixels.chunks_mut(RUN).enumerate() {
            let (Some(first), Some(last)) = (run.iter().position(|p| p.inside), run.iter().rposition(|p| p.inside))
            else {
                continue;
            };
            let pixel = ((x0 + i * RUN + first) as u32, y as u32);
            self.fill(&Run { pixel, place: self.place, len: last - first + 1 }, &mut run[first..=last]);
        }
        pixels
    }

    /// Jump vectors and crossings of a run.
    fn fill(&self, run: &Run, pixels: &mut [Pixel]) {
        let mut jumps = Jumps::default();
        self.interpolator.run(run, &mut jumps);
        let q = |k: usize| Point::new(run.x(k), run.y());
        let feather = self.feather_of(Rect::from_points(q(0), q(run.len - 1)));
        for (k, pixel) in pixels.iter_mut().enumerate().filter(|(_, pixel)| pixel.inside) {
            let interpolated = Vec2::new(jumps.x[k], jumps.y[k]);
            pixel.jump = self.dense.iter().fold(interpolated, |sum, dense| sum + dense.at(q(k))) * feather(q(k));
        }
        if let Some((_, regions)) = &self.fold {
            let members = regions.memberships(q(0), run.len);
            for (i, few) in pixels.chunks_mut(FEW).enumerate() {
                self.cross(regions, |k| q(i * FEW + k), |region, k| members[region][i * FEW + k], few);
            }
        }
    }

    /// Crossings of a few neighboring pixels: only the sides within reach of their paths are looked at.
    fn cross(
        &self,
        regions: &Regions,
        q: impl Fn(usize) -> Point,
        member_of: impl Fn(usize, usize) -> bool,
        pixels: &mut [Pixel],
    ) {
        let (low, high) = self.range;
        let path = |(k, pixel): (usize, &Pixel)| Rect::from_points(q(k) + pixel.jump * low, q(k) + pixel.jump * high);
        let paths = pixels.iter().enumerate().filter(|(_, pixel)| pixel.inside).map(path);
        let Some(reach) = paths.reduce(|reach, path| reach.union(path)) else { return };
        let sides = regions.sides_within(reach);
        let mut member = vec![false; regions.count()];
        for (k, pixel) in pixels.iter_mut().enumerate().filter(|(_, pixel)| pixel.inside) {
            member.iter_mut().enumerate().for_each(|(region, one)| *one = member_of(region, k));
            pixel.crossings = regions.crossings(q(k), pixel.jump, self.range, &sides, &member);
        }
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
        let prepared = self;
        let Some((x0, y0, width, height)) = pixel_box(prepared.outline.bounds(), part) else { return Ok(None) };
        let take = |bytes| materials.budget.try_take(bytes).map_err(|short| short.problem(""));
        let row = |y: usize| {
            if materials.stopped() {
                return Err(Problem::error("", "stopped"));
            }
            let row = Row::of(&prepared.row(x0, y, width));
            // The rows and the whole field are both in memory for a moment.
            let share = take(2 * row.bytes())?;
            materials.made(width as u64);
            Ok((row, share))
        };
        let rows = (y0..y0 + height).into_par_iter().map(row).collect::<Result<Vec<_>, _>>()?;
        let (rows, shares): (Vec<Row>, Vec<Share>) = rows.into_iter().unzip();
        let kept = rows.iter().map(Row::bytes).sum();
        let field = Field {
            x0,
            y0,
            inside: Grid::from_cells(width, height, joined(&rows, |row| &row.inside)),
            jumps: Grid::from_cells(width, height, joined(&rows, |row| &row.jumps)),
            folds: prepared.fold.as_ref().map(|(rule, _)| Folds {
                rule: *rule,
                inside: Grid::from_cells(width, height, joined(&rows, |row| &row.in_region)),
                ahead: Ragged::concat(rows.iter().map(|row| &row.ahead)),
                behind: Ragged::concat(rows.iter().map(|row| &row.behind)),
            }),
        };
        drop((rows, shares));
        Ok(Some((Arc::new(field), take(kept)?)))
    }
}

/// A row of a field in its final form, without the memory that its pixels took while being computed.
struct Row {
    inside: Vec<bool>,
    jumps: Vec<[f32; 2]>,
    in_region: Vec<bool>,
    ahead: Ragged,
    behind: Ragged,
}

impl Row {
    /// How many bytes it takes.
    fn bytes(&self) -> u64 {
        let flags = self.inside.len() + self.in_region.len();
        let lists = |ragged: &Ragged| size_of_val(&ragged.starts[..]) + size_of_val(&ragged.values[..]);
        (flags + size_of_val(&self.jumps[..]) + lists(&self.ahead) + lists(&self.behind)) as u64
    }

    fn of(pixels: &[Pixel]) -> Self {
        Row {
            inside: pixels.iter().map(|p| p.inside).collect(),
            jumps: pixels.iter().map(|p| [p.jump.x as f32, p.jump.y as f32]).collect(),
            in_region: pixels.iter().map(|p| p.crossings.inside).collect(),
            ahead: Ragged::of_lists(pixels.iter().map(|p| p.crossings.ahead.as_slice())),
            behind: Ragged::of_lists(pixels.iter().map(|p| p.crossings.behind.as_slice())),
        }
    }
}

fn joined<T: Copy>(rows: &[Row], of: impl Fn(&Row) -> &Vec<T>) -> Vec<T> {
    rows.iter().map(|row| of(row).as_slice()).collect::<Vec<_>>().concat()
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
