//! What the GPU draws of a layer, as data: a technique says it, and `render/gpu` alone does it.

use std::any::Any;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::base::picture::Picture;
use crate::base::pixels::Grid;

/// What the shaders of several techniques share: the triangle over the whole frame, sRGB.
pub const COMMON: &str = include_str!("common.wgsl");

/// A vertex and a fragment shader. Its bindings are those of group 0, in the order of [`Draw::binds`].
#[derive(Debug)]
pub struct Program {
    /// For error messages.
    pub name: &'static str,
    /// WGSL, put together of these.
    pub source: &'static [&'static str],
    /// The entry point for vertices; three of them are drawn, without buffers.
    pub vertex: &'static str,
    /// The entry point for pixels.
    pub fragment: &'static str,
}

impl Program {
    /// Its WGSL in one piece.
    pub fn text(&self) -> String {
        self.source.concat()
    }
}

/// All of a layer at one time: draws in order, into a picture of the frame's size that is clear at first.
#[derive(Debug, Default)]
pub struct Plan {
    /// The draws.
    pub draws: Vec<Draw>,
}

/// One draw.
#[derive(Debug)]
pub struct Draw {
    /// What is run.
    pub program: &'static Program,
    /// Values of `override` constants: they are compiled in, so let there be few.
    pub constants: Vec<(&'static str, f64)>,
    /// What the program reads, by binding number.
    pub binds: Vec<Bind>,
    /// How a pixel is laid on what is there.
    pub blend: Blend,
    /// The only pixels that are drawn: left, top, width, height, clipped to the frame; `None` if all are.
    pub scissor_px: Option<[u32; 4]>,
}

/// How a drawn pixel, premultiplied by its alpha, is laid on what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// In its place.
    Replace,
    /// Over it.
    Over,
}

/// Something that a program reads.
#[derive(Clone)]
pub enum Bind {
    /// A uniform, laid out as WGSL wants it.
    Bytes(Vec<u8>),
    /// One of the textures that something is packed into.
    Upload(Arc<dyn Upload>, usize),
}

impl fmt::Debug for Bind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Bind::Bytes(bytes) => f.debug_tuple("Bytes").field(&bytes.len()).finish(),
            Bind::Upload(_, part) => f.debug_tuple("Upload").field(part).finish(),
        }
    }
}

/// Something that is packed into textures once, and stays on the device as long as the same `Arc` is asked for.
pub trait Upload: Any + Send + Sync {
    /// The textures, in the order of their numbers in [`Bind::Upload`].
    fn pack(&self) -> Vec<Packed<'_>>;
}

/// A texture, ready to be sent.
pub struct Packed<'a> {
    /// Width and height, in texels.
    pub size: (usize, usize),
    /// What a texel is.
    pub format: Format,
    /// Its bytes.
    pub rows: Rows<'a>,
}

/// Hands over the bytes of some rows, one row after the other.
pub type Rows<'a> = Box<dyn Fn(Range<usize>, &mut dyn FnMut(&[u8])) + 'a>;

/// What a texel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Four floats.
    Rgba32Float,
    /// One float.
    R32Float,
    /// Four whole numbers.
    Rgba32Uint,
}

impl Packed<'static> {
    /// The cells of a grid as texels; a cell has as many bytes as a texel.
    pub fn grid<T: bytemuck::Pod>(grid: Grid<T>, format: Format) -> Self {
        let (width, height) = (grid.width(), grid.height());
        let rows = move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
            take(bytemuck::cast_slice(&grid.cells()[rows.start * width..rows.end * width]));
        };
        Packed { size: (width, height), format, rows: Box::new(rows) }
    }
}

impl Upload for Picture {
    /// One texture: linear light, premultiplied.
    fn pack(&self) -> Vec<Packed<'_>> {
        let width = self.width();
        let rows = move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
            let mut band = vec![[0.0; 4]; rows.len() * width];
            band.chunks_mut(width.max(1)).zip(rows).for_each(|(out, y)| self.row(0, y, out));
            take(bytemuck::cast_slice(&band));
        };
        vec![Packed { size: (width, self.height()), format: Format::Rgba32Float, rows: Box::new(rows) }]
    }
}
