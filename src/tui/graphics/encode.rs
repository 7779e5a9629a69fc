//! Encodes a frame into the cells of a pane. The escape sequence that draws it is in the first cell, and ratatui skips the
//! others; with kitty every cell has a placeholder character, so text may be written over the picture. A reduced picture is
//! scaled up by the terminal, or, as sixels, by repeating dots.

use std::fmt::Write;
use std::num::NonZeroU16;

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use ratatui::buffer::{Buffer, Cell, CellDiffOption};
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::diacritics::diacritic;
use super::protocol::{Protocol, Wanted};
use super::sixel;
use crate::base::pixels::Frame;
use crate::export::still;

/// A cell counts as one column wide, however long its symbol is.
const ONE: CellDiffOption = CellDiffOption::ForcedWidth(NonZeroU16::MIN);
/// The most characters in one of kitty's escape sequences.
const CHUNK: usize = 4096;
/// Kitty's placeholder character: a cell that shows part of a picture.
const PLACEHOLDER: char = '\u{10eeee}';

/// The cells of the pane (`None` for half-blocks), and how many bytes they take.
pub fn encode(frame: &Frame, by: usize, wanted: &Wanted) -> (Option<Buffer>, usize) {
    let escape = match wanted.protocol {
        Protocol::Blocks => return (None, blocks(frame, by)),
        Protocol::Kitty => kitty(&png(frame), wanted.cells),
        Protocol::Iterm2 => format!("{}{}", cleared(wanted.cells), iterm2(&png(frame), wanted.cells)),
        Protocol::Sixel => format!("{}{}", cleared(wanted.cells), sixel::encode(frame, by, wanted.part.dots)),
    };
    let sequence = if wanted.tmux { enveloped(&escape) } else { escape };
    let bytes = sequence.len();
    let area = Rect::new(0, 0, wanted.cells.0, wanted.cells.1);
    let cells =
        if wanted.protocol == Protocol::Kitty { placeholders(area, sequence) } else { left_alone(area, &sequence) };
    (Some(cells), bytes)
}

/// The most bytes that half-blocks take: two colors and a character for each cell that differs from the one before.
fn blocks(frame: &Frame, by: usize) -> usize {
    const COLORS: usize = 2 * "\x1b[38;2;255;255;255m".len();
    const CHARACTER: usize = "▀".len();
    let rows = frame.cells().chunks(frame.width().max(1));
    let changes = rows.map(|row| 1 + row.windows(2).filter(|pair| pair[0] != pair[1]).count()).sum::<usize>();
    // Two rows of dots make one row of cells.
    (changes * COLORS / 2).max(1) * by.div_ceil(2).max(1) + frame.cells().len() * by * by / 2 * CHARACTER
}

/// A finished frame has a size and fits into memory: encoding it cannot fail.
fn png(frame: &Frame) -> Vec<u8> {
    still::frame(frame).unwrap_or_default()
}

/// Kitty's number of our picture, different for each editor in a terminal.
fn number() -> u32 {
    (std::process::id() & 0x00ff_ffff).max(1)
}

/// Makes a kitty terminal delete our picture.
pub fn forget() -> String {
    format!("\x1b_Ga=d,d=I,i={},q=2\x1b\\", number())
}

fn kitty(png: &[u8], (columns, rows): (u16, u16)) -> String {
    let text = BASE64.encode(png);
    let mut head = format!("i={},a=T,U=1,f=100,t=d,c={columns},r={rows},", number());
    let mut sequence = String::with_capacity(text.len() + text.len() / CHUNK * 16 + 80);
    let mut rest = text.as_str();
    while !rest.is_empty() {
        let (chunk, after) = rest.split_at(rest.len().min(CHUNK));
        let more = u8::from(!after.is_empty());
        // Writing to a string cannot fail.
        let _ = write!(sequence, "\x1b_G{head}q=2,m={more};{chunk}\x1b\\");
        head.clear();
        rest = after;
    }
    sequence
}

fn iterm2(png: &[u8], (columns, rows): (u16, u16)) -> String {
    let size = png.len();
    let text = BASE64.encode(png);
    format!(
        "\x1b]1337;File=inline=1;size={size};width={columns};height={rows};preserveAspectRatio=0;doNotMoveCursor=1:{text}\x07"
    )
}

/// Clears the cells of the pane from the first one on, and goes back to it.
fn cleared((columns, rows): (u16, u16)) -> String {
    let line = format!("\x1b[{columns}X\x1b[1B");
    format!("{}\x1b[{rows}A", line.repeat(rows.into()))
}

/// Wraps each escape sequence for tmux.
fn enveloped(escape: &str) -> String {
    let doubled = |part: &str| format!("\x1bPtmux;{}\x1b\\", part.replace('\x1b', "\x1b\x1b"));
    escape.split_inclusive("\x1b\\").map(doubled).collect()
}

fn placeholders(area: Rect, sequence: String) -> Buffer {
    let mut cells = Buffer::empty(area);
    let [_, r, g, b] = number().to_be_bytes();
    for (x, y) in area.positions().map(|at| (at.x, at.y)) {
        let (Some(row), Some(column), Some(cell)) = (diacritic(y), diacritic(x), cells.cell_mut((x, y))) else {
            continue;
        };
        let before = if (x, y) == (0, 0) { sequence.as_str() } else { "" };
        cell.set_symbol(&format!("{before}{PLACEHOLDER}{row}{column}"))
            .set_fg(Color::Rgb(r, g, b))
            .set_diff_option(ONE);
    }
    cells
}

fn left_alone(area: Rect, sequence: &str) -> Buffer {
    let mut skipped = Cell::EMPTY;
    skipped.set_diff_option(CellDiffOption::Skip);
    let mut cells = Buffer::filled(area, skipped);
    if let Some(first) = cells.cell_mut((0, 0)) {
        first.set_symbol(sequence).set_diff_option(ONE);
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::parts::marks::View;
    use crate::render::part::Part;

    fn wanted(protocol: Protocol, tmux: bool) -> Wanted {
        let part = Part { corner: kurbo::Point::ZERO, scale: 1.0, dots: (30, 24) };
        Wanted {
            part,
            cells: (3, 2),
            protocol,
            tmux,
            bytes: 100_000,
            calm: false,
            pass: None,
            clip: None,
            sight: None,
            over: View::default(),
            marks: None,
        }
    }

    fn first(protocol: Protocol, tmux: bool) -> String {
        let noise = |i: usize| [(i * 37 % 251) as u8, (i * 91 % 253) as u8, (i * 17 % 249) as u8, 255];
        let frame = Frame::from_cells(30, 24, (0..30 * 24).map(noise).collect());
        let (cells, bytes) = encode(&frame, 1, &wanted(protocol, tmux));
        let symbol = cells.unwrap().content()[0].symbol().to_owned();
        assert!(symbol.len() >= bytes);
        symbol
    }

    #[test]
    fn a_picture_of_kitty_comes_in_pieces_that_join() {
        let symbol = first(Protocol::Kitty, false);
        let pieces: Vec<&str> = symbol.split("\x1b_G").skip(1).collect();
        assert!(pieces[0].contains("a=T,U=1,f=100,t=d,c=3,r=2,q=2,"), "{}", pieces[0]);
        let mut all = String::new();
        for (i, piece) in pieces.iter().enumerate() {
            let (head, rest) = piece.split_once(';').unwrap();
            let text = rest.split('\x1b').next().unwrap();
            assert!(text.len() <= CHUNK && head.ends_with(&format!("m={}", u8::from(i + 1 < pieces.len()))));
            all.push_str(text);
        }
        let png = BASE64.decode(all).unwrap();
        assert!(png.starts_with(b"\x89PNG"));
        assert!(symbol.ends_with("\x1b\\\u{10eeee}\u{305}\u{305}"));
    }

    #[test]
    fn other_terminals_clear_the_cells_and_take_all_at_once() {
        let symbol = first(Protocol::Iterm2, false);
        assert!(symbol.starts_with("\x1b[3X\x1b[1B\x1b[3X\x1b[1B\x1b[2A\x1b]1337;File=inline=1;size="), "{symbol:.80}");
        assert!(symbol.ends_with('\x07'));
        let sixel = first(Protocol::Sixel, false);
        assert!(sixel.contains("\x1bP0;1;0q\"1;1;30;24") && sixel.ends_with("\x1b\\"), "{sixel:.80}");
    }

    #[test]
    fn tmux_gets_an_envelope() {
        let symbol = first(Protocol::Kitty, true);
        assert!(symbol.starts_with("\x1bPtmux;\x1b\x1b_Gi="), "{symbol:.40}");
        assert_eq!(symbol.matches("\x1bPtmux;").count(), symbol.matches("_G").count());
    }

    #[test]
    fn cells_beside_the_first_are_left_alone_or_stand_for_themselves() {
        let frame = Frame::filled(30, 24, [9, 9, 9, 255]);
        let (cells, _) = encode(&frame, 1, &wanted(Protocol::Sixel, false));
        assert!(cells.unwrap().content()[1..].iter().all(|cell| cell.diff_option == CellDiffOption::Skip));
        let (cells, _) = encode(&frame, 1, &wanted(Protocol::Kitty, false));
        assert_eq!(cells.unwrap().content()[4].symbol(), "\u{10eeee}\u{30d}\u{30d}");
        assert!(encode(&frame, 1, &wanted(Protocol::Blocks, false)).0.is_none());
    }
}
