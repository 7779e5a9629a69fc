//! One piece of work of a scene, as often as asked: `scripts/bench` takes the time of the process and pairs it with others.
//! `work field|frame SCENE COUNT [FILE]`; the last result goes to the file, as raw numbers.

use std::path::Path;
use std::process::ExitCode;

use bytemuck::cast_slice;
use plica::base::error::{Error, Result};
use plica::layers::Layer;
use plica::layers::folding::field::{Field, Inputs};
use plica::layers::parts::moment::CENTER;
use plica::ops::Context;
use plica::ops::opened::Opened;
use plica::ops::scene_options::SceneOptions;
use plica::render::cpu;

/// The time of the frames; the peers take the same.
const TIME: f64 = 0.4;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let done = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => return ExitCode::SUCCESS, // `cargo bench` runs every benchmark; this one is for scripts/bench
        [work @ ("field" | "frame"), scene, count, file @ ..] if file.len() < 2 => {
            run(work, scene, count, file.first())
        }
        _ => Err(Error::Usage("work field|frame SCENE COUNT [FILE]".into())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(work: &str, scene: &str, count: &str, file: Option<&&str>) -> Result<()> {
    let count: u32 = count.parse().map_err(|_| Error::Usage(format!("{count}: not a count")))?;
    let opened = Opened::new(Path::new(scene), &SceneOptions::default(), &mut Context::process(Default::default()))?;
    let mut last = Vec::new();
    if work == "field" {
        let inputs = inputs(&opened)?;
        for _ in 0..count {
            let made = Field::new(&inputs, &opened.materials).map_err(|problem| opened.failed(problem))?;
            last = made.map(|(field, _)| cast_slice(field.jumps.cells()).to_vec()).unwrap_or_default();
        }
    } else {
        let synth = opened.synth()?;
        for _ in 0..count {
            last = cast_slice(cpu::frame(&synth, TIME).cells()).to_vec();
        }
    }
    match file {
        Some(file) => std::fs::write(file, last).map_err(|error| Error::at(file, error)),
        None => Ok(()),
    }
}

/// The inputs of the field of the scene's first zone.
fn inputs(opened: &Opened) -> Result<Inputs> {
    let scene = opened.document.scene();
    let zone = scene.layers.iter().find_map(|layer| match layer {
        Layer::Picture(layer) => Some((layer.zones.first()?, opened.materials.pictures.get(&layer.image)?)),
        _ => None,
    });
    let (zone, picture) = zone.ok_or_else(|| Error::at(opened.path.display(), "has no zone"))?;
    Ok(Inputs::new(zone, (picture.width(), picture.height()), CENTER))
}
