//! What is compiled of a program: once for each way in which it is used.

use std::collections::HashMap;

use super::device::{Device, failed};
use super::kept::Texture;
use crate::base::error::Result;
use crate::layers::parts::plan::{Blend, Format, Program, Routine};

/// The format of depths.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// S + C (1 - S).
const SCREEN: wgpu::BlendComponent = wgpu::BlendComponent {
    src_factor: wgpu::BlendFactor::One,
    dst_factor: wgpu::BlendFactor::OneMinusSrc,
    operation: wgpu::BlendOperation::Add,
};
/// S + C.
const ADD: wgpu::BlendComponent =
    wgpu::BlendComponent { dst_factor: wgpu::BlendFactor::One, ..wgpu::BlendComponent::REPLACE };

/// Everything that was compiled.
#[derive(Default)]
pub struct Pipelines {
    drawing: HashMap<(Used, Way), Pipeline<wgpu::RenderPipeline>>,
    computing: HashMap<Used, Pipeline<wgpu::ComputePipeline>>,
}

/// Code as it is used: everything that is compiled into a pipeline, besides how pixels are drawn.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Used {
    /// The address of the program or the routine.
    code: usize,
    /// Names and bits of the constants.
    constants: Vec<(&'static str, u64)>,
    binds: Vec<Resource>,
}

/// How what is drawn gets to what is there.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Way {
    /// How it is blended.
    pub blend: Blend,
    /// The formats that are drawn into.
    pub into: Vec<wgpu::TextureFormat>,
    /// Whether pixels are tested by depth; `None` if the pass has no depth.
    pub depth: Option<bool>,
}

/// The kind of resource at a binding.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Resource {
    Uniform,
    List,
    Written,
    Floats,
    FloatLayers,
    Filtered,
    Uints,
    Depth,
    Linear,
}

#[derive(Clone)]
struct Pipeline<T> {
    raw: T,
    bindings: wgpu::BindGroupLayout,
}

/// A resource on the device that code reads.
pub enum Bound {
    /// A uniform.
    Uniform(wgpu::Buffer),
    /// An array.
    List(wgpu::Buffer),
    /// An array that is also written.
    Written(wgpu::Buffer),
    /// A texture.
    Texture(Texture),
    /// Textures of floats on top of one another.
    Layers(wgpu::TextureView),
    /// Depths.
    Depth(wgpu::TextureView),
    /// What reads between texels.
    Linear(wgpu::Sampler),
}

impl Pipelines {
    /// A pipeline that draws, compiled if it is new, and its bind group.
    pub fn get(
        &mut self,
        device: &Device,
        (program, constants): (&'static Program, &[(&'static str, f64)]),
        bound: &[Bound],
        way: Way,
    ) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup)> {
        let key = (Used::new(std::ptr::from_ref(program).addr(), constants, bound), way);
        let pipeline = match self.drawing.get(&key) {
            Some(pipeline) => pipeline.clone(),
            None => {
                let made = device.checked(|| compile(&device.raw, program, constants, &key));
                let made = made.map_err(|error| failed(format!("{}: {error}", program.name)))?;
                self.drawing.insert(key, made.clone());
                made
            }
        };
        let group = group(device, &pipeline.bindings, bound);
        Ok((pipeline.raw, group))
    }

    /// A pipeline that computes, compiled if it is new, and its bind group.
    pub fn computing(
        &mut self,
        device: &Device,
        (routine, constants): (&'static Routine, &[(&'static str, f64)]),
        bound: &[Bound],
    ) -> Result<(wgpu::ComputePipeline, wgpu::BindGroup)> {
        let key = Used::new(std::ptr::from_ref(routine).addr(), constants, bound);
        let pipeline = match self.computing.get(&key) {
            Some(pipeline) => pipeline.clone(),
            None => {
                let made = device.checked(|| compile_routine(&device.raw, routine, constants, &key));
                let made = made.map_err(|error| failed(format!("{}: {error}", routine.name)))?;
                self.computing.insert(key, made.clone());
                made
            }
        };
        let group = group(device, &pipeline.bindings, bound);
        Ok((pipeline.raw, group))
    }
}

impl Used {
    fn new(code: usize, constants: &[(&'static str, f64)], bound: &[Bound]) -> Used {
        let constants = constants.iter().map(|&(name, value)| (name, value.to_bits())).collect();
        Used { code, constants, binds: bound.iter().map(Bound::kind).collect() }
    }
}

fn group(device: &Device, layout: &wgpu::BindGroupLayout, bound: &[Bound]) -> wgpu::BindGroup {
    let resources = bound.iter().map(Bound::resource).enumerate();
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding: binding as u32, resource };
    let entries: Vec<_> = resources.map(entry).collect();
    device.raw.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

impl Bound {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Bound::Uniform(buffer) | Bound::List(buffer) | Bound::Written(buffer) => buffer.as_entire_binding(),
            Bound::Texture(Texture { view, .. }) | Bound::Layers(view) | Bound::Depth(view) => {
                wgpu::BindingResource::TextureView(view)
            }
            Bound::Linear(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }

    fn kind(&self) -> Resource {
        match self {
            Bound::Uniform(_) => Resource::Uniform,
            Bound::List(_) => Resource::List,
            Bound::Written(_) => Resource::Written,
            Bound::Depth(_) => Resource::Depth,
            Bound::Layers(_) => Resource::FloatLayers,
            Bound::Linear(_) => Resource::Linear,
            Bound::Texture(texture) => match texture.format {
                Format::Rgba16Float => Resource::Filtered,
                Format::Rgba32Float | Format::R32Float | Format::Rg32Float => Resource::Floats,
                Format::Rgba32Uint => Resource::Uints,
            },
        }
    }
}

impl Resource {
    fn layout(self) -> wgpu::BindingType {
        let textures = |sample_type, view_dimension| wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        };
        let texture = |sample_type| textures(sample_type, wgpu::TextureViewDimension::D2);
        let floats = wgpu::TextureSampleType::Float { filterable: false };
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        match self {
            Resource::Uniform => buffer(wgpu::BufferBindingType::Uniform),
            Resource::List => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
            Resource::Written => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
            Resource::Floats => texture(floats),
            Resource::FloatLayers => textures(floats, wgpu::TextureViewDimension::D2Array),
            Resource::Filtered => texture(wgpu::TextureSampleType::Float { filterable: true }),
            Resource::Uints => texture(wgpu::TextureSampleType::Uint),
            Resource::Depth => texture(wgpu::TextureSampleType::Depth),
            Resource::Linear => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        }
    }
}

/// WGSL as a module.
fn module(device: &wgpu::Device, name: &str, text: String) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source })
}

/// What code that runs in these stages is bound to.
fn layouts(
    device: &wgpu::Device,
    binds: &[Resource],
    visibility: wgpu::ShaderStages,
) -> (wgpu::BindGroupLayout, wgpu::PipelineLayout) {
    let entry = |(binding, kind): (usize, &Resource)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility,
        ty: kind.layout(),
        count: None,
    };
    let entries: Vec<_> = binds.iter().enumerate().map(entry).collect();
    let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&bindings)],
        ..Default::default()
    });
    (bindings, layout)
}

fn compile_routine(
    device: &wgpu::Device,
    routine: &Routine,
    constants: &[(&str, f64)],
    used: &Used,
) -> Pipeline<wgpu::ComputePipeline> {
    let (bindings, layout) = layouts(device, &used.binds, wgpu::ShaderStages::COMPUTE);
    let raw = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(routine.name),
        layout: Some(&layout),
        module: &module(device, routine.name, routine.text()),
        entry_point: Some(routine.entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    });
    Pipeline { raw, bindings }
}

fn compile(
    device: &wgpu::Device,
    program: &Program,
    constants: &[(&str, f64)],
    (used, way): &(Used, Way),
) -> Pipeline<wgpu::RenderPipeline> {
    let module = module(device, program.name, program.text());
    let (bindings, layout) = layouts(device, &used.binds, wgpu::ShaderStages::VERTEX_FRAGMENT);
    let options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let blend = match way.blend {
        Blend::Replace => None,
        Blend::Over => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        Blend::Screen => Some(wgpu::BlendState { color: SCREEN, alpha: SCREEN }),
        Blend::Add => Some(wgpu::BlendState { color: ADD, alpha: ADD }),
    };
    let target = |&format| Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL });
    let targets: Vec<_> = way.into.iter().map(target).collect();
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
        depth_stencil: way.depth.map(depth),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(program.fragment),
            compilation_options: options,
            targets: &targets,
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
