//! What draws go into: the picture of a layer, or textures of a plan of its own.

use super::device::{Device, failed};
use super::kept::{Texture, check_size, format};
use super::pipeline::{Bound, DEPTH};
use crate::base::error::Result;
use crate::layers::parts::plan::{Canvas, Format, Scratch};

/// What draws of one pass go into.
pub struct Target {
    /// Where what programs give goes, and its formats.
    pub colors: Vec<wgpu::TextureView>,
    /// See `colors`.
    pub formats: Vec<wgpu::TextureFormat>,
    /// By what pixels are tested, cleared first.
    pub depth: Option<wgpu::TextureView>,
    /// What is there at first.
    pub load: wgpu::LoadOp<wgpu::Color>,
    /// Width and height.
    pub size_px: [u32; 2],
}

impl Target {
    /// One texture.
    pub fn of(into: &wgpu::Texture, depth: Option<&wgpu::Texture>, load: wgpu::LoadOp<wgpu::Color>) -> Target {
        Target {
            colors: vec![into.create_view(&Default::default())],
            formats: vec![into.format()],
            depth: depth.map(|depth| depth.create_view(&Default::default())),
            load,
            size_px: [into.width(), into.height()],
        }
    }
}

/// Textures for plans that are drawn one after the other, reused from frame to frame.
#[derive(Default)]
pub struct Spare(Vec<Scratches>);

impl Spare {
    /// Textures of this width and height for a plan.
    pub fn take(&mut self, device: &Device, size_px: (usize, usize), wanted: &[Scratch]) -> Result<Scratches> {
        let fits = |spare: &Scratches| spare.size_px == size_px && spare.is_of(wanted);
        match self.0.iter().position(fits) {
            Some(i) => Ok(self.0.swap_remove(i)),
            None => Scratches::new(device, size_px, wanted),
        }
    }

    /// Takes them back once all draws of the plan are encoded.
    pub fn give_back(&mut self, scratch: Scratches) {
        if !scratch.textures.is_empty() {
            self.0.push(Scratches { used: true, ..scratch });
        }
    }

    /// Releases what no plan has taken since the last call.
    pub fn end_frame(&mut self) {
        self.0.retain(|spare| spare.used);
        self.0.iter_mut().for_each(|spare| spare.used = false);
    }
}

/// The textures of a plan of its own.
#[derive(Default)]
pub struct Scratches {
    size_px: (usize, usize),
    textures: Vec<(Scratch, wgpu::Texture)>,
    used: bool,
}

impl Scratches {
    fn is_of(&self, wanted: &[Scratch]) -> bool {
        self.textures.iter().map(|(scratch, _)| scratch).eq(wanted)
    }

    fn new(device: &Device, (width, height): (usize, usize), wanted: &[Scratch]) -> Result<Scratches> {
        check_size(device, width, height)?;
        let texture = |scratch: &Scratch| {
            let (format, layers) = match *scratch {
                Scratch::Texels(of) => (addable(device, of), 1),
                Scratch::Layers(of, layers) => (addable(device, of), layers.max(1)),
                Scratch::Depths => (DEPTH, 1),
            };
            let made = device.checked(|| {
                device.raw.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: layers },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                    view_formats: &[],
                })
            })?;
            Ok((*scratch, made))
        };
        let textures = wanted.iter().map(texture).collect::<Result<_>>()?;
        Ok(Scratches { size_px: (width, height), textures, used: true })
    }

    /// Those that are drawn into.
    pub fn target(&self, canvas: &Canvas) -> Result<Target> {
        let mut target = Target {
            colors: Vec::new(),
            formats: Vec::new(),
            depth: canvas.depths.map(|depths| Ok(self.get(depths)?.1.create_view(&Default::default()))).transpose()?,
            load: if canvas.clear { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load },
            size_px: [0; 2],
        };
        for &(number, layer) in &canvas.textures {
            let texture = &self.get(number)?.1;
            target.colors.push(texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            }));
            target.formats.push(texture.format());
            target.size_px = [texture.width(), texture.height()];
        }
        Ok(target)
    }

    /// One of them, to be read.
    pub fn bound(&self, number: usize) -> Result<Bound> {
        let (scratch, texture) = self.get(number)?;
        let view = |dimension| texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() });
        Ok(match *scratch {
            Scratch::Texels(format) => Bound::Texture(Texture { view: view(None), format }),
            Scratch::Layers(..) => Bound::Layers(view(Some(wgpu::TextureViewDimension::D2Array))),
            Scratch::Depths => Bound::Depth(view(None)),
        })
    }

    fn get(&self, number: usize) -> Result<&(Scratch, wgpu::Texture)> {
        let all = self.textures.len();
        self.textures.get(number).ok_or_else(|| failed(format!("a plan wants texture {number} of its own {all}")))
    }
}

/// The device's format for a texture that may be added to.
fn addable(device: &Device, wanted: Format) -> wgpu::TextureFormat {
    match wanted {
        Format::Rg32Float if !device.blends_floats() => wgpu::TextureFormat::Rg16Float,
        other => format(other).0,
    }
}
