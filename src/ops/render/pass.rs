//! `plica render --pass`: what frames are made from, to OpenEXR files or, to look at, PNG files.

use std::time::Instant;

use super::args::{Args, Numbered, frame_bytes, numbered, wanted};
use crate::base::error::{Error, Result};
use crate::base::pixels::{Frame, Linear};
use crate::export::passes::Files;
use crate::files::outputs;
use crate::layers::parts::pass::COLOR;
use crate::ops::Context;
use crate::ops::opened::{Opened, Unloaded};
use crate::render::passes::{Asked, view, view_over};
use crate::render::{self, Synth, cpu};

/// Renders the pass that `args` ask for, or the finished light if they only name OpenEXR files.
pub fn run(args: &Args, context: &mut Context) -> Result<()> {
    let begun = Instant::now();
    for (given, what) in [
        (args.size.is_some(), "--size"),
        (args.gpu, "--gpu"),
        (args.format.is_some(), "--format"),
        (args.matrix.is_some(), "--matrix"),
        (args.skip_existing, "--skip-existing"),
    ] {
        if given {
            let these = if args.pass.is_some() { "passes: they have" } else { "OpenEXR: it has" };
            return Err(Error::Usage(format!("{what} is not for {these} the numbers of each pixel (leave it out)")));
        }
    }
    let read = Unloaded::read(&args.scene, &args.options, context)?;
    let scene = read.document.scene().clone();
    let asked = Asked::parse(args.pass.as_deref().unwrap_or(COLOR.name), &scene);
    let asked = asked.map_err(|what| Error::Usage(format!("--pass: {what}")))?;
    context.say_all(&asked.emptiness(&scene).into_iter().chain(unsampled(args.samples, &asked)).collect::<Vec<_>>());
    let (frames, still) = wanted(args, &scene)?;
    let todo: Vec<Numbered> = numbered(args, &frames);
    let mut guard = args.replacing.guard(&args.scene, &scene, context);
    let files = Files::new(&args.output, &todo.iter().map(|(_, number)| *number).collect::<Vec<_>>(), &mut guard)?;
    context.say_all(&guard.notes());
    let opened = read.load(context)?.leaving_out();
    let size = render::frame_size(&scene, &opened.materials);
    let each_way = if *asked.pass == COLOR { args.samples } else { 1 };
    let band = size.0 * size.1;
    let _share = opened.materials.budget.take(2 * frame_bytes(size, size, each_way as usize, band), "frames")?;
    let samples = made(&opened, each_way, *asked.pass != COLOR && files.are_numbers())?;
    samples.first().into_iter().for_each(|synth| opened.tell_lacks(synth, context));
    let strokes = samples.first().map_or(0, |synth| render::stroke_bytes(synth, each_way));
    let _strokes = opened.materials.budget.take(strokes, "frames")?;
    let samples: Vec<Synth> = samples.iter().map(|synth| asked.only(synth)).collect();
    for (i, &(frame, number)) in todo.iter().enumerate() {
        context.check_cancelled()?;
        context.messages.step("frame", i as u64, todo.len() as u64);
        let time = scene.timeline.time_of(frame);
        let picture: Linear = match samples.as_slice() {
            [synth] => asked.picture(synth, time),
            samples => cpu::mean(samples, time),
        };
        let shown = || shown(&asked, &picture, (&samples[0], time));
        context.check_cancelled()?;
        files.write(number, &picture, *asked.pass == COLOR, shown)?;
    }
    context.messages.step("frame", todo.len() as u64, todo.len() as u64);
    context.say_all(still.as_slice());
    let what = match todo.len() {
        1 => args.output.display().to_string(),
        n => format!("{}, {n} frames", args.output.display()),
    };
    context.done(&what, outputs::size(files.paths()), begun);
    Ok(())
}

/// What the pass is made from. A PNG of lines shows the frame beneath them, numbers alone need no more than where things are.
fn made(opened: &Opened, each_way: u32, only_numbers: bool) -> Result<Vec<Synth>> {
    match each_way {
        1 if only_numbers => opened.unpainted().map(|synth| vec![synth]),
        1 => opened.synth().map(|synth| vec![synth]),
        _ => opened.samples(each_way),
    }
}

/// Why more samples change nothing, where they do not.
fn unsampled(samples: u32, asked: &Asked) -> Option<String> {
    (samples > 1 && *asked.pass != COLOR).then(|| {
        let name = asked.pass.name;
        format!("--samples {samples} changes nothing: {name} has one sample in the middle of each pixel, since data has no mean")
    })
}

/// A pass to look at.
fn shown(asked: &Asked, picture: &Linear, (synth, time): (&Synth, f64)) -> Frame {
    let other = asked.looked_at();
    if other == *asked {
        return view_over(asked, picture, || cpu::linear(synth, time));
    }
    view(other.pass, &other.picture(synth, time))
}
