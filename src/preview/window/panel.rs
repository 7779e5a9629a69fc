//! A list of keys in the upper left corner, in as many columns as leave its letters largest. One that is too long to be read
//! then has several pages.

use kurbo::{Rect, Size, Vec2};

use super::canvas::Canvas;
use super::state::State;
use super::style::{ACCENT, MARGIN_PX, PANEL, TEXT, TEXT_PX};
use super::text::{LINE, Letters};
use crate::base::keys::KeyRow;

/// How much smaller letters are than others where there is little room, so that they can be read.
const LEAST: f64 = 0.75;
/// Logical pixels that a key and what it does take at most.
const COLUMN_PX: f64 = 560.0;

/// The last row of a page that is not the last.
static MORE: KeyRow = KeyRow { context: "", key: "?", command: "help", help: "More keys" };

/// How many rows can be read at once in an area of so many logical pixels.
fn rows_a_page(area: Size) -> usize {
    let rows = (area.height - 4.0 * MARGIN_PX) / (LINE * TEXT_PX * LEAST);
    let columns = (area.width / (COLUMN_PX * LEAST)).floor().max(1.0);
    (rows.floor().max(2.0) * columns) as usize
}

/// What is on a page of rows (the last, if there are less), and whether there are more behind it.
pub fn page(state: &State, rows: &'static [KeyRow], number: usize) -> (Vec<&'static KeyRow>, bool) {
    let most = rows_a_page(state.area() / state.scale);
    if rows.len() <= most {
        return (rows.iter().collect(), false);
    }
    let most = most - 1; // and that there are more
    let number = number.min((rows.len() - 1) / most);
    let own = rows.iter().skip(number * most).take(most);
    let more = (number + 1) * most < rows.len();
    (own.chain(more.then_some(&MORE)).collect(), more)
}

/// Draws rows of the key table into what is free of the area.
pub fn draw<'a>(
    canvas: &mut Canvas,
    state: &State,
    letters: &Letters,
    free: Rect,
    rows: impl Iterator<Item = &'a KeyRow>,
) {
    let rows: Vec<_> = rows.collect();
    let widest = |text: fn(&KeyRow) -> &str, height: f64| {
        rows.iter().map(|row| letters.width(text(row), height)).fold(0.0, f64::max)
    };
    // In logical pixels; then as much smaller as the window asks for.
    let (keys, line) = (widest(|r| r.key, TEXT_PX) + 1.5 * MARGIN_PX, LINE * TEXT_PX);
    let column = keys + widest(|r| r.help, TEXT_PX) + 2.0 * MARGIN_PX;
    let area = free.size() / state.scale;
    let fits = |columns: usize| {
        let width = column * columns as f64 + 2.0 * MARGIN_PX;
        let height = line * rows.len().div_ceil(columns) as f64 + 4.0 * MARGIN_PX;
        (area.width / width).min(area.height / height).min(1.0)
    };
    let columns = (1..=4).rev().max_by(|&a, &b| fits(a).total_cmp(&fits(b))).unwrap_or(1);
    let rows_a_column = rows.len().div_ceil(columns);
    let scale = state.scale * fits(columns);
    // Letters of whole half pixels, never larger than the room asks for.
    let height = ((TEXT_PX * scale * 2.0).floor() / 2.0).max(1.0);
    let [margin, line] = [MARGIN_PX, line].map(|length| length * scale);
    let keys = widest(|r| r.key, height) + 1.5 * margin;
    let column = keys + widest(|r| r.help, height) + 2.0 * margin;
    let frame = Rect::new(
        free.x0 + margin,
        free.y0 + margin,
        free.x0 + margin + column * columns as f64,
        free.y0 + 3.0 * margin + line * (rows_a_column as f64 - 1.0) + height,
    );
    canvas.rect(frame, 6.0 * scale, PANEL);
    for (i, row) in rows.iter().enumerate() {
        let (across, down) = ((i / rows_a_column) as f64, (i % rows_a_column) as f64);
        let at = frame.origin() + Vec2::new(margin + column * across, margin + line * down);
        canvas.text(&letters.line(row.key, height), at, ACCENT);
        canvas.text(&letters.line(row.help, height), at + Vec2::new(keys, 0.0), TEXT);
    }
}
