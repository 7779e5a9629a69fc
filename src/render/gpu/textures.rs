//! What is kept on the device between frames: pictures and fields, known by the `Arc` they came in, so that an edit of
//! one zone uploads only that zone. What a scene no longer uses is let go.

use std::borrow::Cow;
use std::sync::Arc;

use super::device::{Device, failed};
use crate::base::error::Result;
use crate::base::picture::Picture;
use crate::base::pixels::Grid;
use crate::layers::folding::field::Field;
use crate::layers::folding::texels::Texels;

/// At most so many bytes are handed over at a time.
const BAND_BYTES: usize = 32 << 20;

/// A field on the device.
#[derive(Clone)]
pub struct FieldTextures {
    /// See [`Texels::pixels`].
    pub pixels: wgpu::TextureView,
    /// See [`Texels::crossings`].
    pub crossings: wgpu::TextureView,
}

/// Everything on the device.
#[derive(Default)]
pub struct Textures {
    pictures: Kept<Picture, wgpu::TextureView>,
    fields: Kept<Field, FieldTextures>,
}

impl Textures {
    /// The picture as a texture, uploaded where it is new.
    pub fn picture(&mut self, device: &Device, picture: &Arc<Picture>) -> Result<wgpu::TextureView> {
        self.pictures.get(picture, |picture| {
            let (width, height) = (picture.width(), picture.height());
            upload(device, (width, height), wgpu::TextureFormat::Rgba32Float, |y, rows| {
                let mut band = vec![[0.0; 4]; rows * width];
                band.chunks_mut(width).enumerate().for_each(|(row, out)| picture.row(0, y + row, out));
                band.into()
            })
        })
    }

    /// The field as textures, uploaded where it is new.
    pub fn field(&mut self, device: &Device, field: &Arc<Field>) -> Result<FieldTextures> {
        self.fields.get(field, |field| {
            let texels = Texels::pack(field);
            Ok(FieldTextures {
                pixels: upload_grid(device, &texels.pixels, wgpu::TextureFormat::Rgba32Uint)?,
                crossings: upload_grid(device, &texels.crossings, wgpu::TextureFormat::R32Float)?,
            })
        })
    }

    /// Lets go what was not asked for since the last call.
    pub fn end_frame(&mut self) {
        self.pictures.end_frame();
        self.fields.end_frame();
    }
}

/// Values made from shared ones, by identity.
struct Kept<K, V> {
    rows: Vec<(Arc<K>, V, bool)>,
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Kept { rows: Vec::new() }
    }
}

impl<K, V: Clone> Kept<K, V> {
    fn get(&mut self, key: &Arc<K>, make: impl FnOnce(&K) -> Result<V>) -> Result<V> {
        if let Some((_, value, used)) = self.rows.iter_mut().find(|(k, ..)| Arc::ptr_eq(k, key)) {
            *used = true;
            return Ok(value.clone());
        }
        let value = make(key)?;
        self.rows.push((key.clone(), value.clone(), true));
        Ok(value)
    }

    fn end_frame(&mut self) {
        self.rows.retain(|(.., used)| *used);
        self.rows.iter_mut().for_each(|(.., used)| *used = false);
    }
}

fn upload_grid<T: bytemuck::Pod>(
    device: &Device,
    grid: &Grid<T>,
    format: wgpu::TextureFormat,
) -> Result<wgpu::TextureView> {
    let width = grid.width();
    upload(device, (width, grid.height()), format, |y, rows| grid.cells()[y * width..][..rows * width].into())
}

/// Makes a texture of bands of rows; `band` gives as many as it is asked for, from row y on.
fn upload<'a, T: bytemuck::Pod>(
    device: &Device,
    (width, height): (usize, usize),
    format: wgpu::TextureFormat,
    band: impl Fn(usize, usize) -> Cow<'a, [T]>,
) -> Result<wgpu::TextureView> {
    check_size(device, width, height)?;
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture(device, (width, height), format, usage)?;
    let row_bytes = width * size_of::<T>();
    let most = (BAND_BYTES / row_bytes.max(1)).max(1);
    for y in (0..height).step_by(most) {
        let rows = most.min(height - y);
        let cells = band(y, rows);
        device.checked(|| {
            device.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d { x: 0, y: y as u32, z: 0 },
                    ..texture.as_image_copy()
                },
                bytemuck::cast_slice(&cells),
                wgpu::TexelCopyBufferLayout { bytes_per_row: Some(row_bytes as u32), ..Default::default() },
                wgpu::Extent3d { width: width as u32, height: rows as u32, depth_or_array_layers: 1 },
            );
            device.queue.submit([]);
        })?;
    }
    Ok(texture.create_view(&Default::default()))
}

/// A texture of one level.
pub fn texture(
    device: &Device,
    (width, height): (usize, usize),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::Texture> {
    device.checked(|| {
        device.raw.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    })
}

/// Refuses what the device cannot hold as one texture.
pub fn check_size(device: &Device, width: usize, height: usize) -> Result<()> {
    let most = device.max_side();
    if width == 0 || height == 0 {
        return Err(failed("an empty picture"));
    }
    if width.max(height) > most {
        return Err(failed(format!("{width} x {height} is more than {} can hold, {most} a side", device.name())));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_is_made_once_and_what_is_unused_goes() {
        let mut kept = Kept::<u8, u8>::default();
        let (a, b) = (Arc::new(1), Arc::new(1));
        let mut made = 0;
        let mut get = |kept: &mut Kept<u8, u8>, key| {
            kept.get(key, |k| {
                made += 1;
                Ok(*k)
            })
            .unwrap()
        };
        get(&mut kept, &a);
        get(&mut kept, &a);
        get(&mut kept, &b);
        kept.end_frame();
        get(&mut kept, &b);
        kept.end_frame();
        assert_eq!(kept.rows.len(), 1);
        get(&mut kept, &a);
        assert_eq!(made, 3);
    }
}
