//! How long strokes take on the CPU: a noise by itself, and a whole frame. The surface is a wall that covers the frame, or a
//! wavy ball that fills most of it. `cargo bench --bench strokes`

use std::sync::Arc;

use divan::Bencher;
use glam::DVec3;
use plica::base::maths::{TAU, cos, sin};
use plica::base::mesh::{Mesh, Vertex};
use plica::layers::parts::materials::Materials;
use plica::render::{Synth, cpu, passes::Asked, synth};
use plica::scene::Scene;

fn main() {
    divan::main();
}

/// A noise at 1920 x 1080 on one core: how many kernels are over a pixel, their spacing and regularity. The last is a
/// grain of 1.5 million waves.
#[divan::bench(args = [(16.0, 14.4, 1.25), (64.0, 16.0, 1.25), (8.0, 3.0, 0.8)], sample_count = 10)]
fn noise(bencher: Bencher, (overlap, spacing, regularity): (f64, f64, f64)) {
    let strokes = format!(
        r#"{{"style": "none", "noises": {{"a": {{"overlap": {overlap}, "spacing": {spacing}, "regularity": {regularity}}}}},
            "marks": [{{"name": "m", "kind": "ink", "noise": "a"}}]}}"#
    );
    let synth = scene(wall(50), &strokes, (1920, 1080));
    let asked = Asked::parse("noise", &Scene::default()).expect("there is such a pass");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be had");
    // Each frame is of another time, since the last one drawn is kept.
    let mut time = 0.0;
    bencher.bench_local(|| {
        time = (time + 0.01) % 1.0;
        one.install(|| asked.picture(&synth, time))
    });
}

/// A frame at 1280 x 720 of each style: at most 100 ms on two cores.
#[divan::bench(
    args = ["hatching", "cross-hatching", "stipple", "engraving", "graphite", "charcoal", "watercolor", "felt-tip", "painterly"],
    sample_count = 10
)]
fn frame(bencher: Bencher, style: &str) {
    let synth = scene(ball(44_000), &format!(r#"{{"style": "{style}"}}"#), (1280, 720));
    bencher.bench(|| cpu::linear(&synth, 0.3));
}

/// Growth with triangles.
#[divan::bench(args = [4_000, 11_000, 50_000], sample_count = 10)]
fn triangles(bencher: Bencher, count: usize) {
    let synth = scene(ball(count), r#"{"style": "hatching"}"#, (1280, 720));
    bencher.bench(|| cpu::linear(&synth, 0.3));
}

fn scene(mesh: Mesh, strokes: &str, (width, height): (usize, usize)) -> Synth {
    let json = format!(
        r#"{{"plica": 1, "size": [{width}, {height}], "camera": {{"position": [0, 0, 3], "target": [0, 0, 0]}},
            "meshes": {{"m": {{"path": "m.obj"}}}},
            "layers": [{{"kind": "mesh", "name": "m", "mesh": "m", "strokes": {strokes}}}]}}"#
    );
    let scene: Scene = serde_json::from_str(&json).expect("the scene is written as the document wants it");
    let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh))].into(), ..Materials::default() };
    synth(&scene, &materials, None).expect("the mesh is among the materials")
}

/// A square of 8 m that faces the camera, in so many rows of so many cells.
fn wall(cells: usize) -> Mesh {
    let at = |i: usize| 8.0 * i as f64 / cells as f64 - 4.0;
    let place = |i: usize| DVec3::new(at(i % (cells + 1)), at(i / (cells + 1)), 0.0);
    grid((cells, cells), |i| Vertex { position: place(i), normal: DVec3::Z, ..Vertex::default() })
}

/// A ball of about so many triangles.
fn ball(triangles: usize) -> Mesh {
    let rows = ((triangles / 4) as f64).sqrt() as usize;
    let columns = rows * 2;
    grid((columns, rows), |i| {
        let (u, v) = ((i % (columns + 1)) as f64 / columns as f64, (i / (columns + 1)) as f64 / rows as f64);
        let (a, b) = (u * TAU, (v - 0.5) * TAU / 2.0);
        let normal = DVec3::new(cos(b) * sin(a), sin(b), cos(b) * cos(a));
        Vertex { position: normal * (1.0 + 0.05 * sin(8.0 * a) * cos(b)), normal, ..Vertex::default() }
    })
}

fn grid((across, down): (usize, usize), vertex: impl Fn(usize) -> Vertex) -> Mesh {
    let corner = |x: usize, y: usize| (y * (across + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % across, i / across);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        vertices: (0..(across + 1) * (down + 1)).map(vertex).collect(),
        triangles: (0..across * down).flat_map(pair).collect(),
        ..Mesh::default()
    }
}
