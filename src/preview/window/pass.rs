//! A pass in place of the frame, or a frame that the CPU draws. It is what the reference is made from, and made again only
//! where something that it shows has changed.

use std::borrow::Cow;

use super::own_view::OwnView;
use crate::base::error::Result;
use crate::base::pixels::{Linear, decode, encode};
use crate::render::Synth;
use crate::render::gpu::Gpu;
use crate::render::passes::{self, Asked};

/// At most so many pixels are computed; larger frames are thinned out.
const MOST: usize = 1 << 22;

/// The textures of a pass, and what they were made for.
#[derive(Default)]
pub struct Kept {
    made_for: Option<For>,
    textures: Option<(wgpu::Texture, Option<wgpu::Texture>)>,
    /// Pixels of the frame a pixel of the textures.
    pub each: usize,
}

/// What the textures of a pass depend on.
#[derive(Clone, PartialEq)]
pub struct For {
    /// The pass.
    pub asked: Asked,
    /// The number of scenes so far.
    pub revision: u64,
    /// Where the window looks from, if that is not where the scene's camera does.
    pub own: Option<OwnView>,
    /// The scene times of the frame and of what it is compared with, and whether the frame is the still picture.
    pub times: (f64, Option<f64>, bool),
    /// How many sprites are left out after each that is shown.
    pub left_out: u32,
}

impl Kept {
    /// The textures: of the frame, and of the one that it is shown beside or compared with.
    pub fn follow(
        &mut self,
        gpu: &Gpu,
        wanted: For,
        frame: (&Synth, f64),
        other: Option<(Cow<'_, Synth>, f64)>,
    ) -> Result<(wgpu::Texture, Option<wgpu::Texture>)> {
        if let Some(textures) = self.textures.as_ref().filter(|_| self.made_for.as_ref() == Some(&wanted)) {
            return Ok(textures.clone());
        }
        let mut make = |(synth, time): (&Synth, f64)| {
            let (picture, each) = passes::thinned(&wanted.asked, synth, time, MOST);
            self.each = each;
            upload(gpu, &wanted.asked, &picture)
        };
        let textures = (make(frame)?, other.as_ref().map(|(synth, time)| make((synth, *time))).transpose()?);
        self.made_for = Some(wanted);
        self.textures = Some(textures.clone());
        Ok(textures)
    }
}

/// A pass as a texture to look at: sRGB, premultiplied in linear light.
fn upload(gpu: &Gpu, asked: &Asked, picture: &Linear) -> Result<wgpu::Texture> {
    let view = passes::view(asked.pass, picture);
    let premultiplied = |code: [u8; 4]| {
        let [r, g, b, a] = decode(code);
        let [r, g, b, _] = encode([r, g, b, 1.0]);
        [r, g, b, (a * 255.0).round() as u8]
    };
    let texel = |&code: &[u8; 4]| if matches!(code[3], 0 | 255) { code } else { premultiplied(code) };
    let texels: Vec<[u8; 4]> = view.cells().iter().map(texel).collect();
    let size = wgpu::Extent3d { width: view.width() as u32, height: view.height() as u32, depth_or_array_layers: 1 };
    let device = gpu.device();
    device.checked(|| {
        let texture = device.raw.create_texture(&wgpu::TextureDescriptor {
            label: Some("pass"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(4 * size.width), ..Default::default() };
        device.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
        texture
    })
}
