//! What depends on the direction, kept at each cell for an array of directions: a frame then reads it, however many views
//! there are.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::frames::{self, Frame};
use super::map::Map;
use super::mixer::Mixer;
use crate::base::half::{half_of_value, value_of_half};

/// The memory of an element, in bytes.
pub const ELEMENT_BYTES: u64 = 8;

/// The arrays of all cells.
#[derive(Debug)]
pub struct Arrays {
    /// How many directions there are along a side.
    side: usize,
    /// How the cells of each layer are turned.
    pub frames: Vec<Vec<Frame>>,
    /// The elements of each layer, cell after cell, row by row: half floats, light times opacity, then that.
    pub elements: Vec<Vec<[u16; 4]>>,
}

impl Arrays {
    /// The arrays of a map, so many directions along a side. `None` if it was stopped.
    pub fn new(map: &Map, side: usize, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Arrays> {
        let frames = frames::all(map);
        let of_layer = |(layer, frames): (usize, &Vec<Frame>)| elements(map, (layer, 0), frames, side, stopped);
        let elements = frames.iter().enumerate().map(of_layer).collect();
        (!stopped()).then_some(Arrays { side, frames, elements })
    }

    /// How many directions there are along a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The memory of the elements.
    pub fn bytes(&self) -> u64 {
        self.elements.iter().map(|layer| layer.len() as u64 * ELEMENT_BYTES).sum()
    }

    /// What a cell has in a direction: light times opacity, then that.
    pub fn read(&self, layer: usize, cell: u32, way: DVec3) -> [f64; 4] {
        let most = (self.side - 1) as f64;
        let at = self.frames[layer][cell as usize].direction(way);
        let at = ((at + 1.0) * (self.side as f64 / 2.0) - 0.5).clamp(DVec2::ZERO, DVec2::splat(most));
        let (x, y) = (at.x as usize, at.y as usize);
        let (right, down) = ((x + 1).min(self.side - 1), (y + 1).min(self.side - 1));
        let (wx, wy) = (at.x - x as f64, at.y - y as f64);
        let elements = &self.elements[layer][cell as usize * self.side * self.side..][..self.side * self.side];
        let corners = [
            (x, y, (1.0 - wx) * (1.0 - wy)),
            (right, y, wx * (1.0 - wy)),
            (x, down, (1.0 - wx) * wy),
            (right, down, wx * wy),
        ];
        let mut sum = [0.0; 4];
        for (x, y, weight) in corners {
            let element = elements[y * self.side + x];
            sum.iter_mut().zip(element).for_each(|(sum, bits)| *sum += weight * f64::from(value_of_half(bits)));
        }
        sum
    }
}

/// The elements of cells of a layer from the `first` on, which are turned so; nothing in particular if it was stopped.
pub fn elements(
    map: &Map,
    (layer, first): (usize, usize),
    frames: &[Frame],
    side: usize,
    stopped: &(dyn Fn() -> bool + Sync),
) -> Vec<[u16; 4]> {
    let mut elements = vec![[0; 4]; frames.len() * side * side];
    let cells = elements.par_chunks_mut(side * side).zip(frames).enumerate();
    cells.for_each_init(
        || Mixer::new(map),
        |mixer, (cell, (elements, frame))| {
            for (i, element) in elements.iter_mut().enumerate().filter(|_| !stopped()) {
                let at = |i: usize| 2.0 * (i as f64 + 0.5) / side as f64 - 1.0;
                mixer.look(frame.at, frame.way(DVec2::new(at(i % side), at(i / side))));
                let found = mixer.at(layer, (first + cell) as u32, |_, _| ());
                *element = found.map(|value| half_of_value(value as f32));
            }
        },
    );
    elements
}
