//! What a view tells the cells: its own pixels, and what follows from them for cells of other sizes and beside them.

use rayon::prelude::*;

use super::cells::{Cells, Layer, NONE};
use super::id::{Pixel, Seen};
use crate::base::pixels::Rgba;

/// How a cell got what a view tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Origin {
    /// From pixels of the view.
    Own,
    /// From the cells that it is made of.
    Finer,
    /// From the cell that it is a part of, and its neighbors.
    Coarser,
    /// From the cells round it.
    Beside,
}

/// What a view tells a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// The color: linear light.
    pub color: [f32; 3],
    /// How much of the cell the view tells.
    pub mask: f32,
    /// How much it counts by the angle that it was seen at.
    pub facing: f32,
    /// Its depth in layers.
    pub depth: f32,
}

/// What a view tells the cells of one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// The cells, ascending.
    pub cells: Vec<u32>,
    /// What is told to each.
    pub entries: Vec<Entry>,
    /// How many got it in each way, in the order of [`Origin`].
    pub origins: [usize; 4],
}

/// What limits how near and how far a view reaches, in layers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// How many layers closer it is whole.
    pub closer: Option<f64>,
    /// How many layers farther it is whole.
    pub farther: Option<f64>,
}

/// An entry in the making.
#[derive(Clone, Copy, Default)]
struct Sum {
    /// Mask times color.
    light: [f64; 3],
    mask: f64,
    facing: f64,
    depth: f64,
    /// The weight of its own pixels.
    weight: f64,
    /// How it was made; `None` if there is no entry.
    origin: Option<Origin>,
}

impl Sum {
    /// Adds so much of another.
    #[inline]
    fn add(&mut self, other: &Sum, weight: f64) {
        for (sum, light) in self.light.iter_mut().zip(other.light) {
            *sum += light * weight;
        }
        self.mask += other.mask * weight;
        self.facing += other.facing * weight;
        self.depth += other.depth * weight;
        self.weight += weight;
    }

    /// The mean of what was added.
    #[inline]
    fn mean(&self, origin: Origin) -> Sum {
        let by = 1.0 / self.weight;
        let Sum { light, mask, facing, depth, weight, .. } = *self;
        let [light, [mask, facing, depth]] = [light, [mask, facing, depth]].map(|all| all.map(|sum| sum * by));
        Sum { light, mask, facing, depth, weight, origin: Some(origin) }
    }
}

/// Who does the work for a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// One thread, as others are busy with other views.
    Alone,
    /// All threads.
    Shared,
}

impl Work {
    /// The fewest cells that are worth a thread.
    fn least(self) -> usize {
        match self {
            Work::Alone => usize::MAX,
            Work::Shared => 1 << 13,
        }
    }
}

/// What a view that sees this, with these pixels, tells the cells of each layer. The bytes do not depend on who does the work.
pub fn told(cells: &Cells, (seen, pixels): (&Seen, &[Rgba]), reach: Reach, work: Work) -> Vec<Told> {
    let least = work.least();
    let mut sums = own(cells, seen, pixels, work);
    for layer in (0..cells.layers.len().saturating_sub(1)).rev() {
        let [coarser, finer] = [layer, layer + 1].map(|layer| &cells.layers[layer]);
        let (own, children) = sums.split_at_mut(layer + 1);
        from_finer((coarser, &mut own[layer]), (finer, &children[0]), least);
    }
    for (layer, sums) in cells.layers.iter().zip(&mut sums) {
        from_beside(layer, sums, least);
    }
    for layer in 1..cells.layers.len() {
        let (above, own) = sums.split_at_mut(layer);
        let coarser = (&cells.layers[layer - 1], &above[layer - 1][..]);
        from_coarser((&cells.layers[layer], &mut own[0]), coarser, layer, least);
    }
    let layers = sums.par_iter().enumerate().with_min_len(least);
    layers.map(|(layer, sums)| finished(sums, |depth| within(reach, layer as f64, depth))).collect()
}

/// The means of a view's own pixels. Each pixel counts on two layers that follow one another: of those with even numbers on one.
fn own(cells: &Cells, seen: &Seen, pixels: &[Rgba], work: Work) -> Vec<Vec<Sum>> {
    let [even, odd] = [0, 1].map(|first| move || own_on(cells, seen, pixels, first));
    let (even, odd) = match work {
        Work::Alone => (even(), odd()),
        Work::Shared => rayon::join(even, odd),
    };
    let mut sums: Vec<Vec<Sum>> = cells.layers.iter().map(|_| Vec::new()).collect();
    sums.iter_mut().step_by(2).zip(even).for_each(|(sums, own)| *sums = own);
    sums.iter_mut().skip(1).step_by(2).zip(odd).for_each(|(sums, own)| *sums = own);
    sums
}

/// Those of every second layer from `first`, 0 or 1, on.
fn own_on(cells: &Cells, seen: &Seen, pixels: &[Rgba], first: usize) -> Vec<Vec<Sum>> {
    let own = cells.layers.iter().skip(first).step_by(2);
    let mut sums: Vec<Vec<Sum>> = own.map(|layer| vec![Sum::default(); layer.len()]).collect();
    let Some(finest) = cells.layers.len().checked_sub(1) else { return sums };
    for pixel in seen.bands.iter().flatten().filter(|pixel| pixel.facing > 0.0) {
        let depth = pixel.depth.clamp(0.0, finest as f64);
        let layer = depth.floor() as usize;
        let near = depth - layer as f64;
        let (layer, share) = if layer % 2 == first { (layer, 1.0 - near) } else { (layer + 1, near) };
        if share <= 0.0 {
            continue;
        }
        let down = Pixel::FINEST - layer;
        let cell = cells.layers[layer].find(pixel.chart, (pixel.x >> down) as i32, (pixel.y >> down) as i32);
        if cell == NONE {
            continue;
        }
        let [r, g, b, counts] = pixels[pixel.at as usize].map(f64::from);
        let weight = share * pixel.share * f64::from(1_u32 << (2 * layer));
        let sum = &mut sums[layer / 2][cell as usize];
        for (sum, light) in sum.light.iter_mut().zip([r, g, b]) {
            *sum += weight * light;
        }
        sum.mask += weight * counts;
        sum.facing += weight * pixel.facing;
        sum.depth += weight * depth;
        sum.weight += weight;
    }
    for sum in sums.iter_mut().flatten().filter(|sum| sum.weight > 0.0) {
        *sum = sum.mean(Origin::Own);
    }
    sums
}

/// Completes a layer by what the next one has.
fn from_finer((layer, sums): (&Layer, &mut [Sum]), (finer, below): (&Layer, &[Sum]), least: usize) {
    layer.cells.par_iter().zip(sums).with_min_len(least).for_each(|(cell, sum)| {
        let (mut found, mut count, mut masks) = (Sum::default(), 0.0, 0.0);
        for child in Layer::children(cell, finer).into_iter().filter(|child| *child != NONE) {
            let child = &below[child as usize];
            if child.origin.is_none() {
                continue;
            }
            count += 1.0;
            masks += child.mask;
            for (sum, light) in found.light.iter_mut().zip(child.light) {
                *sum += light;
            }
            found.facing += child.facing * child.mask;
            found.depth += child.depth * child.mask;
        }
        if masks <= 0.0 {
            return;
        }
        let light = found.light.map(|light| light / count);
        let finer = Sum {
            light,
            mask: masks / count,
            facing: found.facing / masks,
            depth: found.depth / masks,
            weight: 0.0,
            origin: Some(Origin::Finer),
        };
        *sum = match sum.origin {
            None => finer,
            Some(origin) => {
                let own = sum.weight.min(1.0);
                let mut both = Sum::default();
                both.add(sum, own);
                both.add(&finer, 1.0 - own);
                Sum { origin: Some(origin), ..both }
            }
        };
    });
}

/// Closes the gaps that a raster leaves.
fn from_beside(layer: &Layer, sums: &mut [Sum], least: usize) {
    let empty =
        layer.cells.par_iter().enumerate().with_min_len(least).filter(|(number, _)| sums[*number].origin.is_none());
    let found = empty.filter_map(|(number, cell)| {
        let mut sum = Sum::default();
        for other in layer.around(cell).into_iter().filter(|other| *other != NONE) {
            if sums[other as usize].origin.is_some() {
                sum.add(&sums[other as usize], 1.0);
            }
        }
        (sum.weight > 0.0).then(|| (number, sum.mean(Origin::Beside)))
    });
    let found: Vec<(usize, Sum)> = found.collect();
    found.into_iter().for_each(|(number, sum)| sums[number] = sum);
}

/// Fills what the layer above can tell, where it was measured there.
fn from_coarser((layer, sums): (&Layer, &mut [Sum]), (coarser, above): (&Layer, &[Sum]), number: usize, least: usize) {
    let all = layer.cells.par_iter().zip(sums).with_min_len(least);
    all.filter(|(_, sum)| sum.origin.is_none()).for_each(|(cell, sum)| {
        let mut found = Sum::default();
        for (other, weight) in coarser.above(cell).into_iter().filter(|(other, _)| *other != NONE) {
            let other = &above[other as usize];
            let measured = other.origin.is_some_and(|origin| origin != Origin::Beside) && other.depth <= number as f64;
            if measured {
                found.add(other, weight);
            }
        }
        if found.weight > 0.0 {
            *sum = found.mean(Origin::Coarser);
        }
    });
}

/// How much of an entry of this depth is left on a layer.
fn within(reach: Reach, layer: f64, depth: f64) -> f64 {
    let left = |most: Option<f64>, far: f64| most.map_or(1.0, |most| (most + 1.0 - far).clamp(0.0, 1.0));
    left(reach.closer, layer - depth) * left(reach.farther, depth - layer)
}

fn finished(sums: &[Sum], left: impl Fn(f64) -> f64) -> Told {
    let mut told = Told::default();
    for (cell, sum) in sums.iter().enumerate() {
        let Some(origin) = sum.origin else { continue };
        let mask = (sum.mask * left(sum.depth)) as f32;
        if mask <= 0.0 {
            continue;
        }
        told.cells.push(cell as u32);
        told.entries.push(Entry {
            color: sum.light.map(|light| (light / sum.mask) as f32),
            mask,
            facing: sum.facing as f32,
            depth: sum.depth as f32,
        });
        told.origins[origin as usize] += 1;
    }
    told
}
