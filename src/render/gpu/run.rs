//! Executes plans: the only place that turns the techniques' descriptions of steps into bindings and passes.

use std::mem::offset_of;

use super::device::{Device, failed, readable};
use super::kept::{KeptTextures, Texture, check_size, texture};
use super::pipeline::{Bound, DEPTH, Pipelines, Way};
use super::target::{Scratches, Spare, Target, all};
use crate::base::error::Result;
use crate::base::pixels::Rgba;
use crate::layers::parts::plan::{Bind, Blend, Canvas, Compute, Draw, Format, Groups, Plan, Program, Step, Tally};

/// The format of frames on the device.
pub const FRAME: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Executes plans, with everything that is kept from frame to frame.
#[derive(Default)]
pub struct Runner {
    pipelines: Pipelines,
    kept: KeptTextures,
    spare: Spare,
    /// How much room the plans since the last [`Runner::had_room`] have asked for.
    asked: Vec<wgpu::Buffer>,
}

/// A draw with everything that it needs on the device.
struct Ready {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    /// Left, top, width, height.
    scissor: [u32; 4],
    amount: Amount,
}

/// How much is drawn: so many vertices and instances, or what is found in a buffer.
enum Amount {
    Count(u32, u32),
    Found(wgpu::Buffer),
}

/// What was drawn before.
#[derive(Clone, Copy)]
struct Before<'a> {
    depth: Option<&'a wgpu::Texture>,
    scratch: &'a Scratches,
}

impl Runner {
    /// Draws the plans of a group into a part of a texture, which is cleared first.
    pub fn run(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (into, part): (&wgpu::Texture, [u32; 4]),
        plans: &[Plan],
    ) -> Result<()> {
        let all = || plans.iter().flat_map(|plan| &plan.steps);
        let first: Vec<&Draw> = all().filter_map(Step::draw).filter(|draw| is_first(draw)).collect();
        let size = (into.width() as usize, into.height() as usize);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let deep = first.iter().any(|draw| draw.depth) || all().any(|step| reads_depth(step.binds()));
        let depth = deep.then(|| texture(device, size, DEPTH, usage)).transpose()?;
        let target = Target::of((into, part), depth.as_ref(), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let nothing = Scratches::default();
        self.pass(device, encoder, (&target, Before { depth: None, scratch: &nothing }), &first)?;
        let (with_scratch, others): (Vec<&Plan>, Vec<&Plan>) = plans.iter().partition(|plan| !plan.scratch.is_empty());
        for plan in with_scratch.into_iter().chain(others) {
            let scratch = self.spare.take(device, size, &plan.scratch)?;
            scratch.clear(encoder);
            self.later(device, encoder, ((into, part), Before { depth: depth.as_ref(), scratch: &scratch }), plan)?;
            self.note(device, encoder, &scratch)?;
            self.spare.give_back(scratch);
        }
        Ok(())
    }

    /// The steps of a plan that come after the first draws of all.
    fn later(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (into, before): ((&wgpu::Texture, [u32; 4]), Before),
        plan: &Plan,
    ) -> Result<()> {
        let later: Vec<&Step> = plan.steps.iter().filter(|step| !step.draw().is_some_and(is_first)).collect();
        for steps in later.chunk_by(|one, next| is_same(one, next)) {
            let draws: Vec<&Draw> = steps.iter().filter_map(|step| step.draw()).collect();
            let target = match draws.first().map(|draw| draw.into.as_ref()) {
                Some(Some(canvas)) => before.scratch.target(canvas)?,
                Some(None) => Target::of(into, None, wgpu::LoadOp::Load),
                None => {
                    self.compute(device, encoder, before, steps)?;
                    continue;
                }
            };
            self.pass(device, encoder, (&target, before), &draws)?;
        }
        Ok(())
    }

    /// Some steps that compute, each after those before.
    fn compute(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        before: Before,
        steps: &[&Step],
    ) -> Result<()> {
        let mut ready = Vec::with_capacity(steps.len());
        for step in steps {
            let Step::Compute(Compute { routine, constants, binds, groups }) = step else { continue };
            let bound = self.all_bound(device, encoder, binds, before)?;
            let found = match *groups {
                Groups::Count(count) => Err(count),
                Groups::Found(number) => Ok(before.scratch.buffer(number)?.clone()),
            };
            ready.push((self.pipelines.computing(device, (routine, constants), &bound)?, found));
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        for ((pipeline, group), groups) in &ready {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            match groups {
                Err(count) => pass.dispatch_workgroups(*count, 1, 1),
                Ok(tally) => pass.dispatch_workgroups_indirect(tally, offset_of!(Tally, groups) as u64),
            }
        }
        Ok(())
    }

    /// Notes how much room a plan has asked for.
    fn note(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, scratch: &Scratches) -> Result<()> {
        for tally in scratch.tallies() {
            let asked = readable(device, size_of::<u32>() as u64)?;
            encoder.copy_buffer_to_buffer(tally, offset_of!(Tally, room) as u64, &asked, 0, asked.size());
            self.asked.push(asked);
        }
        Ok(())
    }

    /// Whether all plans that were submitted had room for what they computed; if not, they will have when they are run again.
    pub fn had_room(&mut self, device: &Device) -> Result<bool> {
        let mut most = None;
        for asked in std::mem::take(&mut self.asked) {
            let asked = device.read(&asked, bytemuck::pod_read_unaligned::<u32>)?;
            most = most.max(Some(u64::from(asked)));
        }
        Ok(most.is_none_or(|most| self.spare.grow(device, most)))
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
            let Some(scissor) = scissor(draw, target.part) else { continue };
            let bound = self.all_bound(device, encoder, &draw.binds, before)?;
            let depth = target.depth.is_some().then_some(draw.depth);
            let way = Way { blend: draw.blend, into: target.formats.clone(), depth };
            let (pipeline, group) = self.pipelines.get(device, (draw.program, &draw.constants), &bound, way)?;
            let amount = match draw.found {
                Some(number) => Amount::Found(before.scratch.buffer(number)?.clone()),
                None => Amount::Count(draw.vertices, draw.instances),
            };
            ready.push(Ready { pipeline, group, scissor, amount });
        }
        pass(encoder, target, &ready);
        Ok(())
    }

    /// Fills a texture with one color.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder, into: &wgpu::Texture, color: Rgba) {
        let [r, g, b, a] = color.map(f64::from);
        pass(encoder, &Target::of((into, all(into)), None, wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a })), &[]);
    }

    /// Runs a program that reads one float texture, over a part of another texture.
    pub fn lay(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (program, blend): (&'static Program, Blend),
        (from, into): (&wgpu::Texture, &wgpu::Texture),
        part: [u32; 4],
    ) -> Result<()> {
        let view = from.create_view(&Default::default());
        let bound = [Bound::Texture(Texture { view, format: Format::Rgba32Float })];
        let way = Way { blend, into: vec![into.format()], depth: None };
        let (pipeline, group) = self.pipelines.get(device, (program, &[]), &bound, way)?;
        let draw = Ready { pipeline, group, scissor: part, amount: Amount::Count(3, 1) };
        pass(encoder, &Target::of((into, part), None, wgpu::LoadOp::Load), &[draw]);
        Ok(())
    }

    /// What is kept on the device.
    pub fn kept(&mut self) -> &mut KeptTextures {
        &mut self.kept
    }

    /// Releases what no plan has asked for since the last call.
    pub fn end_frame(&mut self) {
        self.kept.end_frame();
        self.spare.end_frame();
    }

    /// What code reads and writes, on the device.
    fn all_bound(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        binds: &[Bind],
        before: Before,
    ) -> Result<Vec<Bound>> {
        binds.iter().map(|bind| self.bound(device, encoder, (bind, before))).collect()
    }

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
            Bind::Written(number) => before.scratch.buffer(*number).cloned().map(Bound::Written),
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
                self.run(device, encoder, (&into, all(&into)), std::slice::from_ref(&drawn.plan))?;
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

/// Whether something that reads these reads the depths of the surfaces.
fn reads_depth(binds: &[Bind]) -> bool {
    binds.iter().any(|bind| matches!(bind, Bind::Depth))
}

/// Whether a draw comes before what reads depths.
fn is_first(draw: &Draw) -> bool {
    draw.into.is_none() && !reads_depth(&draw.binds)
}

/// Whether a step goes on where the one before it has drawn, or both compute.
fn is_same(before: &Step, step: &Step) -> bool {
    match (before.draw().map(|draw| &draw.into), step.draw().map(|draw| &draw.into)) {
        (None, None) | (Some(None), Some(None)) => true,
        (Some(Some(one)), Some(Some(next))) => *next == Canvas { clear: false, ..one.clone() },
        _ => false,
    }
}

/// The pixels of a part to draw; `None` if there are none.
fn scissor(draw: &Draw, part: [u32; 4]) -> Option<[u32; 4]> {
    let Some(own) = draw.scissor_px else { return Some(part) };
    let [(left, right), (top, bottom)] = [0, 1].map(|axis| {
        let end = |rect: [u32; 4]| rect[axis].saturating_add(rect[axis + 2]);
        (own[axis].max(part[axis]), end(own).min(end(part)))
    });
    (left < right && top < bottom).then(|| [left, top, right - left, bottom - top])
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
        let [x, y, width, height] = draw.scissor;
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&draw.pipeline);
        pass.set_bind_group(0, &draw.group, &[]);
        match &draw.amount {
            Amount::Count(vertices, instances) => pass.draw(0..*vertices, 0..*instances),
            Amount::Found(tally) => pass.draw_indirect(tally, offset_of!(Tally, draw) as u64),
        }
    }
}
