//! How long a frame takes on the CPU. `cargo bench --bench frames`

mod scenes;

use std::sync::Arc;

use divan::Bencher;
use plica::base::picture::{Channels, Picture, SRGB_8, Samples};
use plica::layers::Layer;
use plica::layers::folding::model::PictureLayer;
use plica::layers::parts::materials::Materials;
use plica::layers::timeline::Wrap;
use plica::render::{cpu, synth};
use plica::scene::Scene;

fn main() {
    divan::main();
}

/// Every pixel moves, and folds at an ellipse; from synthesis to sRGB codes, of a picture of 8 bits.
#[divan::bench(args = [(640, 480), (1920, 1080), (3840, 2160)], sample_count = 10)]
fn frame(bencher: Bencher, size: (usize, usize)) {
    let layer = PictureLayer {
        name: "all".into(),
        image: "noise".into(),
        zones: vec![scenes::zone(size, 94, r#"{"method":"modified-shepard","radius":400}"#)],
    };
    let scene = Scene {
        timeline: plica::layers::timeline::Timeline { wrap: Wrap::Repeat, ..Default::default() },
        layers: vec![Layer::Picture(layer)],
        ..Scene::default()
    };
    let mut materials = Materials::default();
    materials.pictures.insert("noise".into(), Arc::new(picture(size)));
    let synth = synth(&scene, &materials, None).expect("the picture is among the materials");
    bencher.bench(|| cpu::frame(&synth, 0.3));
}

fn picture((width, height): (usize, usize)) -> Picture {
    let code = |i: usize| if i % 4 == 3 { 255 } else { ((i * 7 % 251) ^ (i / 997)) as u8 };
    let codes = (0..4 * width * height).map(code).collect();
    Picture::new(width, height, Channels::Rgba, Samples::Bytes(codes, SRGB_8.clone()))
}
