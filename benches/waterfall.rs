//! How long a waterfall takes on the CPU, over the clip of the demo `falls`: whole frames in linear light, and what each
//! step of one takes. `cargo bench --bench waterfall`

use std::path::Path;

use divan::Bencher;
use plica::files::{Options, materials};
use plica::layers::parts::moment::Columns;
use plica::layers::waterfall;
use plica::layers::waterfall::between::texels;
use plica::layers::waterfall::draw::{bins, drawn};
use plica::layers::waterfall::frame::places;
use plica::layers::waterfall::splat::{Splat, splats};
use plica::render::{Synth, cpu, synth};
use plica::scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde_json::{Value, json};

fn main() {
    divan::main();
}

const SIZE: (usize, usize) = (512, 400);
/// A time with nothing special about it.
const TIME: f64 = 0.37;

/// 10,000 sprites of 32 pixels on one thread, turned by up to so many degrees: at most 50 ms if not at all, otherwise 100.
#[divan::bench(args = [0, 180], sample_count = 20)]
fn ten_thousand(bencher: Bencher, tilt: u32) {
    let synth = ready(ten_thousand_sprites(tilt));
    let pool = pool(1);
    bencher.bench_local(|| pool.install(|| cpu::linear(&synth, TIME)));
}

/// The layer with nothing set: at most 33 ms on two threads.
#[divan::bench(args = [1, 2], sample_count = 30)]
fn default_layer(bencher: Bencher, threads: usize) {
    let synth = ready(json!({}));
    let pool = pool(threads);
    bencher.bench_local(|| pool.install(|| cpu::linear(&synth, TIME)));
}

/// Of that, on one thread: where sprites are, and what they show.
#[divan::bench(args = ["ten thousand", "default"], sample_count = 30)]
fn births(bencher: Bencher, name: &str) {
    let synth = named(name);
    let moment = synth.moment(TIME);
    let pool = pool(1);
    bencher.bench_local(|| pool.install(|| splats(own(&synth), &moment)));
}

/// Which strips of the frame draw which sprites.
#[divan::bench(args = ["ten thousand", "default"], sample_count = 30)]
fn binning(bencher: Bencher, name: &str) {
    let synth = named(name);
    let moment = synth.moment(TIME);
    let (own, rows): (_, Vec<usize>) = (own(&synth), (0..SIZE.1).collect());
    let (splats, places) = (splats(own, &moment), places(own, &moment, &rows, Columns::All));
    let pool = pool(1);
    bencher.bench_local(|| pool.install(|| bins(&drawn(own.blend, &splats, &places), rows.len())));
}

/// The texels of all sprites, each once. What is left of a frame is their splatting.
#[divan::bench(args = ["ten thousand", "default"], sample_count = 30)]
fn synthesis(bencher: Bencher, name: &str) {
    let synth = named(name);
    let own = own(&synth);
    let splats = splats(own, &synth.moment(TIME));
    let from = (&*own.pictures, &*own.residues);
    let mut out = Vec::new();
    bencher.bench_local(|| {
        for Splat { mix, level, .. } in &splats {
            texels(from, mix, *level, 0..own.pictures.side >> level, &mut out);
        }
    });
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

fn named(name: &str) -> Synth {
    ready(if name == "default" { json!({}) } else { ten_thousand_sprites(0) })
}

fn own(synth: &Synth) -> &waterfall::synth::Synth {
    synth.layers[0].downcast().expect("its layer is a waterfall")
}

/// 500 lines straight down, with 20 sprites on each whatever the time is.
fn ten_thousand_sprites(tilt: u32) -> Value {
    let lip = [-2.2, 2.2].map(|x| json!({ "at": [x, 1.7, 0], "velocity": [0, -3.2, 0] }));
    let look = json!({ "width": [0.2912, 0.2912], "jitter": 0, "streak": 0, "tilt": tilt, "fade": [0, 0] });
    json!({
        "lip": lip, "pool": -100, "height": 1, "lines": 500, "rate": 20, "life": 1, "thickness": 0, "spread": 0,
        "scatter": [0, 0], "gravity": 0, "drag": { "model": "none" }, "surge": { "amount": 0, "sway": 0 },
        "look": look, "foam": { "lines": 0 },
    })
}

/// A scene with nothing but a layer of which this is set.
fn ready(set: Value) -> Synth {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/falls/falls.plica.json");
    let many = set.get("lip").is_some();
    let mut layer = json!({ "kind": "waterfall", "name": "falls", "clip": "water" });
    layer.as_object_mut().expect("it is one").extend(set.as_object().cloned().unwrap_or_default());
    let camera = if many { json!({ "position": [0, 0, 5], "target": [0, 0, 0] }) } else { json!({}) };
    let scene = json!({
        "plica": 1, "size": [SIZE.0, SIZE.1], "timeline": { "duration": 1 }, "camera": camera,
        "clips": { "water": { "path": "water-%04d.png" } }, "layers": [layer],
    });
    let scene: Scene = serde_json::from_value(scene).expect("the scene is written as the document wants it");
    let loaded = materials::load(&path, &scene, &Options::default(), &mut materials::Cache::default());
    let (materials, _) = loaded.expect("the clip is among the demos");
    synth(&scene, &materials, None).expect("its clip is among the materials")
}
