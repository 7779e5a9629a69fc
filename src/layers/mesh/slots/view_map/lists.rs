//! What all views tell the cells of one layer: for each cell a list.

use std::ops::Range;

use super::entries::{Entry, Told};

/// What is told to the cells of one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// Where the list of each cell begins; one more at the end.
    pub starts: Vec<u32>,
    /// The views, by cells, each list ascending.
    pub views: Vec<u8>,
    /// What they tell.
    pub entries: Vec<Entry>,
}

impl Lists {
    /// Joins what views, ascending, tell so many cells; of lists before, those views go on that are the same.
    pub fn new(cells: usize, before: Option<(&Lists, &[bool])>, fresh: &[(usize, &Told)]) -> Lists {
        let most = fresh.iter().map(|(_, told)| told.cells.len()).sum::<usize>()
            + before.map_or(0, |(before, _)| before.views.len());
        let mut lists = Lists {
            starts: Vec::with_capacity(cells + 1),
            views: Vec::with_capacity(most),
            entries: Vec::with_capacity(most),
        };
        lists.starts.push(0);
        let is_same = |view: u8| before.is_some_and(|(_, same)| same.get(usize::from(view)) == Some(&true));
        let mut next = vec![0; fresh.len()];
        // What goes on as it is, cell after cell, is copied at once.
        let mut whole = 0..0;
        for cell in 0..cells as u32 {
            let told_anew = fresh.iter().zip(&next).any(|((_, told), next)| told.cells.get(*next) == Some(&cell));
            let old = before.map_or(0..0, |(before, _)| before.of(cell));
            if let Some((before, _)) = before {
                if !told_anew && before.views[old.clone()].iter().all(|view| is_same(*view)) {
                    whole.end = old.end;
                    lists.starts.push((lists.views.len() + whole.len()) as u32);
                    continue;
                }
                lists.copy(before, whole);
            }
            whole = old.end..old.end;
            let old = before.iter().flat_map(|(before, _)| before.told_to(cell).filter(|(view, _)| is_same(*view)));
            let mut old = old.peekable();
            for ((view, told), next) in fresh.iter().zip(&mut next) {
                if told.cells.get(*next) == Some(&cell) {
                    while let Some((view, entry)) = old.next_if(|(own, _)| usize::from(*own) < *view) {
                        lists.push(view, entry);
                    }
                    lists.push(*view as u8, &told.entries[*next]);
                    *next += 1;
                }
            }
            old.for_each(|(view, entry)| lists.push(view, entry));
            lists.starts.push(lists.views.len() as u32);
        }
        before.into_iter().for_each(|(before, _)| lists.copy(before, whole.clone()));
        lists.views.shrink_to_fit();
        lists.entries.shrink_to_fit();
        lists
    }

    fn push(&mut self, view: u8, entry: &Entry) {
        self.views.push(view);
        self.entries.push(*entry);
    }

    fn copy(&mut self, other: &Lists, at: Range<usize>) {
        self.views.extend_from_slice(&other.views[at.clone()]);
        self.entries.extend_from_slice(&other.entries[at]);
    }

    /// Whether a cell is told the same in both, by views that are wanted; those that are `same` tell every cell the same.
    pub fn tell_the_same(&self, other: &Lists, cell: u32, same: &[bool], wanted: impl Fn(u8) -> bool) -> bool {
        let is_known = |view: &u8| same.get(usize::from(*view)) == Some(&true) || !wanted(*view);
        let are_known = |lists: &Lists| lists.views[lists.of(cell)].iter().all(is_known);
        if are_known(self) && are_known(other) {
            return true;
        }
        self.told_to(cell).filter(|(view, _)| wanted(*view)).eq(other.told_to(cell).filter(|(view, _)| wanted(*view)))
    }

    fn told_to(&self, cell: u32) -> impl Iterator<Item = (u8, &Entry)> {
        self.of(cell).map(|at| (self.views[at], &self.entries[at]))
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
