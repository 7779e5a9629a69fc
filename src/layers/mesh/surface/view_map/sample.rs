//! What a frame reads from a map at one place.

use glam::{DVec2, DVec3};

use super::cells::NONE;
use super::coat::{self, State};
use super::gauge::Gauges;
use super::map::Map;
use super::mix::{Part, mix};

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

/// A map that is read.
pub struct Reader<'a> {
    map: &'a Map,
    gauges: Gauges,
    parts: Vec<Part>,
}

impl<'a> Reader<'a> {
    /// Reads a map.
    pub fn new(map: &'a Map) -> Reader<'a> {
        Reader { map, gauges: Gauges::default(), parts: Vec::new() }
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

    /// What is where there are no cells at all.
    fn missing(&self) -> Sample {
        let missing = self.map.wanted.missing.map(f64::from);
        Sample { independent: missing, over: missing, ..Sample::default() }
    }

    /// Calls `each` with the share that each view has at a place in what is shown there: near its camera, and in the base
    /// coat.
    pub fn everyone(&mut self, spot: &Spot, mut each: impl FnMut(usize, f64)) {
        let map = self.map;
        self.gauges.set(&map.wanted.views, spot.point, spot.eye);
        for (layer, cell, weight) in self.cells(spot).into_iter().filter(|(.., weight)| *weight > 0.0) {
            let opacity = if self.gauges.none() { 0.0 } else { self.mixed(layer, cell) };
            if opacity > 0.0 {
                self.parts.iter().for_each(|part| each(part.view, weight * part.share));
            }
            let whole = coat::parts(&map.lists[layer], cell, layer, &map.wanted.views, &mut self.parts);
            if whole > 0.0 {
                self.parts.iter().for_each(|part| each(part.view, weight * (1.0 - opacity) * part.share / whole));
            }
        }
    }

    /// What is at a place. `each` is told the share that each view has there in what depends on the direction.
    #[inline]
    pub fn at(&mut self, spot: &Spot, mut each: impl FnMut(usize, f64)) -> Sample {
        let map = self.map;
        let mut sample = Sample::default();
        self.gauges.set(&map.wanted.views, spot.point, spot.eye);
        let cells = self.cells(spot);
        if cells.iter().all(|(.., weight)| *weight <= 0.0) {
            return self.missing();
        }
        for (layer, cell, weight) in cells.into_iter().filter(|(.., weight)| *weight > 0.0) {
            let opacity = if self.gauges.none() { 0.0 } else { self.mixed(layer, cell) };
            let (lists, coat) = (&map.lists[layer], &map.coats[layer]);
            let mut dependent = [0.0; 3];
            if opacity > 0.0 {
                for part in &self.parts {
                    let color = lists.entries[part.entry].color;
                    dependent.iter_mut().zip(color).for_each(|(sum, light)| *sum += part.share * f64::from(light));
                    each(part.view, weight * part.share);
                }
            }
            let coated = coat.colors[cell as usize].map(f64::from);
            for k in 0..3 {
                sample.independent[k] += weight * coated[k];
                sample.dependent[k] += weight * dependent[k];
                sample.over[k] += weight * (dependent[k] + (1.0 - opacity) * coated[k]);
            }
            sample.opacity += weight * opacity;
            sample.known += if coat.states[cell as usize] == State::Known { weight } else { 0.0 };
        }
        sample
    }

    /// Mixes the views that depend on the direction at a cell. Returns how opaque they are.
    #[inline]
    fn mixed(&mut self, layer: usize, cell: u32) -> f64 {
        let lists = &self.map.lists[layer];
        let range = lists.of(cell);
        self.parts.clear();
        let (views, entries) = (&lists.views[range.clone()], &lists.entries[range.clone()]);
        for (at, (view, entry)) in views.iter().zip(entries).enumerate() {
            let slot = self.gauges.slot(*view);
            if slot == NONE {
                continue;
            }
            let strength =
                views.iter().zip(entries).map(|(view, entry)| (*view, f64::from(entry.mask) * f64::from(entry.facing)));
            let gauge = self.gauges.gauge(slot, strength);
            let view = usize::from(*view);
            let factor = self.map.wanted.views[view].fade.factor(gauge);
            if factor > 0.0 {
                self.parts.push(Part::new(range.start + at, view, entry, factor, layer));
            }
        }
        mix(&mut self.parts)
    }
}
