//! What a model says of the looks of its surfaces.

/// What the materials of a model say of its looks, as far as a layer can have it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Looks {
    /// The color of the material that is shown: sRGB, with straight alpha where it is blended.
    pub color: Option<String>,
    /// Whether both sides of triangles are meant to be seen.
    pub both_sides: bool,
    /// The materials that are not shown, in words.
    pub left_out: Vec<String>,
}
