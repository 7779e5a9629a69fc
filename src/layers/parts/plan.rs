//! What the GPU draws for a layer, as data: a technique describes it, and only `render/gpu` executes it.

use std::any::Any;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::base::picture::Picture;
use crate::base::pixels::Grid;

/// Code shared by the shaders of all techniques: the triangle over the whole frame, and sRGB.
pub const COMMON: &str = include_str!("common.wgsl");

/// A vertex and a fragment shader. Its bindings are those of group 0, in the order of [`Draw::binds`].
#[derive(Debug)]
pub struct Program {
    /// Its name in error messages.
    pub name: &'static str,
    /// The parts of its WGSL.
    pub source: &'static [&'static str],
    /// The entry point for vertices; three vertices are drawn, without buffers.
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

/// A whole layer at one time: draws, in order, into a picture of the frame's size that is transparent at first.
#[derive(Debug, Default)]
pub struct Plan {
    /// The draws.
    pub draws: Vec<Draw>,
}

/// One draw.
#[derive(Debug)]
pub struct Draw {
    /// The program to run.
    pub program: &'static Program,
    /// Values of `override` constants: they are compiled in, so there should be few different ones.
    pub constants: Vec<(&'static str, f64)>,
    /// The resources that the program reads, by binding number.
    pub binds: Vec<Bind>,
    /// How a pixel is blended with what is there.
    pub blend: Blend,
    /// The pixels to draw: left, top, width, height, clipped to the frame; `None` for all.
    pub scissor_px: Option<[u32; 4]>,
}

/// How a drawn pixel, with premultiplied alpha, is blended with what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// It replaces what is there.
    Replace,
    /// It is drawn over what is there.
    Over,
}

/// A resource that a program reads.
#[derive(Clone)]
pub enum Bind {
    /// A uniform, in the memory layout of WGSL.
    Bytes(Vec<u8>),
    /// One of the textures that an upload is packed into, by its number.
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

/// Something that is packed into textures once, and stays on the device for as long as the same `Arc` is used.
pub trait Upload: Any + Send + Sync {
    /// The textures, in the order of their numbers in [`Bind::Upload`].
    fn pack(&self) -> Vec<Packed<'_>>;
}

/// A texture, ready for upload.
pub struct Packed<'a> {
    /// Width and height, in texels.
    pub size: (usize, usize),
    /// The format of a texel.
    pub format: Format,
    /// Its bytes.
    pub rows: Rows<'a>,
}

/// Calls back with the bytes of some rows, row by row.
pub type Rows<'a> = Box<dyn Fn(Range<usize>, &mut dyn FnMut(&[u8])) + 'a>;

/// The format of a texel.
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
    /// The cells of a grid as texels; a cell must have as many bytes as a texel.
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
