//! The parts of a glTF 2.0 file that a mesh is made from, as its JSON has them. What is not listed here is skipped.

use std::borrow::Cow;

use serde::Deserialize;

use crate::base::pixels::encode;
use crate::base::text::hex;

/// A text that is not copied where the JSON has it as it is: buffers may be in one.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Text<'a>(#[serde(borrow)] pub(super) Cow<'a, str>);

/// The whole of it. Indices are those of the lists.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Document<'a> {
    #[serde(borrow)]
    pub(super) asset: Asset<'a>,
    pub(super) scene: Option<usize>,
    pub(super) scenes: Vec<Scene>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<View>,
    #[serde(borrow)]
    pub(super) buffers: Vec<Buffer<'a>>,
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
    #[serde(borrow)]
    pub(super) images: Vec<Image<'a>>,
    #[serde(borrow)]
    pub(super) extensions_required: Vec<Text<'a>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Asset<'a> {
    #[serde(borrow)]
    pub(super) version: Text<'a>,
    /// The version that a reader is to know, where that is not the same.
    #[serde(borrow)]
    pub(super) min_version: Text<'a>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub(super) nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    /// By columns; in place of the three below.
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    /// A quaternion: x, y, z, w.
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Mesh {
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    /// Points, lines, a loop and a strip of them, triangles, a strip and a fan of them; from 0.
    pub(super) mode: Option<u32>,
    pub(super) targets: Vec<serde::de::IgnoredAny>,
}

impl Primitive {
    /// Whether its corners make triangles.
    pub(super) fn has_faces(&self) -> bool {
        self.attributes.position.is_some() && matches!(self.mode, None | Some(4..=6))
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Attributes {
    pub(super) position: Option<usize>,
    pub(super) normal: Option<usize>,
    pub(super) texcoord_0: Option<usize>,
    pub(super) color_0: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Accessor {
    /// All zero without one.
    pub(super) buffer_view: Option<usize>,
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<Sparse>,
}

/// Elements that differ from those of the view.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: Part,
    pub(super) values: Part,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Part {
    pub(super) buffer_view: usize,
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Buffer<'a> {
    pub(super) byte_length: u64,
    /// The second chunk of a `.glb` without one.
    #[serde(borrow)]
    pub(super) uri: Option<Text<'a>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: Option<Surface>,
    pub(super) double_sided: bool,
    pub(super) alpha_mode: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Surface {
    pub(super) base_color_texture: Option<TextureInfo>,
    /// Linear light and alpha.
    pub(super) base_color_factor: Option<[f32; 4]>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: usize,
    /// Which texture coordinates it is laid by.
    #[serde(default)]
    pub(super) tex_coord: u32,
    #[serde(default)]
    pub(super) extensions: Option<InfoExtensions>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct InfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<serde::de::IgnoredAny>,
}

impl Material {
    /// Its base color, which a texture is multiplied by: sRGB, #rrggbb, and #rrggbbaa where it is blended. White unless it
    /// is written.
    pub(super) fn color(&self) -> String {
        let surface = self.pbr_metallic_roughness.as_ref();
        let [r, g, b, a] = surface.and_then(|surface| surface.base_color_factor).unwrap_or([1.0; 4]);
        let [r, g, b, _] = encode([r, g, b, 1.0]);
        let alpha = (a.clamp(0.0, 1.0) * 255.0).round() as u8;
        let is_blended = self.alpha_mode.as_deref() == Some("BLEND") && alpha < 255;
        format!("#{}", if is_blended { hex(&[r, g, b, alpha]) } else { hex(&[r, g, b]) })
    }

    /// The texture of its base color.
    pub(super) fn base_color(&self) -> Option<&TextureInfo> {
        self.pbr_metallic_roughness.as_ref()?.base_color_texture.as_ref()
    }
}

impl TextureInfo {
    /// Whether it is laid otherwise than by the first texture coordinates as they are.
    pub(super) fn is_moved(&self) -> bool {
        self.tex_coord > 0 || self.extensions.as_ref().is_some_and(|extensions| extensions.transform.is_some())
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Texture {
    pub(super) source: Option<usize>,
    pub(super) extensions: Option<TextureExtensions>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct TextureExtensions {
    /// In place of `source`, where a program can read WebP.
    #[serde(rename = "EXT_texture_webp")]
    pub(super) webp: Option<Webp>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Webp {
    pub(super) source: usize,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Image<'a> {
    #[serde(borrow)]
    pub(super) uri: Option<Text<'a>>,
    pub(super) buffer_view: Option<usize>,
}
