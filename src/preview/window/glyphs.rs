//! The atlas of glyphs on the GPU: what changed of it is sent before a drawing.

use super::text::{ATLAS_WIDTH, Letters};
use crate::render::gpu::device::Device;

/// The atlas as a texture.
#[derive(Default)]
pub struct Glyphs(Option<wgpu::Texture>);

impl Glyphs {
    /// The texture as the letters have it now.
    pub fn follow(&mut self, device: &Device, letters: &Letters) -> wgpu::Texture {
        letters.atlas(|atlas| {
            let height = atlas.height();
            let changed = atlas.take_changed();
            let kept = self.0.take().filter(|texture| texture.height() == height);
            let rows = if kept.is_some() { changed } else { 0..height };
            let texture = kept.unwrap_or_else(|| texture(device, height));
            if !rows.is_empty() {
                write(device, &texture, &rows, atlas.rows(&rows));
            }
            self.0 = Some(texture.clone());
            texture
        })
    }
}

fn texture(device: &Device, height: u32) -> wgpu::Texture {
    device.raw.create_texture(&wgpu::TextureDescriptor {
        label: Some("glyphs"),
        size: wgpu::Extent3d { width: ATLAS_WIDTH, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn write(device: &Device, texture: &wgpu::Texture, rows: &std::ops::Range<u32>, bytes: &[u8]) {
    device.queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x: 0, y: rows.start, z: 0 },
            aspect: wgpu::TextureAspect::All,
        },
        bytes,
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(ATLAS_WIDTH * 4), rows_per_image: None },
        wgpu::Extent3d { width: ATLAS_WIDTH, height: rows.end - rows.start, depth_or_array_layers: 1 },
    );
}
