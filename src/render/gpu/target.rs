//! What steps go into: the picture of a layer, or textures and arrays of a plan of its own.

use super::device::{Device, failed};
use super::kept::{Texture, check_size, format};
use super::pipeline::{Bound, DEPTH};
use crate::base::error::Result;
use crate::layers::parts::plan::{Canvas, Format, LUMP_BYTES, Scratch, Tally};

/// What draws of one pass go into.
pub struct Target {
    /// Where what programs give goes, and its formats.
    pub colors: Vec<wgpu::TextureView>,
    /// See `colors`.
    pub formats: Vec<wgpu::TextureFormat>,
    /// The depth texture that pixels are tested against, cleared first.
    pub depth: Option<wgpu::TextureView>,
    /// What is there at first.
    pub load: wgpu::LoadOp<wgpu::Color>,
    /// The part of it that is drawn: left, top, width, height.
    pub part: [u32; 4],
}

impl Target {
    /// A part of one texture.
    pub fn of(
        (into, part): (&wgpu::Texture, [u32; 4]),
        depth: Option<&wgpu::Texture>,
        load: wgpu::LoadOp<wgpu::Color>,
    ) -> Target {
        Target {
            colors: vec![into.create_view(&Default::default())],
            formats: vec![into.format()],
            depth: depth.map(|depth| depth.create_view(&Default::default())),
            load,
            part,
        }
    }
}

/// How many lumps growing arrays have room for at first.
const FIRST_LUMPS: u64 = 1 << 18;

/// Textures and arrays for plans that are run one after the other, reused from frame to frame.
pub struct Spare {
    all: Vec<Scratches>,
    /// How many lumps growing arrays have room for.
    lumps: u64,
}

impl Default for Spare {
    fn default() -> Spare {
        Spare { all: Vec::new(), lumps: FIRST_LUMPS }
    }
}

impl Spare {
    /// What a plan wants at this width and height.
    pub fn take(&mut self, device: &Device, size_px: (usize, usize), wanted: &[Scratch]) -> Result<Scratches> {
        let room = |lumps: u64| (self.lumps..=4 * self.lumps).contains(&lumps);
        let fits =
            |spare: &Scratches| spare.size_px == size_px && spare.is_of(wanted) && spare.lumps().is_none_or(room);
        match self.all.iter().position(fits) {
            Some(i) => Ok(self.all.swap_remove(i)),
            None => Scratches::new(device, size_px, wanted, self.lumps),
        }
    }

    /// Takes it back once all steps of the plan are encoded.
    pub fn give_back(&mut self, scratch: Scratches) {
        if !scratch.all.is_empty() {
            self.all.push(Scratches { used: true, ..scratch });
        }
    }

    /// Makes growing arrays as large as a frame needs that has asked for so many lumps; returns whether they were.
    pub fn grow(&mut self, device: &Device, asked: u64) -> bool {
        let enough = asked <= self.lumps;
        // Something more where there can be, so that the next frame has room too.
        let most = device.raw.limits().max_storage_buffer_binding_size / LUMP_BYTES;
        self.lumps = (asked + asked / 4).min(most).max(asked).max(FIRST_LUMPS);
        enough
    }

    /// Releases what no plan has taken since the last call.
    pub fn end_frame(&mut self) {
        self.all.retain(|spare| spare.used);
        self.all.iter_mut().for_each(|spare| spare.used = false);
    }
}

/// The textures and arrays of a plan of its own.
#[derive(Default)]
pub struct Scratches {
    size_px: (usize, usize),
    all: Vec<(Scratch, Made)>,
    used: bool,
}

/// One of them on the device.
enum Made {
    Texture(wgpu::Texture),
    Buffer(wgpu::Buffer),
}

impl Scratches {
    fn is_of(&self, wanted: &[Scratch]) -> bool {
        self.all.iter().map(|(scratch, _)| scratch).eq(wanted)
    }

    /// How many lumps its growing array has room for, if it has one.
    fn lumps(&self) -> Option<u64> {
        self.all.iter().find_map(|made| match made {
            (Scratch::Growing, Made::Buffer(buffer)) => Some(buffer.size() / LUMP_BYTES),
            _ => None,
        })
    }

    fn new(device: &Device, size_px: (usize, usize), wanted: &[Scratch], lumps: u64) -> Result<Scratches> {
        check_size(device, size_px.0, size_px.1)?;
        let made = |scratch: &Scratch| {
            let made = match *scratch {
                Scratch::Texels(of) => Made::Texture(layers(device, size_px, (addable(device, of), 1))?),
                Scratch::Layers(of, count) => Made::Texture(layers(device, size_px, (addable(device, of), count))?),
                Scratch::Depths => Made::Texture(layers(device, size_px, (DEPTH, 1))?),
                Scratch::Bytes(bytes) => Made::Buffer(array(device, bytes)?),
                Scratch::Growing => Made::Buffer(array(device, lumps * LUMP_BYTES)?),
                Scratch::Tally => Made::Buffer(array(device, size_of::<Tally>() as u64)?),
            };
            Ok((*scratch, made))
        };
        let all = wanted.iter().map(made).collect::<Result<_>>()?;
        Ok(Scratches { size_px, all, used: true })
    }

    /// Makes its tallies 0.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        self.tallies().for_each(|tally| encoder.clear_buffer(tally, 0, None));
    }

    /// Its tallies.
    pub fn tallies(&self) -> impl Iterator<Item = &wgpu::Buffer> {
        self.all.iter().filter_map(|made| match made {
            (Scratch::Tally, Made::Buffer(buffer)) => Some(buffer),
            _ => None,
        })
    }

    /// Those that are drawn into.
    pub fn target(&self, canvas: &Canvas) -> Result<Target> {
        let depths = canvas.depths.map(|depths| Ok(self.texture(depths)?.create_view(&Default::default())));
        let mut target = Target {
            colors: Vec::new(),
            formats: Vec::new(),
            depth: depths.transpose()?,
            load: if canvas.clear { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load },
            part: [0; 4],
        };
        for &(number, layer) in &canvas.textures {
            let texture = self.texture(number)?;
            target.colors.push(texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            }));
            target.formats.push(texture.format());
            target.part = all(texture);
        }
        Ok(target)
    }

    /// One of them, to be read.
    pub fn bound(&self, number: usize) -> Result<Bound> {
        let (scratch, texture) = match self.get(number)? {
            (_, Made::Buffer(buffer)) => return Ok(Bound::List(buffer.clone())),
            (scratch, Made::Texture(texture)) => (scratch, texture),
        };
        let view = |dimension| texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() });
        Ok(match *scratch {
            Scratch::Texels(format) => Bound::Texture(Texture { view: view(None), format }),
            Scratch::Layers(..) => Bound::Layers(view(Some(wgpu::TextureViewDimension::D2Array))),
            // The others are arrays.
            Scratch::Depths | Scratch::Bytes(_) | Scratch::Growing | Scratch::Tally => Bound::Depth(view(None)),
        })
    }

    /// One of its arrays.
    pub fn buffer(&self, number: usize) -> Result<&wgpu::Buffer> {
        match self.get(number)? {
            (_, Made::Buffer(buffer)) => Ok(buffer),
            _ => Err(failed(format!("a plan takes texture {number} of its own for an array"))),
        }
    }

    fn texture(&self, number: usize) -> Result<&wgpu::Texture> {
        match self.get(number)? {
            (_, Made::Texture(texture)) => Ok(texture),
            _ => Err(failed(format!("a plan takes array {number} of its own for a texture"))),
        }
    }

    fn get(&self, number: usize) -> Result<&(Scratch, Made)> {
        let count = self.all.len();
        self.all.get(number).ok_or_else(|| failed(format!("a plan wants scratch {number} of its own {count}")))
    }
}

/// All of a texture: left, top, width, height.
pub fn all(texture: &wgpu::Texture) -> [u32; 4] {
    [0, 0, texture.width(), texture.height()]
}

/// Textures on top of one another that are drawn and read.
fn layers(
    device: &Device,
    (width, height): (usize, usize),
    (format, count): (wgpu::TextureFormat, u32),
) -> Result<wgpu::Texture> {
    let depth_or_array_layers = count.max(1);
    device.checked(|| {
        device.raw.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    })
}

/// An array that is computed, and read by what comes after that.
fn array(device: &Device, bytes: u64) -> Result<wgpu::Buffer> {
    let most = device.raw.limits().max_storage_buffer_binding_size;
    if bytes > most {
        let name = device.name();
        return Err(failed(format!("a layer takes {} MB at once, and {name} has {} MB", bytes >> 20, most >> 20)));
    }
    let usage = wgpu::BufferUsages::STORAGE
        | wgpu::BufferUsages::INDIRECT
        | wgpu::BufferUsages::COPY_SRC
        | wgpu::BufferUsages::COPY_DST;
    // A buffer cannot be empty.
    let size = bytes.max(LUMP_BYTES);
    device.checked(|| {
        device.raw.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    })
}

/// The device's format for a texture that may be added to.
fn addable(device: &Device, wanted: Format) -> wgpu::TextureFormat {
    match wanted {
        Format::Rg32Float if !device.blends_floats() => wgpu::TextureFormat::Rg16Float,
        other => format(other).0,
    }
}
