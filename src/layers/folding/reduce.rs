//! A smaller layer for a preview. Folds, jumps and membership are those of the pixel in the middle of each block,
//! scaled; the picture is the mean of each block.

use std::sync::Arc;

use super::field::Field;
use super::ragged::Ragged;
use super::synth::{Synth, ZoneSynth};
use super::thresholds::Folds;
use crate::base::pixels::Grid;
use crate::base::reduce::Reduced;

/// The layer, reduced.
pub fn layer(synth: &Synth, pictures: &mut Reduced) -> Synth {
    let zones = synth.zones.iter().filter_map(|one| zone(one, pictures)).collect();
    Synth { picture: pictures.picture(&synth.picture), zones }
}

/// The zone, reduced; `None` if no block has its middle in the zone's box.
fn zone(zone: &ZoneSynth, pictures: &mut Reduced) -> Option<ZoneSynth> {
    let factor = pictures.by;
    let mut small = zone.clone();
    small.field = Arc::new(field(&zone.field, factor)?);
    small.source.picture = pictures.picture(&zone.source.picture);
    if let Some(playing) = &mut small.source.clip {
        playing.clip = pictures.clip(&playing.clip);
    }
    small.source.offset = zone.source.offset / factor as f64;
    Some(small)
}

fn field(field: &Field, factor: usize) -> Option<Field> {
    // Block b takes the values of pixel b * factor + factor / 2.
    let first = |from: usize| (from + factor - 1 - factor / 2) / factor;
    let blocks = |from: usize, n: usize| first(from)..first(from + n);
    let columns = blocks(field.x0, field.inside.width());
    let rows = blocks(field.y0, field.inside.height());
    if columns.is_empty() || rows.is_empty() {
        return None;
    }
    let middle = |b: usize, from: usize| b * factor + factor / 2 - from;
    let kept: Vec<usize> = rows
        .clone()
        .flat_map(|y| columns.clone().map(move |x| (x, y)))
        .map(|(x, y)| middle(y, field.y0) * field.inside.width() + middle(x, field.x0))
        .collect();
    let (width, height) = (columns.len(), rows.len());
    let jump = |i: &usize| field.jumps.cells()[*i].map(|c| c / factor as f32);
    Some(Field {
        x0: columns.start,
        y0: rows.start,
        inside: Arc::new(Grid::from_cells(width, height, kept.iter().map(|&i| field.inside.cells()[i]).collect())),
        jumps: Arc::new(Grid::from_cells(width, height, kept.iter().map(jump).collect())),
        folds: field.folds.as_ref().map(|folds| Folds {
            rule: folds.rule,
            inside: Grid::from_cells(width, height, kept.iter().map(|&i| folds.inside.cells()[i]).collect()),
            ahead: some_of(&folds.ahead, &kept),
            behind: some_of(&folds.behind, &kept),
        }),
    })
}

fn some_of(ragged: &Ragged, kept: &[usize]) -> Ragged {
    Ragged::new(kept.iter().map(|&i| ragged.of(i)))
}
