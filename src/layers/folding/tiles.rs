//! A frame, tile by tile: the same bits as pixel by pixel (`frame.rs`), in loops that the compiler makes vectors of. What the
//! samplers of a tile read lies close together, so it is turned into light once, and no read has to ask whether it is
//! beyond an edge.

use std::ops::Range;

use super::field::Field;
use super::frame::{Frame, ZoneAt, effective, zone_pixel};
use crate::base::picture::Picture;
use crate::base::pixels::{Beyond, Rgba, encode_all, over};
use crate::base::simd::vectorised;
use crate::layers::parts::moment::Columns;
use crate::layers::ready::Still;

/// Columns and rows of a tile: wide, since memory is read in rows; small enough to stay close to the processor.
const ACROSS: usize = 64;
const DOWN: usize = 16;
const CELLS: usize = ACROSS * DOWN;
/// For so many texels a sampler, what all of a tile read is turned into light at once.
const MOST: usize = 8;

impl Still for Frame<'_> {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        self.pixels(y, columns, out);
    }

    fn rows(&self, rows: Range<usize>, width: usize, out: &mut [Rgba]) {
        vectorised(
            #[inline(always)]
            || light(self, rows, width, out),
        );
    }

    fn codes(&self, rows: Range<usize>, background: Rgba, out: &mut [[u8; 4]]) -> bool {
        let (picture, width) = (&self.synth.picture, out.len() / rows.len().max(1));
        let covers = width <= picture.width() && rows.end <= picture.height();
        if covers {
            vectorised(
                #[inline(always)]
                || codes(self, (rows, width), background, out),
            );
        }
        covers
    }
}

/// See [`Still::rows`].
#[inline(always)]
fn light(frame: &Frame, rows: Range<usize>, width: usize, out: &mut [Rgba]) {
    let (picture, mut scratch) = (&*frame.synth.picture, Scratch::default());
    let within = rows.start..rows.end.min(picture.height());
    for tile in tiles(within, width.min(picture.width())) {
        draw(frame, &tile, &mut scratch);
        for row in 0..tile.rows.len() {
            let y = tile.rows.start + row;
            let out = &mut out[(y - rows.start) * width..][tile.columns.clone()];
            match scratch.row(row, out.len()) {
                Some(cells) => out.copy_from_slice(cells),
                None => picture.row(tile.columns.start, y, out),
            }
        }
    }
}

/// See [`Still::codes`].
#[inline(always)]
fn codes(frame: &Frame, (rows, width): (Range<usize>, usize), background: Rgba, out: &mut [[u8; 4]]) {
    let (picture, mut scratch) = (&*frame.synth.picture, Scratch::default());
    for tile in tiles(rows.clone(), width) {
        draw(frame, &tile, &mut scratch);
        for row in 0..tile.rows.len() {
            let (x, y) = (tile.columns.start, tile.rows.start + row);
            let out = &mut out[(y - rows.start) * width..][tile.columns.clone()];
            if !scratch.drawn[row] {
                if picture.copy_codes((x, y), out) {
                    continue;
                }
                picture.row(x, y, scratch.begin(row, out.len()));
            }
            let cells = scratch.begin(row, out.len());
            if background != [0.0; 4] {
                cells.iter_mut().for_each(|cell| *cell = over(*cell, background));
            }
            encode_all(cells, out);
        }
    }
}

/// The part of a frame that is drawn at once.
struct Tile {
    columns: Range<usize>,
    rows: Range<usize>,
}

/// Rows of a frame in tiles.
#[inline(always)]
fn tiles(rows: Range<usize>, width: usize) -> impl Iterator<Item = Tile> {
    let ends = move |y: usize| y..(y + DOWN).min(rows.end);
    let across = move |x: usize| x..(x + ACROSS).min(width);
    let starts = rows.start..rows.end;
    starts.step_by(DOWN).flat_map(move |y| {
        let rows = ends(y);
        (0..width).step_by(ACROSS).map(move |x| Tile { columns: across(x), rows: rows.clone() })
    })
}

/// Neighbors in a row of a tile whose samplers are active.
struct Span {
    row: usize,
    columns: Range<usize>,
}

/// Places along an axis: the texels before them, and their shares of the ways to the next.
struct Axis {
    texels: Vec<i32>,
    shares: Vec<f32>,
}

/// Memory that is used again and again: a cell for each pixel of a tile.
struct Scratch {
    /// The colors.
    cells: Vec<Rgba>,
    /// Which rows have theirs.
    drawn: [bool; DOWN],
    /// How far along its jump path each sampler is.
    e: Vec<f64>,
    /// Where each reads, in columns and in rows.
    axes: [Axis; 2],
    spans: Vec<Span>,
    /// What samplers read, in light.
    patch: Vec<Rgba>,
}

impl Default for Scratch {
    fn default() -> Self {
        Scratch {
            cells: vec![[0.0; 4]; CELLS],
            drawn: [false; DOWN],
            e: vec![0.0; CELLS],
            axes: std::array::from_fn(|_| Axis { texels: vec![0; CELLS], shares: vec![0.0; CELLS] }),
            spans: Vec::new(),
            patch: Vec::new(),
        }
    }
}

impl Scratch {
    /// The colors of a row of the tile; `None` if it shows the layer's picture unchanged.
    #[inline(always)]
    fn row(&self, row: usize, width: usize) -> Option<&[Rgba]> {
        self.drawn[row].then(|| &self.cells[row * ACROSS..][..width])
    }

    /// The same, to be written; from now on it has colors of its own.
    #[inline(always)]
    fn begin(&mut self, row: usize, width: usize) -> &mut [Rgba] {
        self.drawn[row] = true;
        &mut self.cells[row * ACROSS..][..width]
    }
}

/// Draws the rows of a tile that do not just show the layer's picture.
#[inline(always)]
fn draw(frame: &Frame, tile: &Tile, scratch: &mut Scratch) {
    scratch.drawn = [false; DOWN];
    for shown in &frame.zones {
        find_spans(shown, tile, scratch);
        if scratch.spans.is_empty() {
            continue;
        }
        begin_rows(&frame.synth.picture, shown, tile, scratch);
        let texels = find_places(shown, tile, scratch);
        match Patch::new(shown, texels, scratch) {
            Some(patch) => mix(shown, &patch, scratch),
            None => one_by_one(shown, tile, scratch),
        }
    }
}

/// Finds the pixels of a tile whose samplers are active.
#[inline(always)]
fn find_spans(shown: &ZoneAt, tile: &Tile, scratch: &mut Scratch) {
    let field = &*shown.zone.field;
    let within = |part: &Range<usize>, first: usize, count: usize| part.start.max(first)..part.end.min(first + count);
    let columns = within(&tile.columns, field.x0, field.inside.width());
    scratch.spans.clear();
    if columns.is_empty() {
        return;
    }
    for y in within(&tile.rows, field.y0, field.inside.height()) {
        let row = y - tile.rows.start;
        let i = (y - field.y0) * field.inside.width() + columns.start - field.x0;
        let inside = &field.inside.cells()[i..][..columns.len()];
        let Some(first) = inside.iter().position(|inside| *inside) else { continue };
        let end = inside.iter().rposition(|inside| *inside).map_or(first, |last| last + 1);
        let (i, column) = (i + first, columns.start - tile.columns.start + first);
        let e = &mut scratch.e[row * ACROSS + column..][..end - first];
        let mut active_until = |from: usize, to: usize| {
            if from < to {
                scratch.spans.push(Span { row, columns: column + from..column + to });
            }
        };
        match all_or_none(field, i..i + e.len(), shown.s) {
            Some(true) => {
                e.fill(shown.s);
                active_until(0, e.len());
            }
            Some(false) => {}
            None => {
                let mut from = 0;
                for (k, e) in e.iter_mut().enumerate() {
                    match field.inside.cells()[i + k].then(|| effective(field, i + k, shown.s)).flatten() {
                        Some(own) => *e = own,
                        None => {
                            active_until(from, k);
                            from = k + 1;
                        }
                    }
                }
                active_until(from, e.len());
            }
        }
    }
}

/// Whether all of these pixels of a box are active with e(s) = s, or none; `None` if neither is sure.
#[inline(always)]
fn all_or_none(field: &Field, pixels: Range<usize>, s: f64) -> Option<bool> {
    let same = |flags: &[bool]| {
        let set = flags.iter().filter(|flag| **flag).count();
        (set == 0 || set == flags.len()).then_some(set > 0)
    };
    if !same(&field.inside.cells()[pixels.clone()])? {
        return Some(false);
    }
    let Some(folds) = &field.folds else { return Some(true) };
    let crossings = if s < 0.0 { &folds.behind } else { &folds.ahead };
    if crossings.any(pixels.start, pixels.end) {
        return None;
    }
    let inside = same(&folds.inside.cells()[pixels])?;
    Some(folds.rule.effective(inside, &[], s).is_some())
}

/// Gives the rows that a zone draws on what lies beneath, unless it covers all of that.
#[inline(always)]
fn begin_rows(picture: &Picture, shown: &ZoneAt, tile: &Tile, scratch: &mut Scratch) {
    let (width, x) = (tile.columns.len(), tile.columns.start);
    for i in 0..scratch.spans.len() {
        let Span { row, columns } = &scratch.spans[i];
        let (row, covers) = (*row, columns.len() == width && !shown.zone.source.over);
        if !std::mem::replace(&mut scratch.drawn[row], true) && !covers {
            picture.row(x, tile.rows.start + row, &mut scratch.cells[row * ACROSS..][..width]);
        }
    }
}

/// Texels: columns and rows, also beyond the edges.
type Texels = [Range<i64>; 2];

/// Finds which texels the samplers of all spans read.
#[inline(always)]
fn find_places(shown: &ZoneAt, tile: &Tile, scratch: &mut Scratch) -> Texels {
    let (field, offset) = (&*shown.zone.field, shown.zone.source.offset);
    let mut across = [0.0; ACROSS];
    for (k, x) in across.iter_mut().enumerate() {
        *x = ((tile.columns.start + k) as f64 + 0.5) + offset.x;
    }
    let mut ends = [[i32::MAX, i32::MIN]; 2];
    for Span { row, columns } in &scratch.spans {
        let (x, y) = (tile.columns.start + columns.start, tile.rows.start + row);
        let from = (y - field.y0) * field.inside.width() + x - field.x0;
        let jumps = &field.jumps.cells()[from..][..columns.len()];
        let down = [(y as f64 + 0.5) + offset.y; ACROSS];
        let cells = row * ACROSS + columns.start..row * ACROSS + columns.end;
        let e = &scratch.e[cells.clone()];
        for (axis, q) in [&across[columns.clone()], &down[columns.clone()]].into_iter().enumerate() {
            let Axis { texels, shares } = &mut scratch.axes[axis];
            let (texels, shares) = (&mut texels[cells.clone()], &mut shares[cells.clone()]);
            for (((q, jump), e), (texel, share)) in q.iter().zip(jumps).zip(e).zip(texels.iter_mut().zip(shares)) {
                let at = (q + f64::from(jump[axis]) * e) - 0.5;
                let before = at.floor();
                *share = (at - before) as f32;
                *texel = whole(before);
            }
            let [least, most] = ends[axis];
            ends[axis] = [texels.iter().fold(least, |a, b| a.min(*b)), texels.iter().fold(most, |a, b| a.max(*b))];
        }
    }
    // Each read needs the next texel too.
    ends.map(|[least, most]| i64::from(least)..i64::from(most) + 2)
}

/// A whole number as an integer, as near as there is one: its bits beside those of a large number, since no processor
/// but the newest converts several at once.
#[inline(always)]
fn whole(number: f64) -> i32 {
    /// Far beyond the edges of all pictures.
    const FAR: f64 = (1 << 30) as f64;
    /// So large that its last bit is a one, and that it stays positive.
    const ONES: f64 = (3_u64 << 51) as f64;
    let number = if number > -FAR { number } else { -FAR };
    let number = if number < FAR { number } else { FAR };
    (number + ONES).to_bits() as i32
}

/// What the samplers of a tile read.
struct Patch {
    left: i32,
    above: i32,
    width: i32,
}

impl Patch {
    /// Turns texels into light; `None` if reading them one by one is less work.
    #[inline(always)]
    fn new(shown: &ZoneAt, [columns, rows]: Texels, scratch: &mut Scratch) -> Option<Patch> {
        let (width, height) = ((columns.end - columns.start) as usize, (rows.end - rows.start) as usize);
        let samplers: usize = scratch.spans.iter().map(|span| span.columns.len()).sum();
        if width.saturating_mul(height) > MOST * samplers.max(ACROSS) {
            return None;
        }
        // What is there is overwritten.
        scratch.patch.resize(width * height, [0.0; 4]);
        let clear = shown.zone.source.beyond == Beyond::Transparent;
        for (y, out) in rows.clone().zip(scratch.patch.chunks_exact_mut(width)) {
            read_row(shown.picture, clear, (columns.clone(), y), out);
        }
        Some(Patch { left: columns.start as i32, above: rows.start as i32, width: width as i32 })
    }
}

/// Texels of a row, also of columns and rows beyond the edge.
#[inline(always)]
fn read_row(picture: &Picture, clear: bool, (columns, y): (Range<i64>, i64), out: &mut [Rgba]) {
    let (width, height) = (picture.width() as i64, picture.height() as i64);
    let own = columns.start.clamp(0, width)..columns.end.clamp(0, width);
    if clear && (own.is_empty() || !(0..height).contains(&y)) {
        return out.fill([0.0; 4]);
    }
    let y = y.clamp(0, height - 1) as usize;
    if own.is_empty() {
        return out.fill(picture.texel(own.start.min(width - 1) as usize, y));
    }
    let there = (own.start - columns.start) as usize..(own.end - columns.start) as usize;
    picture.row(own.start as usize, y, &mut out[there.clone()]);
    let ends = if clear { [[0.0; 4]; 2] } else { [out[there.start], out[there.end - 1]] };
    out[..there.start].fill(ends[0]);
    out[there.end..].fill(ends[1]);
}

/// Mixes what all samplers read.
#[inline(always)]
fn mix(shown: &ZoneAt, patch: &Patch, scratch: &mut Scratch) {
    let (width, over_it) = (patch.width as usize, shown.zone.source.over);
    let texels = &scratch.patch[..];
    let mut first = [0; ACROSS];
    for Span { row, columns } in &scratch.spans {
        let cells = row * ACROSS + columns.start..row * ACROSS + columns.end;
        let [(left, u), (above, v)] =
            scratch.axes.each_ref().map(|axis| (&axis.texels[cells.clone()], &axis.shares[cells.clone()]));
        let first = &mut first[..left.len()];
        for (first, (left, above)) in first.iter_mut().zip(left.iter().zip(above)) {
            *first = ((above - patch.above) * patch.width + (left - patch.left)) as u32;
        }
        let out = &mut scratch.cells[cells];
        for ((first, (u, v)), out) in first.iter().zip(u.iter().zip(v)).zip(out) {
            let above = &texels[*first as usize..][..width + 2];
            let below = &above[width..];
            let moving = mean(mean(above[0], above[1], *u), mean(below[0], below[1], *u), *v);
            *out = if over_it { over(moving, *out) } else { moving };
        }
    }
}

/// What is this share of the way from one color to another.
#[inline(always)]
fn mean(a: Rgba, b: Rgba, share: f32) -> Rgba {
    let mut mean = [0.0; 4];
    for i in 0..4 {
        mean[i] = a[i] + (b[i] - a[i]) * share;
    }
    mean
}

/// Draws each pixel by itself.
#[cold]
fn one_by_one(shown: &ZoneAt, tile: &Tile, scratch: &mut Scratch) {
    for Span { row, columns } in &scratch.spans {
        for column in columns.clone() {
            let place = (tile.columns.start + column - shown.zone.field.x0, tile.rows.start + row);
            zone_pixel(shown, place, &mut scratch.cells[row * ACROSS + column]);
        }
    }
}
