//! The kernels of impulses, sorted by the tiles of the frame that they may reach.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::curves::turns;
use super::impulse::Impulse;

/// The side of a tile, in pixels.
pub const TILE: usize = 64;

/// What a tile adds of an impulse: little, as there may be millions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Kernel {
    /// Its place from the corner of the tile, in pixels.
    pub at: [f32; 2],
    /// Its radius, in pixels.
    pub radius_px: f32,
    /// How much it counts.
    pub factor: f32,
    /// The direction of its stroke, clockwise from +x, in turns.
    pub angle: f32,
    /// The phase of its wave, in turns.
    pub phase: f32,
    /// What differences of 1 / depth are multiplied by, to be distances in radii.
    pub scale: f32,
    /// Its triangle, as one of [`Bins::facets`].
    pub facet: u32,
}

/// The triangle of some impulses.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Its number.
    pub triangle: u32,
    /// See the `plane` of an impulse.
    pub plane: DVec3,
}

/// Takes impulses, in order.
#[derive(Debug)]
pub struct Binning {
    tiles: DVec2,
    focal_px: f64,
    facets: Vec<Facet>,
    found: Vec<Found>,
}

/// An impulse that is to be sorted.
#[derive(Debug)]
struct Found {
    at: DVec2,
    /// The columns and rows of tiles that it may reach: from and to.
    tiles: [[u16; 2]; 2],
    kernel: Kernel,
}

impl Binning {
    /// For a frame of this size, with the picture plane at this distance.
    pub fn new((width, height): (usize, usize), focal_px: f64) -> Binning {
        let tiles = [width, height].map(|length| length.div_ceil(TILE).max(1) as f64);
        Binning { tiles: tiles.into(), focal_px, facets: Vec::new(), found: Vec::new() }
    }

    /// What was taken since the last time, sorted.
    pub fn sorted(&mut self) -> Bins {
        let side = |k: usize| {
            let sides = self.found.iter().map(|found| found.tiles[k]);
            let [from, to] = sides.fold([u16::MAX, 0], |[least, most], [from, to]| [least.min(from), most.max(to)]);
            usize::from(from.min(to))..usize::from(to)
        };
        let [columns, rows] = [side(0), side(1)];
        let begins = vec![0; columns.len() * rows.len() + 1];
        let mut bins = Bins { begins, facets: std::mem::take(&mut self.facets), columns, rows, kernels: Vec::new() };
        for found in &self.found {
            found.tiles(|x, y| {
                let tile = bins.tile(x, y);
                bins.begins[tile + 1] += 1;
            });
        }
        for tile in 1..bins.begins.len() {
            bins.begins[tile] += bins.begins[tile - 1];
        }
        let (mut next, count) = (bins.begins.clone(), bins.begins.last().map_or(0, |count| *count as usize));
        bins.kernels = vec![Kernel::default(); count];
        for found in self.found.drain(..) {
            found.tiles(|x, y| {
                let at = found.at - DVec2::new(x as f64, y as f64) * TILE as f64;
                let next = &mut next[bins.tile(x, y)];
                bins.kernels[*next as usize] = Kernel { at: at.as_vec2().to_array(), ..found.kernel };
                *next += 1;
            });
        }
        bins
    }
}

impl Extend<Impulse> for Binning {
    #[inline(always)]
    fn extend<T: IntoIterator<Item = Impulse>>(&mut self, impulses: T) {
        for impulse in impulses {
            let triangle = impulse.of[0];
            if self.facets.last().is_none_or(|last| last.triangle != triangle) {
                self.facets.push(Facet { triangle, plane: impulse.plane });
            }
            let (from, to) = (impulse.at - impulse.radius_px, impulse.at + impulse.radius_px);
            let tile = |at: f64, most: f64| (at * (1.0 / TILE as f64)).clamp(0.0, most) as i32 as u16;
            let side = |from: f64, to: f64, most: f64| [tile(from, most), tile(to + TILE as f64, most)];
            let kernel = Kernel {
                at: [0.0; 2],
                radius_px: impulse.radius_px as f32,
                factor: impulse.factor as f32,
                angle: turns(impulse.angle),
                phase: turns(impulse.phase),
                scale: (impulse.depth * self.focal_px / impulse.radius_px) as f32,
                facet: self.facets.len() as u32 - 1,
            };
            let tiles = [side(from.x, to.x, self.tiles.x), side(from.y, to.y, self.tiles.y)];
            self.found.push(Found { at: impulse.at, tiles, kernel });
        }
    }
}

impl Found {
    /// Calls `each` with the columns and rows of the tiles, row after row.
    #[inline(always)]
    fn tiles(&self, mut each: impl FnMut(usize, usize)) {
        let [columns, rows] = self.tiles;
        for y in rows[0]..rows[1] {
            for x in columns[0]..columns[1] {
                each(usize::from(x), usize::from(y));
            }
        }
    }
}

/// The kernels of some impulses, those of each tile together, in order.
#[derive(Debug)]
pub struct Bins {
    /// The triangles of the impulses.
    pub facets: Vec<Facet>,
    /// The columns and rows of tiles that are reached.
    columns: Range<usize>,
    rows: Range<usize>,
    /// Where the kernels of each of these begin, row after row, and where the last end.
    begins: Vec<u32>,
    kernels: Vec<Kernel>,
}

impl Bins {
    /// Those that may reach the tile in this column and row.
    pub fn of(&self, x: usize, y: usize) -> &[Kernel] {
        if !self.columns.contains(&x) || !self.rows.contains(&y) {
            return &[];
        }
        let tile = self.tile(x, y);
        &self.kernels[self.begins[tile] as usize..self.begins[tile + 1] as usize]
    }

    fn tile(&self, x: usize, y: usize) -> usize {
        (y - self.rows.start) * self.columns.len() + x - self.columns.start
    }
}
