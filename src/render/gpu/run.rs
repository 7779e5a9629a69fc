//! Executes plans: the only place that turns the techniques' descriptions of draws into bindings and passes.

use super::device::{Device, failed};
use super::kept::{Kept, Texture, check_size, texture};
use super::pipeline::{Bound, DEPTH, Pipelines, Way};
use super::target::{Scratches, Spare, Target};
use crate::base::error::Result;
use crate::base::pixels::Rgba;
use crate::layers::parts::plan::{Bind, Blend, Canvas, Draw, Format, Plan, Program};

/// The format of frames on the device.
pub const FRAME: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Executes plans, with everything that is kept from frame to frame.
#[derive(Default)]
pub struct Runner {
    pipelines: Pipelines,
    kept: Kept,
    spare: Spare,
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

/// What was drawn before.
#[derive(Clone, Copy)]
struct Before<'a> {
    depth: Option<&'a wgpu::Texture>,
    scratch: &'a Scratches,
}

impl Runner {
    /// Draws the plans of a group into a texture, which is cleared first.
    pub fn run(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::Texture,
        plans: &[Plan],
    ) -> Result<()> {
        let all = || plans.iter().flat_map(|plan| &plan.draws);
        let first: Vec<&Draw> = all().filter(|draw| is_first(draw)).collect();
        let size = (into.width() as usize, into.height() as usize);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let deep = first.iter().any(|draw| draw.depth) || all().any(reads_depth);
        let depth = deep.then(|| texture(device, size, DEPTH, usage)).transpose()?;
        let target = Target::of(into, depth.as_ref(), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let nothing = Scratches::default();
        self.pass(device, encoder, (&target, Before { depth: None, scratch: &nothing }), &first)?;
        let (drawn_on, others): (Vec<&Plan>, Vec<&Plan>) = plans.iter().partition(|plan| !plan.scratch.is_empty());
        for plan in drawn_on.into_iter().chain(others) {
            let scratch = self.spare.take(device, size, &plan.scratch)?;
            let later: Vec<&Draw> = plan.draws.iter().filter(|draw| !is_first(draw)).collect();
            for draws in later.chunk_by(|one, next| is_same(one, next)) {
                let target = match draws.first().and_then(|draw| draw.into.as_ref()) {
                    Some(canvas) => scratch.target(canvas)?,
                    None => Target::of(into, None, wgpu::LoadOp::Load),
                };
                self.pass(device, encoder, (&target, Before { depth: depth.as_ref(), scratch: &scratch }), draws)?;
            }
            self.spare.give_back(scratch);
        }
        Ok(())
    }

    /// One pass of draws; those that cover no pixel are left out.
    fn pass(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (target, before): (&Target, Before),
        draws: &[&Draw],
    ) -> Result<()> {
        let mut ready = Vec::with_capacity(draws.len());
        for draw in draws {
            let Some(scissor) = scissor(draw, target.size_px) else { continue };
            let bound = draw.binds.iter().map(|bind| self.bound(device, encoder, (bind, before)));
            let bound = bound.collect::<Result<Vec<_>>>()?;
            let depth = target.depth.is_some().then_some(draw.depth);
            let way = Way { blend: draw.blend, into: target.formats.clone(), depth };
            let (pipeline, group) = self.pipelines.get(device, (draw.program, &draw.constants), &bound, way)?;
            let (vertices, instances) = (draw.vertices, draw.instances);
            ready.push(Ready { pipeline, group, scissor: Some(scissor), vertices, instances });
        }
        pass(encoder, target, &ready);
        Ok(())
    }

    /// Fills a texture with one color.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder, into: &wgpu::Texture, color: Rgba) {
        let [r, g, b, a] = color.map(f64::from);
        pass(encoder, &Target::of(into, None, wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a })), &[]);
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
        let way = Way { blend, into: vec![into.format()], depth: None };
        let (pipeline, group) = self.pipelines.get(device, (program, &[]), &bound, way)?;
        let draw = Ready { pipeline, group, scissor: None, vertices: 3, instances: 1 };
        pass(encoder, &Target::of(into, None, wgpu::LoadOp::Load), &[draw]);
        Ok(())
    }

    /// What is kept on the device.
    pub fn kept(&mut self) -> &mut Kept {
        &mut self.kept
    }

    /// Releases what no plan has asked for since the last call.
    pub fn end_frame(&mut self) {
        self.kept.end_frame();
        self.spare.end_frame();
    }

    /// What a program reads, on the device.
    fn bound(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (bind, before): (&Bind, Before),
    ) -> Result<Bound> {
        match bind {
            Bind::Bytes(bytes) => buffer(device, bytes, wgpu::BufferUsages::UNIFORM).map(Bound::Uniform),
            Bind::List(bytes) => buffer(device, bytes, wgpu::BufferUsages::STORAGE).map(Bound::List),
            Bind::Depth => {
                let depth = before.depth.ok_or_else(|| failed("a plan reads depths that are not there"))?;
                Ok(Bound::Depth(depth.create_view(&Default::default())))
            }
            Bind::Scratch(number) => before.scratch.bound(*number),
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
                self.run(device, encoder, &into, std::slice::from_ref(&drawn.plan))?;
                let view = into.create_view(&Default::default());
                Ok(Bound::Texture(Texture { view, format: Format::Rgba32Float }))
            }
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

/// Whether a draw reads the depths of the surfaces.
fn reads_depth(draw: &Draw) -> bool {
    draw.binds.iter().any(|bind| matches!(bind, Bind::Depth))
}

/// Whether a draw comes before what reads depths.
fn is_first(draw: &Draw) -> bool {
    draw.into.is_none() && !reads_depth(draw)
}

/// Whether a draw goes on where the one before it has drawn.
fn is_same(before: &Draw, draw: &Draw) -> bool {
    match (&before.into, &draw.into) {
        (None, None) => true,
        (Some(one), Some(next)) => *next == Canvas { clear: false, ..one.clone() },
        _ => false,
    }
}

/// The pixels of a frame to draw; `None` if there are none.
fn scissor(draw: &Draw, frame: [u32; 2]) -> Option<[u32; 4]> {
    let Some([x, y, width, height]) = draw.scissor_px else { return Some([0, 0, frame[0], frame[1]]) };
    let width = width.min(frame[0].saturating_sub(x));
    let height = height.min(frame[1].saturating_sub(y));
    (width > 0 && height > 0).then_some([x, y, width, height])
}

/// One pass of draws.
fn pass(encoder: &mut wgpu::CommandEncoder, target: &Target, draws: &[Ready]) {
    let color = |view| {
        let ops = wgpu::Operations { load: target.load, store: wgpu::StoreOp::Store };
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    };
    let colors: Vec<_> = target.colors.iter().map(color).collect();
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &colors,
        depth_stencil_attachment: target.depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
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
