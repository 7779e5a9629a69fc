//! How long a frame of a mesh takes on the CPU, from the pose to linear light: depth, normals and shading. The camera
//! looks at a wavy ball that fills most of the frame; and how long a view map of it takes. `cargo bench --bench space`

use std::sync::Arc;

use divan::Bencher;
use glam::{DVec2, DVec3};
use plica::base::maths::{TAU, cos, sin};
use plica::base::mesh::{Mesh, Vertex};
use plica::base::picture::Picture;
use plica::layers::parts::materials::Materials;
use plica::render::{Synth, cpu, passes::Asked, synth};
use plica::scene::Scene;
use rayon::ThreadPoolBuilder;

fn main() {
    divan::main();
}

const SIZE: (usize, usize) = (1280, 720);

/// Growth with triangles: at most 25 ms for 44,000 on two cores.
#[divan::bench(args = [2_750, 11_000, 44_000, 176_000], sample_count = 30)]
fn triangles(bencher: Bencher, count: usize) {
    let synth = scene(count, SIZE);
    bencher.bench(|| cpu::linear(&synth, 0.3));
}

/// Growth with pixels.
#[divan::bench(args = [(320, 180), (640, 360), (1280, 720), (2560, 1440)], sample_count = 30)]
fn pixels(bencher: Bencher, size: (usize, usize)) {
    let synth = scene(44_000, size);
    bencher.bench(|| cpu::linear(&synth, 0.3));
}

/// A pass alone.
#[divan::bench(args = ["depth", "normal"], sample_count = 30)]
fn pass(bencher: Bencher, name: &str) {
    let synth = scene(44_000, SIZE);
    let asked = Asked::parse(name, &Scene::default()).expect("there is such a pass");
    bencher.bench(|| asked.picture(&synth, 0.3));
}

/// Filling a view map of 25,800 triangles by one picture of 800x600, the finest layer 512 cells wide, on one thread: at most 0.3 s.
#[divan::bench(args = [1], sample_count = 10)]
fn filling(bencher: Bencher, threads: usize) {
    let json = r#"{"plica": 1, "camera": {}, "images": {"seen": {"path": "seen.png"}}, "meshes": {"ball": {"path": "ball.obj"}},
        "layers": [{"kind": "mesh", "name": "ball", "mesh": "ball", "surface": {"kind": "view-map", "cells": 32, "levels": 5, "views": [
            {"name": "seen", "image": "seen", "camera": {"position": [0, 0, 3], "target": [0, 0, 0]}}]}}]}"#;
    let scene: Scene = serde_json::from_str(json).expect("the scene is written as the document wants it");
    let (width, height) = (800, 600);
    let cell = |i: usize| [(i % 251) as f32 / 251.0, (i % 127) as f32 / 127.0, 0.5, 1.0];
    let seen = Picture::from_cells(width, height, (0..width * height).map(cell).collect());
    let materials = Materials {
        meshes: [("ball".to_owned(), Arc::new(ball(25_800)))].into(),
        pictures: [("seen".to_owned(), Arc::new(seen))].into(),
        ..Materials::default()
    };
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    bencher
        .bench_local(|| pool.install(|| synth(&scene, &materials, None).expect("the files are among the materials")));
}

fn scene(triangles: usize, (width, height): (usize, usize)) -> Synth {
    let json = format!(
        r#"{{"plica": 1, "size": [{width}, {height}], "camera": {{"position": [0, 0, 3], "target": [0, 0, 0]}},
            "meshes": {{"ball": {{"path": "ball.obj"}}}},
            "layers": [{{"kind": "mesh", "name": "ball", "mesh": "ball", "pose": {{"spin": 360}}}}]}}"#
    );
    let scene: Scene = serde_json::from_str(&json).expect("the scene is written as the document wants it");
    let materials =
        Materials { meshes: [("ball".to_owned(), Arc::new(ball(triangles)))].into(), ..Materials::default() };
    synth(&scene, &materials, None).expect("the mesh is among the materials")
}

/// A ball of about so many triangles.
fn ball(triangles: usize) -> Mesh {
    let rows = ((triangles / 4) as f64).sqrt() as usize;
    let columns = rows * 2;
    let vertex = |i: usize| {
        let (u, v) = ((i % (columns + 1)) as f64 / columns as f64, (i / (columns + 1)) as f64 / rows as f64);
        let (a, b) = (u * TAU, (v - 0.5) * TAU / 2.0);
        let normal = DVec3::new(cos(b) * sin(a), sin(b), cos(b) * cos(a));
        Vertex { position: normal * (1.0 + 0.05 * sin(8.0 * a) * cos(b)), normal, uv: DVec2::new(u, v) }
    };
    let corner = |x: usize, y: usize| (y * (columns + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % columns, i / columns);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        vertices: (0..(columns + 1) * (rows + 1)).map(vertex).collect(),
        triangles: (0..columns * rows).flat_map(pair).collect(),
        ..Mesh::default()
    }
}
