//! The views that depend on the direction, mixed at a cell that is looked at from somewhere.

use glam::DVec3;

use super::cells::NONE;
use super::gauge::Gauges;
use super::map::Map;
use super::mix::{Part, mix};

/// Mixes views at one place after the other.
pub struct Mixer<'a> {
    map: &'a Map,
    gauges: Gauges<'a>,
    /// Where in the list of a cell each view is.
    places: Vec<u32>,
    parts: Vec<Part>,
}

impl<'a> Mixer<'a> {
    /// Mixes the views of a map.
    pub fn new(map: &'a Map) -> Mixer<'a> {
        Mixer {
            map,
            gauges: Gauges::new(&map.wanted.views),
            places: vec![NONE; map.wanted.views.len()],
            parts: Vec::new(),
        }
    }

    /// From now on cells are looked at from `eye`, a unit vector away from `place`.
    #[inline]
    pub fn look(&mut self, place: DVec3, eye: DVec3) {
        self.gauges.set(place, eye);
    }

    /// Mixes what views tell a cell: the color times its opacity, and that. `each` is told the share of each view.
    #[inline]
    pub fn at(&mut self, layer: usize, cell: u32, mut each: impl FnMut(usize, f64)) -> [f64; 4] {
        if self.gauges.near().is_empty() {
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
        for (at, view) in views.iter().enumerate() {
            self.places[usize::from(*view)] = at as u32;
        }
        let places = &self.places;
        let entry = |view: usize| {
            // The place may be of another cell.
            let at = places[view] as usize;
            (views.get(at).is_some_and(|found| usize::from(*found) == view)).then(|| (at, &entries[at]))
        };
        let strength = |view: usize| entry(view).map_or(0.0, |(_, told)| f64::from(told.mask) * f64::from(told.facing));
        for near in self.gauges.near() {
            let Some((at, told)) = entry(near.view) else { continue };
            let factor = self.map.wanted.views[near.view].fade.factor(self.gauges.gauge(near, strength));
            if factor > 0.0 {
                self.parts.push(Part::new(range.start + at, near.view, told, factor, layer));
            }
        }
        mix(&mut self.parts)
    }
}
