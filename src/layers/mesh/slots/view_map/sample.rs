//! What a frame reads from a map at one place.

use glam::{DVec2, DVec3};

use super::arrays::Arrays;
use super::cells::NONE;
use super::coat::{self, State};
use super::map::Map;
use super::mix::Part;
use super::mixer::Mixer;

/// A place of the surface as it is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The triangle.
    pub triangle: usize,
    /// How much each of its corners counts.
    pub weights: [f64; 3],
    /// The point of the unbent model.
    pub point: DVec3,
    /// The unit vector from there to the eye, in the model.
    pub eye: DVec3,
    /// The depth of the pixel, in layers.
    pub depth: f64,
}

/// What is there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// The base coat.
    pub independent: [f64; 3],
    /// What depends on the direction, times its opacity.
    pub dependent: [f64; 3],
    /// How opaque that is.
    pub opacity: f64,
    /// The second over the first, cell by cell.
    pub over: [f64; 3],
    /// How much of the base coat views tell.
    pub known: f64,
}

impl Sample {
    /// What is shown where so much of the base coat alone is seen.
    pub fn shown(&self, base: f64) -> [f64; 3] {
        std::array::from_fn(|k| base * self.independent[k] + (1.0 - base) * self.over[k])
    }
}

/// A map that is read.
pub struct Reader<'a> {
    map: &'a Map,
    arrays: Option<&'a Arrays>,
    mixer: Mixer<'a>,
    parts: Vec<Part>,
}

/// What is told the share that each view has in what depends on the direction.
pub type Each<'a> = Option<&'a mut dyn FnMut(usize, f64)>;

impl<'a> Reader<'a> {
    /// Reads a map; directions by its arrays, if it has some.
    pub fn new(map: &'a Map, arrays: Option<&'a Arrays>) -> Reader<'a> {
        Reader { map, arrays, mixer: Mixer::new(map), parts: Vec::new() }
    }

    /// The cells that count at a place, by layer, and how much.
    fn cells(&self, spot: &Spot) -> [(usize, u32, f64); 8] {
        let map = self.map;
        let mut found = [(0, NONE, 0.0); 8];
        let Some(finest) = map.cells.layers.len().checked_sub(1) else { return found };
        let chart = map.atlas.chart[spot.triangle];
        let at: DVec2 = map.atlas.at(spot.triangle, spot.weights);
        let depth = spot.depth.clamp(0.0, finest as f64);
        let near = depth - depth.floor();
        let mut all = 0.0;
        for (k, share) in [1.0 - near, near].into_iter().enumerate().filter(|(_, share)| *share > 0.0) {
            let number = depth as usize + k;
            let layer = &map.cells.layers[number];
            let four = layer.four(chart, at * layer.resolution);
            let sum: f64 = four.iter().filter(|(cell, _)| *cell != NONE).map(|(_, weight)| weight).sum();
            if sum > 0.0 {
                all += share;
                for (out, (cell, weight)) in found[4 * k..].iter_mut().zip(four) {
                    *out = (number, cell, if cell == NONE { 0.0 } else { share * weight / sum });
                }
            }
        }
        // Where a layer has no cell, the other counts alone.
        if all > 0.0 && all < 1.0 {
            found.iter_mut().for_each(|(.., weight)| *weight /= all);
        }
        found
    }

    /// The base coat of a place, however it is looked at.
    pub fn coated(&self, spot: &Spot) -> [f64; 3] {
        let cells = self.cells(spot);
        if cells.iter().all(|(.., weight)| *weight <= 0.0) {
            return self.map.wanted.missing.map(f64::from);
        }
        let mut sum = [0.0; 3];
        for (layer, cell, weight) in cells.into_iter().filter(|(.., weight)| *weight > 0.0) {
            let color = self.map.coats[layer].colors[cell as usize];
            sum.iter_mut().zip(color).for_each(|(sum, light)| *sum += weight * f64::from(light));
        }
        sum
    }

    /// What a place shows that has no cells at all.
    fn missing(&self) -> Sample {
        let missing = self.map.wanted.missing.map(f64::from);
        Sample { independent: missing, over: missing, ..Sample::default() }
    }

    /// Calls `each` with the share that each view has at a place in what is shown there: near its camera, and in the base
    /// coat.
    pub fn everyone(&mut self, spot: &Spot, mut each: impl FnMut(usize, f64)) {
        let map = self.map;
        self.mixer.look(spot.point, spot.eye);
        for (layer, cell, weight) in self.cells(spot).into_iter().filter(|(.., weight)| *weight > 0.0) {
            let [.., opacity] = self.mixer.at(layer, cell, |view, share| each(view, weight * share));
            let whole = coat::parts(&map.lists[layer], cell, layer, &map.wanted.views, &mut self.parts);
            if whole > 0.0 {
                self.parts.iter().for_each(|part| each(part.view, weight * (1.0 - opacity) * part.share / whole));
            }
        }
    }

    /// What is at a place. `each` is told the share that each view has there in what depends on the direction.
    #[inline]
    pub fn at(&mut self, spot: &Spot, mut each: Each) -> Sample {
        let map = self.map;
        let mut sample = Sample::default();
        let exact = self.arrays.is_none() || each.is_some();
        if exact {
            self.mixer.look(spot.point, spot.eye);
        }
        let cells = self.cells(spot);
        if cells.iter().all(|(.., weight)| *weight <= 0.0) {
            return self.missing();
        }
        for (layer, cell, weight) in cells.into_iter().filter(|(.., weight)| *weight > 0.0) {
            let mut found = [0.0; 4];
            if exact {
                let mut tell = |view: usize, share: f64| each.iter_mut().for_each(|each| each(view, weight * share));
                found = self.mixer.at(layer, cell, &mut tell);
            }
            if let Some(arrays) = self.arrays {
                found = arrays.read(layer, cell, spot.eye);
            }
            let coat = &map.coats[layer];
            let coated = coat.colors[cell as usize].map(f64::from);
            for k in 0..3 {
                sample.independent[k] += weight * coated[k];
                sample.dependent[k] += weight * found[k];
                sample.over[k] += weight * (found[k] + (1.0 - found[3]) * coated[k]);
            }
            sample.opacity += weight * found[3];
            sample.known += if coat.states[cell as usize] == State::Known { weight } else { 0.0 };
        }
        sample
    }
}
