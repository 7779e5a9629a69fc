//! What is known of a filled map and of its views, in numbers.

use super::arrays::Arrays;
use super::coat::State;
use super::looked::Filled;
use super::map::Map;
use super::view::View;

/// The memory that an entry is counted as, in bytes.
pub const ENTRY_BYTES: u64 = 16;
/// The pixels of the image of triangles in one of the picture.
const IN_A_PIXEL: f64 = 4.0;

/// What is known of an active view.
#[derive(Clone, Debug)]
pub struct OfView<'a> {
    /// The view.
    pub view: &'a View,
    /// Its depth in layers; `None` if it sees nothing.
    pub depth: Option<f64>,
    /// How many pixels of its picture are used for colors.
    pub pixels: f64,
    /// The share of them that is finer than the finest layer.
    pub beyond: f64,
    /// How many cells of each layer it tells something, by how they got it: from its pixels, from finer cells, from coarser
    /// ones, from those beside.
    pub cells: Vec<[usize; 4]>,
}

/// What is known of a map; lists go by layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OfMap {
    /// How many charts the surface has.
    pub charts: usize,
    /// How many layers there are.
    pub levels: usize,
    /// Cells.
    pub cells: Vec<usize>,
    /// Cells whose base coat views tell.
    pub known: Vec<usize>,
    /// Cells whose base coat comes from others.
    pub filled: Vec<usize>,
    /// What views tell cells that depends on the direction.
    pub entries: Vec<usize>,
    /// The memory of what views tell, as it is counted.
    pub bytes: u64,
}

/// The active views, in order.
pub fn views(map: &Map) -> Vec<OfView<'_>> {
    let views = map.wanted.views.iter().zip(&map.reports).zip(&map.origins);
    let of = |((view, report), cells): ((_, &super::map::Report), &Vec<[usize; 4]>)| OfView {
        view,
        depth: report.depth,
        pixels: report.used as f64 / IN_A_PIXEL,
        beyond: if report.used > 0 { report.beyond as f64 / report.used as f64 } else { 0.0 },
        cells: cells.clone(),
    };
    views.map(of).collect()
}

/// The memory of what views tell, as it is counted.
pub fn bytes((map, arrays): Filled) -> u64 {
    let entries: usize = map.lists.iter().map(|lists| lists.views.len()).sum();
    entries as u64 * ENTRY_BYTES + arrays.map_or(0, Arrays::bytes)
}

/// The map.
pub fn map((map, arrays): Filled) -> OfMap {
    let count = |state: State| map.coats.iter().map(|coat| coat.count(state)).collect();
    let depends = |view: &&u8| map.wanted.views[usize::from(**view)].dependent;
    OfMap {
        charts: map.atlas.extents.len(),
        levels: map.cells.layers.len(),
        cells: map.cells.layers.iter().map(|layer| layer.len()).collect(),
        known: count(State::Known),
        filled: count(State::Filled),
        entries: map.lists.iter().map(|lists| lists.views.iter().filter(depends).count()).collect(),
        bytes: bytes((map, arrays)),
    }
}
