//! Pictures as they were read: codes of 8 or 16 bits, halves or floats, and what turns them into light. A photograph takes
//! 3 bytes a pixel instead of 16; every read gives linear, premultiplied RGBA all the same.

use std::sync::{Arc, LazyLock};

use crate::base::half::value_of_half;
use crate::base::pixels::{Beyond, Linear, Rgba, bilinear, bilinear_repeated, encode, linear_from_srgb};

/// A picture that a scene names.
#[derive(Clone, Debug)]
pub struct Picture {
    width: usize,
    height: usize,
    channels: Channels,
    samples: Samples,
}

/// Which samples a pixel has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Luma alone.
    Grey = 1,
    /// Luma, then alpha.
    GreyAlpha = 2,
    /// Red, green, blue.
    Rgb = 3,
    /// Red, green, blue, then alpha.
    Rgba = 4,
}

impl Channels {
    /// As many as `count`, 1 to 4.
    pub fn of(count: usize) -> Option<Self> {
        [Channels::Grey, Channels::GreyAlpha, Channels::Rgb, Channels::Rgba].into_iter().find(|c| c.count() == count)
    }

    /// How many there are.
    pub fn count(self) -> usize {
        self as usize
    }

    /// Whether one of them is alpha.
    pub fn have_alpha(self) -> bool {
        matches!(self, Channels::GreyAlpha | Channels::Rgba)
    }
}

/// The samples of all pixels, row by row.
#[derive(Clone, Debug)]
pub enum Samples {
    /// Codes of 8 bits with straight alpha.
    Bytes(Vec<u8>, Arc<Light<256>>),
    /// Codes of 16 bits with straight alpha.
    Words(Vec<u16>, Arc<Light<65536>>),
    /// Bits of half floats: linear light, premultiplied, none of them infinite or NaN.
    Halves(Vec<u16>),
    /// Linear light, premultiplied, none of them infinite or NaN.
    Floats(Vec<f32>),
}

impl Samples {
    fn len(&self) -> usize {
        match self {
            Samples::Bytes(all, _) => all.len(),
            Samples::Words(all, _) | Samples::Halves(all) => all.len(),
            Samples::Floats(all) => all.len(),
        }
    }
}

/// What turns codes into linear sRGB light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light<const CODES: usize> {
    /// The light of each code, of red, green and blue.
    pub curves: [Arc<[f32; CODES]>; 3],
    /// Converts light from other primaries, row by row; what is outside sRGB is clipped.
    pub matrix: Option<[[f32; 3]; 3]>,
}

impl<const CODES: usize> Light<CODES> {
    /// One curve for all channels; the primaries are those of sRGB.
    pub fn of_curve(curve: impl Fn(f64) -> f64) -> Self {
        let curve = table(curve);
        Light { curves: std::array::from_fn(|_| curve.clone()), matrix: None }
    }

    /// The light of three codes.
    #[inline]
    fn of(&self, [r, g, b]: [usize; 3]) -> [f32; 3] {
        let [red, green, blue] = &self.curves;
        let light = [red[r], green[g], blue[b]];
        match &self.matrix {
            None => light,
            Some(rows) => rows.map(|row| (row[0] * light[0] + row[1] * light[1] + row[2] * light[2]).clamp(0.0, 1.0)),
        }
    }
}

/// A curve from 0 to 1 at every code.
pub fn table<const CODES: usize>(curve: impl Fn(f64) -> f64) -> Arc<[f32; CODES]> {
    let values: Vec<f32> = (0..CODES).map(|code| curve(code as f64 / (CODES - 1) as f64) as f32).collect();
    // As many as there are codes: the conversion cannot fail.
    Arc::<[f32]>::from(values).try_into().unwrap_or_else(|_| Arc::new([0.0; CODES]))
}

/// sRGB in 8 bits.
pub static SRGB_8: LazyLock<Arc<Light<256>>> = LazyLock::new(|| Arc::new(Light::of_curve(linear_from_srgb)));
/// sRGB in 16 bits.
pub static SRGB_16: LazyLock<Arc<Light<65536>>> = LazyLock::new(|| Arc::new(Light::of_curve(linear_from_srgb)));

/// The value of every half float.
static HALVES: LazyLock<Box<[f32]>> = LazyLock::new(|| (0..=u16::MAX).map(value_of_half).collect());

/// The pixels of a picture as linear, premultiplied RGBA.
trait Texels {
    /// The samples of a pixel.
    type Cell;

    /// All pixels, row by row.
    fn cells(&self) -> &[Self::Cell];

    /// What the samples mean.
    fn of(&self, cell: &Self::Cell) -> Rgba;

    /// Pixel `i`.
    #[inline]
    fn at(&self, i: usize) -> Rgba {
        self.of(&self.cells()[i])
    }

    /// All pixels from `first` on.
    #[inline]
    fn row(&self, first: usize, out: &mut [Rgba]) {
        out.iter_mut().zip(&self.cells()[first..]).for_each(|(out, cell)| *out = self.of(cell));
    }
}

struct Codes<'a, C, const N: usize, const CODES: usize> {
    cells: &'a [[C; N]],
    light: &'a Light<CODES>,
}

impl<C: Copy + Into<usize> + Into<f32>, const N: usize, const CODES: usize> Codes<'_, C, N, CODES> {
    /// The codes of red, green and blue.
    #[inline]
    fn colors(cell: &[C; N]) -> [usize; 3] {
        if N < 3 { [cell[0].into(); 3] } else { [0, 1, 2].map(|c| cell[c].into()) }
    }

    /// Light, premultiplied by what the last channel says.
    #[inline]
    fn premultiplied([r, g, b]: [f32; 3], cell: &[C; N]) -> Rgba {
        if N % 2 == 1 {
            return [r, g, b, 1.0];
        }
        let alpha = Into::<f32>::into(cell[N - 1]) / (CODES - 1) as f32;
        [r * alpha, g * alpha, b * alpha, alpha]
    }
}

impl<C: Copy + Into<usize> + Into<f32>, const N: usize, const CODES: usize> Texels for Codes<'_, C, N, CODES> {
    type Cell = [C; N];

    #[inline]
    fn cells(&self) -> &[[C; N]] {
        self.cells
    }

    #[inline]
    fn of(&self, cell: &[C; N]) -> Rgba {
        Self::premultiplied(self.light.of(Self::colors(cell)), cell)
    }

    #[inline]
    fn row(&self, first: usize, out: &mut [Rgba]) {
        let pixels = out.iter_mut().zip(&self.cells[first..]);
        if self.light.matrix.is_some() {
            return pixels.for_each(|(out, cell)| *out = self.of(cell));
        }
        // The tables are found once: in the loop they would be looked up for each pixel.
        let [red, green, blue] = self.light.curves.each_ref().map(|curve| &**curve);
        for (out, cell) in pixels {
            let [r, g, b] = Self::colors(cell);
            *out = Self::premultiplied([red[r], green[g], blue[b]], cell);
        }
    }
}

struct Values<'a, T, const N: usize> {
    cells: &'a [[T; N]],
    value: &'a dyn Fn(T) -> f32,
}

impl<T: Copy, const N: usize> Texels for Values<'_, T, N> {
    type Cell = [T; N];

    #[inline]
    fn cells(&self) -> &[[T; N]] {
        self.cells
    }

    #[inline]
    fn of(&self, cell: &[T; N]) -> Rgba {
        let cell = cell.map(self.value);
        let alpha = if N % 2 == 1 { 1.0 } else { cell[N - 1] };
        if N < 3 { [cell[0], cell[0], cell[0], alpha] } else { [cell[0], cell[1], cell[2], alpha] }
    }
}

/// Runs `$body` with `$texels` of the picture's own kind: the choice is made once, not at every pixel.
macro_rules! with_texels {
    ($picture:expr, $texels:ident => $body:expr) => {
        match ($picture.channels, &$picture.samples) {
            (Channels::Grey, samples) => with_texels!(1, samples, $texels => $body),
            (Channels::GreyAlpha, samples) => with_texels!(2, samples, $texels => $body),
            (Channels::Rgb, samples) => with_texels!(3, samples, $texels => $body),
            (Channels::Rgba, samples) => with_texels!(4, samples, $texels => $body),
        }
    };
    ($n:literal, $samples:expr, $texels:ident => $body:expr) => {
        match $samples {
            Samples::Bytes(all, light) => {
                let $texels = Codes { cells: all.as_chunks::<$n>().0, light: &**light };
                $body
            }
            Samples::Words(all, light) => {
                let $texels = Codes { cells: all.as_chunks::<$n>().0, light: &**light };
                $body
            }
            Samples::Halves(all) => {
                let values = &**HALVES;
                let $texels = Values { cells: all.as_chunks::<$n>().0, value: &|bits: u16| values[usize::from(bits)] };
                $body
            }
            Samples::Floats(all) => {
                let $texels = Values { cells: all.as_chunks::<$n>().0, value: &|value: f32| value };
                $body
            }
        }
    };
}

impl Picture {
    /// A picture of samples, as many as its pixels have.
    pub fn new(width: usize, height: usize, channels: Channels, samples: Samples) -> Self {
        assert_eq!(samples.len(), width * height * channels.count(), "samples of a {width} x {height} picture");
        Picture { width, height, channels, samples }
    }

    /// A picture of linear, premultiplied RGBA, row by row.
    pub fn from_cells(width: usize, height: usize, cells: Vec<Rgba>) -> Self {
        Picture::new(width, height, Channels::Rgba, Samples::Floats(cells.into_flattened()))
    }

    /// A picture of one color.
    pub fn filled(width: usize, height: usize, color: Rgba) -> Self {
        Picture::from_cells(width, height, vec![color; width * height])
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Which samples its pixels have.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Its samples as they were read.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Whether nothing shines through any of its pixels.
    pub fn is_opaque(&self) -> bool {
        let mut row = vec![[0.0; 4]; self.width];
        !self.channels.have_alpha()
            || (0..self.height).all(|y| {
                self.row(0, y, &mut row);
                row.iter().all(|[.., alpha]| *alpha >= 1.0)
            })
    }

    /// How many bytes of memory it takes.
    pub fn bytes(&self) -> u64 {
        let each = match self.samples {
            Samples::Bytes(..) => 1,
            Samples::Words(..) | Samples::Halves(_) => 2,
            Samples::Floats(_) => 4,
        };
        self.samples.len() as u64 * each
    }

    /// The pixel in column `x`, row `y`.
    pub fn texel(&self, x: usize, y: usize) -> Rgba {
        assert!(x < self.width, "column {x} of {}", self.width);
        with_texels!(self, texels => texels.at(y * self.width + x))
    }

    /// Red, green and blue of the pixel in column `x`, row `y` in codes of 8 bits: those that were read, otherwise sRGB.
    pub fn codes(&self, x: usize, y: usize) -> [u8; 3] {
        let Samples::Bytes(all, _) = &self.samples else {
            let [r, g, b, _] = encode(self.texel(x, y));
            return [r, g, b];
        };
        let count = self.channels.count();
        let first = (y * self.width + x) * count;
        if count < 3 { [all[first]; 3] } else { [0, 1, 2].map(|c| all[first + c]) }
    }

    /// Gives a fully transparent encoded pixel the color that the picture has at `place`, where it has one: pictures with
    /// straight alpha do, whatever the alpha.
    pub fn keep_clear_color(&self, place: Option<(usize, usize)>, code: &mut [u8; 4]) {
        let Some((x, y)) = place.filter(|_| code[3] == 0) else { return };
        let count = self.channels.count();
        let first = (y * self.width + x) * count;
        let channels = if count < 3 { [0; 3] } else { [0, 1, 2] };
        let light = match &self.samples {
            Samples::Bytes(all, light) => light.of(channels.map(|c| all[first + c].into())),
            Samples::Words(all, light) => light.of(channels.map(|c| all[first + c].into())),
            Samples::Halves(_) | Samples::Floats(_) => return,
        };
        let [r, g, b, _] = encode([light[0], light[1], light[2], 1.0]);
        *code = [r, g, b, 0];
    }

    /// Writes the pixels of row `y` from column `x` on to `out`.
    pub fn row(&self, x: usize, y: usize, out: &mut [Rgba]) {
        assert!(x + out.len() <= self.width, "columns {x} to {} of {}", x + out.len(), self.width);
        let first = y * self.width + x;
        with_texels!(self, texels => texels.row(first, out))
    }

    /// Writes the codes of row `y` from column `x` on as a frame has them, if that is what was read: opaque sRGB of 8 bits.
    pub fn copy_codes(&self, (x, y): (usize, usize), out: &mut [[u8; 4]]) -> bool {
        let Samples::Bytes(all, light) = &self.samples else { return false };
        if !Arc::ptr_eq(light, &SRGB_8) {
            return false;
        }
        let first = y * self.width + x;
        match self.channels {
            Channels::Grey => out.iter_mut().zip(&all[first..]).for_each(|(out, &v)| *out = [v, v, v, 255]),
            Channels::Rgb => {
                let own = &all.as_chunks::<3>().0[first..];
                out.iter_mut().zip(own).for_each(|(out, &[r, g, b])| *out = [r, g, b, 255]);
            }
            Channels::Rgba => {
                let own = &all.as_chunks::<4>().0[first..][..out.len()];
                if own.iter().filter(|code| code[3] == 255).count() < own.len() {
                    return false;
                }
                out.copy_from_slice(own);
            }
            Channels::GreyAlpha => return false,
        }
        true
    }

    /// The bilinear read at image coordinates (x, y); the center of pixel (i, j) is (i + 0.5, j + 0.5).
    pub fn read(&self, x: f64, y: f64, beyond: Beyond) -> Rgba {
        with_texels!(self, texels => bilinear((self.width, self.height), (x, y), beyond, |i| texels.at(i)))
    }

    /// As [`Picture::read`], of a picture that repeats in both directions.
    pub fn read_repeated(&self, x: f64, y: f64) -> Rgba {
        with_texels!(self, texels => bilinear_repeated((self.width, self.height), (x, y), |i| texels.at(i)))
    }

    /// All of it in linear light.
    pub fn to_linear(&self) -> Linear {
        let mut linear = Linear::filled(self.width, self.height, [0.0; 4]);
        let width = self.width.max(1);
        linear.cells_mut().chunks_mut(width).enumerate().for_each(|(y, row)| self.row(0, y, row));
        linear
    }
}

impl From<Linear> for Picture {
    fn from(linear: Linear) -> Self {
        let (width, height) = (linear.width(), linear.height());
        Picture::from_cells(width, height, linear.into_cells())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::pixels;

    #[test]
    fn every_kind_of_samples_gives_the_same_light() {
        let (grey, half) = (linear_from_srgb(128.0 / 255.0) as f32, 128.0f32 / 255.0);
        let (red, clear) = ([1.0, 0.0, 0.0, 1.0], [half * grey, half * grey, half * grey, half]);
        let bytes = |all: &[u8]| Samples::Bytes(all.to_vec(), SRGB_8.clone());
        let words = |all: &[u16]| Samples::Words(all.to_vec(), SRGB_16.clone());
        for (channels, samples, expected) in [
            (Channels::Grey, bytes(&[128]), [grey, grey, grey, 1.0]),
            (Channels::GreyAlpha, bytes(&[128, 128]), clear),
            (Channels::Rgb, bytes(&[255, 0, 0]), red),
            (Channels::Rgba, bytes(&[128, 128, 128, 128]), clear),
            (Channels::Grey, words(&[128 * 257]), [grey, grey, grey, 1.0]),
            (Channels::GreyAlpha, words(&[128 * 257, 128 * 257]), clear),
            (Channels::Rgb, words(&[65535, 0, 0]), red),
            (Channels::Rgba, words(&[128 * 257; 4]), clear),
            (Channels::Grey, Samples::Halves(vec![0x3800]), [0.5, 0.5, 0.5, 1.0]),
            (Channels::Rgb, Samples::Halves(vec![0x4000, 0xbc00, 1]), [2.0, -1.0, 5.9604645e-8, 1.0]),
            (Channels::GreyAlpha, Samples::Floats(vec![0.25, 0.5]), [0.25, 0.25, 0.25, 0.5]),
            (Channels::Rgba, Samples::Floats(vec![0.1, 0.2, 0.3, 0.4]), [0.1, 0.2, 0.3, 0.4]),
        ] {
            let picture = Picture::new(1, 1, channels, samples);
            let mut row = [[9.0; 4]];
            picture.row(0, 0, &mut row);
            for found in [picture.texel(0, 0), row[0], picture.read(0.5, 0.5, Beyond::Clamp)] {
                assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7), "{channels:?}: {found:?}");
            }
        }
    }

    #[test]
    fn bytes_give_the_bits_that_decoding_gives() {
        let codes: Vec<u8> = (0..=255).flat_map(|c: u8| [c, 255 - c, c / 2, c.wrapping_mul(7)]).collect();
        let picture = Picture::new(16, 16, Channels::Rgba, Samples::Bytes(codes.clone(), SRGB_8.clone()));
        for (i, &code) in codes.as_chunks::<4>().0.iter().enumerate() {
            assert_eq!(picture.texel(i % 16, i / 16).map(f32::to_bits), pixels::decode(code).map(f32::to_bits));
        }
    }

    #[test]
    fn codes_are_copied_only_if_they_are_those_of_a_frame() {
        let of = |channels: Channels, all: &[u8], light: &Arc<Light<256>>| {
            let mut out = [[0; 4]];
            let picture = Picture::new(2, 1, channels, Samples::Bytes(all.to_vec(), light.clone()));
            picture.copy_codes((1, 0), &mut out).then_some(out[0])
        };
        let other = Arc::new(Light::of_curve(|code| code));
        assert_eq!(of(Channels::Grey, &[0, 7], &SRGB_8), Some([7, 7, 7, 255]));
        assert_eq!(of(Channels::Rgb, &[0, 0, 0, 1, 2, 3], &SRGB_8), Some([1, 2, 3, 255]));
        assert_eq!(of(Channels::Rgba, &[0, 0, 0, 0, 1, 2, 3, 255], &SRGB_8), Some([1, 2, 3, 255]));
        assert_eq!(of(Channels::Rgba, &[0, 0, 0, 255, 1, 2, 3, 254], &SRGB_8), None);
        assert_eq!(of(Channels::GreyAlpha, &[0, 0, 1, 255], &SRGB_8), None);
        assert_eq!(of(Channels::Rgb, &[0, 0, 0, 1, 2, 3], &other), None);
    }

    #[test]
    fn other_primaries_are_turned_and_clipped() {
        let swap = [[0.0, 1.0, 0.0], [1.5, 0.0, 0.0], [0.0, 0.0, -1.0]];
        let light = Light::<256> { matrix: Some(swap), ..(**SRGB_8).clone() };
        let picture = Picture::new(1, 1, Channels::Rgb, Samples::Bytes(vec![255, 0, 255], Arc::new(light)));
        assert_eq!(picture.texel(0, 0), [0.0, 1.0, 0.0, 1.0]);
    }
}
