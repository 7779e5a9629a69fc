//! A view map filled: all that a frame reads.

use std::sync::Arc;

use rayon::prelude::*;

use super::atlas::{Atlas, By};
use super::cells::{Cells, Layer};
use super::coat::{Coat, coats};
use super::entries::{Told, Work, told};
use super::id::Seen;
use super::lists::Lists;
use super::view::View;
use crate::base::mesh::Mesh;
use crate::base::progress::Watch;

/// How many levels there are where no view sees anything.
pub const UNSEEN: usize = 5;
/// The numbers that the finest layer may have if it is not said.
const FINEST: (f64, f64) = (2.0, 5.0);
/// How far a view may be deeper than the finest layer before another is made.
const DEEPER: f64 = 0.05;
/// The most memory for what views see while the levels are not yet known, and for what is kept of it; what is beyond is found twice.
pub const KEPT_BYTES: usize = 1 << 29;

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
    /// What views see whose pictures are being edited.
    seen: Vec<Option<Arc<Seen>>>,
}

impl Map {
    /// Fills a map; `None` if it was stopped. What it has in common with `previous` is reused. There is memory for so many bytes of what
    /// views see while the levels are not yet known.
    pub fn new(wanted: Wanted, previous: Option<&Map>, room: usize, watch: &Watch) -> Option<Map> {
        let before = previous.filter(|map| Arc::ptr_eq(&map.wanted.mesh, &wanted.mesh) && map.wanted.by == wanted.by);
        let atlas = before.map_or_else(|| Arc::new(Atlas::new(&wanted.mesh, wanted.by)), |map| map.atlas.clone());
        let before = before.filter(|map| map.wanted.first == wanted.first);
        let (mut seen, depths) = looked(&wanted, &atlas, before, (room, watch))?;
        let levels = wanted.levels.unwrap_or_else(|| Cells::fitting(&atlas, wanted.first, automatic(&depths)));
        let before = before.filter(|map| map.cells.layers.len() == levels);
        let cells = before.map_or_else(|| Arc::new(Cells::new(&atlas, wanted.first, levels)), |map| map.cells.clone());
        let alike = before.filter(|map| map.wanted.tells_the_same(&wanted));
        if let Some(Map { reports, origins, lists, coats, seen, .. }) = alike {
            let (lists, coats, seen) = (lists.clone(), coats.clone(), seen.clone());
            return Some(Map {
                wanted,
                atlas,
                cells,
                reports: reports.clone(),
                origins: origins.clone(),
                lists,
                coats,
                seen,
            });
        }
        let work = work(&wanted, before);
        let filled = wanted.views.par_iter().zip(&mut seen).enumerate().map(|(number, (view, seen))| {
            if (watch.stopped)() {
                return None;
            }
            let of_view = before.and_then(|map| map.told_by(number, view)).unwrap_or_else(|| {
                // Who paints does it again and again.
                let is_edited = before.is_some_and(|map| map.looks_as(view).is_some());
                let kept = before.and_then(|map| map.seen[map.looks_as(view)?].clone());
                let seen = kept.or_else(|| seen.take().map(Arc::new));
                let seen = seen.unwrap_or_else(|| Arc::new(look(&wanted, &atlas, view)));
                let told = told(&cells, (&seen, &view.paint.pixels()), view.reach, work);
                OfView { report: report(&seen, levels), told: Some(told), seen: Some(seen).filter(|_| is_edited) }
            });
            (watch.done)(number);
            Some(of_view)
        });
        let filled: Vec<OfView> = filled.collect::<Option<_>>()?;
        let same: Vec<bool> = filled.iter().map(|of| of.told.is_none()).collect();
        let lists = (0..levels).into_par_iter().map(|layer| {
            let fresh = filled.iter().enumerate().filter_map(|(view, of)| Some((view, of.told.as_ref()?.get(layer)?)));
            let before = before.map(|map| (&map.lists[layer], &same[..]));
            Lists::new(cells.layers[layer].len(), before, &fresh.collect::<Vec<_>>())
        });
        let lists = Arc::new(lists.collect::<Vec<Lists>>());
        let origins = filled.iter().enumerate().map(|(view, of)| match (&of.told, before) {
            (None, Some(map)) => map.origins[view].clone(),
            (told, _) => told.iter().flatten().map(|told| told.origins).collect(),
        });
        let origins = origins.collect();
        let coats = coated(&wanted, &cells, &lists, before.map(|map| (map, &same[..])));
        let (reports, mut seen): (_, Vec<_>) = filled.into_iter().map(|of| (of.report, of.seen)).unzip();
        keep(&mut seen, &same);
        Some(Map { wanted, atlas, cells, reports, origins, lists, coats, seen })
    }

    /// What is known of the view of this number, if this map has it: what it tells only if it has another number here.
    fn told_by(&self, number: usize, view: &View) -> Option<OfView> {
        let same = |own: &usize| self.wanted.views.get(*own).is_some_and(|own| own.tells_the_same(view));
        let own = Some(number).filter(same).or_else(|| (0..self.wanted.views.len()).find(same))?;
        let told = |(lists, origins): (&Lists, &[usize; 4])| lists.told(own as u8, *origins);
        let told = (own != number).then(|| self.lists.iter().zip(&self.origins[own]).map(told).collect());
        Some(OfView { report: self.reports[own], told, seen: self.seen[own].clone() })
    }

    /// The view of this map that sees what a view does.
    fn looks_as(&self, view: &View) -> Option<usize> {
        self.wanted.views.iter().position(|own| (own.camera, own.edge_px) == (view.camera, view.edge_px))
    }

    /// Whether the base coat of a map is made of the views with the same numbers.
    fn has_bases_of(&self, wanted: &Wanted) -> bool {
        let bases = |wanted: &Wanted| wanted.views.iter().map(|view| view.base).collect::<Vec<_>>();
        bases(&self.wanted) == bases(wanted)
    }

    /// The memory of what views see, in bytes.
    pub fn seen_bytes(&self) -> u64 {
        self.seen.iter().flatten().map(|seen| seen.bytes() as u64).sum()
    }

    /// The same without what depends on the direction, and what the base coat was made of: only that is left.
    pub fn coat_alone(self) -> Map {
        let empty = |layer: &Layer| Lists::new(layer.len(), None, &[]);
        let lists = Arc::new(self.cells.layers.iter().map(empty).collect());
        Map { lists, seen: vec![None; self.seen.len()], ..self }
    }

    /// Forgets what views see; it is found again when it is needed.
    pub fn forget_seen(&mut self) {
        self.seen.iter_mut().for_each(|seen| *seen = None);
    }
}

/// Keeps as much of what views see as there is room for; that of views which are the same as before is forgotten first.
fn keep(seen: &mut [Option<Arc<Seen>>], same: &[bool]) {
    let mut room = KEPT_BYTES;
    for is_same in [false, true] {
        for (seen, _) in seen.iter_mut().zip(same).filter(|(_, same)| **same == is_same) {
            match seen.as_ref().map_or(0, |seen| seen.bytes()) {
                bytes if bytes <= room => room -= bytes,
                _ => *seen = None,
            }
        }
    }
}

/// What is known of a view while a map is filled.
struct OfView {
    report: Report,
    /// What it tells; `None` if that is as it was in the map before, where it has the same number.
    told: Option<Vec<Told>>,
    /// What it sees, if that is kept.
    seen: Option<Arc<Seen>>,
}

/// The base coat; what is known of it before is kept where the same views tell the same.
fn coated(wanted: &Wanted, cells: &Cells, lists: &[Lists], before: Option<(&Map, &[bool])>) -> Arc<Vec<Coat>> {
    let before = before.filter(|(map, _)| map.has_bases_of(wanted));
    let is_same = |(same, view): (&bool, &View)| *same || !view.base;
    if let Some((map, same)) = before
        && map.wanted.missing == wanted.missing
        && same.iter().zip(&wanted.views).all(is_same)
    {
        return map.coats.clone();
    }
    let before = before.map(|(map, same)| (&map.lists[..], &map.coats[..], same));
    Arc::new(coats(cells, lists, &wanted.views, wanted.missing, before))
}

/// Who works on a view: all threads where a single one is not as it was in the map before.
fn work(wanted: &Wanted, before: Option<&Map>) -> Work {
    let known = |view: &&View| before.is_some_and(|map| map.wanted.views.iter().any(|own| own.tells_the_same(view)));
    match wanted.views.iter().filter(|view| !known(view)).count() {
        0 | 1 => Work::Shared,
        _ => Work::Alone,
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
    (mut room, watch): (usize, &Watch),
) -> Option<(Vec<Option<Seen>>, Vec<Option<f64>>)> {
    if wanted.levels.is_some() {
        return Some((wanted.views.iter().map(|_| None).collect(), Vec::new()));
    }
    let (mut all, mut depths) = (Vec::new(), Vec::new());
    // In pieces, so that no more is in memory at once than there is room for.
    let numbered: Vec<_> = wanted.views.iter().enumerate().collect();
    for views in numbered.chunks(rayon::current_num_threads().max(1)) {
        let seen = views.par_iter().map(|(number, view)| {
            if (watch.stopped)() {
                return None;
            }
            let known = before.and_then(|map| Some(map.reports[map.looks_as(view)?].depth));
            let found = match known {
                Some(depth) => (None, depth),
                None => {
                    let seen = look(wanted, atlas, view);
                    let depth = seen.depth;
                    (Some(seen), depth)
                }
            };
            (watch.done)(*number);
            Some(found)
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
pub fn automatic(depths: &[Option<f64>]) -> usize {
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
