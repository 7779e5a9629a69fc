//! Frames drawn by the GPU: the same pictures as from `render::cpu`, at display rate. The only module besides the
//! window that uses wgpu; it owns the device and replaces it if it is lost.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::base::error::Result;
use crate::base::pixels::{Frame, Grid, Linear};
use crate::base::progress::Progress;
use crate::layers::parts::plan::{Plan, Upload};
use crate::layers::ready::Ready;
use crate::render::{Synth, cpu};

pub mod device;
mod draw;
mod kept;
mod pipeline;
mod run;
mod target;

use device::{Device, readable};
pub use draw::PROGRAMS;
pub use kept::Uploaded;
pub use run::FRAME;

/// A GPU that draws frames.
pub struct Gpu {
    instance: wgpu::Instance,
    parts: Parts,
}

/// Uploads textures on the device of a [`Gpu`]; see [`Gpu::uploader`].
pub struct Uploader {
    device: Device,
    known: Vec<Arc<dyn Upload>>,
}

impl Uploader {
    /// Uploads what the frames of scenes need and is not on the device yet. `sent` counts how far that is.
    ///
    /// # Errors
    /// The device is lost, or has not enough memory; or `stop` was set, soon after that.
    pub fn upload(&self, scenes: &[&Synth], sent: &Progress, stop: &AtomicBool) -> Result<Uploaded> {
        // What the CPU draws itself where it would pretend to be a GPU is not wanted there.
        let is_drawn = |layer: &&Arc<dyn Ready>| {
            !(self.device.is_software() && layer.takes_long()) && self.device.cannot(&***layer).is_none()
        };
        let plans = scenes.iter().flat_map(|synth| {
            let moment = synth.moment(0.0);
            synth.layers.iter().filter(is_drawn).map(move |layer| layer.plan(&moment))
        });
        let wanted = plans.flat_map(Plan::uploads);
        kept::upload_all(&self.device, wanted, &self.known, (sent, stop))
    }

    /// Whether its device is gone.
    pub fn is_lost(&self) -> bool {
        self.device.is_lost()
    }
}

/// Everything that is lost with a device.
struct Parts {
    device: Device,
    painter: draw::Painter,
}

impl Parts {
    fn open(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Parts> {
        Ok(Parts { device: Device::open(instance, surface)?, painter: draw::Painter::default() })
    }
}

impl Gpu {
    /// The fastest GPU of the machine, without a window.
    ///
    /// # Errors
    /// If there is none.
    pub fn new() -> Result<Gpu> {
        Gpu::open(device::instance(None), None)
    }

    /// A GPU of `instance` that can present to `surface`, if one is given.
    pub fn open(instance: wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Gpu> {
        let parts = Parts::open(&instance, surface)?;
        Ok(Gpu { instance, parts })
    }

    /// The instance that adapters and surfaces come from.
    pub fn instance(&self) -> &wgpu::Instance {
        &self.instance
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.parts.device
    }

    /// What can upload the textures of scenes on another thread, so that drawing them later does not wait for that.
    pub fn uploader(&mut self) -> Uploader {
        Uploader { device: self.parts.device.clone(), known: self.parts.painter.kept().known() }
    }

    /// Takes over what an [`Uploader`] has uploaded; it stays if the next frame needs it.
    pub fn take(&mut self, uploaded: Uploaded) {
        let Parts { device, painter } = &mut self.parts;
        painter.kept().take(device, uploaded);
    }

    /// Draws the frame at `scene_time` in [0, 1] into a texture: linear, premultiplied, [`FRAME`].
    pub fn texture(&mut self, synth: &Synth, scene_time: f64) -> Result<wgpu::Texture> {
        self.textures((synth, scene_time), None, whole(synth)).map(|(frame, _)| frame)
    }

    /// As [`Gpu::texture`], with a second frame in a separate texture if one is wanted. Only `part` of them has to be right:
    /// left, top, width and height in pixels.
    pub fn textures(
        &mut self,
        first: (&Synth, f64),
        second: Option<(&Synth, f64)>,
        part: [u32; 4],
    ) -> Result<(wgpu::Texture, Option<wgpu::Texture>)> {
        let Parts { device, painter } = &mut self.parts;
        let first = painter.frame(device, 0, first, part)?;
        let second = second.map(|second| painter.frame(device, 1, second, part)).transpose()?;
        painter.end_frame();
        Ok((first, second))
    }

    /// Why the CPU draws frames in place of this GPU, in a few words; `None` if it need not.
    pub fn by_cpu(&self, synth: &Synth) -> Option<String> {
        synth.layers.iter().find_map(|layer| self.parts.device.cannot(&**layer))
    }

    /// The frame at `scene_time` in [0, 1]. A device lost on the way is replaced once. What the CPU alone can draw
    /// makes all of a frame its work.
    pub fn frame(&mut self, synth: &Synth, scene_time: f64) -> Result<Frame> {
        if self.by_cpu(synth).is_some() {
            return Ok(cpu::frame(synth, scene_time));
        }
        let frame = self.frame_once(synth, scene_time);
        if !self.parts.device.is_lost() {
            return frame;
        }
        self.parts = Parts::open(&self.instance, None)?;
        self.frame_once(synth, scene_time)
    }

    /// Why the CPU draws in place of this GPU where these are all samples of a pixel, in a few words; `None` if it need not.
    pub fn samples_by_cpu(&self, samples: &[Synth]) -> Option<String> {
        let first = samples.first()?;
        self.by_cpu(first).or_else(|| match Each::of(samples) {
            Each::Magnified(large) if large.size.0.max(large.size.1) > self.device().max_side() => {
                Some(format!("strokes with so many samples take frames of {} x {}", large.size.0, large.size.1))
            }
            Each::Apart => Some("strokes with several samples, with pictures or sprites beside them".to_owned()),
            Each::Magnified(_) | Each::Alone => None,
        })
    }

    /// The mean light of frames at `scene_time`, which are all samples of a pixel.
    pub fn mean(&mut self, samples: &[Synth], scene_time: f64) -> Result<Linear> {
        if self.samples_by_cpu(samples).is_some() {
            return Ok(cpu::mean(samples, scene_time));
        }
        let Each::Magnified(large) = Each::of(samples) else {
            let frames = samples.iter().map(|synth| self.frame(synth, scene_time)).collect::<Result<Vec<_>>>()?;
            return Ok(cpu::mean_of(frames.iter().map(Frame::to_linear)));
        };
        let frame = self.frame(&large, scene_time)?;
        let each = large.stage.magnified as usize;
        let sample = |k: usize| {
            let rows = (k / each..frame.height()).step_by(each).map(|y| frame.row(y));
            let cells = rows.flat_map(|row| row[k % each..].iter().step_by(each).copied());
            Frame::from_cells(frame.width() / each, frame.height() / each, cells.collect()).to_linear()
        };
        Ok(cpu::mean_of((0..samples.len()).map(sample)))
    }

    fn frame_once(&mut self, synth: &Synth, scene_time: f64) -> Result<Frame> {
        let frame = self.texture(synth, scene_time)?;
        let encoded = self.parts.painter.encode(&self.parts.device, &frame)?;
        let read = read_back(&self.parts.device, &encoded);
        self.parts.device.take_uncaught()?;
        read
    }
}

/// All of a frame.
fn whole(synth: &Synth) -> [u32; 4] {
    [0, 0, synth.size.0 as u32, synth.size.1 as u32]
}

/// How samples of a pixel are drawn.
enum Each {
    /// Frame by frame.
    Alone,
    /// In one frame that is so much larger: strokes are the same in all of them.
    Magnified(Synth),
    /// Not at all: strokes would be others in each.
    Apart,
}

impl Each {
    fn of(samples: &[Synth]) -> Each {
        let each_way = samples.len().isqrt() as u32;
        match samples.first() {
            Some(synth) if samples.len() > 1 && synth.has_strokes() => {
                synth.magnified(each_way).map_or(Each::Apart, Each::Magnified)
            }
            _ => Each::Alone,
        }
    }
}

/// Reads back a frame whose pixels are four codes of 8 bits. Rows of a copy are aligned to 256 bytes.
///
/// # Errors
/// If the device is lost.
pub fn read_back(device: &Device, texture: &wgpu::Texture) -> Result<Frame> {
    let (width, height) = (texture.width() as usize, texture.height() as usize);
    let stride = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = readable(device, (stride * height) as u64)?;
    device.checked(|| {
        let mut encoder = device.raw.create_command_encoder(&Default::default());
        let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(stride as u32), ..Default::default() };
        let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
        device.queue.submit([encoder.finish()]);
    })?;
    device.read(&buffer, |bytes| {
        let rows = bytes.chunks_exact(stride).flat_map(|row| bytemuck::cast_slice::<u8, [u8; 4]>(&row[..width * 4]));
        Grid::from_cells(width, height, rows.copied().collect())
    })
}
