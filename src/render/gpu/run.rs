//! Executes plans: the only place that turns the techniques' descriptions of draws into pipelines, bindings and passes.

use std::collections::HashMap;

use super::device::{Device, failed};
use super::kept::{Kept, Texture};
use crate::base::error::Result;
use crate::base::pixels::Rgba;
use crate::layers::parts::plan::{Bind, Blend, Draw, Format, Plan, Program};

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
    blend: Blend,
    into: wgpu::TextureFormat,
}

/// The kind of resource at a binding.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    Uniform,
    Floats,
    Uints,
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
}

/// A resource on the device that a program reads.
enum Bound {
    Buffer(wgpu::Buffer),
    Texture(Texture),
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
        let mut draws = Vec::with_capacity(plan.draws.len());
        for draw in &plan.draws {
            let Some(scissor) = scissor(draw, into) else { continue };
            let bound = draw.binds.iter().map(|bind| self.bound(device, bind)).collect::<Result<Vec<_>>>()?;
            let (pipeline, group) =
                self.pipeline(device, (draw.program, &draw.constants), &bound, (draw.blend, into.format()))?;
            draws.push(Ready { pipeline, group, scissor: Some(scissor) });
        }
        pass(encoder, into, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), &draws);
        Ok(())
    }

    /// Fills a texture with one color.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder, into: &wgpu::Texture, color: Rgba) {
        let [r, g, b, a] = color.map(f64::from);
        pass(encoder, into, wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }), &[]);
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
        let (pipeline, group) = self.pipeline(device, (program, &[]), &bound, (blend, into.format()))?;
        pass(encoder, into, wgpu::LoadOp::Load, &[Ready { pipeline, group, scissor: None }]);
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

    fn bound(&mut self, device: &Device, bind: &Bind) -> Result<Bound> {
        match bind {
            Bind::Bytes(bytes) => {
                let buffer = device.raw.create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size: bytes.len() as u64,
                    usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                device.queue.write_buffer(&buffer, 0, bytes);
                Ok(Bound::Buffer(buffer))
            }
            Bind::Upload(of, part) => self.kept.get(device, of, *part).map(Bound::Texture),
        }
    }

    /// A pipeline, compiled if it is new, and its bind group.
    fn pipeline(
        &mut self,
        device: &Device,
        (program, constants): (&'static Program, &[(&'static str, f64)]),
        bound: &[Bound],
        (blend, into): (Blend, wgpu::TextureFormat),
    ) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup)> {
        let key = Key {
            program: std::ptr::from_ref(program).addr(),
            constants: constants.iter().map(|&(name, value)| (name, value.to_bits())).collect(),
            binds: bound.iter().map(Bound::kind).collect(),
            blend,
            into,
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
            Bound::Buffer(buffer) => buffer.as_entire_binding(),
            Bound::Texture(texture) => wgpu::BindingResource::TextureView(&texture.view),
        }
    }

    fn kind(&self) -> Kind {
        match self {
            Bound::Buffer(_) => Kind::Uniform,
            Bound::Texture(texture) => match texture.format {
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
        match self {
            Kind::Uniform => wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            Kind::Floats => texture(wgpu::TextureSampleType::Float { filterable: false }),
            Kind::Uints => texture(wgpu::TextureSampleType::Uint),
        }
    }
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
    let blend = match key.blend {
        Blend::Replace => None,
        Blend::Over => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
    };
    let target = wgpu::ColorTargetState { format: key.into, blend, write_mask: wgpu::ColorWrites::ALL };
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
        depth_stencil: None,
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

/// One pass of draws into a texture.
fn pass(encoder: &mut wgpu::CommandEncoder, into: &wgpu::Texture, load: wgpu::LoadOp<wgpu::Color>, draws: &[Ready]) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &into.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    for draw in draws {
        if let Some([x, y, width, height]) = draw.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&draw.pipeline);
        pass.set_bind_group(0, &draw.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
