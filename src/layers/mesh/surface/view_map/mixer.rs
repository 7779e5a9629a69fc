//! The views that depend on the direction, mixed at a cell that is looked at from somewhere.

use glam::DVec3;

use super::cells::NONE;
use super::gauge::Gauges;
use super::map::Map;
use super::mix::{Part, mix};

/// Mixes views at one place after the other.
pub struct Mixer<'a> {
    map: &'a Map,
    gauges: Gauges,
    parts: Vec<Part>,
}

impl<'a> Mixer<'a> {
    /// Mixes the views of a map.
    pub fn new(map: &'a Map) -> Mixer<'a> {
        Mixer { map, gauges: Gauges::default(), parts: Vec::new() }
    }

    /// From now on cells are looked at from `eye`, a unit vector away from `place`.
    #[inline]
    pub fn look(&mut self, place: DVec3, eye: DVec3) {
        self.gauges.set(&self.map.wanted.views, place, eye);
    }

    /// Mixes what views tell a cell: the color times its opacity, and that. `each` is told the share of each view.
    #[inline]
    pub fn at(&mut self, layer: usize, cell: u32, mut each: impl FnMut(usize, f64)) -> [f64; 4] {
        if self.gauges.none() {
            return [0.0; 4];
        }
        let opacity = self.mixed(layer, cell);
        let mut sum = [0.0, 0.0, 0.0, opacity];
        for part in &self.parts {
            let color = self.map.lists[layer].entries[part.entry].color;
            sum.iter_mut().zip(color).for_each(|(sum, light)| *sum += part.share * f64::from(light));
            each(part.view, part.share);
        }
        sum
    }

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
            let strength = views.iter().zip(entries);
            let strength = strength.map(|(view, entry)| (*view, f64::from(entry.mask) * f64::from(entry.facing)));
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
