//! Lays out the cells of a form or a table. Rows with the same cells share their columns. Columns that do not fit are left
//! out as a whole, because half a number reads as another number; the first column of a table always stays.

use crate::scene::field::Kind;
use crate::tui::document::cell::Cell;
use crate::tui::document::sheet::Row;
use crate::tui::text::numbers;
use crate::tui::text::wrap::{clipped, width};

/// Columns between two cells, with room for the mark that says that cells are left out.
pub const GAP: i32 = 2;

/// Where a cell is in its row, right of the label.
pub struct Placed<'a> {
    pub cell: &'a Cell,
    /// Where its name begins; `None` if that is not shown.
    pub head: Option<i32>,
    /// Where it begins, including its name.
    start: i32,
    /// Where its text begins.
    pub at: i32,
    /// The text.
    pub text: String,
    /// Where its column ends.
    pub end: i32,
}

/// The widths of the columns, for each group of rows with the same cells.
pub struct Columns<'a> {
    /// The names above the table: those of its longest row; empty above a form.
    pub heads: Vec<&'a str>,
    table: bool,
    room: i32,
    groups: Vec<(Vec<&'a str>, Vec<i32>)>,
}

impl<'a> Columns<'a> {
    /// The columns of these rows in so much room.
    pub fn of(rows: &'a [Row], table: bool, room: i32) -> Self {
        let heads = |row: &'a Row| row.cells.iter().map(|cell| cell.head.as_str());
        let mut groups: Vec<(Vec<&str>, Vec<i32>)> = Vec::new();
        for row in rows.iter().filter(|row| row.item) {
            let known = groups.iter().position(|(group, _)| heads(row).eq(group.iter().copied()));
            let known = known.unwrap_or_else(|| {
                groups.push((heads(row).collect(), vec![0; row.cells.len()]));
                groups.len() - 1
            });
            for (widest, cell) in groups[known].1.iter_mut().zip(&row.cells) {
                *widest = i32::from(width(&text(cell, row, room))).max(*widest);
            }
        }
        // The first of the longest, so that the names stay the same while scrolling.
        let longest = groups.iter().rev().max_by_key(|(group, _)| group.len()).filter(|_| table);
        Columns { heads: longest.map(|(group, _)| group.clone()).unwrap_or_default(), table, room, groups }
    }

    /// Lays out the cells of a row in the columns of its group, each with its name unless that is above the table.
    pub fn lay(&self, row: &'a Row) -> Vec<Placed<'a>> {
        let heads = || row.cells.iter().map(|cell| cell.head.as_str());
        let group = self.groups.iter().filter(|_| row.item).find(|(group, _)| heads().eq(group.iter().copied()));
        let under_heads = row.item && heads().eq(self.heads.iter().copied());
        let mut x = 0;
        let place = |(c, cell): (usize, &'a Cell)| {
            // The kind of an item needs no name.
            let says_itself = c == 0 && matches!(cell.field.kind, Kind::Choice(_));
            let text = text(cell, row, self.room);
            let own = i32::from(width(&text));
            let widest = group.map_or(own, |(_, widths)| widths[c]);
            let named = !under_heads && !says_itself && !cell.head.is_empty() && (row.cells.len() > 1 || self.table);
            let name = i32::from(width(&cell.head));
            let wide = if under_heads { widest.max(name) } else { widest };
            let start = x;
            let text_at = start + if named { name + 1 } else { 0 };
            let at = if cell.is_number() { text_at + wide - own } else { text_at };
            let end = text_at + wide;
            x = end + GAP;
            Placed { cell, head: named.then_some(start), start, at, text, end }
        };
        row.cells.iter().enumerate().map(place).collect()
    }
}

/// What a cell shows in a row of this width: a text beside other cells takes at most half of it.
fn text(cell: &Cell, row: &Row, room: i32) -> String {
    let room = usize::try_from(room).unwrap_or(0);
    match cell.is_number() {
        true => numbers::fitted(&cell.text, room.saturating_sub(2).max(4)),
        false if row.cells.len() > 1 => clipped(&cell.text, (room / 2).max(8)),
        false => clipped(&cell.text, room),
    }
}

/// Which cells of a row are visible, and how far they are moved to the left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VisibleCells {
    /// How many of the first cells stay where they are.
    frozen: usize,
    /// The first of the others.
    first: usize,
    /// The cell after the last one.
    end: usize,
    shift: i32,
}

impl VisibleCells {
    /// The visible cells of a row, with the cell `focus` among them; of an item, so many of the first cells stay, if they
    /// leave room for others.
    pub fn of(row: &[Placed], stay: usize, focus: usize, room: i32) -> VisibleCells {
        let fits = |count: &usize| row[count - 1].end <= room / 2 || *count == 1;
        let frozen = (1..=stay.min(focus).min(row.len().saturating_sub(1))).take_while(fits).last().unwrap_or(0);
        let least = frozen;
        let focus = focus.min(row.len().saturating_sub(1));
        let from = (least..=focus).map(|first| VisibleCells::from(row, frozen, first, room));
        from.into_iter().find(|visible| visible.end > focus).unwrap_or_else(|| {
            let visible = VisibleCells::from(row, frozen, focus, room);
            VisibleCells { end: visible.end.max((focus + 1).min(row.len())), ..visible }
        })
    }

    /// The visible cells of a row that is shown below one with other columns.
    pub fn beside(row: &[Placed], other: VisibleCells, room: i32) -> VisibleCells {
        let frozen = other.frozen.min(row.len().saturating_sub(1));
        let first = if other.first <= other.frozen { frozen } else { other.first };
        VisibleCells::from(row, frozen, first.min(row.len().saturating_sub(1)), room)
    }

    fn from(row: &[Placed], frozen: usize, first: usize, room: i32) -> VisibleCells {
        // One more column for the mark.
        let begin = if frozen > 0 { row[frozen - 1].end + GAP + 1 } else { GAP };
        let scrolled = first > frozen;
        let shift = if scrolled { row.get(first).map_or(0, |placed| placed.start - begin) } else { 0 };
        let fits = |i: &usize| row[*i].end - shift <= room - if i + 1 < row.len() { GAP } else { 0 };
        let end = (first..row.len()).take_while(fits).last().map_or(first, |last| last + 1);
        VisibleCells { frozen, first, end, shift }
    }

    /// The visible cells: index, place, and how far it is moved.
    pub fn cells<'r, 'a>(self, row: &'r [Placed<'a>]) -> impl Iterator<Item = (usize, &'r Placed<'a>, i32)> {
        let stays = row.iter().enumerate().take(self.frozen.min(self.first)).map(|(i, placed)| (i, placed, 0));
        let others = row.iter().enumerate().take(self.end).skip(self.first);
        stays.chain(others.map(move |(i, placed)| (i, placed, self.shift)))
    }

    /// Where the mark for cells that are left out on the left belongs; `None` if there are none.
    pub fn before(self, row: &[Placed]) -> Option<i32> {
        let scrolled = self.first > self.frozen;
        scrolled.then(|| if self.frozen > 0 { row[self.frozen - 1].end + 1 } else { 0 })
    }

    /// Whether cells are left out on the right.
    pub fn goes_on(self, row: &[Placed]) -> bool {
        self.end < row.len()
    }
}
