//! 2-D arrays, color spaces and bilinear reads. What is filtered and composed is linear, premultiplied RGBA in `f32`;
//! pictures from files stay as they were read (`picture.rs`).

use std::sync::LazyLock;

/// A 2-D array, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    width: usize,
    height: usize,
    cells: Vec<T>,
}

impl<T> Grid<T> {
    /// Wraps `cells`, row by row; their number is `width` times `height`.
    pub fn from_cells(width: usize, height: usize, cells: Vec<T>) -> Self {
        assert_eq!(cells.len(), width * height, "cells of a {width} x {height} grid");
        Grid { width, height, cells }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The cells, row by row.
    pub fn cells(&self) -> &[T] {
        &self.cells
    }

    /// The cells, row by row, alone.
    pub fn into_cells(self) -> Vec<T> {
        self.cells
    }

    /// The cells, row by row, to be changed.
    pub fn cells_mut(&mut self) -> &mut [T] {
        &mut self.cells
    }

    /// One row.
    pub fn row(&self, y: usize) -> &[T] {
        &self.cells[y * self.width..][..self.width]
    }

    /// The cell in column `x`, row `y`.
    pub fn get(&self, x: usize, y: usize) -> &T {
        &self.row(y)[x]
    }
}

impl<T: Clone> Grid<T> {
    /// A grid with `value` in every cell.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Grid { width, height, cells: vec![value; width * height] }
    }
}

/// Grids of as many rows side by side, from left to right.
pub fn side_by_side<T: Clone>(grids: &[Grid<T>]) -> Grid<T> {
    let height = grids.first().map_or(0, Grid::height);
    let rows = (0..height).flat_map(|y| grids.iter().flat_map(move |grid| grid.row(y)));
    Grid::from_cells(grids.iter().map(Grid::width).sum(), height, rows.cloned().collect())
}

/// One color: linear light, premultiplied by its alpha.
pub type Rgba = [f32; 4];

/// What was computed, in linear, premultiplied RGBA.
pub type Linear = Grid<Rgba>;

/// A finished frame: sRGB, straight alpha, 8 bits a channel.
pub type Frame = Grid<[u8; 4]>;

/// `over` laid on `under` (Porter and Duff), both premultiplied.
pub fn over(over: Rgba, under: Rgba) -> Rgba {
    let rest = 1.0 - over[3];
    std::array::from_fn(|i| over[i] + under[i] * rest)
}

/// What a read beyond a picture's edge gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// The nearest pixel of the edge.
    Clamp,
    /// Nothing: transparent.
    Transparent,
}

/// The bilinear read at image coordinates (x, y) of a picture of `size` whose pixel number i is `texel(i)`; the center of
/// pixel (i, j) is (i + 0.5, j + 0.5).
#[inline]
pub fn bilinear(
    (width, height): (usize, usize),
    (x, y): (f64, f64),
    beyond: Beyond,
    texel: impl Fn(usize) -> Rgba,
) -> Rgba {
    let (w, h) = (width as i64, height as i64);
    let texel = |x: i64, y: i64| {
        if beyond == Beyond::Transparent && (x < 0 || y < 0 || x >= w || y >= h) {
            return [0.0; 4];
        }
        texel(y.clamp(0, h - 1) as usize * width + x.clamp(0, w - 1) as usize)
    };
    mean_of_four((x, y), texel)
}

/// The place of texture coordinates in a picture of this width and height that repeats, in pixels: v = 0 is its bottom edge.
#[inline]
pub fn texture_place([u, v]: [f64; 2], (width, height): (usize, usize)) -> (f64, f64) {
    ((u - u.floor()) * width as f64, (1.0 - (v - v.floor())) * height as f64)
}

/// As [`bilinear`], of a picture that repeats in both directions.
#[inline]
pub fn bilinear_repeated((width, height): (usize, usize), (x, y): (f64, f64), texel: impl Fn(usize) -> Rgba) -> Rgba {
    let (w, h) = (width as i64, height as i64);
    mean_of_four((x, y), |x, y| texel(y.rem_euclid(h) as usize * width + x.rem_euclid(w) as usize))
}

/// The mean of the four pixels round a place, by their distances.
#[inline]
fn mean_of_four((x, y): (f64, f64), texel: impl Fn(i64, i64) -> Rgba) -> Rgba {
    let (gx, gy) = (x - 0.5, y - 0.5);
    let (fx, fy) = (gx.floor(), gy.floor());
    let (wx, wy) = ((gx - fx) as f32, (gy - fy) as f32);
    let (ix, iy) = (fx as i64, fy as i64);
    let [a, b] = [texel(ix, iy), texel(ix.saturating_add(1), iy)];
    let iy = iy.saturating_add(1);
    let [c, d] = [texel(ix, iy), texel(ix.saturating_add(1), iy)];
    std::array::from_fn(|i| {
        let top = a[i] + (b[i] - a[i]) * wx;
        let bottom = c[i] + (d[i] - c[i]) * wx;
        top + (bottom - top) * wy
    })
}

impl Linear {
    /// The bilinear read at image coordinates (x, y).
    pub fn read(&self, x: f64, y: f64, beyond: Beyond) -> Rgba {
        bilinear((self.width, self.height), (x, y), beyond, |i| self.cells[i])
    }
}

impl Frame {
    /// Decodes sRGB with straight alpha.
    pub fn to_linear(&self) -> Linear {
        Grid { width: self.width, height: self.height, cells: self.cells.iter().map(|&c| decode(c)).collect() }
    }
}

/// sRGB code value in 0 to 1 to linear light (IEC 61966-2-1).
pub fn linear_from_srgb(code: f64) -> f64 {
    if code <= 0.04045 { code / 12.92 } else { crate::base::maths::pow((code + 0.055) / 1.055, 2.4) }
}

/// The sRGB code, 0 to 1, of linear light.
pub fn srgb_from_linear(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * crate::base::maths::pow(light, 1.0 / 2.4) - 0.055 }
}

/// 8-bit sRGB with straight alpha to linear, premultiplied.
pub fn decode([r, g, b, a]: [u8; 4]) -> Rgba {
    let alpha = f32::from(a) / 255.0;
    let linear = |code: u8| LINEAR[usize::from(code)] * alpha;
    [linear(r), linear(g), linear(b), alpha]
}

/// Linear, premultiplied to 8-bit sRGB with straight alpha; each channel is rounded to the nearest code.
pub fn encode([r, g, b, a]: Rgba) -> [u8; 4] {
    if a <= 0.0 {
        return [0; 4];
    }
    let [r, g, b] = if a == 1.0 { [r, g, b] } else { [r / a, g / a, b / a] };
    let code = |light| srgb_code(&CODES, light) as u8;
    [code(r), code(g), code(b), (a.clamp(0.0, 1.0) * 255.0 + 0.5) as u8]
}

/// What [`encode`] gives for each color.
#[inline(always)]
pub fn encode_all(colors: &[Rgba], out: &mut [[u8; 4]]) {
    const RUN: usize = 32;
    let table: &Codes = &CODES;
    for (colors, out) in colors.chunks(RUN).zip(out.chunks_mut(RUN)) {
        if colors.iter().filter(|color| color[3] == 1.0).count() < colors.len() {
            out.iter_mut().zip(colors).for_each(|(out, color)| *out = encode(*color));
            continue;
        }
        let (mut stretches, mut rests) = ([[0; 4]; RUN], [[0; 4]; RUN]);
        let halves = stretches.as_flattened_mut().iter_mut().zip(rests.as_flattened_mut());
        for ((stretch, rest), light) in halves.zip(colors.as_flattened()) {
            (*stretch, *rest) = halves_of(*light);
        }
        let mut entries = [[OPAQUE; 4]; RUN];
        for (entry, stretch) in entries.iter_mut().zip(&stretches) {
            for i in 0..3 {
                entry[i] = table[usize::from(stretch[i])];
            }
        }
        let codes = entries.as_flattened().iter().zip(rests.as_flattened());
        for (out, (entry, rest)) in out.as_flattened_mut().iter_mut().zip(codes) {
            *out = ((entry + u32::from(*rest)) >> 16) as u8;
        }
    }
}

static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| linear_from_srgb(code as f64 / 255.0) as f32));

/// For all light whose upper half of bits is the same: the code at its beginning in the upper half, in the lower half what
/// carries over into the next code from where that begins. None of these stretches is so long that two codes begin in it.
type Codes = [u32; 1 + STRETCHES];

/// The entry of all light of 1.
const OPAQUE: u32 = 255 << 16;
/// How many stretches there are up to 1, and where the first begins: darker light has code 0 as well.
const STRETCHES: usize = 13 << 7;
const DARKEST: f32 = 1.0 / 8192.0;

static CODES: LazyLock<Box<Codes>> = LazyLock::new(|| {
    let begins: Vec<u32> =
        (1..256).map(|code| (linear_from_srgb((f64::from(code) - 0.5) / 255.0) as f32).to_bits()).collect();
    let entry = |stretch: usize| {
        let first = (DARKEST.to_bits() >> 16) + stretch as u32;
        let code = begins.partition_point(|&begin| begin <= first << 16);
        let next = begins.get(code).filter(|begin| *begin >> 16 == first);
        (code as u32) << 16 | next.map_or(0, |begin| (1 << 16) - (begin & 0xffff))
    };
    Box::new(std::array::from_fn(entry))
});

/// The code of linear light, rounded to the nearest: without a power function, and without a branch.
#[inline(always)]
fn srgb_code(codes: &Codes, light: f32) -> u32 {
    let (stretch, rest) = halves_of(light);
    (codes[usize::from(stretch)] + u32::from(rest)) >> 16
}

/// The number of the stretch that light is in, and the lower half of its bits; a NaN is dark.
#[inline(always)]
fn halves_of(light: f32) -> (u16, u16) {
    let light = if light > DARKEST { light } else { DARKEST };
    let bits = (if light < 1.0 { light } else { 1.0 }).to_bits();
    (((bits - DARKEST.to_bits()) >> 16) as u16, bits as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_round_trips() {
        for code in 0..=255u8 {
            assert_eq!(encode(decode([code, code, code, 255])), [code, code, code, 255]);
            let [r, .., a] = encode(decode([code, 0, 0, 128]));
            assert_eq!((r, a), (code, 128));
        }
    }

    #[test]
    fn encoding_rounds_to_the_nearest_code() {
        for i in 0..=20000 {
            let light = i as f64 / 20000.0;
            let srgb = if light <= 0.0031308 {
                12.92 * light
            } else {
                1.055 * crate::base::maths::pow(light, 1.0 / 2.4) - 0.055
            };
            let error = (f64::from(srgb_code(&CODES, light as f32)) - srgb * 255.0).abs();
            assert!(error <= 0.5005, "{light}: {error}");
        }
    }

    #[test]
    fn codes_begin_where_they_should_to_the_bit() {
        let begins: Vec<f32> = (1..256).map(|code| linear_from_srgb((f64::from(code) - 0.5) / 255.0) as f32).collect();
        let code = |light: f32| begins.partition_point(|begin| *begin <= light) as u32;
        let stretches = (0..=STRETCHES as u32).map(|stretch| f32::from_bits(DARKEST.to_bits() + (stretch << 16)));
        for place in begins.iter().copied().chain(stretches) {
            for bits in place.to_bits() - 300..=place.to_bits() + 300 {
                let light = f32::from_bits(bits);
                assert_eq!(srgb_code(&CODES, light), code(light.min(1.0)), "{light}");
            }
        }
    }

    #[test]
    fn many_colors_are_encoded_as_each() {
        let light = [0.0, 1e-5, 0.2, 0.9999, 1.0, 1.5, -1.0, f32::NAN];
        for alphas in [&[1.0][..], &[1.0, 0.5], &[0.0, 1.0, f32::NAN, 1e-9, 2.0]] {
            let color = |i: usize| [light[i % 8], light[i / 3 % 8], light[i / 5 % 8], alphas[i / 40 % alphas.len()]];
            let colors: Vec<Rgba> = (0..213).map(color).collect();
            let mut codes = vec![[9; 4]; colors.len()];
            encode_all(&colors, &mut codes);
            assert_eq!(codes, colors.iter().map(|color| encode(*color)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn odd_light_is_clamped() {
        for (light, code) in [(-1.0, 0), (2.0, 255), (f32::NAN, 0), (f32::INFINITY, 255)] {
            assert_eq!(srgb_code(&CODES, light), code, "{light}");
        }
    }

    #[test]
    fn a_read_at_a_center_is_the_pixel() {
        let mut p = Linear::filled(3, 2, [0.0; 4]);
        p.cells_mut()[4] = [1.0, 0.5, 0.25, 1.0];
        assert_eq!(p.read(1.5, 1.5, Beyond::Clamp), [1.0, 0.5, 0.25, 1.0]);
        assert_eq!(p.read(1.0, 1.5, Beyond::Clamp)[0], 0.5);
        assert_eq!(p.read(1.5, 9.0, Beyond::Clamp)[0], 1.0);
        assert_eq!(p.read(1.5, 9.0, Beyond::Transparent), [0.0; 4]);
        assert_eq!(p.read(1.5, 2.0, Beyond::Transparent)[0], 0.5);
    }

    #[test]
    fn over_is_porter_duff() {
        assert_eq!(over([0.5, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 1.0]), [0.5, 0.5, 0.0, 1.0]);
    }
}
