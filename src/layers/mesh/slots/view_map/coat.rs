//! The base coat: what is seen from everywhere.

use rayon::prelude::*;

use super::cells::{Cells, Layer, NONE};
use super::lists::Lists;
use super::mix::{Part, mix};
use super::view::View;

/// How a cell got its base coat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// No view tells anything near it.
    Missing,
    /// From cells round it or above it.
    Filled,
    /// From views.
    Known,
}

/// The base coat of one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coat {
    /// The color of each cell, in linear light.
    pub colors: Vec<[f32; 3]>,
    /// How it got it.
    pub states: Vec<State>,
}

impl Coat {
    /// How many cells are in this state.
    pub fn count(&self, state: State) -> usize {
        self.states.iter().filter(|own| **own == state).count()
    }
}

/// Collects the views of the base coat at a cell, and mixes them. Returns how opaque they are.
pub fn parts(lists: &Lists, cell: u32, layer: usize, views: &[View], parts: &mut Vec<Part>) -> f64 {
    parts.clear();
    let own = lists.of(cell).filter(|at| views[usize::from(lists.views[*at])].base);
    parts.extend(own.map(|at| Part::new(at, usize::from(lists.views[at]), &lists.entries[at], 1.0, layer)));
    mix(parts)
}

/// What views told before, the base coat of that, and which views tell the same as before.
pub type Before<'a> = (&'a [Lists], &'a [Coat], &'a [bool]);

/// The base coat of all layers; what was known `before` of cells that are told the same is kept.
pub fn coats(cells: &Cells, lists: &[Lists], views: &[View], missing: [f32; 3], before: Option<Before>) -> Vec<Coat> {
    let mut coats: Vec<Coat> = Vec::with_capacity(lists.len());
    for (number, (layer, lists)) in cells.layers.iter().zip(lists).enumerate() {
        let before = before.map(|(lists, coats, same)| (&lists[number], &coats[number], same));
        let mut coat = known(layer, lists, (number, before), views, missing);
        match coats.last() {
            None => fill_from_beside(layer, &mut coat),
            Some(above) => fill_from_above(layer, &mut coat, &cells.layers[number - 1], above),
        }
        coats.push(coat);
    }
    coats
}

fn known(
    layer: &Layer,
    lists: &Lists,
    (number, before): (usize, Option<(&Lists, &Coat, &[bool])>),
    views: &[View],
    missing: [f32; 3],
) -> Coat {
    let is_base = |view: u8| views[usize::from(view)].base;
    let cells = (0..layer.len() as u32).into_par_iter().map_init(Vec::new, |found: &mut Vec<Part>, cell| {
        if let Some((told, coat, same)) = before
            && coat.states[cell as usize] == State::Known
            && lists.tell_the_same(told, cell, same, is_base)
        {
            return (coat.colors[cell as usize], State::Known);
        }
        let opacity = parts(lists, cell, number, views, found);
        if opacity <= 0.0 {
            return (missing, State::Missing);
        }
        let mut color = [0.0; 3];
        for part in found.iter() {
            let entry = &lists.entries[part.entry];
            color.iter_mut().zip(entry.color).for_each(|(sum, light)| *sum += part.share * f64::from(light));
        }
        (color.map(|light| (light / opacity) as f32), State::Known)
    });
    let (colors, states) = cells.unzip();
    Coat { colors, states }
}

/// Fills a layer from its own cells, round by round.
fn fill_from_beside(layer: &Layer, coat: &mut Coat) {
    let empty = |coat: &Coat| -> Vec<u32> {
        (0..layer.len() as u32).filter(|cell| coat.states[*cell as usize] == State::Missing).collect()
    };
    let mut left = empty(coat);
    loop {
        let found = left.iter().filter_map(|cell| {
            let around = layer.around(&layer.cells[*cell as usize]);
            Some((*cell, mean(coat, around.map(|other| (other, 1.0)))?))
        });
        let found: Vec<(u32, [f32; 3])> = found.collect();
        if found.is_empty() {
            return;
        }
        set(coat, found);
        left.retain(|cell| coat.states[*cell as usize] == State::Missing);
    }
}

/// Fills a layer from the one above.
fn fill_from_above(layer: &Layer, coat: &mut Coat, coarser: &Layer, above: &Coat) {
    let missing = (0..layer.len()).filter(|cell| coat.states[*cell] == State::Missing);
    let found = missing.filter_map(|cell| Some((cell as u32, mean(above, coarser.above(&layer.cells[cell]))?)));
    let found: Vec<(u32, [f32; 3])> = found.collect();
    set(coat, found);
}

fn set(coat: &mut Coat, found: Vec<(u32, [f32; 3])>) {
    for (cell, color) in found {
        (coat.colors[cell as usize], coat.states[cell as usize]) = (color, State::Filled);
    }
}

/// The mean of those cells that have a color.
fn mean<const N: usize>(coat: &Coat, of: [(u32, f64); N]) -> Option<[f32; 3]> {
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    for (cell, weight) in of {
        if cell == NONE || coat.states[cell as usize] == State::Missing {
            continue;
        }
        let color = coat.colors[cell as usize];
        sum.iter_mut().zip(color).for_each(|(sum, light)| *sum += weight * f64::from(light));
        weights += weight;
    }
    (weights > 0.0).then(|| sum.map(|sum| (sum / weights) as f32))
}
