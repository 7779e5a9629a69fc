//! Executes plans: the only place that turns the techniques' descriptions of draws into pipelines, bindings and passes.

use std::collections::HashMap;

use super::device::{Device, failed};
use super::kept::{Kept, Texture, check_size, texture};
use crate::base::error::Result;
use crate::base::pixels::Rgba;
use crate::layers::parts::plan::{Bind, Blend, Draw, Format, Plan, Program};

/// The format of frames on the device.
pub const FRAME: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// S + C (1 - S).
const SCREEN: wgpu::BlendComponent = wgpu::BlendComponent {
    src_factor: wgpu::BlendFactor::One,
    dst_factor: wgpu::BlendFactor::OneMinusSrc,
    operation: wgpu::BlendOperation::Add,
};
/// The format of depths.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Executes plans, with everything that is kept from frame to frame.
#[derive(Default)]
pub struct Runner {
    pipelines: HashMap<Key, Pipeline>,
    kept: Kept,
}

/// Everything that is compiled into a pipeline.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    /// The program's address.
    program: usize,
    /// Names and bits of the constants.
    constants: Vec<(&'static str, u64)>,
    binds: Vec<Kind>,
    way: Way,
}

/// How what is drawn gets to what is there.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Way {
    blend: Blend,
    into: wgpu::TextureFormat,
    /// Whether pixels are tested by depth; `None` if the pass has no depth.
    depth: Option<bool>,
}

/// The kind of resource at a binding.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    Uniform,
    List,
    Floats,
    Filtered,
    Uints,
    Depth,
    Linear,
}

#[derive(Clone)]
struct Pipeline {
    raw: wgpu::RenderPipeline,
    bindings: wgpu::BindGroupLayout,
}

/// A draw with everything that it needs on the device.
struct Ready {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    /// Left, top, width, height.
    scissor: Option<[u32; 4]>,
    vertices: u32,
    instances: u32,
}

/// A resource on the device that a program reads.
enum Bound {
    Uniform(wgpu::Buffer),
    List(wgpu::Buffer),
    Texture(Texture),
    Depth(wgpu::TextureView),
    Linear(wgpu::Sampler),
}

impl Runner {
    /// Draws a plan into a texture, which is cleared first.
    pub fn run(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::Texture,
        plan: &Plan,
    ) -> Result<()> {
        let reads = |draw: &&Draw| draw.binds.iter().any(|bind| matches!(bind, Bind::Depth));
        let (after, first): (Vec<&Draw>, Vec<&Draw>) = plan.draws.iter().partition(reads);
        let deep = !after.is_empty() || first.iter().any(|draw| draw.depth);
        let size = (into.width() as usize, into.height() as usize);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let depth = deep.then(|| texture(device, size, DEPTH, usage)).transpose()?;
        let draws = self.ready(device, encoder, (into, None), (&first, deep))?;
        pass(encoder, (into, depth.as_ref()), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), &draws);
        if !after.is_empty() {
            let draws = self.ready(device, encoder, (into, depth.as_ref()), (&after, false))?;
            pass(encoder, (into, None), wgpu::LoadOp::Load, &draws);
        }
        Ok(())
    }

    /// Draws with everything that they need; draws that cover no pixel are skipped.
    fn ready(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (into, depth): (&wgpu::Texture, Option<&wgpu::Texture>),
        (draws, deep): (&[&Draw], bool),
    ) -> Result<Vec<Ready>> {
        let mut ready = Vec::with_capacity(draws.len());
        for draw in draws {
            let Some(scissor) = scissor(draw, into) else { continue };
            let bound = draw.binds.iter().map(|bind| self.bound(device, encoder, (bind, depth)));
            let bound = bound.collect::<Result<Vec<_>>>()?;
            let way = Way { blend: draw.blend, into: into.format(), depth: deep.then_some(draw.depth) };
            let (pipeline, group) = self.pipeline(device, (draw.program, &draw.constants), &bound, way)?;
            let (vertices, instances) = (draw.vertices, draw.instances);
            ready.push(Ready { pipeline, group, scissor: Some(scissor), vertices, instances });
        }
        Ok(ready)
    }

    /// Fills a texture with one color.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder, into: &wgpu::Texture, color: Rgba) {
        let [r, g, b, a] = color.map(f64::from);
        pass(encoder, (into, None), wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }), &[]);
    }

    /// Runs a program that reads one float texture, over all of another texture.
    pub fn lay(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (program, blend): (&'static Program, Blend),
        (from, into): (&wgpu::Texture, &wgpu::Texture),
    ) -> Result<()> {
        let view = from.create_view(&Default::default());
        let bound = [Bound::Texture(Texture { view, format: Format::Rgba32Float })];
        let way = Way { blend, into: into.format(), depth: None };
        let (pipeline, group) = self.pipeline(device, (program, &[]), &bound, way)?;
        let draw = Ready { pipeline, group, scissor: None, vertices: 3, instances: 1 };
        pass(encoder, (into, None), wgpu::LoadOp::Load, &[draw]);
        Ok(())
    }

    /// What is kept on the device.
    pub fn kept(&mut self) -> &mut Kept {
        &mut self.kept
    }

    /// Releases what no plan has asked for since the last call.
    pub fn end_frame(&mut self) {
        self.kept.end_frame();
    }

    /// What a program reads, on the device; `depth` is what was drawn before.
    fn bound(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (bind, depth): (&Bind, Option<&wgpu::Texture>),
    ) -> Result<Bound> {
        match bind {
            Bind::Bytes(bytes) => buffer(device, bytes, wgpu::BufferUsages::UNIFORM).map(Bound::Uniform),
            Bind::List(bytes) => buffer(device, bytes, wgpu::BufferUsages::STORAGE).map(Bound::List),
            Bind::Depth => {
                let depth = depth.ok_or_else(|| failed("a plan reads depths that are not there"))?;
                Ok(Bound::Depth(depth.create_view(&Default::default())))
            }
            Bind::Linear => Ok(Bound::Linear(device.raw.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }))),
            Bind::Upload(of, part) => self.kept.get(device, of, *part).map(Bound::Texture),
            Bind::Drawn(drawn) => {
                check_size(device, drawn.size_px.0, drawn.size_px.1)?;
                let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
                let into = texture(device, drawn.size_px, FRAME, usage)?;
                self.run(device, encoder, &into, &drawn.plan)?;
                let view = into.create_view(&Default::default());
                Ok(Bound::Texture(Texture { view, format: Format::Rgba32Float }))
            }
        }
    }

    /// A pipeline, compiled if it is new, and its bind group.
    fn pipeline(
        &mut self,
        device: &Device,
        (program, constants): (&'static Program, &[(&'static str, f64)]),
        bound: &[Bound],
        way: Way,
    ) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup)> {
        let key = Key {
            program: std::ptr::from_ref(program).addr(),
            constants: constants.iter().map(|&(name, value)| (name, value.to_bits())).collect(),
            binds: bound.iter().map(Bound::kind).collect(),
            way,
        };
        let pipeline = match self.pipelines.get(&key) {
            Some(pipeline) => pipeline.clone(),
            None => {
                let made = device.checked(|| compile(&device.raw, program, constants, &key));
                let made = made.map_err(|error| failed(format!("{}: {error}", program.name)))?;
                self.pipelines.insert(key, made.clone());
                made
            }
        };
        let resources = bound.iter().map(Bound::resource).enumerate();
        let entry = |(binding, resource)| wgpu::BindGroupEntry { binding: binding as u32, resource };
        let entries: Vec<_> = resources.map(entry).collect();
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &pipeline.bindings, entries: &entries };
        Ok((pipeline.raw, device.raw.create_bind_group(&descriptor)))
    }
}

impl Bound {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Bound::Uniform(buffer) | Bound::List(buffer) => buffer.as_entire_binding(),
            Bound::Texture(Texture { view, .. }) | Bound::Depth(view) => wgpu::BindingResource::TextureView(view),
            Bound::Linear(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }

    fn kind(&self) -> Kind {
        match self {
            Bound::Uniform(_) => Kind::Uniform,
            Bound::List(_) => Kind::List,
            Bound::Depth(_) => Kind::Depth,
            Bound::Linear(_) => Kind::Linear,
            Bound::Texture(texture) => match texture.format {
                Format::Rgba16Float => Kind::Filtered,
                Format::Rgba32Float | Format::R32Float => Kind::Floats,
                Format::Rgba32Uint => Kind::Uints,
            },
        }
    }
}

impl Kind {
    fn layout(self) -> wgpu::BindingType {
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        match self {
            Kind::Uniform => buffer(wgpu::BufferBindingType::Uniform),
            Kind::List => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
            Kind::Floats => texture(wgpu::TextureSampleType::Float { filterable: false }),
            Kind::Filtered => texture(wgpu::TextureSampleType::Float { filterable: true }),
            Kind::Uints => texture(wgpu::TextureSampleType::Uint),
            Kind::Depth => texture(wgpu::TextureSampleType::Depth),
            Kind::Linear => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        }
    }
}

/// A buffer with these bytes.
fn buffer(device: &Device, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
    let buffer = device.checked(|| {
        device.raw.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    device.queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// The pixels of `into` to draw; `None` if there are none.
fn scissor(draw: &Draw, into: &wgpu::Texture) -> Option<[u32; 4]> {
    let Some([x, y, width, height]) = draw.scissor_px else { return Some([0, 0, into.width(), into.height()]) };
    let width = width.min(into.width().saturating_sub(x));
    let height = height.min(into.height().saturating_sub(y));
    (width > 0 && height > 0).then_some([x, y, width, height])
}

fn compile(device: &wgpu::Device, program: &Program, constants: &[(&str, f64)], key: &Key) -> Pipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(program.name),
        source: wgpu::ShaderSource::Wgsl(program.text().into()),
    });
    let entry = |(binding, kind): (usize, &Kind)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: kind.layout(),
        count: None,
    };
    let entries: Vec<_> = key.binds.iter().enumerate().map(entry).collect();
    let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&bindings)],
        ..Default::default()
    });
    let options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let blend = match key.way.blend {
        Blend::Replace => None,
        Blend::Over => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        Blend::Screen => Some(wgpu::BlendState { color: SCREEN, alpha: SCREEN }),
    };
    let target = wgpu::ColorTargetState { format: key.way.into, blend, write_mask: wgpu::ColorWrites::ALL };
    let raw = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(program.name),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(program.vertex),
            compilation_options: options.clone(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: key.way.depth.map(depth),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(program.fragment),
            compilation_options: options,
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    });
    Pipeline { raw, bindings }
}

/// Tested draws show what is nearest, and of that the first; the others show everything.
fn depth(tested: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(tested),
        depth_compare: Some(if tested { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Always }),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// One pass of draws into a texture, with depth if there is a texture for it.
fn pass(
    encoder: &mut wgpu::CommandEncoder,
    (into, depth): (&wgpu::Texture, Option<&wgpu::Texture>),
    load: wgpu::LoadOp<wgpu::Color>,
    draws: &[Ready],
) {
    let depth = depth.map(|depth| depth.create_view(&Default::default()));
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &into.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            // Depths are reversed: 0 is infinitely far.
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    for draw in draws {
        if let Some([x, y, width, height]) = draw.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&draw.pipeline);
        pass.set_bind_group(0, &draw.group, &[]);
        pass.draw(0..draw.vertices, 0..draw.instances);
    }
}
