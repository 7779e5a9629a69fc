//! Where the paths of a zone's pixels meet its fold regions, found tile by tile: of most tiles no path can reach a side.
//! Paths are those of the jump vectors as they are kept, in single precision.

use kurbo::{Point, Rect, Vec2};
use rayon::prelude::*;

use super::fold::{Fold, Rule};
use super::inside::spans;
use super::interpolation::area::Area;
use super::ragged::{Ragged, TILE};
use super::regions::{Crossings, Near, Regions, SAME, Walk};
use crate::base::pieces::Bundle;
use crate::base::pixels::Grid;
use crate::base::simd::{LANES, Lanes, vectorised};

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

    /// How many bytes it takes.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.inside.cells()) as u64 + self.ahead.bytes() + self.behind.bytes()
    }
}

/// The fold regions of a zone, and how far its paths are followed.
pub struct Folding {
    rule: Rule,
    regions: Regions,
    /// The smallest and largest s for which crossings are wanted.
    range: (f64, f64),
    /// The place in each pixel where its path begins, from its top-left corner.
    place: Vec2,
}

/// What rows of tiles are followed with, one after the other.
#[derive(Default)]
struct Scratch {
    /// For each side of the tile which pixels' paths may cross it.
    may_cross: Vec<u16>,
    /// Which regions contain the pixel.
    member: Vec<bool>,
    walk: Walk,
}

/// Pixels of a zone, row by row: which belong to it, and their jump vectors.
#[derive(Clone, Copy)]
pub struct Paths<'a> {
    /// The pixels.
    pub area: Area,
    /// Which belong to the zone.
    pub inside: &'a [bool],
    /// Jump vectors in pixels.
    pub jumps: &'a [[f32; 2]],
}

impl Folding {
    /// The regions of `fold`; `None` for a mask, which has none.
    pub fn new(fold: &Fold, range: (f64, f64), place: Vec2) -> Option<Self> {
        Some(Folding { rule: fold.rule()?, regions: Regions::new(fold.regions()), range, place })
    }

    /// Where one path meets the regions.
    pub fn crossings(&self, [x, y]: [u32; 2], jump: [f32; 2]) -> Crossings {
        let paths = Paths { area: Area { from: [x, y], to: [x + 1, y + 1] }, inside: &[true], jumps: &[jump] };
        let q = self.q([x, y]);
        let sides = self.regions.sides_within(self.reach(&paths, &paths.area));
        self.regions
            .follow((q, vector(jump)), self.range, &sides, &self.regions.members(q), &mut Walk::default())
            .clone()
    }

    /// Where the paths of all pixels meet the regions; `None` once `stopped`.
    pub fn folds(&self, paths: &Paths, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Folds> {
        let Area { from, to } = paths.area;
        let (width, height) = ((to[0] - from[0]) as usize, (to[1] - from[1]) as usize);
        let mut inside = vec![false; width * height];
        let bands = inside.par_chunks_mut(width * TILE).zip(paths.inside.par_chunks(width * TILE));
        let bands = bands.zip(paths.jumps.par_chunks(width * TILE)).zip((from[1]..to[1]).into_par_iter().step_by(TILE));
        let of_band = |(((in_region, inside), jumps), y): (((&mut [bool], _), _), u32)| {
            let area = Area { from: [from[0], y], to: [to[0], to[1].min(y + TILE as u32)] };
            (!stopped()).then(|| self.band(&Paths { area, inside, jumps }, in_region))
        };
        let (ahead, behind): (Vec<Ragged>, Vec<Ragged>) =
            bands.map(of_band).collect::<Option<Vec<_>>>()?.into_iter().unzip();
        Some(Folds {
            rule: self.rule,
            inside: Grid::from_cells(width, height, inside),
            ahead: Ragged::concat(ahead),
            behind: Ragged::concat(behind),
        })
    }

    /// Marks which pixels of a row of tiles are in a region, and lists their crossings ahead and behind.
    fn band(&self, paths: &Paths, in_region: &mut [bool]) -> (Ragged, Ragged) {
        let (mut ahead, mut behind) = (Ragged::default(), Ragged::default());
        self.regions.polygons().iter().for_each(|polygon| spans(polygon, &paths.area, self.place, in_region));
        let tiles: Vec<(Area, Vec<Near>)> = tiles(&paths.area)
            .map(|tile| (tile, self.regions.sides_within(self.reach(paths, &tile))))
            .filter(|(_, sides)| !sides.is_empty())
            .collect();
        let mut scratch = Scratch::default();
        for y in (paths.area.from[1]..paths.area.to[1]).filter(|_| !tiles.is_empty()) {
            let row = |part: &Area| Area { from: [part.from[0], y], to: [part.to[0], y + 1] };
            let members = self.members(&row(&paths.area));
            for (tile, sides) in &tiles {
                self.row(paths, &row(tile), sides, &members, &mut scratch, &mut |i, found| {
                    ahead.push(i, &found.ahead);
                    behind.push(i, &found.behind);
                });
            }
        }
        (ahead.ended(in_region.len()), behind.ended(in_region.len()))
    }

    /// Tells the crossings of the pixels in a row of a tile, which has these `sides`; `members` are those of the whole row.
    fn row(
        &self,
        paths: &Paths,
        row: &Area,
        sides: &[Near],
        members: &[Vec<bool>],
        scratch: &mut Scratch,
        tell: &mut impl FnMut(usize, &Crossings),
    ) {
        let Scratch { may_cross, member, walk } = scratch;
        let (first, count) = (paths.index(row.from), row.count() as usize);
        let jumps = &paths.jumps[first..first + count];
        may_cross.clear();
        vectorised(
            #[inline(always)]
            || {
                let bundle = Bundle::new(self.q(row.from), jumps, (self.range.0 - SAME, self.range.1 + SAME));
                for side in sides {
                    may_cross.push(bundle.may_cross(&side.piece));
                }
            },
        );
        let mut left = may_cross.iter().fold(0, |all, bits| all | bits);
        while left != 0 {
            let k = left.trailing_zeros() as usize;
            left &= left - 1;
            if !paths.inside[first + k] {
                continue;
            }
            let x = row.from[0] + k as u32;
            member.clear();
            member.extend(members.iter().map(|of_region| of_region[(x - paths.area.from[0]) as usize]));
            let met = sides.iter().zip(&*may_cross).filter(|(_, bits)| *bits >> k & 1 == 1).map(|(side, _)| side);
            let path = (self.q([x, row.from[1]]), vector(jumps[k]));
            tell(first + k, self.regions.follow(path, self.range, met, member, walk));
        }
    }

    /// For each region which pixels of a row are in it.
    fn members(&self, row: &Area) -> Vec<Vec<bool>> {
        let of_region = |polygon| {
            let mut inside = vec![false; row.count() as usize];
            spans(polygon, row, self.place, &mut inside);
            inside
        };
        self.regions.polygons().iter().map(of_region).collect()
    }

    /// Where the path of a pixel begins.
    fn q(&self, [x, y]: [u32; 2]) -> Point {
        Point::new(f64::from(x) + self.place.x, f64::from(y) + self.place.y)
    }

    /// A box around the paths of `part`.
    fn reach(&self, paths: &Paths, part: &Area) -> Rect {
        let (low, high) = self.range;
        let along = |[least, most]: [f64; 2]| [(least * high).min(most * low), (most * high).max(least * low)];
        let [[left, right], [up, down]] = vectorised(
            #[inline(always)]
            || paths.extremes(part),
        )
        .map(along);
        let (first, last) = (self.q(part.from), self.q(part.to.map(|end| end - 1)));
        Rect::new(first.x + left, first.y + up, last.x + right, last.y + down)
    }
}

fn vector([x, y]: [f32; 2]) -> Vec2 {
    Vec2::new(x.into(), y.into())
}

impl Paths<'_> {
    /// Where the numbers of a pixel are.
    pub fn index(&self, [x, y]: [u32; 2]) -> usize {
        let Area { from, to } = self.area;
        (y - from[1]) as usize * (to[0] - from[0]) as usize + (x - from[0]) as usize
    }

    /// The least and the greatest x and y of the jump vectors of `part`.
    #[inline(always)]
    fn extremes(&self, part: &Area) -> [[f64; 2]; 2] {
        let (mut least, mut most) = (Lanes::all(f32::INFINITY), Lanes::all(f32::NEG_INFINITY));
        for y in part.from[1]..part.to[1] {
            let jumps = &self.jumps[self.index([part.from[0], y])..][..(part.to[0] - part.from[0]) as usize];
            let (many, rest) = jumps.as_flattened().as_chunks::<LANES>();
            for numbers in many {
                least = least.min(Lanes(*numbers));
                most = most.max(Lanes(*numbers));
            }
            for (k, number) in rest.iter().enumerate() {
                least.0[k] = least.0[k].min(*number);
                most.0[k] = most.0[k].max(*number);
            }
        }
        // x and y alternate.
        [0, 1].map(|axis| {
            let of = |lanes: Lanes, pick: fn(f32, f32) -> f32| {
                lanes.0[axis..].iter().copied().step_by(2).reduce(pick).map_or(0.0, f64::from)
            };
            [of(least, f32::min), of(most, f32::max)]
        })
    }
}

/// A row of tiles, from left to right.
fn tiles(band: &Area) -> impl Iterator<Item = Area> {
    let (from, to) = (band.from, band.to);
    (from[0]..to[0]).step_by(TILE).map(move |x| Area { from: [x, from[1]], to: [to[0].min(x + TILE as u32), to[1]] })
}
