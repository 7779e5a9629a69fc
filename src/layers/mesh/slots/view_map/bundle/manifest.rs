//! What a manifest says about a view map: all that a shader must know besides the numbers in the textures.

use serde::Serialize;

use crate::layers::parts::bundle::{FileNote, HalvesNote, PictureNote, TextureNote};

/// A view map.
#[derive(Debug, Serialize)]
pub struct Manifest {
    /// Its kind of surface.
    pub kind: &'static str,
    /// How all of it is read, in words and formulas.
    pub conventions: Conventions,
    /// The mesh, with the texture coordinates that lead to its cells.
    pub mesh: FileNote,
    /// How many directions there are along the sides of the array of a cell.
    pub directions: usize,
    /// The color where no view tells anything, in linear light.
    pub missing: [f32; 3],
    /// The layers of cells, the coarsest first.
    pub layers: Vec<Layer>,
    /// Where each chart is.
    pub charts: Vec<Chart>,
    /// From where the base coat alone is seen.
    pub blend: Blend,
    /// The base coat by the texture coordinates of the mesh itself, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baked: Option<PictureNote>,
}

/// How the textures are read, in words for whoever writes a shader.
#[derive(Debug, Serialize)]
pub struct Conventions {
    texels: &'static str,
    cells: &'static str,
    depth: &'static str,
    reading: &'static str,
    base: &'static str,
    turns: &'static str,
    directions: &'static str,
    blend: &'static str,
    shown: &'static str,
}

/// The conventions of this version.
pub const CONVENTIONS: Conventions = Conventions {
    texels: "rows from the top; the centre of texel (i, j) is at (i + 0.5, j + 0.5); u and v are those of mesh, v upward; with width and height of layer i its place there is p_i = (u width, (1 - v) height)",
    cells: "cell (x, y) of a chart on layer i is the texel (2^i chart.x + x, 2^i chart.y + y) of base and turns, and in directions the block of n x n texels that begins at n times that, n = directions; where the alpha of base is 0 there is no cell: a texel beside one repeats it",
    depth: "d = -log4(J), held in 0 ... layers - 1; J = abs(det(dp_0/dx, dp_0/dy)) is the area of layer 0, in texels, that a pixel of the frame covers",
    reading: "linear over layers floor(d) and floor(d) + 1 by the fraction of d; on each bilinear over the four texels nearest to p_i, those without a cell dropped and the weights made to sum to one; a layer without any is dropped likewise; of each cell I, P and a are found for itself",
    base: "I: base decoded from sRGB to linear light, its alpha not multiplied; where there is a float file that as it is",
    turns: "a quaternion (x, y, z, w) that turns (1, 0, 0) into T, (0, 1, 0) into B and (0, 0, 1) into N of the cell, in the coordinates of the mesh",
    directions: "w: the unit vector from the point to the eye, turned back by what turns the object (and bends it there); (s, t) = (w . T, w . B) / (1 + w . N), where w . N < 0 the normalised (w . T, w . B); the place in the block is ((s + 1) n / 2, (t + 1) n / 2), bilinear between its texels' centres, held within them; RGB is P, linear and premultiplied, A is a",
    blend: "p and v: place and direction of the camera in the coordinates of the mesh; s_i = max(0, (v . direction_i - cosine) / (1 - cosine)) max(0, 1 - |p - position_i| / distance); B = (sum base_i s_i / sum s_i) min(1, 4 sum s_i), 0 where that sum is 0",
    shown: "B I + (1 - B) (P + (1 - a) I), each sum over cells first; opaque, and no light falls on it",
};

/// A layer of cells.
#[derive(Debug, Serialize)]
pub struct Layer {
    /// Cells along a unit of the atlas, in which all of the surface is half a square.
    pub density: f64,
    /// Columns of base and turns.
    pub width: usize,
    /// Rows of base and turns.
    pub height: usize,
    /// The base coat.
    pub base: PictureNote,
    /// What depends on the direction.
    pub directions: HalvesNote,
    /// How cells are turned.
    pub turns: TextureNote,
}

/// A chart, in texels of layer 0.
#[derive(Debug, Serialize)]
pub struct Chart {
    /// Its first column.
    pub x: usize,
    /// Its first row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// From where the base coat alone is seen.
#[derive(Debug, Serialize)]
pub struct Blend {
    /// The points.
    pub points: Vec<Point>,
    /// The cosine of the angle that they reach.
    pub cosine: f64,
    /// The distance that they reach, in meters.
    pub distance: f64,
}

/// A blend point.
#[derive(Debug, Serialize)]
pub struct Point {
    /// Where one stands.
    pub position: [f64; 3],
    /// Where one looks: a unit vector.
    pub direction: [f64; 3],
    /// How much of the base coat alone is seen from there.
    pub base: f64,
}
