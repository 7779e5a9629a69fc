//! What is kept on the device between frames: pictures, fields and anything else that a plan uploads, identified by its
//! `Arc`, so that an edit of one zone uploads only that zone. What a scene no longer uses is released.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::device::{Device, failed};
use crate::base::error::Result;
use crate::base::progress::Progress;
use crate::layers::parts::plan::{Format, Packed, Upload};

/// At most this many bytes are uploaded at a time.
const BAND_BYTES: usize = 32 << 20;
/// Progress of one upload is counted in this many steps.
const PIECES: u64 = 1000;

/// A texture on the device.
#[derive(Clone)]
pub struct Texture {
    /// A view of the whole texture.
    pub view: wgpu::TextureView,
    /// The format of a texel.
    pub format: Format,
}

/// Textures that were made on another thread than the one that draws, which takes them over.
pub struct Uploaded {
    device: wgpu::Device,
    rows: Vec<Row>,
}

impl Uploaded {
    /// How many things were uploaded.
    pub fn count(&self) -> usize {
        self.rows.len()
    }
}

/// Packs and uploads what of `wanted` is not `known`, one after the other; `sent` counts how far that is.
pub fn upload_all(
    device: &Device,
    wanted: impl Iterator<Item = Arc<dyn Upload>>,
    known: &[Arc<dyn Upload>],
    (sent, stop): (&Progress, &AtomicBool),
) -> Result<Uploaded> {
    let mut new: Vec<Arc<dyn Upload>> = Vec::new();
    for of in wanted {
        if !known.iter().chain(&new).any(|known| same(known, &of)) {
            new.push(of);
        }
    }
    // Packing takes the most of it: how many rows there are in all is not known before.
    sent.expect(new.len() as u64 * PIECES);
    let one = |of: Arc<dyn Upload>| {
        let packed = of.pack();
        let count = packed.len().max(1) as u64;
        let done = |share: f64| {
            sent.done((PIECES as f64 * share) as u64 / count);
            !stop.load(Ordering::Relaxed)
        };
        let textures = packed.iter().map(|packed| upload(device, packed, &done)).collect::<Result<_>>()?;
        drop(packed);
        Ok(Row { of, textures, used: true })
    };
    Ok(Uploaded { device: device.raw.clone(), rows: new.into_iter().map(one).collect::<Result<_>>()? })
}

/// Textures by what they were packed from.
#[derive(Default)]
pub struct KeptTextures {
    rows: Vec<Row>,
}

struct Row {
    of: Arc<dyn Upload>,
    textures: Vec<Texture>,
    used: bool,
}

impl KeptTextures {
    /// One of the textures that something is packed into, uploaded if it is new.
    pub fn get(&mut self, device: &Device, of: &Arc<dyn Upload>, part: usize) -> Result<Texture> {
        let textures = self.all(of, |of| of.pack().iter().map(|packed| upload(device, packed, &|_| true)).collect())?;
        textures.get(part).cloned().ok_or_else(|| failed(format!("a plan wants texture {part} of {}", textures.len())))
    }

    fn all(
        &mut self,
        of: &Arc<dyn Upload>,
        make: impl FnOnce(&dyn Upload) -> Result<Vec<Texture>>,
    ) -> Result<&[Texture]> {
        let known = self.rows.iter().position(|row| same(&row.of, of));
        let i = match known {
            Some(i) => i,
            None => {
                self.rows.push(Row { of: of.clone(), textures: make(&**of)?, used: true });
                self.rows.len() - 1
            }
        };
        let row = &mut self.rows[i];
        row.used = true;
        Ok(&row.textures)
    }

    /// What is here.
    pub fn known(&self) -> Vec<Arc<dyn Upload>> {
        self.rows.iter().map(|row| row.of.clone()).collect()
    }

    /// Takes over what was uploaded; nothing if that was on another device.
    pub fn take(&mut self, device: &Device, uploaded: Uploaded) {
        if uploaded.device == device.raw {
            self.rows.extend(uploaded.rows);
        }
    }

    /// Releases what has not been asked for since the last call.
    pub fn end_frame(&mut self) {
        self.rows.retain(|row| row.used);
        self.rows.iter_mut().for_each(|row| row.used = false);
    }
}

/// By their addresses alone: the same thing may be known by several tables of functions.
fn same(a: &Arc<dyn Upload>, b: &Arc<dyn Upload>) -> bool {
    Arc::as_ptr(a).cast::<()>() == Arc::as_ptr(b).cast::<()>()
}

/// The device's format, and its bytes per texel.
pub fn format(format: Format) -> (wgpu::TextureFormat, usize) {
    match format {
        Format::Rgba32Float => (wgpu::TextureFormat::Rgba32Float, 16),
        Format::Rgba16Float => (wgpu::TextureFormat::Rgba16Float, 8),
        Format::R32Float => (wgpu::TextureFormat::R32Float, 4),
        Format::Rg32Float => (wgpu::TextureFormat::Rg32Float, 8),
        Format::Rgba32Uint => (wgpu::TextureFormat::Rgba32Uint, 16),
    }
}

/// Makes a texture, band by band of its rows; `done` hears what share of them was sent, and returns
/// whether to go on.
fn upload(device: &Device, packed: &Packed<'_>, done: &dyn Fn(f64) -> bool) -> Result<Texture> {
    let (width, height) = packed.size;
    check_size(device, width, height)?;
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let (name, texel_bytes) = format(packed.format);
    let texture = texture(device, packed.size, name, usage)?;
    let row_bytes = width * texel_bytes;
    let most = (BAND_BYTES / row_bytes).max(1);
    for y in (0..height).step_by(most) {
        let rows = most.min(height - y);
        let mut send = |bytes: &[u8]| {
            device.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d { x: 0, y: y as u32, z: 0 },
                    ..texture.as_image_copy()
                },
                bytes,
                wgpu::TexelCopyBufferLayout { bytes_per_row: Some(row_bytes as u32), ..Default::default() },
                wgpu::Extent3d { width: width as u32, height: rows as u32, depth_or_array_layers: 1 },
            );
            device.queue.submit([]);
        };
        device.alone(|| (packed.rows)(y..y + rows, &mut send))?;
        if !done(rows as f64 / height as f64) {
            return Err(failed("stopped"));
        }
    }
    Ok(Texture { view: texture.create_view(&Default::default()), format: packed.format })
}

/// A texture with one mip level.
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

/// Refuses sizes that are too large for one texture of the device.
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
    use crate::base::picture::Picture;

    #[test]
    fn what_is_shared_is_made_once_and_what_is_unused_goes() {
        let mut kept = KeptTextures::default();
        let picture = || -> Arc<dyn Upload> { Arc::new(Picture::filled(1, 1, [0.0; 4])) };
        let (a, b) = (picture(), picture());
        let mut made = 0;
        let mut get = |kept: &mut KeptTextures, key: &Arc<dyn Upload>| {
            let make = |_: &dyn Upload| {
                made += 1;
                Ok(Vec::new())
            };
            kept.all(key, make).map(drop).unwrap();
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
