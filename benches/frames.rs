//! How long a frame takes on the CPU. `cargo bench --bench frames`

mod scenes;

use std::sync::Arc;

use divan::Bencher;
use plica::base::picture::Picture;
use plica::layers::Layer;
use plica::layers::folding::model::PictureLayer;
use plica::layers::parts::materials::Materials;
use plica::layers::timeline::Wrap;
use plica::render::{cpu, synth};
use plica::scene::Scene;

fn main() {
    divan::main();
}

/// Every pixel moves, and folds at an ellipse; from synthesis to sRGB codes.
#[divan::bench(args = [(640, 480), (1920, 1080)], sample_count = 10)]
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
    let cell = |i: usize| [(i * 7 % 251) as f32 / 251.0, (i * 13 % 241) as f32 / 241.0, (i % 97) as f32 / 97.0, 1.0];
    Picture::from_cells(width, height, (0..width * height).map(cell).collect())
}
