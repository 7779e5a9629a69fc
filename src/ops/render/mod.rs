//! `plica render`: frames to numbered files, to one animation, or to another program.

mod args;
mod pass;

pub use args::Args;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use args::{Numbered, frame_bytes, numbered, wanted};

use super::demo::quoted;
use super::opened::{Opened, Unloaded};
use super::watched::watched;
use super::writing::Counting;
use super::{Context, Progress};
use crate::base::budget::Share;
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, Linear, side_by_side};
use crate::base::problem::Problem;
use crate::base::text::counted;
use crate::export::animation::matrix::Matrix;
use crate::export::animation::{Show, Target, range, rate::Rate, scale};
use crate::files::outputs::{self, Cleared};
use crate::layers::parts::materials::Materials;
use crate::layers::timeline::{Timeline, Wrap};
use crate::render::bands::Bands;
use crate::render::{Synth, cpu, seams};
use crate::scene::{Scene, address};

/// Renders the frames.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    let light = args.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
    if light && args.compare.is_some() {
        return Err(Error::Usage("--compare is for frames as one sees them: .png, not .exr".into()));
    }
    if args.pass.is_some() || light {
        return pass::run(&args, context);
    }
    let begun = Instant::now();
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let timeline = read.document.scene().timeline.clone();
    let (frames, still) = wanted(&args, read.document.scene())?;
    let numbered = numbered(&args, &frames);
    let written = Arc::new(AtomicU64::new(0));
    let (target, place) = target(&args, &read, &numbered, &written, context)?;
    let opened = read.load(context)?.leaving_out();
    let ways = match &args.compare {
        Some(by) => opened.compared(by)?,
        None => vec![opened],
    };
    let each = frame_size(&args, &ways[0])?;
    let size = (each.0 * ways.len(), each.1);
    let todo: Vec<Numbered> =
        numbered.into_iter().filter(|(_, number)| !(args.skip_existing && target.has(*number, size))).collect();
    let skipped = frames.len() - todo.len();
    let show = show(&args, place, size, &frames, todo.len(), &timeline, context);
    target.ready(&show)?;
    let files = target.files();
    let what = what(&show.place, &files, &todo, skipped);
    if !todo.is_empty() {
        let is_sequence = target.is_sequence();
        let mut done = 0;
        let outcome = write(&args, (target, show), (&ways, each), &timeline, &todo, &mut done, context);
        if matches!(outcome, Err(Error::Interrupted)) && is_sequence {
            let all = todo.len();
            context.messages.say(&format!("{done} of {all} frames are there; with --skip-existing the same goes on"));
        }
        outcome?;
    }
    let bytes = written.load(Ordering::Relaxed) + outputs::size(files.iter().map(Cleared::path));
    context.say_all(still.as_slice());
    context.done(&what, bytes, begun);
    Ok(())
}

/// Renders the frames and passes them to the target; `done` counts them.
fn write(
    args: &Args,
    (target, show): (Target, Show),
    (ways, each): (&[Opened], (usize, usize)),
    timeline: &Timeline,
    todo: &[Numbered],
    done: &mut u64,
    context: &mut Context,
) -> Result<()> {
    let renderer = |opened| Renderer::new(args, opened, each, todo.len());
    let mut renderers = ways.iter().map(renderer).collect::<Result<Vec<_>>>()?;
    let by_cpu = renderers.iter_mut().find_map(|one| one.by_cpu.take());
    context.say_all(&by_cpu.map(|why| format!("--gpu: the CPU draws this: {why}")).into_iter().collect::<Vec<_>>());
    let first = &renderers[0];
    let Opened { document, materials, .. } = first.opened;
    let pictures = first.bands.as_ref().map(Bands::pictures);
    first.samples.first().or(pictures.as_ref()).into_iter().for_each(|synth| first.opened.tell_lacks(synth, context));
    let _encoding = materials.budget.take(target.memory(&show), &show.place)?;
    if todo.len() > 1 {
        for warning in seams::warnings(document.scene(), materials, || first.samples.first()) {
            let warning = address::of_problem(document, &warning);
            context.messages.say(&format!("{}: {warning}", args.scene.display()));
        }
    }
    let total = todo.len() as u64;
    let mut sink = target.begin(show)?;
    for &(frame, number) in todo {
        context.check_cancelled()?;
        context.messages.step("frame", *done, total);
        let (time, messages) = (timeline.time_of(frame), &mut *context.messages);
        let drawn = match renderers.as_mut_slice() {
            [one] => one.frame(time, messages)?,
            ways => side_by_side(&ways.iter_mut().map(|way| way.frame(time, messages)).collect::<Result<Vec<_>>>()?),
        };
        // What is drawn then may be incomplete.
        context.check_cancelled()?;
        sink.frame(number, drawn)?;
        *done += 1;
    }
    context.check_cancelled()?;
    let notes = sink.finish()?;
    context.messages.step("frame", total, total);
    context.say_all(&notes);
    Ok(())
}

fn target(
    args: &Args,
    read: &Unloaded,
    numbered: &[Numbered],
    written: &Arc<AtomicU64>,
    context: &mut Context,
) -> Result<(Target, String)> {
    let to_stream = args.output == Path::new("-");
    let (target, place) = match (&args.format, to_stream) {
        (None, false) => {
            let mut guard = args.replacing.guard(&args.scene, read.document.scene(), context);
            let numbers: Vec<u64> = numbered.iter().map(|&(_, number)| number).collect();
            let target = Target::file(&args.output, &numbers, &mut guard)?;
            context.say_all(&guard.notes());
            (target, args.output.display().to_string())
        }
        (Some(format), true) => {
            let out = std::mem::replace(&mut context.out, Box::new(std::io::sink()));
            let out = Box::new(Counting { out, count: written.clone() });
            (Target::stream(format, out)?, "standard output".into())
        }
        (None, true) => return Err(Error::Usage("-o -: say the format by --format y4m or --format rgba".into())),
        (Some(_), false) => {
            return Err(Error::Usage("--format is for -o -; a file's extension names its format".into()));
        }
    };
    for (given, fits, what) in [
        (args.start_number.is_some(), target.is_sequence(), "--start-number is for numbered files, as %04d.png"),
        (args.skip_existing, target.is_sequence(), "--skip-existing is for numbered files, as %04d.png"),
        (args.matrix.is_some(), target.has_matrix(), "--matrix is for y4m and video"),
    ] {
        if given && !fits {
            return Err(Error::Usage(what.into()));
        }
    }
    Ok((target, place))
}

/// Width and height of the finished frames.
fn frame_size(args: &Args, opened: &Opened) -> Result<(usize, usize)> {
    let own = crate::render::frame_size(opened.document.scene(), &opened.materials);
    args.size.as_ref().map_or(Ok(own), |text| scale::parse(text, own))
}

/// What was written, in words.
fn what(place: &str, files: &[Cleared], todo: &[Numbered], skipped: usize) -> String {
    let skipped = if skipped > 0 { format!(" ({skipped} were there already)") } else { String::new() };
    let frames = counted(todo.len(), "frame");
    match files {
        [_] if skipped.is_empty() => place.to_owned(),
        _ => format!("{place}, {frames}{skipped}"),
    }
}

/// Frames with an even step keep the speed of the scene; others are shown at its frame rate.
fn show(
    args: &Args,
    place: String,
    (width, height): (usize, usize),
    frames: &[u64],
    count: usize,
    timeline: &Timeline,
    context: &Context,
) -> Show {
    let rate = Rate::from_fps(timeline.fps).every(range::step(frames).unwrap_or(1));
    let matrix = args.matrix.as_deref().and_then(Matrix::named);
    let once = timeline.wrap == Wrap::Once;
    let (command, cancel) = (command(args), context.cancel.clone());
    Show { place, width, height, frames: count as u64, rate, once, matrix, command, cancel }
}

/// The command line without its output.
fn command(args: &Args) -> String {
    let scene = quoted(&args.scene.display().to_string());
    let options =
        [("frames", &args.frames), ("size", &args.size), ("compare", &args.compare), ("matrix", &args.matrix)];
    let options = options.into_iter().filter_map(|(name, value)| Some(format!(" --{name} {}", value.as_ref()?)));
    let samples = (args.samples > 1).then(|| format!(" --samples {}", args.samples));
    let words = ["plica render ".to_owned(), scene].into_iter().chain(options).chain(samples);
    words.chain(args.gpu.then(|| " --gpu".to_owned())).collect()
}

/// That there is not the memory for a frame of a scene beside its `materials`; or the memory, as it is taken for every frame.
pub fn room(scene: &Scene, materials: &Materials) -> std::result::Result<Share, Problem> {
    let size = crate::render::frame_size(scene, materials);
    let taken = materials.budget.try_take(frame_bytes(size, size, 1, cpu::BAND));
    taken.map_err(|short| short.problem("/size"))
}

/// Turns a time into a finished frame.
struct Renderer<'a> {
    opened: &'a Opened,
    /// One synthesis per sample of a pixel.
    samples: Vec<Synth>,
    /// Instead of `samples`, for a single frame that is not scaled: nothing is kept for another frame.
    bands: Option<Bands<'a>>,
    /// Width and height of the finished frame.
    size: (usize, usize),
    /// The memory that frames take while they are made.
    _share: Share,
    #[cfg(feature = "window")]
    gpu: Option<Box<crate::render::gpu::Gpu>>,
    /// Why the CPU draws though the GPU should.
    by_cpu: Option<String>,
}

impl<'a> Renderer<'a> {
    fn new(args: &Args, opened: &'a Opened, size: (usize, usize), frames: usize) -> Result<Self> {
        let own = crate::render::frame_size(opened.document.scene(), &opened.materials);
        let in_bands = frames == 1 && !args.gpu && own == size;
        let band = if in_bands { Bands::PIXELS } else { cpu::BAND };
        let place = args.size.as_ref().map_or("frames".to_owned(), |text| format!("--size {text}"));
        let bytes = frame_bytes(own, size, args.samples as usize, band);
        // Before what is made of the scene, so that where that lacks memory it is told how much all of it needs.
        let share = opened.materials.budget.take(bytes, &place)?;
        let bands = in_bands.then(|| opened.bands(args.samples)).transpose()?;
        let samples = match (&bands, args.samples) {
            (Some(_), _) => Vec::new(),
            (None, 1) => vec![opened.synth()?],
            (None, n) => opened.samples(n)?,
        };
        let pictures = bands.as_ref().map(Bands::pictures);
        let first = samples.first().or(pictures.as_ref());
        let strokes = first.map_or(0, |synth| crate::render::stroke_bytes(synth, args.samples));
        let share = share.and(opened.materials.budget.take(strokes, place)?);
        #[cfg(not(feature = "window"))]
        if args.gpu {
            return Err(Error::at("--gpu", "this plica was built without the GPU").cure("leave --gpu out"));
        }
        #[cfg(feature = "window")]
        let gpu = match args.gpu {
            true => Some(Box::new(crate::render::gpu::Gpu::new()?)),
            false => None,
        };
        #[cfg(feature = "window")]
        let by_cpu = gpu.as_ref().and_then(|gpu| gpu.samples_by_cpu(&samples));
        #[cfg(not(feature = "window"))]
        let by_cpu = None;
        Ok(Renderer {
            by_cpu,
            opened,
            samples,
            bands,
            size,
            _share: share,
            #[cfg(feature = "window")]
            gpu,
        })
    }

    fn frame(&mut self, time: f64, messages: &mut dyn Progress) -> Result<Frame> {
        let mut frame = self.drawn(time, messages)?;
        match (&self.bands, self.samples.first()) {
            (Some(bands), _) => cpu::keep_clear_colors(&bands.pictures(), &mut frame),
            (None, Some(synth)) if synth.size == self.size => cpu::keep_clear_colors(synth, &mut frame),
            _ => {}
        }
        Ok(frame)
    }

    fn drawn(&mut self, time: f64, messages: &mut dyn Progress) -> Result<Frame> {
        #[cfg(feature = "window")]
        if let Some(gpu) = &mut self.gpu {
            if let [synth] = &self.samples[..]
                && synth.size == self.size
            {
                return gpu.frame(synth, time);
            }
            let mean = gpu.mean(&self.samples, time)?;
            return Ok(self.finish(&mean));
        }
        if let Some(bands) = &self.bands {
            // A single frame of many samples takes as long as many frames.
            let drawn = watched(messages, "row", bands.steps(), |done| bands.frame(time, done));
            return drawn.map_err(|problem| self.opened.failed(problem));
        }
        let own = self.samples.first().map(|synth| synth.size);
        if own == Some(self.size) {
            return Ok(cpu::frames(&self.samples, time));
        }
        Ok(self.finish(&cpu::mean(&self.samples, time)))
    }

    fn finish(&self, picture: &Linear) -> Frame {
        cpu::finish(&scale::resize(picture, self.size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::budget::Budget;

    #[test]
    fn a_frame_that_is_too_large_is_a_problem_before_it_is_made() {
        let scene: Scene = serde_json::from_str(r#"{ "plica": 1, "size": [1000, 500], "layers": [] }"#).unwrap();
        for (most, fits) in [(1 << 30, true), (1 << 20, false)] {
            let materials = Materials { budget: Budget::new(most), ..Materials::default() };
            let found = room(&scene, &materials);
            assert_eq!(found.as_ref().err().map(|short| short.path.as_str()), (!fits).then_some("/size"), "{most}");
            assert_eq!(materials.budget.taken() > 0, fits, "it is taken while it is kept");
        }
    }
}
