//! The passes of a frame: a layer's picture, then its zones in order, each over its box; later layers over earlier. The
//! frame stays linear and premultiplied in half floats until it is encoded.

use std::collections::HashMap;

use super::device::Device;
use super::textures::{Textures, check_size, texture};
use crate::base::error::Result;
use crate::base::pixels::Beyond;
use crate::layers::folding;
use crate::layers::folding::synth::ZoneSynth;
use crate::layers::folding::texels::{SHADER, rule_number};
use crate::render::Synth;

/// The format of frames on the device.
pub const FRAME: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// The format of encoded frames.
pub const ENCODED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

const COMPOSE: &str = include_str!("compose.wgsl");

/// How a zone is drawn: everything that is compiled into its pipeline.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Manner {
    rule: u32,
    clamps: bool,
    over: bool,
}

/// The uniform `Zone` of frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ZoneUniform {
    offset: [f32; 2],
    origin: [i32; 2],
    s: f32,
    padding: [f32; 3],
}

/// The pipelines of frames.
pub struct Painter {
    zone_shader: wgpu::ShaderModule,
    zone_bindings: wgpu::BindGroupLayout,
    zone_pipelines: HashMap<Manner, wgpu::RenderPipeline>,
    source_bindings: wgpu::BindGroupLayout,
    replace: wgpu::RenderPipeline,
    over: wgpu::RenderPipeline,
    encode: wgpu::RenderPipeline,
    frames: [Target; 2],
    layer: Target,
}

impl Painter {
    /// Compiles what every frame needs.
    pub fn new(device: &Device) -> Result<Painter> {
        device.checked(|| {
            let raw = &device.raw;
            let zone_shader = shader(raw, SHADER);
            let compose = shader(raw, COMPOSE);
            let zone_bindings = bindings(raw, &[UNIFORM, TEXELS, FLOATS, FLOATS]);
            let source_bindings = bindings(raw, &[FLOATS]);
            let compose = |entry, format, blend| pipeline(raw, &compose, &source_bindings, entry, &[], (format, blend));
            Painter {
                replace: compose("lay", FRAME, None),
                over: compose("lay", FRAME, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
                encode: compose("encode", ENCODED, None),
                zone_shader,
                zone_bindings,
                zone_pipelines: HashMap::new(),
                source_bindings,
                frames: Default::default(),
                layer: Target::default(),
            }
        })
    }

    /// Draws the frame at a scene time into a texture of the scene's size, the same one for every frame of this number, 0
    /// or 1.
    pub fn frame(
        &mut self,
        device: &Device,
        textures: &mut Textures,
        number: usize,
        (synth, scene_time): (&Synth, f64),
    ) -> Result<wgpu::Texture> {
        let frame = self.frames[number].get(device, synth.size)?;
        let mut encoder = device.raw.create_command_encoder(&Default::default());
        clear(&mut encoder, &frame.create_view(&Default::default()));
        for (i, layer) in synth.layers.iter().enumerate() {
            let Some(layer) = layer.downcast() else { continue };
            if i == 0 {
                self.layer(device, textures, &mut encoder, &frame, layer, scene_time)?;
            } else {
                let own = self.layer.get(device, synth.size)?;
                self.layer(device, textures, &mut encoder, &own, layer, scene_time)?;
                let group = self.source(device, &own.create_view(&Default::default()));
                let mut pass = pass(&mut encoder, &frame.create_view(&Default::default()));
                pass.set_pipeline(&self.over);
                pass.set_bind_group(0, &group, &[]);
                pass.draw(0..3, 0..1);
            }
        }
        device.checked(|| device.queue.submit([encoder.finish()]))?;
        Ok(frame)
    }

    /// Encodes a frame for the outside: sRGB, straight alpha, 8 bits.
    pub fn encode(&self, device: &Device, frame: &wgpu::Texture) -> Result<wgpu::Texture> {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let encoded = texture(device, (frame.width() as usize, frame.height() as usize), ENCODED, usage)?;
        device.checked(|| {
            let group = self.source(device, &frame.create_view(&Default::default()));
            let mut encoder = device.raw.create_command_encoder(&Default::default());
            let mut pass = pass(&mut encoder, &encoded.create_view(&Default::default()));
            pass.set_pipeline(&self.encode);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
            drop(pass);
            device.queue.submit([encoder.finish()]);
        })?;
        Ok(encoded)
    }

    fn layer(
        &mut self,
        device: &Device,
        textures: &mut Textures,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::Texture,
        layer: &folding::synth::Synth,
        scene_time: f64,
    ) -> Result<()> {
        let still = self.source(device, &textures.picture(device, &layer.picture)?);
        let mut zones = Vec::new();
        for zone in &layer.zones {
            let manner = manner(zone);
            self.compile(device, manner)?;
            zones.push((manner, self.zone(device, textures, zone, scene_time)?, scissor(zone, into)));
        }
        let mut pass = pass(encoder, &into.create_view(&Default::default()));
        pass.set_pipeline(&self.replace);
        pass.set_bind_group(0, &still, &[]);
        pass.draw(0..3, 0..1);
        for (manner, group, scissor) in &zones {
            let (Some([x, y, width, height]), Some(pipeline)) = (scissor, self.zone_pipelines.get(manner)) else {
                continue;
            };
            pass.set_scissor_rect(*x, *y, *width, *height);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }

    fn compile(&mut self, device: &Device, manner: Manner) -> Result<()> {
        if self.zone_pipelines.contains_key(&manner) {
            return Ok(());
        }
        let constants = [("rule", f64::from(manner.rule)), ("clamps", f64::from(u8::from(manner.clamps)))];
        let blend = manner.over.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let compiled = device.checked(|| {
            pipeline(&device.raw, &self.zone_shader, &self.zone_bindings, "shown", &constants, (FRAME, blend))
        })?;
        self.zone_pipelines.insert(manner, compiled);
        Ok(())
    }

    fn zone(&self, device: &Device, textures: &mut Textures, zone: &ZoneSynth, time: f64) -> Result<wgpu::BindGroup> {
        let uniform = ZoneUniform {
            offset: [zone.source.offset.x as f32, zone.source.offset.y as f32],
            origin: [zone.field.x0 as i32, zone.field.y0 as i32],
            s: zone.clock.s(time) as f32,
            padding: [0.0; 3],
        };
        let field = textures.field(device, &zone.field)?;
        let picture = textures.picture(device, &zone.source.picture)?;
        let buffer = device.raw.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of::<ZoneUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        device.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&uniform));
        let resources = [
            buffer.as_entire_binding(),
            wgpu::BindingResource::TextureView(&field.pixels),
            wgpu::BindingResource::TextureView(&field.crossings),
            wgpu::BindingResource::TextureView(&picture),
        ];
        Ok(group(&device.raw, &self.zone_bindings, resources))
    }

    fn source(&self, device: &Device, view: &wgpu::TextureView) -> wgpu::BindGroup {
        group(&device.raw, &self.source_bindings, [wgpu::BindingResource::TextureView(view)])
    }
}

fn manner(zone: &ZoneSynth) -> Manner {
    Manner {
        rule: rule_number(zone.field.folds.as_ref()),
        clamps: zone.source.beyond == Beyond::Clamp,
        over: zone.source.over,
    }
}

/// The zone's box within the frame; `None` if they do not meet.
fn scissor(zone: &ZoneSynth, into: &wgpu::Texture) -> Option<[u32; 4]> {
    let (x, y) = (zone.field.x0 as u32, zone.field.y0 as u32);
    let width = (zone.field.inside.width() as u32).min(into.width().saturating_sub(x));
    let height = (zone.field.inside.height() as u32).min(into.height().saturating_sub(y));
    (width > 0 && height > 0).then_some([x, y, width, height])
}

/// A texture to draw into, kept from frame to frame.
#[derive(Default)]
struct Target(Option<wgpu::Texture>);

impl Target {
    fn get(&mut self, device: &Device, (width, height): (usize, usize)) -> Result<wgpu::Texture> {
        if let Some(kept) = self.0.as_ref().filter(|t| (t.width() as usize, t.height() as usize) == (width, height)) {
            return Ok(kept.clone());
        }
        check_size(device, width, height)?;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let made = texture(device, (width, height), FRAME, usage)?;
        Ok(self.0.insert(made).clone())
    }
}

const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};
const TEXELS: wgpu::BindingType = texture_binding(wgpu::TextureSampleType::Uint);
const FLOATS: wgpu::BindingType = texture_binding(wgpu::TextureSampleType::Float { filterable: false });

const fn texture_binding(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false }
}

fn bindings(device: &wgpu::Device, types: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
    let entry = |(binding, &ty)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let entries: Vec<_> = types.iter().enumerate().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn group<const N: usize>(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: [wgpu::BindingResource<'_>; N],
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding: binding as u32, resource };
    let entries: Vec<_> = resources.into_iter().enumerate().map(entry).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

fn shader(device: &wgpu::Device, source: &'static str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    bindings: &wgpu::BindGroupLayout,
    fragment: &str,
    constants: &[(&str, f64)],
    (format, blend): (wgpu::TextureFormat, Option<wgpu::BlendState>),
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(bindings)],
        ..Default::default()
    });
    let options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("whole_frame"),
            compilation_options: options.clone(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: options,
            targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn pass<'e>(encoder: &'e mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'e> {
    begin(encoder, view, wgpu::LoadOp::Load)
}

fn clear(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView) {
    drop(begin(encoder, view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)));
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    })
}
