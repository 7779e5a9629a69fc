//! A data texture: numbers in four channels, and their exact or rounded forms. Zero is zero in each of them.

use crate::base::error::{Error, Result};
use crate::base::pixels::Grid;
use crate::export::{floats, still};
use crate::layers::parts::bundle::{Channel, ChannelNote, Texture, TextureNote};

/// How many bits a number takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 32-bit float, OpenEXR: the exact form.
    #[default]
    Float,
    /// 16-bit integers, PNG.
    Sixteen,
    /// 8-bit integers, PNG.
    Eight,
}

impl Depth {
    /// The extension of data files.
    pub fn extension(self) -> &'static str {
        match self {
            Depth::Float => "exr",
            Depth::Sixteen | Depth::Eight => "png",
        }
    }

    fn bits(self) -> u8 {
        match self {
            Depth::Float => 32,
            Depth::Sixteen => 16,
            Depth::Eight => 8,
        }
    }

    /// The largest code; `None` for floats.
    pub fn largest(self) -> Option<u16> {
        match self {
            Depth::Float => None,
            Depth::Sixteen => Some(65535),
            Depth::Eight => Some(255),
        }
    }
}

impl Texture {
    /// The bytes of the file called `file`, and its line in the manifest.
    ///
    /// # Errors
    /// Returns the encoder's error.
    pub fn encode(&self, file: String, depth: Depth) -> Result<(Vec<u8>, TextureNote)> {
        let codes = self.codes(depth);
        let failed = |e: &dyn std::fmt::Display| Error::at(&file, e);
        let (width, height) = (self.values.width(), self.values.height());
        let bytes = match depth.largest() {
            None => {
                let floats = self.values.cells().iter().map(|v| v.map(|v| v as f32)).collect();
                floats::rgba(&Grid::from_cells(width, height, floats)).map_err(|e| failed(&e))?
            }
            Some(_) => {
                let flat: Vec<u16> = self.values.cells().iter().flat_map(|v| encode(v, &codes)).collect();
                still::data(width, height, depth.bits(), &flat).map_err(|e| failed(&e))?
            }
        };
        let channels = self.channels.iter().enumerate().map(|(i, channel)| self.note(i, channel, codes[i])).collect();
        Ok((bytes, TextureNote { file, width, height, bits: depth.bits(), channels }))
    }

    /// The code of each channel.
    fn codes(&self, depth: Depth) -> [Code; 4] {
        let Some(largest) = depth.largest() else { return [Code::Float; 4] };
        let range = |i: usize| {
            let mine = |j: &usize| self.channels.get(*j).map(|c| c.group) == self.channels.get(i).map(|c| c.group);
            let values = (0..4).filter(mine).flat_map(|j| self.values.cells().iter().map(move |v| v[j]));
            values.fold((0.0, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)))
        };
        std::array::from_fn(|i| {
            let (low, high) = range(i);
            if low >= 0.0 {
                return Code::Whole { zero: 0, one: largest, scale: high.max(1.0) };
            }
            Code::Whole { zero: largest / 2 + 1, one: largest, scale: high.max(-low) }
        })
    }

    fn note(&self, i: usize, channel: &Channel, code: Code) -> ChannelNote {
        let off = |v: &[f64; 4]| (code.decode(code.encode(v[i]), v[i]) - v[i]).abs();
        let error = self.values.cells().iter().map(off).fold(0.0, f64::max);
        let (zero, one, scale) = match code {
            Code::Float => (None, None, None),
            Code::Whole { zero, one, scale } => (Some(zero), Some(one), Some(scale)),
        };
        let error_px = channel.pixels.map(|pixels| error * pixels);
        let Channel { name, meaning, .. } = *channel;
        ChannelNote { channel: ["R", "G", "B", "A"][i], name, meaning, zero, one, scale, error, error_px }
    }
}

#[derive(Clone, Copy)]
enum Code {
    Float,
    Whole { zero: u16, one: u16, scale: f64 },
}

impl Code {
    fn encode(self, value: f64) -> u16 {
        match self {
            Code::Float => 0,
            Code::Whole { zero, one, scale } => {
                (f64::from(zero) + value / scale * f64::from(one - zero)).round().clamp(0.0, f64::from(one)) as u16
            }
        }
    }

    /// What is read where `value` was written as `code`.
    fn decode(self, code: u16, value: f64) -> f64 {
        match self {
            Code::Float => f64::from(value as f32),
            Code::Whole { zero, one, scale } => (f64::from(code) - f64::from(zero)) / f64::from(one - zero) * scale,
        }
    }
}

fn encode(values: &[f64; 4], codes: &[Code; 4]) -> [u16; 4] {
    std::array::from_fn(|i| codes[i].encode(values[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHANNELS: [Channel; 3] = [
        Channel::new("a", "", 0),
        Channel::new("b", "", 0),
        Channel { pixels: Some(100.0), ..Channel::new("c", "", 1) },
    ];

    fn texture() -> Texture {
        let values = Grid::from_cells(2, 1, vec![[0.0, -3.0, 0.25, 0.0], [1.5, 0.0, 1.0, 0.0]]);
        Texture { values, channels: CHANNELS.to_vec() }
    }

    #[test]
    fn zero_and_the_largest_are_exact() {
        for (depth, zero, one) in [(Depth::Eight, 128, 255), (Depth::Sixteen, 32768, 65535)] {
            let (bytes, note) = texture().encode("x.png".into(), depth).unwrap();
            let image = image::load_from_memory(&bytes).unwrap();
            let code = |x, i| match depth {
                Depth::Eight => u16::from(image.to_rgba8().get_pixel(x, 0).0[i]),
                _ => image.to_rgba16().get_pixel(x, 0).0[i],
            };
            assert_eq!((code(0, 0), code(1, 1), code(0, 1)), (zero, zero, 1), "zero is zero, -scale is 1");
            assert_eq!((code(1, 2), code(0, 3)), (one, 0));
            assert_eq!((note.channels[0].scale, note.channels[2].scale), (Some(3.0), Some(1.0)));
            let error = note.channels[2].error;
            assert!(error <= 0.5 / f64::from(one) && note.channels[2].error_px == Some(error * 100.0));
        }
    }

    #[test]
    fn floats_are_floats() {
        let (bytes, note) = texture().encode("x.exr".into(), Depth::Float).unwrap();
        let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::OpenExr).unwrap().to_rgba32f();
        assert_eq!(image.get_pixel(0, 0).0, [0.0, -3.0, 0.25, 0.0]);
        assert_eq!((note.bits, note.channels[1].error), (32, 0.0));
    }
}
