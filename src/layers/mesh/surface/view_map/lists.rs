//! What all views tell the cells of one layer: for each cell a list.

use std::ops::Range;

use super::entries::{Entry, Told};

/// What is told to the cells of one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// Where the list of each cell begins; one more at the end.
    starts: Vec<u32>,
    /// The views, by cells, each list ascending.
    pub views: Vec<u8>,
    /// What they tell.
    pub entries: Vec<Entry>,
}

impl Lists {
    /// Joins what views tell so many cells.
    pub fn new(cells: usize, told: &[&Told]) -> Lists {
        let mut starts = vec![0_u32; cells + 1];
        for cell in told.iter().flat_map(|told| &told.cells) {
            starts[*cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let count = starts[cells] as usize;
        let mut next = starts.clone();
        let (mut views, mut entries) = (vec![0; count], vec![Entry::default(); count]);
        for (view, told) in told.iter().enumerate() {
            for (cell, entry) in told.cells.iter().zip(&told.entries) {
                let at = &mut next[*cell as usize];
                (views[*at as usize], entries[*at as usize]) = (view as u8, *entry);
                *at += 1;
            }
        }
        Lists { starts, views, entries }
    }

    /// Where the list of a cell is.
    #[inline]
    pub fn of(&self, cell: u32) -> Range<usize> {
        self.starts[cell as usize] as usize..self.starts[cell as usize + 1] as usize
    }

    /// What one view tells.
    pub fn told(&self, view: u8, origins: [usize; 4]) -> Told {
        let mut told = Told { origins, ..Told::default() };
        for cell in 0..self.starts.len().saturating_sub(1) as u32 {
            if let Some(at) = self.of(cell).find(|at| self.views[*at] == view) {
                told.cells.push(cell);
                told.entries.push(self.entries[at]);
            }
        }
        told
    }
}
