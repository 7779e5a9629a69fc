//! A view map filled: all that a frame reads.

use std::sync::Arc;

use rayon::prelude::*;

use super::atlas::{Atlas, By};
use super::cells::Cells;
use super::coat::{Coat, coats};
use super::entries::{Told, told};
use super::id::Seen;
use super::lists::Lists;
use super::view::View;
use crate::base::mesh::Mesh;

/// How many levels there are where no view sees anything.
pub const UNSEEN: usize = 5;
/// The numbers that the finest layer may have if it is not said.
const FINEST: (f64, f64) = (2.0, 5.0);
/// How far a view may be deeper than the finest layer before another is made.
const DEEPER: f64 = 0.05;
/// The memory for what views see while the levels are not yet known; what is beyond is found twice.
const KEPT_BYTES: usize = 1 << 29;

/// What a map is made from.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The mesh, unbent.
    pub mesh: Arc<Mesh>,
    /// How it is laid flat.
    pub by: By,
    /// How many cells of layer 0 are side by side in a unit of the atlas.
    pub first: u32,
    /// How many layers; `None` for as many as views need.
    pub levels: Option<usize>,
    /// The color where no view tells anything: linear light.
    pub missing: [f32; 3],
    /// The active views.
    pub views: Vec<View>,
}

impl Wanted {
    /// Whether both ask for the same map.
    pub fn same(&self, other: &Wanted) -> bool {
        let views = || self.views.iter().zip(&other.views);
        Arc::ptr_eq(&self.mesh, &other.mesh)
            && (self.by, self.first, self.levels) == (other.by, other.first, other.levels)
            && self.tells_the_same(other)
            && views().all(|(own, other)| own.counts_the_same(other))
    }

    /// Whether the views of both tell the cells the same.
    fn tells_the_same(&self, other: &Wanted) -> bool {
        let same = |(own, other): (&View, &View)| own.tells_the_same(other) && own.base == other.base;
        let views = self.views.iter().zip(&other.views);
        self.missing == other.missing && self.views.len() == other.views.len() && views.into_iter().all(same)
    }
}

/// What is known of a view after the map is filled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Its depth; `None` if it sees nothing.
    pub depth: Option<f64>,
    /// How many pixels of the image of triangles have colors.
    pub used: usize,
    /// How many of them are deeper than the finest layer.
    pub beyond: usize,
}

/// A filled map.
#[derive(Debug)]
pub struct Map {
    /// What it is made from.
    pub wanted: Wanted,
    /// The mesh laid flat.
    pub atlas: Arc<Atlas>,
    /// The cells.
    pub cells: Arc<Cells>,
    /// What is known of each view.
    pub reports: Vec<Report>,
    /// How the cells of each layer got what a view tells them, by view.
    pub origins: Vec<Vec<[usize; 4]>>,
    /// What views tell, by layer.
    pub lists: Arc<Vec<Lists>>,
    /// The base coat, by layer.
    pub coats: Arc<Vec<Coat>>,
}

/// What watches over a filling.
pub struct Watch<'a> {
    /// Whether it should end.
    pub stopped: &'a (dyn Fn() -> bool + Sync),
    /// Called with the index of each view that is done.
    pub done: &'a (dyn Fn(usize) + Sync),
}

impl Map {
    /// Fills a map; `None` if it was stopped. What it has in common with `previous` is reused.
    pub fn new(wanted: Wanted, previous: Option<&Map>, watch: &Watch) -> Option<Map> {
        let before = previous.filter(|map| Arc::ptr_eq(&map.wanted.mesh, &wanted.mesh) && map.wanted.by == wanted.by);
        let atlas = before.map_or_else(|| Arc::new(Atlas::new(&wanted.mesh, wanted.by)), |map| map.atlas.clone());
        let before = before.filter(|map| map.wanted.first == wanted.first);
        let (mut seen, depths) = looked(&wanted, &atlas, before, watch)?;
        let levels = wanted.levels.unwrap_or_else(|| automatic(&depths));
        let before = before.filter(|map| map.cells.layers.len() == levels);
        let cells = before.map_or_else(|| Arc::new(Cells::new(&atlas, wanted.first, levels)), |map| map.cells.clone());
        let alike = before.filter(|map| map.wanted.tells_the_same(&wanted));
        if let Some(Map { reports, origins, lists, coats, .. }) = alike {
            let (lists, coats) = (lists.clone(), coats.clone());
            return Some(Map {
                wanted,
                atlas,
                cells,
                reports: reports.clone(),
                origins: origins.clone(),
                lists,
                coats,
            });
        }
        let filled = wanted.views.par_iter().zip(&mut seen).enumerate().map(|(number, (view, seen))| {
            if (watch.stopped)() {
                return None;
            }
            let known = before.and_then(|map| map.told_by(view));
            let of_view = known.unwrap_or_else(|| {
                let seen = seen.take().unwrap_or_else(|| look(&wanted, &atlas, view));
                (report(&seen, levels), told(&cells, &seen, &view.paint.pixels(), view.reach))
            });
            (watch.done)(number);
            Some(of_view)
        });
        let filled: Vec<(Report, Vec<Told>)> = filled.collect::<Option<_>>()?;
        let lists = (0..levels).into_par_iter().map(|layer| {
            let told: Vec<&Told> = filled.iter().map(|(_, told)| &told[layer]).collect();
            Lists::new(cells.layers[layer].len(), &told)
        });
        let lists: Vec<Lists> = lists.collect();
        let (reports, origins) =
            filled.into_iter().map(|(report, told)| (report, told.iter().map(|told| told.origins).collect())).unzip();
        let coats = Arc::new(coats(&cells, &lists, &wanted.views, wanted.missing));
        let lists = Arc::new(lists);
        Some(Map { wanted, atlas, cells, reports, origins, lists, coats })
    }

    /// What is known of a view, and what it tells, if this map has it.
    fn told_by(&self, view: &View) -> Option<(Report, Vec<Told>)> {
        let own = self.wanted.views.iter().position(|own| own.tells_the_same(view))?;
        let origins = self.origins[own].iter();
        let told = self.lists.iter().zip(origins).map(|(lists, origins)| lists.told(own as u8, *origins));
        Some((self.reports[own], told.collect()))
    }
}

fn look(wanted: &Wanted, atlas: &Atlas, view: &View) -> Seen {
    Seen::new(&wanted.mesh, atlas, &view.camera, wanted.first, view.edge_px)
}

/// What each view sees, as far as it must be known before the levels are and there is room for it; and the depths of views.
fn looked(
    wanted: &Wanted,
    atlas: &Atlas,
    before: Option<&Map>,
    watch: &Watch,
) -> Option<(Vec<Option<Seen>>, Vec<Option<f64>>)> {
    if wanted.levels.is_some() {
        return Some((wanted.views.iter().map(|_| None).collect(), Vec::new()));
    }
    let mut room = KEPT_BYTES;
    let (mut all, mut depths) = (Vec::new(), Vec::new());
    // In pieces, so that no more is in memory at once than there is room for.
    for views in wanted.views.chunks(rayon::current_num_threads().max(1)) {
        let seen = views.par_iter().map(|view| {
            if (watch.stopped)() {
                return None;
            }
            let same = |own: &&View| (own.camera, own.edge_px) == (view.camera, view.edge_px);
            let known = before.and_then(|map| {
                let own = map.wanted.views.iter().position(|own| same(&own))?;
                Some(map.reports[own].depth)
            });
            Some(match known {
                Some(depth) => (None, depth),
                None => {
                    let seen = look(wanted, atlas, view);
                    let depth = seen.depth;
                    (Some(seen), depth)
                }
            })
        });
        for (seen, depth) in seen.collect::<Option<Vec<_>>>()? {
            let kept = seen.filter(|seen| seen.bytes() <= room);
            room -= kept.as_ref().map_or(0, Seen::bytes);
            all.push(kept);
            depths.push(depth);
        }
    }
    Some((all, depths))
}

/// How many layers views of these depths need.
fn automatic(depths: &[Option<f64>]) -> usize {
    let deepest = depths.iter().flatten().fold(f64::NEG_INFINITY, |most, depth| most.max(*depth));
    if deepest == f64::NEG_INFINITY {
        return UNSEEN;
    }
    (deepest - DEEPER).ceil().clamp(FINEST.0, FINEST.1) as usize + 1
}

fn report(seen: &Seen, levels: usize) -> Report {
    let finest = levels.saturating_sub(1) as f64;
    let used = || seen.bands.iter().flatten().filter(|pixel| pixel.facing > 0.0);
    Report { depth: seen.depth, used: used().count(), beyond: used().filter(|pixel| pixel.depth > finest).count() }
}
