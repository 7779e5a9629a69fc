//! Draws frames: every layer's plan, later layers over earlier. The frame stays linear and premultiplied in half floats
//! until it is encoded.

use super::device::Device;
use super::kept::{KeptTextures, check_size, texture};
use super::run::{FRAME, Runner};
use super::target::all;
use crate::base::error::Result;
use crate::layers::parts::plan::{Blend, COMMON, Plan, Program, Step};
use crate::render::Synth;

/// The format of layers that are blended from much.
const FINE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// The format of encoded frames.
const ENCODED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

const COMPOSE: &[&str] = &[COMMON, include_str!("compose.wgsl")];
static LAY: Program = Program { name: "compose.wgsl", source: COMPOSE, vertex: "whole_frame", fragment: "lay" };
static ENCODE: Program = Program { name: "compose.wgsl", source: COMPOSE, vertex: "whole_frame", fragment: "encode" };

/// The programs for frames; those for layers belong to the techniques.
pub static PROGRAMS: &[&Program] = &[&LAY, &ENCODE];

/// Draws frames.
#[derive(Default)]
pub struct Painter {
    runner: Runner,
    frames: [Target; 2],
    layer: Target,
    fine: Target,
}

impl Painter {
    /// Draws a part of the frame at a scene time into a texture of the scene's size; there is one texture for each number, 0 or
    /// 1.
    pub fn frame(
        &mut self,
        device: &Device,
        number: usize,
        at: (&Synth, f64),
        part: [u32; 4],
    ) -> Result<wgpu::Texture> {
        let frame = self.frames[number].get(device, at.0.size, FRAME)?;
        loop {
            self.draw(device, &frame, at, part)?;
            if self.runner.had_room(device)? {
                return Ok(frame);
            }
        }
    }

    /// Draws the frame once, though there may not be room for all that it is drawn from.
    fn draw(
        &mut self,
        device: &Device,
        frame: &wgpu::Texture,
        (synth, scene_time): (&Synth, f64),
        part: [u32; 4],
    ) -> Result<()> {
        let mut encoder = device.raw.create_command_encoder(&Default::default());
        let moment = synth.moment(scene_time);
        let stage = &synth.stage;
        self.runner.clear(&mut encoder, frame, stage.background);
        for (i, group) in stage.groups.iter().enumerate() {
            let plans: Vec<Plan> = group.layers().iter().map(|&layer| synth.layers[layer].plan(&moment)).collect();
            // Halves lose too much where much is blended.
            let mut draws = plans.iter().flat_map(|plan| &plan.steps).filter_map(Step::draw);
            let fine = device.blends_floats() && draws.any(|draw| draw.into.is_none() && draw.instances > 1);
            // Beneath the first layer there is often nothing.
            if i == 0 && stage.background == [0.0; 4] && !fine {
                self.runner.run(device, &mut encoder, (frame, part), &plans)?;
                continue;
            }
            let (target, format) = if fine { (&mut self.fine, FINE) } else { (&mut self.layer, FRAME) };
            let into = target.get(device, synth.size, format)?;
            self.runner.run(device, &mut encoder, (&into, part), &plans)?;
            self.runner.lay(device, &mut encoder, (&LAY, Blend::Over), (&into, frame), part)?;
        }
        device.checked(|| device.queue.submit([encoder.finish()])).map(|_| ())
    }

    /// What is kept on the device.
    pub fn kept(&mut self) -> &mut KeptTextures {
        self.runner.kept()
    }

    /// Releases what has not been drawn since the last call.
    pub fn end_frame(&mut self) {
        self.runner.end_frame();
    }

    /// Encodes a frame for output: sRGB, straight alpha, 8 bits.
    pub fn encode(&mut self, device: &Device, frame: &wgpu::Texture) -> Result<wgpu::Texture> {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let encoded = texture(device, (frame.width() as usize, frame.height() as usize), ENCODED, usage)?;
        let mut encoder = device.raw.create_command_encoder(&Default::default());
        self.runner.lay(device, &mut encoder, (&ENCODE, Blend::Replace), (frame, &encoded), all(frame))?;
        device.checked(|| device.queue.submit([encoder.finish()]))?;
        Ok(encoded)
    }
}

/// A texture to draw into, reused from frame to frame.
#[derive(Default)]
struct Target(Option<wgpu::Texture>);

impl Target {
    fn get(
        &mut self,
        device: &Device,
        (width, height): (usize, usize),
        format: wgpu::TextureFormat,
    ) -> Result<wgpu::Texture> {
        if let Some(kept) = self.0.as_ref().filter(|t| (t.width() as usize, t.height() as usize) == (width, height)) {
            return Ok(kept.clone());
        }
        check_size(device, width, height)?;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let made = texture(device, (width, height), format, usage)?;
        Ok(self.0.insert(made).clone())
    }
}
