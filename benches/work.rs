//! One piece of work of a scene, as often as asked: `scripts/bench` takes the time of the process and pairs it with others.
//! `work field|mask|frame SCENE COUNT [FILE]`; the last result goes to the file, as raw numbers. `work edit SCENE COUNT
//! POINTER` prints how long each edit of that number took until there were new pixels, in milliseconds.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use bytemuck::cast_slice;
use plica::base::error::{Error, Result};
use plica::layers::Layer;
use plica::layers::folding::field::{Inputs, Made};
use plica::layers::folding::inside::mask;
use plica::layers::folding::model::Zone;
use plica::layers::parts::moment::CENTER;
use plica::ops::Context;
use plica::ops::opened::Opened;
use plica::ops::scene_options::SceneOptions;
use plica::render::{cpu, synth};
use plica::scene::Edit;

/// The time of the frames; the peers take the same.
const TIME: f64 = 0.4;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let done = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => return ExitCode::SUCCESS, // `cargo bench` runs every benchmark; this one is for scripts/bench
        [work, scene, count, more @ ..] if more.len() < 2 => run(work, scene, count, more.first().copied()),
        _ => Err(Error::Usage("work field|mask|frame|edit SCENE COUNT [FILE|POINTER]".into())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(work: &str, scene: &str, count: &str, more: Option<&str>) -> Result<()> {
    let count: u32 = count.parse().map_err(|_| Error::Usage(format!("{count}: not a count")))?;
    let opened = Opened::new(Path::new(scene), &SceneOptions::default(), &mut Context::process(Default::default()))?;
    if let ("edit", Some(pointer)) = (work, more) {
        return edit(&opened, count, pointer);
    }
    let last = repeated(work, &opened, count)?;
    match more {
        Some(file) => std::fs::write(file, last).map_err(|error| Error::at(file, error)),
        None => Ok(()),
    }
}

/// Does the work so many times; the bytes of the last result.
fn repeated(work: &str, opened: &Opened, count: u32) -> Result<Vec<u8>> {
    let mut last = Vec::new();
    match work {
        "field" => {
            let (zone, size) = first_zone(opened)?;
            let (inputs, mut made) = (Inputs::new(zone, size, CENTER), None);
            for _ in 0..count {
                made = Made::new(&inputs, None, &opened.materials).map_err(|problem| opened.failed(problem))?;
            }
            made.iter().for_each(|made| last.extend_from_slice(cast_slice(made.field.jumps.cells())));
        }
        "mask" => {
            let (zone, size) = first_zone(opened)?;
            let (polygon, mut made) = (zone.outline.polygon(), None);
            for _ in 0..count {
                made = Some(mask(&polygon, size, CENTER));
            }
            made.iter().for_each(|mask| last.extend(mask.cells().iter().map(|&inside| u8::from(inside))));
        }
        "frame" => {
            let (synth, mut made) = (opened.synth()?, None);
            for _ in 0..count {
                made = Some(cpu::frame(&synth, TIME));
            }
            made.iter().for_each(|frame| last.extend_from_slice(cast_slice(frame.cells())));
        }
        _ => return Err(Error::Usage(format!("{work}: no such work"))),
    }
    Ok(last)
}

/// The scene's first zone, and the size of its picture.
fn first_zone(opened: &Opened) -> Result<(&Zone, (usize, usize))> {
    let scene = opened.document.scene();
    let zone = scene.layers.iter().find_map(|layer| match layer {
        Layer::Picture(layer) => Some((layer.zones.first()?, opened.materials.pictures.get(&layer.image)?)),
        _ => None,
    });
    let (zone, picture) = zone.ok_or_else(|| Error::at(opened.path.display(), "has no zone"))?;
    Ok((zone, (picture.width(), picture.height())))
}

/// Moves the number at `pointer` to and fro by one.
fn edit(opened: &Opened, count: u32, pointer: &str) -> Result<()> {
    let mut document = opened.document.clone();
    let number = document.json().pointer(pointer).and_then(serde_json::Value::as_f64);
    let number = number.ok_or_else(|| Error::Usage(format!("{pointer}: no number")))?;
    let mut last = opened.synth()?;
    for k in 0..count {
        let begun = Instant::now();
        let edit = Edit::set(&document, pointer, (number + f64::from((k + 1) % 2)).into());
        document = document.apply(&edit).map_err(|mut problems| opened.failed(problems.remove(0)))?;
        last = synth(document.scene(), &opened.materials, Some(&last)).map_err(|problem| opened.failed(problem))?;
        std::hint::black_box(cpu::frame(&last, TIME));
        println!("{}", begun.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}
