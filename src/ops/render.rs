//! `plica render`: frames to numbered files, to one animation, or to another program.

use std::path::{Path, PathBuf};

use super::{Context, opened::Opened, scene_options::SceneOptions};
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, Linear};
use crate::export::animation::{Show, Target, range, rate::Rate, scale, table};
use crate::layers::timeline::{Timeline, Wrap};
use crate::render::{Synth, cpu, seams};

/// Render frames to numbered files, an animation or a stream.
#[derive(clap::Args)]
#[command(after_help = format!("Outputs:\n{}\n  -         y4m or rgba for another program, by --format", table()))]
pub struct Args {
    /// The scene; - is standard input
    scene: PathBuf,
    /// Where to: the extension names the format, %04d numbers files, - is standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Which frames, as 0,5,10-20:2; all without it
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
    frames: Option<String>,
    /// Scale finished frames; a 0 keeps the ratio
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    size: Option<String>,
    /// N x N samples a pixel: smooth edges of folds
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    samples: u32,
    /// Draw with the GPU instead of the reference
    #[arg(long)]
    gpu: bool,
    /// Format on standard output: y4m or rgba
    #[arg(long)]
    format: Option<String>,
    #[command(flatten)]
    options: SceneOptions,
}

/// Renders.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let opened = Opened::new(&args.scene, &args.options, context)?;
    let timeline = &opened.document.scene().timeline;
    let frames = match &args.frames {
        Some(text) => range::parse(text, timeline.frames())?,
        None => (0..timeline.frames()).collect(),
    };
    let (target, place) = target(&args, frames.len() as u64, context)?;
    let mut renderer = Renderer::new(&args, &opened)?;
    if frames.len() > 1 {
        let loops = seams::warnings(opened.document.scene(), || renderer.samples.first());
        loops.iter().for_each(|warning| context.messages.say(&format!("{}: {warning}", args.scene.display())));
    }
    let show = show(place, renderer.size, &frames, timeline);
    let mut sink = target.begin(show)?;
    for (done, &number) in frames.iter().enumerate() {
        context.check_cancelled()?;
        context.messages.step("frame", done as u64, frames.len() as u64);
        sink.frame(number, renderer.frame(timeline.time_of(number))?)?;
    }
    context.check_cancelled()?;
    let notes = sink.finish()?;
    context.messages.step("frame", frames.len() as u64, frames.len() as u64);
    notes.iter().for_each(|note| context.messages.say(note));
    Ok(())
}

fn target(args: &Args, frames: u64, context: &mut Context) -> Result<(Target, String)> {
    let to_stream = args.output == Path::new("-");
    match (&args.format, to_stream) {
        (None, false) => Ok((Target::file(&args.output, frames)?, args.output.display().to_string())),
        (Some(format), true) => {
            let out = std::mem::replace(&mut context.out, Box::new(std::io::sink()));
            Ok((Target::stream(format, out)?, "standard output".into()))
        }
        (None, true) => Err(Error::Usage("-o -: say the format by --format y4m or --format rgba".into())),
        (Some(_), false) => Err(Error::Usage("--format is for -o -; a file's extension names its format".into())),
    }
}

/// Frames with an even step keep the speed of the scene; others follow one another at its rate.
fn show(place: String, (width, height): (usize, usize), frames: &[u64], timeline: &Timeline) -> Show {
    let rate = Rate::from_fps(timeline.fps).every(range::step(frames).unwrap_or(1));
    Show { place, width, height, frames: frames.len() as u64, rate, once: timeline.wrap == Wrap::Once }
}

/// What turns a time into a finished frame.
struct Renderer {
    /// One synthesis a sample of each pixel.
    samples: Vec<Synth>,
    /// Width and height of the finished frame.
    size: (usize, usize),
    #[cfg(feature = "window")]
    gpu: Option<Box<crate::render::gpu::Gpu>>,
}

impl Renderer {
    fn new(args: &Args, opened: &Opened) -> Result<Self> {
        let samples = if args.samples == 1 { vec![opened.synth()?] } else { opened.samples(args.samples)? };
        let own = samples.first().map_or((0, 0), |synth| synth.size);
        let size = args.size.as_ref().map_or(Ok(own), |text| scale::parse(text, own))?;
        #[cfg(not(feature = "window"))]
        if args.gpu {
            return Err(Error::at("--gpu", "this plica was built without the GPU").cure("leave --gpu out"));
        }
        #[cfg(feature = "window")]
        let gpu = if args.gpu { Some(Box::new(crate::render::gpu::Gpu::new()?)) } else { None };
        Ok(Renderer {
            samples,
            size,
            #[cfg(feature = "window")]
            gpu,
        })
    }

    fn frame(&mut self, time: f64) -> Result<Frame> {
        #[cfg(feature = "window")]
        if let Some(gpu) = &mut self.gpu {
            let frames = self.samples.iter().map(|synth| gpu.frame(synth, time)).collect::<Result<Vec<_>>>()?;
            return Ok(match &frames[..] {
                [frame] if (frame.width(), frame.height()) == self.size => frame.clone(),
                frames => self.finish(&cpu::mean_of(frames.iter().map(Frame::to_linear))),
            });
        }
        Ok(self.finish(&cpu::mean(&self.samples, time)))
    }

    fn finish(&self, picture: &Linear) -> Frame {
        cpu::finish(&scale::resize(picture, self.size))
    }
}
