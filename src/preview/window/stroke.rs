//! One stroke: an instance that screen.wgsl draws. In physical pixels; nothing here knows what it draws.

/// sRGB with straight alpha.
pub type Color = [u8; 4];

/// One instance of screen.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Stroke {
    /// One end, or a box's corner.
    pub a: [f32; 2],
    /// The other.
    pub b: [f32; 2],
    /// Half the width; the corner radius of a box.
    pub radius: f32,
    /// One of the forms below.
    pub form: u32,
    /// Its color.
    pub color: Color,
    /// Where a glyph stands in the atlas.
    pub texel: [u16; 2],
}

impl Stroke {
    /// A glyph between two corners on whole pixels, from its place in the atlas.
    pub fn glyph(a: [f32; 2], b: [f32; 2], texel: [u16; 2], color: Color) -> Stroke {
        Stroke { a, b, radius: 0.0, form: GLYPH, color, texel }
    }
}

/// A line with round ends; a disc where the ends meet.
pub const LINE: u32 = 0;
/// A box between two corners.
pub const BOX: u32 = 1;
/// A square on its corner, at `a`.
pub const DIAMOND: u32 = 2;
/// A part of the atlas of glyphs, between two corners.
pub const GLYPH: u32 = 3;
