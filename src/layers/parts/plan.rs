//! What the GPU computes and draws for a layer, as data: a technique describes it, and only `render/gpu` executes it.

use std::any::Any;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use crate::base::half::half_of_value;
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
    /// The entry point for vertices; it has their numbers, and no buffers.
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

/// A compute shader. Its bindings are those of group 0, in the order of [`Compute::binds`].
#[derive(Debug)]
pub struct Routine {
    /// Its name in error messages.
    pub name: &'static str,
    /// The parts of its WGSL.
    pub source: &'static [&'static str],
    /// The entry point.
    pub entry: &'static str,
}

impl Routine {
    /// Its WGSL in one piece.
    pub fn text(&self) -> String {
        self.source.concat()
    }
}

/// A whole layer at one time: steps, in order, that draw into a picture of the frame's size that is transparent at first. With
/// other layers of a group, the draws into the picture that read no depths come first, then the steps of layers with scratch
/// of their own, then all others.
#[derive(Debug, Default)]
pub struct Plan {
    /// What its steps leave for later ones, by their numbers in [`Canvas`] and [`Bind::Scratch`].
    pub scratch: Vec<Scratch>,
    /// The steps.
    pub steps: Vec<Step>,
}

/// One step of a plan.
#[derive(Debug)]
pub enum Step {
    /// Draws.
    Draw(Draw),
    /// Computes.
    Compute(Compute),
}

/// What some steps of a plan write and later ones read. Textures have the frame's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scratch {
    /// One texture.
    Texels(Format),
    /// So many on top of one another.
    Layers(Format, u32),
    /// Depths.
    Depths,
    /// An array of so many bytes.
    Bytes(u64),
    /// An array that has room for all that the [`Scratch::Tally`] asks for.
    Growing,
    /// What computes find out to be done, as a [`Tally`] that is all 0 at first.
    Tally,
}

/// How much there is to be done, in the memory layout of WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Tally {
    /// How much room the growing array has to have, in lumps of [`LUMP_BYTES`]. Where it has less, all of the frame is drawn
    /// again with more.
    pub room: u32,
    /// What [`Groups::Found`] runs.
    pub groups: [u32; 3],
    /// What a [`Draw::found`] draws: vertices, instances, and the first of both, 0.
    pub draw: [u32; 4],
}

/// The unit of [`Tally::room`], in bytes.
pub const LUMP_BYTES: u64 = 16;

impl Step {
    /// What its program reads and writes.
    pub fn binds(&self) -> &[Bind] {
        match self {
            Step::Draw(draw) => &draw.binds,
            Step::Compute(compute) => &compute.binds,
        }
    }

    /// The draw, if it is one.
    pub fn draw(&self) -> Option<&Draw> {
        match self {
            Step::Draw(draw) => Some(draw),
            Step::Compute(_) => None,
        }
    }
}

impl Plan {
    /// Only draws.
    pub fn of(draws: impl IntoIterator<Item = Draw>) -> Plan {
        Plan { scratch: Vec::new(), steps: draws.into_iter().map(Step::Draw).collect() }
    }

    /// Everything that is packed for it.
    pub fn uploads(self) -> Vec<Arc<dyn Upload>> {
        let binds = self.steps.into_iter().flat_map(|step| match step {
            Step::Draw(draw) => draw.binds,
            Step::Compute(compute) => compute.binds,
        });
        let uploads = binds.flat_map(|bind| match bind {
            Bind::Upload(of, _) => vec![of],
            Bind::Drawn(drawn) => drawn.plan.uploads(),
            Bind::Bytes(_) | Bind::List(_) | Bind::Scratch(_) | Bind::Written(_) | Bind::Depth | Bind::Linear => {
                Vec::new()
            }
        });
        uploads.collect()
    }
}

/// Work on arrays of the plan.
#[derive(Debug)]
pub struct Compute {
    /// The routine to run.
    pub routine: &'static Routine,
    /// As those of a [`Draw`].
    pub constants: Vec<(&'static str, f64)>,
    /// The resources that the routine reads and writes, by binding number.
    pub binds: Vec<Bind>,
    /// How many groups of threads run.
    pub groups: Groups,
}

/// A number of groups of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Groups {
    /// So many.
    Count(u32),
    /// As many as the [`Scratch::Tally`] of this number says.
    Found(usize),
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
    /// What is drawn into; `None` for the layer's picture.
    pub into: Option<Canvas>,
    /// How a pixel is blended with what is there.
    pub blend: Blend,
    /// How many vertices are drawn: three for all of the frame.
    pub vertices: u32,
    /// How often they are drawn, one time after the other.
    pub instances: u32,
    /// The number of the [`Scratch::Tally`] that says both in place of these, if one does.
    pub found: Option<usize>,
    /// Whether a pixel is drawn only where it is nearer than all before, and hides what is farther then.
    pub depth: bool,
    /// The pixels to draw: left, top, width, height, clipped to the frame; `None` for all.
    pub scissor_px: Option<[u32; 4]>,
}

impl Draw {
    /// A draw of all pixels of the layer's picture.
    pub fn frame(program: &'static Program, binds: Vec<Bind>) -> Draw {
        Draw {
            program,
            constants: Vec::new(),
            binds,
            into: None,
            blend: Blend::Replace,
            vertices: 3,
            instances: 1,
            found: None,
            depth: false,
            scissor_px: None,
        }
    }
}

/// What of a plan's own textures is drawn into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// The textures by their numbers, each with the layer of it, in the order of what the program gives.
    pub textures: Vec<(usize, u32)>,
    /// That of the depths by which pixels are tested.
    pub depths: Option<usize>,
    /// Whether they are cleared first.
    pub clear: bool,
}

impl Canvas {
    /// One layer of one texture, cleared first.
    pub fn one(texture: usize, layer: u32) -> Option<Canvas> {
        Some(Canvas { textures: vec![(texture, layer)], depths: None, clear: true })
    }
}

/// How a drawn pixel, with premultiplied alpha, is blended with what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// It replaces what is there.
    Replace,
    /// It is drawn over what is there.
    Over,
    /// What is there shines through by as much as each channel leaves, alpha like colors: in any order the same.
    Screen,
    /// It is added to what is there.
    Add,
}

/// A resource that a program reads.
pub enum Bind {
    /// A uniform, in the memory layout of WGSL.
    Bytes(Vec<u8>),
    /// An array that is only read, in the memory layout of WGSL.
    List(Vec<u8>),
    /// One of the textures that an upload is packed into, by its number.
    Upload(Arc<dyn Upload>, usize),
    /// A texture that is drawn first.
    Drawn(Box<DrawnTexture>),
    /// One of the plan's own textures or arrays, by its number, to be read.
    Scratch(usize),
    /// One of the plan's own arrays, by its number, that a routine also writes.
    Written(usize),
    /// The depths of the surfaces that are drawn with the layer, near / depth, 0 where there is none: the draw comes after
    /// them.
    Depth,
    /// What reads between the texels of filtered textures: linear, up to the edge.
    Linear,
}

/// A texture that is drawn before what reads it.
#[derive(Debug)]
pub struct DrawnTexture {
    /// Its width and height, in pixels.
    pub size_px: (usize, usize),
    /// What is drawn in it.
    pub plan: Plan,
}

impl fmt::Debug for Bind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Bind::Bytes(bytes) => f.debug_tuple("Bytes").field(&bytes.len()).finish(),
            Bind::List(bytes) => f.debug_tuple("List").field(&bytes.len()).finish(),
            Bind::Upload(_, part) => f.debug_tuple("Upload").field(part).finish(),
            Bind::Drawn(drawn) => drawn.fmt(f),
            Bind::Scratch(number) => f.debug_tuple("Scratch").field(number).finish(),
            Bind::Written(number) => f.debug_tuple("Written").field(number).finish(),
            Bind::Depth => f.write_str("Depth"),
            Bind::Linear => f.write_str("Linear"),
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

/// Calls back once, with the bytes of all of some rows, row by row.
pub type Rows<'a> = Box<dyn Fn(Range<usize>, &mut dyn FnMut(&[u8])) + 'a>;

/// The format of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Four floats.
    Rgba32Float,
    /// Four half floats, which can be filtered.
    Rgba16Float,
    /// One float.
    R32Float,
    /// Two floats that can be added to: of 16 bits where the device cannot add to others.
    Rg32Float,
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
    /// One texture: linear light, premultiplied, as fine as the frame that it is drawn in.
    fn pack(&self) -> Vec<Packed<'_>> {
        let width = self.width();
        let rows = move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
            let mut band = vec![[0_u16; 4]; rows.len() * width];
            let lines = band.par_chunks_mut(width.max(1)).zip(rows.into_par_iter());
            lines.for_each_init(
                || vec![[0.0; 4]; width],
                |line, (out, y)| {
                    self.row(0, y, line);
                    out.iter_mut().zip(line).for_each(|(out, color)| *out = color.map(half_of_value));
                },
            );
            take(bytemuck::cast_slice(&band));
        };
        vec![Packed { size: (width, self.height()), format: Format::Rgba16Float, rows: Box::new(rows) }]
    }
}
