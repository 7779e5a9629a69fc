//! Sixels: bands of six rows, color by color, runs counted. At most 255 colors, and fewer in a picture that has to be small;
//! nothing is dithered, since grains make runs short and pictures large.

use std::fmt::Write;

use crate::base::pixels::Frame;
use crate::base::quantise::{Point, cut};

/// The most colors, and of a picture that is reduced: pixels are worth more than shades.
const COLORS: usize = 255;
const FEW_COLORS: usize = 48;
/// Colors are counted in 5 bits a channel.
const BINS: usize = 1 << 15;

/// The sequence that draws `frame` on `dots`, each of its pixels `by` dots wide and high. Transparent pixels are left out.
pub fn encode(frame: &Frame, by: usize, (width, height): (usize, usize)) -> String {
    let palette = Palette::of(frame, if by == 1 { COLORS } else { FEW_COLORS });
    let mut text = format!("\x1bP0;1;0q\"1;1;{width};{height}");
    for (i, color) in palette.colors.iter().enumerate() {
        let [r, g, b] = color.map(|code| (u32::from(code) * 100 + 127) / 255);
        // Writing to a string cannot fail, here and below.
        let _ = write!(text, "#{i};2;{r};{g};{b}");
    }
    let mut bits = vec![Vec::new(); palette.colors.len()];
    for top in (0..height).step_by(6) {
        bits.iter_mut().for_each(Vec::clear);
        for row in top..(top + 6).min(height).min(frame.height() * by) {
            for (x, cell) in frame.row(row / by).iter().enumerate().filter(|(_, cell)| cell[3] > 0) {
                let line = &mut bits[usize::from(palette.index[bin(*cell)])];
                line.resize(frame.width(), 0);
                line[x] |= 1u8 << (row - top);
            }
        }
        for (i, line) in bits.iter().enumerate().filter(|(_, line)| !line.is_empty()) {
            let _ = write!(text, "#{i}");
            runs(line, by, width, &mut text);
            text.push('$');
        }
        text.push('-');
    }
    text.push_str("\x1b\\");
    text
}

/// Writes a line of sixels, each `by` times, up to `width`.
fn runs(line: &[u8], by: usize, width: usize, text: &mut String) {
    let end = line.iter().rposition(|&bits| bits != 0).map_or(0, |last| last + 1);
    let mut x = 0;
    while x < end {
        let same = line[x..end].iter().take_while(|&&bits| bits == line[x]).count();
        let count = ((x + same) * by).min(width).saturating_sub(x * by);
        let sixel = char::from(63 + line[x]);
        if count > 3 {
            let _ = write!(text, "!{count}{sixel}");
        } else {
            text.extend(std::iter::repeat_n(sixel, count));
        }
        x += same;
    }
}

fn bin([r, g, b, _]: [u8; 4]) -> usize {
    usize::from(r >> 3) << 10 | usize::from(g >> 3) << 5 | usize::from(b >> 3)
}

/// The colors of a frame, and for each bin the one that stands for it.
struct Palette {
    colors: Vec<[u8; 3]>,
    index: Vec<u8>,
}

impl Palette {
    /// Without the rounds that settle a palette for a file: a picture in the terminal must be there at once.
    fn of(frame: &Frame, most: usize) -> Palette {
        let mut sums = vec![[0u64; 4]; BINS];
        for cell in frame.cells().iter().filter(|cell| cell[3] > 0) {
            let sum = &mut sums[bin(*cell)];
            *sum = [sum[0] + u64::from(cell[0]), sum[1] + u64::from(cell[1]), sum[2] + u64::from(cell[2]), sum[3] + 1];
        }
        let filled = sums.into_iter().filter(|sum| sum[3] > 0);
        let point = |[r, g, b, count]: [u64; 4]| Point {
            color: [r, g, b].map(|sum| sum as f64 / count as f64),
            weight: count as f64,
        };
        let mut palette = Palette { colors: Vec::new(), index: vec![0; BINS] };
        for group in cut(filled.map(point).collect(), most) {
            for point in group.points {
                // The mean of a bin lies in it.
                let [r, g, b] = point.color.map(|code| code as u8);
                palette.index[bin([r, g, b, 255])] = palette.colors.len() as u8;
            }
            palette.colors.push(group.mean.map(|code| code.round() as u8));
        }
        palette
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws a sequence as a terminal would; `None` if nothing was drawn.
    fn decoded(text: &str) -> (usize, usize, Vec<Option<[u32; 3]>>) {
        let body = text.split_once('q').unwrap().1.strip_suffix("\x1b\\").unwrap();
        let numbers = |text: &str| text.split(';').map(|n| n.parse::<usize>().unwrap()).collect::<Vec<_>>();
        let end = body.find(['#', '-']).unwrap_or(body.len());
        let size = numbers(&body[1..end]);
        let (width, height) = (size[2], size[3]);
        let mut dots = vec![None; width * height];
        let mut colors = std::collections::BTreeMap::new();
        let (mut x, mut top, mut ink, mut count) = (0, 0, 0, 1);
        let mut rest = &body[end..];
        while let Some(c) = rest.chars().next() {
            rest = &rest[1..];
            let digits = rest.find(|c: char| !c.is_ascii_digit() && c != ';').unwrap_or(rest.len());
            match c {
                '#' => {
                    let all = numbers(&rest[..digits]);
                    ink = all[0];
                    if let [_, 2, r, g, b] = all[..] {
                        colors.insert(ink, [r as u32, g as u32, b as u32]);
                    }
                    rest = &rest[digits..];
                }
                '!' => {
                    count = rest[..digits].parse().unwrap();
                    rest = &rest[digits..];
                }
                '$' => x = 0,
                '-' => (x, top) = (0, top + 6),
                sixel => {
                    for row in (0..6).filter(|row| (sixel as u8 - 63) >> row & 1 == 1) {
                        (x..x + count).for_each(|x| dots[(top + row) * width + x] = Some(colors[&ink]));
                    }
                    x += count;
                    count = 1;
                }
            }
        }
        (width, height, dots)
    }

    #[test]
    fn few_colors_come_back_exactly_and_reduced_pixels_are_repeated() {
        let color = |i: usize| if i % 7 == 3 { [0; 4] } else { [(i % 5 * 51) as u8, (i / 10 * 17) as u8, 255, 255] };
        let frame = Frame::from_cells(10, 8, (0..80).map(color).collect());
        for (by, dots) in [(1, (10, 8)), (3, (29, 24))] {
            let (width, height, found) = decoded(&encode(&frame, by, dots));
            assert_eq!((width, height), dots);
            for (i, dot) in found.iter().enumerate() {
                let [r, g, b, a] = *frame.get(i % width / by, i / width / by);
                let percent = [r, g, b].map(|code| (u32::from(code) * 100 + 127) / 255);
                assert_eq!(*dot, (a > 0).then_some(percent), "dot {i} at {by}");
            }
        }
    }

    #[test]
    fn many_colors_are_reduced_to_near_ones() {
        let color = |i: usize| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, (i * 7 % 256) as u8, 255];
        let frame = Frame::from_cells(64, 64, (0..64 * 64).map(color).collect());
        let palette = Palette::of(&frame, COLORS);
        assert!(palette.colors.len() <= COLORS && palette.colors.len() > 200);
        let error = |cell: &[u8; 4]| {
            let near = palette.colors[usize::from(palette.index[bin(*cell)])];
            (0..3).map(|i| u32::from(near[i].abs_diff(cell[i]))).max().unwrap()
        };
        assert!(frame.cells().iter().all(|cell| error(cell) < 64));
        assert!(frame.cells().iter().map(error).sum::<u32>() / 4096 < 24);
    }

    #[test]
    fn a_thin_mark_keeps_its_color_among_many_and_few() {
        let ground = |i: usize| [(i % 64 * 3) as u8, (i / 64 * 3) as u8, (i * 7 % 90) as u8, 255];
        let color = |i: usize| if i / 64 == i % 64 { [255, 0, 255, 255] } else { ground(i) };
        let frame = Frame::from_cells(64, 64, (0..64 * 64).map(color).collect());
        for most in [COLORS, FEW_COLORS] {
            let palette = Palette::of(&frame, most);
            let [r, g, b] = palette.colors[usize::from(palette.index[bin([255, 0, 255, 255])])];
            assert!(r > 235 && g < 20 && b > 235, "{r} {g} {b} of {most}");
        }
    }

    #[test]
    fn nothing_at_all_is_drawn_too() {
        assert_eq!(decoded(&encode(&Frame::filled(4, 6, [0; 4]), 1, (4, 6))).2, vec![None; 24]);
    }
}
