//! Thresholds of a zone as textures: the first stretch on which each pixel moves, and, where that does not tell all,
//! every place at which its path meets the fold regions.

use crate::base::pixels::Grid;
use crate::layers::folding::field::Field;
use crate::layers::folding::thresholds::Folds;
use crate::layers::parts::bundle::{Channel, Texture};

/// Crossings of all pixels, in blocks of the box's size stacked downward.
pub struct Thresholds {
    /// The numbers.
    pub texture: Texture,
    /// Slots for crossings with s >= 0.
    pub ahead: usize,
    /// Slots for crossings with s <= 0.
    pub behind: usize,
}

/// s0 and s1 of pixel `i` of the box: the first stretch in (0, 1] on which it moves; (1, 1) for one that never does.
pub fn stretch(field: &Field, i: usize) -> [f64; 2] {
    let Some(folds) = &field.folds else { return [0.0, 1.0] };
    let mut crossings = folds.ahead.of(i).iter().copied().filter(|&c| c <= 1.0);
    let begin = if moves_at_init(folds, i) { Some(0.0) } else { crossings.next().filter(|&c| c < 1.0) };
    match begin {
        Some(begin) => [begin, crossings.next().unwrap_or(1.0)],
        None => [1.0, 1.0],
    }
}

fn moves_at_init(folds: &Folds, i: usize) -> bool {
    folds.inside.cells()[i] == folds.rule.moves_inside()
}

/// The `thresholds` texture of a zone whose position function takes s from `low` to `high`; `None` if the first stretch
/// of every pixel tells all.
pub fn thresholds(field: &Field, (low, high): (f64, f64)) -> Option<Thresholds> {
    let folds = field.folds.as_ref()?;
    let pixels = || (0..field.inside.cells().len()).filter(|&i| field.inside.cells()[i]);
    if !pixels().any(|i| needs_more(folds, i, low, high)) {
        return None;
    }
    let most = |of: fn(&Folds, usize) -> usize| pixels().map(|i| of(folds, i)).max().unwrap_or(0);
    let ahead = most(|folds, i| folds.ahead.of(i).len());
    let behind = most(|folds, i| folds.behind.of(i).len());
    // A slot that is not used holds a place that s never passes: no player need count.
    let (beyond, before) = (high.max(1.0) + 1.0, low.min(0.0) - 1.0);
    let slots = 1 + ahead + behind;
    let slot = |i: usize, k: usize| match k {
        0 => f64::from(u8::from(folds.inside.cells()[i])),
        k if k <= ahead => folds.ahead.of(i).get(k - 1).copied().unwrap_or(beyond),
        k if k < slots => folds.behind.of(i).get(k - 1 - ahead).copied().unwrap_or(before),
        _ => 0.0,
    };
    let (width, height) = (field.inside.width(), field.inside.height());
    let cell = |at: usize| {
        let (block, i) = (at / (width * height), at % (width * height));
        std::array::from_fn(|c| if field.inside.cells()[i] { slot(i, block * 4 + c) } else { 0.0 })
    };
    let blocks = slots.div_ceil(4);
    let values = Grid::from_cells(width, height * blocks, (0..width * height * blocks).map(cell).collect());
    let channels = ["slot 4k", "slot 4k + 1", "slot 4k + 2", "slot 4k + 3"];
    let channels = channels.map(|name| Channel::new(name, "in block k; see thresholds.slots", 0)).to_vec();
    Some(Thresholds { texture: Texture { values, channels }, ahead, behind })
}

/// Whether pixel `i` does anything, for an s that is reached, that its first stretch does not tell.
fn needs_more(folds: &Folds, i: usize, low: f64, high: f64) -> bool {
    let ahead: Vec<f64> = folds.ahead.of(i).iter().copied().take_while(|&c| c < high).collect();
    let behind = folds.behind.of(i).iter().any(|&c| c > low);
    let told = if moves_at_init(folds, i) { 1 } else { 2 };
    let waits = folds.rule.waits() && ahead.len() > usize::from(folds.inside.cells()[i]);
    behind || waits || ahead.len() > told || ahead.first() == Some(&0.0) || ahead.last().is_some_and(|&c| c >= 1.0)
}
