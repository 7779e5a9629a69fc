//! The window's surface and what is drawn to it: the frame, scaled, then strokes with their glyphs. An outdated surface is configured anew;
//! a window without size is not drawn.

use std::sync::Arc;

use bytemuck::Zeroable;
use winit::window::Window;

use super::glyphs::Glyphs;
use super::state::State;
use super::stroke::{Color, Stroke};
use super::style::BACKGROUNDS;
use super::text::Letters;
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, linear_from_srgb};
use crate::layers::parts::plan::COMMON;
use crate::render::gpu::{Gpu, read_back};

const SHADER: [&str; 2] = [COMMON, include_str!("screen.wgsl")];

const LIGHT: Color = [74, 77, 82, 255];
const DARK: Color = [56, 59, 64, 255];
/// Side of a check, in logical pixels.
const CHECK_PX: f64 = 8.0;

/// What became of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presented {
    /// It is on the screen.
    Yes,
    /// The surface has changed: draw again.
    Again,
    /// The window cannot be seen.
    Hidden,
    /// Surface or device are gone: open the screen again.
    Lost,
}

/// The surface of a window, with its pipelines.
pub struct Screen {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    format: wgpu::TextureFormat,
    configured: (u32, u32),
    pipelines: Pipelines,
    glyphs: Glyphs,
}

/// What is drawn over the picture, from below to the top, and the letters that it was written with.
pub struct Strokes<'a> {
    pub layers: [&'a [Stroke]; 5],
    pub letters: &'a Letters,
}

/// The picture to be shown, as textures.
pub struct Pictures {
    /// The frame.
    pub frame: wgpu::Texture,
    /// What it is shown beside or compared with, of the same size.
    pub other: Option<wgpu::Texture>,
    /// Pixels of the textures a pixel of the picture.
    pub scale: f64,
}

struct Pipelines {
    bindings: wgpu::BindGroupLayout,
    enlarged: wgpu::RenderPipeline,
    reduced: wgpu::RenderPipeline,
    difference: wgpu::RenderPipeline,
    strokes: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
}

/// The uniform `Screen` of screen.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, Zeroable)]
struct ScreenUniform {
    size: [f32; 2],
    origin: [f32; 2],
    frame: [f32; 2],
    zoom: f32,
    check: f32,
    ground: [f32; 4],
    light: [f32; 4],
    dark: [f32; 4],
}

impl Screen {
    /// A GPU that can show in the window, and the window's surface.
    pub fn open(instance: wgpu::Instance, window: Arc<Window>) -> Result<(Gpu, Screen)> {
        let surface = instance.create_surface(window.clone()).map_err(|_| nothing_draws())?;
        let gpu = Gpu::open(instance, Some(&surface))?;
        let format = format(&surface, &gpu)?;
        let pipelines = Pipelines::new(&gpu, format)?;
        Ok((gpu, Screen { window, surface, format, configured: (0, 0), pipelines, glyphs: Glyphs::default() }))
    }

    /// Draws the picture with strokes over it.
    pub fn draw(&mut self, gpu: &Gpu, state: &State, pictures: &Pictures, strokes: &Strokes<'_>) -> Result<Presented> {
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(Presented::Hidden);
        }
        if self.configured != (size.width, size.height) {
            self.configure(gpu, size.width, size.height)?;
        }
        let texture = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture) | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => texture,
            wgpu::CurrentSurfaceTexture::Timeout => return Ok(Presented::Again),
            wgpu::CurrentSurfaceTexture::Occluded => return Ok(Presented::Hidden),
            wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Validation => {
                self.configured = (0, 0);
                return Ok(Presented::Again);
            }
            wgpu::CurrentSurfaceTexture::Lost => return Ok(Presented::Lost),
        };
        self.paint(gpu, &texture.texture, state, pictures, strokes)?;
        self.window.pre_present_notify();
        gpu.device().queue.present(texture);
        Ok(Presented::Yes)
    }

    /// What the window shows, as a picture of its size.
    pub fn screenshot(
        &mut self,
        gpu: &Gpu,
        state: &State,
        pictures: &Pictures,
        strokes: &Strokes<'_>,
    ) -> Result<Frame> {
        let (width, height) = self.configured;
        let size = wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 };
        let device = gpu.device();
        let into = device.checked(|| {
            device.raw.create_texture(&wgpu::TextureDescriptor {
                label: Some("screenshot"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: self.format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        })?;
        self.paint(gpu, &into, state, pictures, strokes)?;
        let screenshot = read_back(device, &into)?;
        let is_bgra = matches!(self.format, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb);
        // A window is not transparent.
        let code = |[a, b, c, _]: &[u8; 4]| if is_bgra { [*c, *b, *a, 255] } else { [*a, *b, *c, 255] };
        Ok(Frame::from_cells(screenshot.width(), screenshot.height(), screenshot.cells().iter().map(code).collect()))
    }

    fn configure(&mut self, gpu: &Gpu, width: u32, height: u32) -> Result<()> {
        let config = self.surface.get_default_config(&gpu.device().adapter, width, height);
        let mut config = config.ok_or_else(|| Error::at("window", "the GPU cannot show in this window"))?;
        config.format = self.format;
        config.present_mode = wgpu::PresentMode::AutoVsync;
        gpu.device().alone(|| self.surface.configure(&gpu.device().raw, &config))?;
        self.configured = (width, height);
        Ok(())
    }

    fn paint(
        &mut self,
        gpu: &Gpu,
        into: &wgpu::Texture,
        state: &State,
        pictures: &Pictures,
        &Strokes { layers, letters }: &Strokes<'_>,
    ) -> Result<()> {
        let device = gpu.device();
        let uniform = uniform(state, pictures);
        device.checked(|| {
            device.queue.write_buffer(&self.pipelines.uniform, 0, bytemuck::bytes_of(&uniform));
            let glyphs = self.glyphs.follow(device, letters);
            let strokes = layers.map(|strokes| instances(device, strokes));
            let mut encoder = device.raw.create_command_encoder(&Default::default());
            let view = into.create_view(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..Default::default()
            });
            self.pictures(&device.raw, &mut pass, state, pictures, uniform.zoom < 1.0);
            pass.set_bind_group(
                0,
                &self.pipelines.group(&device.raw, [&pictures.frame, &pictures.frame, &glyphs]),
                &[],
            );
            pass.set_pipeline(&self.pipelines.strokes);
            for (buffer, strokes) in strokes.iter().zip(layers) {
                if let Some(buffer) = buffer {
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    pass.draw(0..4, 0..strokes.len() as u32);
                }
            }
            drop(pass);
            device.queue.submit([encoder.finish()]);
        })
    }

    /// The frame; or its difference from the other; or the other to the left of the border.
    fn pictures(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        state: &State,
        Pictures { frame, other, .. }: &Pictures,
        reduces: bool,
    ) {
        let frames = if reduces { &self.pipelines.reduced } else { &self.pipelines.enlarged };
        let differs = state.shows("view-seam") && other.is_some();
        pass.set_pipeline(if differs { &self.pipelines.difference } else { frames });
        pass.set_bind_group(0, &self.pipelines.group(device, [frame, other.as_ref().unwrap_or(frame), frame]), &[]);
        pass.draw(0..3, 0..1);
        if let (Some(other), Some(border)) = (other, state.wipe_at()) {
            // What is drawn into may be of another size than the last that was heard of the window.
            let (width, height) = self.configured;
            pass.set_bind_group(0, &self.pipelines.group(device, [other; 3]), &[]);
            pass.set_scissor_rect(0, 0, (border as u32).min(width), height);
            pass.draw(0..3, 0..1);
            pass.set_scissor_rect(0, 0, width, height);
        }
    }
}

impl Pipelines {
    fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Pipelines> {
        let device = gpu.device();
        device.checked(|| {
            let raw = &device.raw;
            let bindings = bindings(raw);
            let module = raw.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("screen"),
                source: wgpu::ShaderSource::Wgsl(SHADER.concat().into()),
            });
            let maker = Maker { device: raw, module: &module, bindings: &bindings, format };
            Pipelines {
                enlarged: maker.frame(""),
                reduced: maker.frame("reduces"),
                difference: maker.frame("differs"),
                strokes: maker.strokes(),
                uniform: raw.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("screen"),
                    size: size_of::<ScreenUniform>() as u64,
                    usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                }),
                bindings,
            }
        })
    }

    /// The frame, what it is compared with, and the glyphs, as far as the pipeline reads them.
    fn group(&self, device: &wgpu::Device, textures: [&wgpu::Texture; 3]) -> wgpu::BindGroup {
        let views = textures.map(|texture| texture.create_view(&Default::default()));
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.bindings,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&views[0]) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&views[1]) },
                wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::TextureView(&views[2]) },
            ],
        })
    }
}

/// What the pipelines of the screen have in common.
struct Maker<'a> {
    device: &'a wgpu::Device,
    module: &'a wgpu::ShaderModule,
    bindings: &'a wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
}

impl Maker<'_> {
    /// `constant` is that of the shader that is set, where one is.
    fn frame(&self, constant: &'static str) -> wgpu::RenderPipeline {
        let constants = ["reduces", "differs"].map(|name| (name, f64::from(u8::from(name == constant))));
        self.make(["whole_frame", "show_frame"], &constants, &[], None)
    }

    fn strokes(&self) -> wgpu::RenderPipeline {
        let attributes = wgpu::vertex_attr_array![
            0 => Float32x2, 1 => Float32x2, 2 => Float32, 3 => Uint32, 4 => Unorm8x4, 5 => Uint16x2
        ];
        let layout = wgpu::VertexBufferLayout {
            array_stride: size_of::<Stroke>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &attributes,
        };
        let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        self.make(["place_stroke", "fill_stroke"], &[], &[Some(layout)], blend)
    }

    fn make(
        &self,
        [vertex, fragment]: [&str; 2],
        constants: &[(&str, f64)],
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        blend: Option<wgpu::BlendState>,
    ) -> wgpu::RenderPipeline {
        let encodes = ("encodes", f64::from(u8::from(!self.format.is_srgb())));
        let constants: Vec<_> = constants.iter().copied().chain([encodes]).collect();
        let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(self.bindings)],
            ..Default::default()
        });
        let target = wgpu::ColorTargetState { format: self.format, blend, write_mask: wgpu::ColorWrites::ALL };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(vertex),
                compilation_options: options.clone(),
                buffers,
            },
            primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(fragment),
                compilation_options: options,
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn bindings(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let frame = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[entry(0, uniform), entry(1, frame), entry(2, frame), entry(3, frame)],
    })
}

fn instances(device: &crate::render::gpu::device::Device, strokes: &[Stroke]) -> Option<wgpu::Buffer> {
    if strokes.is_empty() {
        return None;
    }
    let bytes: &[u8] = bytemuck::cast_slice(strokes);
    let buffer = device.raw.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    device.queue.write_buffer(&buffer, 0, bytes);
    Some(buffer)
}

/// The reason that the library gives is empty where no driver answers at all.
fn nothing_draws() -> Error {
    Error::at("window", "nothing here can draw in it: neither a GPU nor a software driver was found")
        .cure("install a Vulkan or OpenGL driver, as Mesa; plica render and plica edit need none")
}

/// One that takes sRGB codes as they are, if there is one.
fn format(surface: &wgpu::Surface<'_>, gpu: &Gpu) -> Result<wgpu::TextureFormat> {
    let formats = surface.get_capabilities(&gpu.device().adapter).formats;
    let plain =
        |f: &&wgpu::TextureFormat| matches!(f, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Rgba8Unorm);
    let found = formats.iter().find(plain).or(formats.first());
    found.copied().ok_or_else(|| Error::at("window", "the GPU cannot show in this window"))
}

fn uniform(state: &State, Pictures { frame, scale, .. }: &Pictures) -> ScreenUniform {
    let linear = |color: Color| {
        let [r, g, b, _] = color.map(|code| linear_from_srgb(f64::from(code) / 255.0) as f32);
        [r, g, b, 1.0]
    };
    let origin = state.viewport.origin(state.area());
    let zoom = state.viewport.zoom / scale;
    let background = BACKGROUNDS[state.background % BACKGROUNDS.len()];
    let checks = if state.shows("view-checkerboard") { [LIGHT, DARK] } else { [background; 2] };
    ScreenUniform {
        size: [state.window.width as f32, state.window.height as f32],
        origin: [origin.x as f32, origin.y as f32],
        frame: if state.has_picture() {
            [frame.width(), frame.height()].map(|n| (f64::from(n) * zoom) as f32)
        } else {
            [0.0; 2]
        },
        zoom: zoom as f32,
        check: (CHECK_PX * state.scale) as f32,
        ground: linear(background),
        light: linear(checks[0]),
        dark: linear(checks[1]),
    }
}
