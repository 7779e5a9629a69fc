//! Meshes drawn with strokes, over a mesh made here: each style as text (`PLICA_UPDATE=1 cargo test --test strokes` writes it
//! again), and what must not change a frame.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use plica::base::maths::{TAU, cos, sin};
use plica::base::mesh::{Mesh, Vertex};
use plica::base::pixels::{Frame, Linear, Rgba};
use plica::layers::parts::materials::Materials;
use plica::render::bands::Bands;
use plica::render::passes::Asked;
use plica::render::{self, Synth, cpu};
use plica::scene::Scene;
use serde_json::{Value, json};

/// A ring about the y axis.
fn ring() -> Mesh {
    let (around, across) = (32, 16);
    let vertex = |i: usize| {
        let (u, v) = ((i % (around + 1)) as f64 / around as f64, (i / (around + 1)) as f64 / across as f64);
        let (a, b) = (u * TAU, v * TAU);
        let normal = DVec3::new(cos(b) * cos(a), sin(b), cos(b) * sin(a));
        let position = DVec3::new(cos(a), 0.0, sin(a)) + normal * 0.45;
        Vertex { position, normal, uv: DVec2::new(u, v) }
    };
    let corner = |x: usize, y: usize| (y * (around + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % around, i / around);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, c, b], [a, d, c]]
    };
    Mesh {
        vertices: (0..(around + 1) * (across + 1)).map(vertex).collect(),
        triangles: (0..around * across).flat_map(pair).collect(),
        ..Mesh::default()
    }
}

fn materials() -> Materials {
    Materials { meshes: [("ring".to_owned(), Arc::new(ring()))].into(), ..Materials::default() }
}

/// A scene of so many pixels with these strokes, and more layers.
fn scene(size: [u32; 2], strokes: Value, more: &[Value]) -> Scene {
    let light = json!({ "direction": [-0.5, -0.8, -0.3], "ambient": 0.2 });
    let ring = json!({ "kind": "mesh", "name": "ring", "mesh": "ring", "light": light, "strokes": strokes,
        "surface": { "kind": "plain", "color": "#e09050" }, "pose": { "spin": 90 } });
    let layers: Vec<&Value> = std::iter::once(&ring).chain(more).collect();
    let camera = json!({ "position": [0.4, 2.4, 3.6], "target": [0, 0, 0], "fov": 46 });
    let meshes = json!({ "ring": { "path": "ring.obj" } });
    serde_json::from_value(json!({ "plica": 1, "size": size, "camera": camera, "meshes": meshes, "layers": layers }))
        .unwrap()
}

fn synth(scene: &Scene) -> Synth {
    render::synth(scene, &materials(), None).unwrap()
}

fn pass(scene: &Scene, name: &str) -> Linear {
    Asked::parse(name, scene).unwrap().picture(&synth(scene), 0.0)
}

/// A frame as letters, from dark to light.
fn letters(frame: &Frame) -> String {
    let letter = |[r, g, b, a]: &[u8; 4]| {
        let light = (u32::from(*r) * 2 + u32::from(*g) * 7 + u32::from(*b)) / 10;
        if *a < 128 { ' ' } else { char::from(b"@%#*+=-:."[(light * 9 / 256) as usize]) }
    };
    let row = |y: usize| frame.row(y).iter().map(letter).collect::<String>().trim_end().to_owned();
    (0..frame.height()).map(|y| row(y) + "\n").collect()
}

#[test]
fn every_style_draws_as_is_kept() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/strokes");
    let styles = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/styles");
    let mut wrong = Vec::new();
    for style in std::fs::read_dir(styles).unwrap() {
        let style = style.unwrap().path();
        let name = style.file_stem().unwrap().to_str().unwrap();
        let scene = scene([72, 40], json!({ "style": name, "size": 0.6 }), &[]);
        let found = letters(&cpu::frame(&synth(&scene), 0.0));
        let file = folder.join(name).with_extension("txt");
        if std::env::var_os("PLICA_UPDATE").is_some() {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&file, &found).unwrap();
        }
        let kept = std::fs::read_to_string(&file).unwrap_or_default();
        if kept != found {
            wrong.push(format!("{name}\n{kept}\nis now\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_bits_do_not_depend_on_threads_and_parts_are_those_of_the_whole() {
    let scene = scene([50, 36], json!({ "style": "engraving" }), &[]);
    let synth = synth(&scene);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| cpu::linear(&synth, 0.3))
    };
    let whole = with(1);
    assert!(whole.cells() == with(2).cells());
    let part = cpu::lattice(&synth, 0.3, &[3, 20, 21, 44], &[5, 18, 30]);
    let expected = [5, 18, 30].iter().flat_map(|y| [3, 20, 21, 44].map(|x| *whole.get(x, *y)));
    assert_eq!(part.cells(), expected.collect::<Vec<Rgba>>());
    let materials = materials();
    for samples in [1, 2] {
        let bands = Bands::new(&scene, &materials, samples).unwrap();
        let frame = cpu::frames(&render::samples(&scene, &materials, samples).unwrap(), 0.3);
        assert!(
            bands.frame(0.3, &|_| ()).unwrap() == frame && bands.pixel(0.3, (20, 18)).unwrap() == *frame.get(20, 18)
        );
    }
}

#[test]
fn samples_are_those_of_a_frame_that_is_as_many_times_larger() {
    let strokes = |times: f64| {
        json!({ "style": "none", "noises": { "a": { "spacing": 4.0 * times } }, "marks": [
            { "name": "i", "kind": "ink", "noise": "a", "softness": times },
            { "name": "o", "kind": "outline", "width": 2.0 * times, "softness": times, "step": 4.0 * times }] })
    };
    let few = cpu::mean(&render::samples(&scene([30, 20], strokes(1.0), &[]), &materials(), 2).unwrap(), 0.0);
    let large = cpu::linear(&synth(&scene([60, 40], strokes(2.0), &[])), 0.0);
    for (i, cell) in few.cells().iter().enumerate() {
        let (x, y) = (i % 30 * 2, i / 30 * 2);
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| large.get(x + right, y + down)[1]);
        assert!((four.iter().sum::<f32>() / 4.0 - cell[1]).abs() < 1e-3, "{x} {y}");
    }
}

#[test]
fn what_stands_in_front_does_not_change_the_strokes_beside_it() {
    let front =
        json!({ "kind": "mesh", "name": "front", "mesh": "ring", "pose": { "position": [0.6, 0.9, 1], "scale": 0.4 } });
    let (alone, hidden) = (scene([64, 44], json!({}), &[]), scene([64, 44], json!({}), &[front]));
    let (before, after) = (pass(&alone, "noise"), pass(&hidden, "noise"));
    let object = pass(&hidden, "object");
    let shown = |i: usize| object.cells()[i][0] == 1.0;
    let kept = (0..before.cells().len()).filter(|i| shown(*i));
    assert!(kept.clone().count() > 300);
    assert!(kept.clone().all(|i| before.cells()[i] == after.cells()[i]));
    let covered = object.cells().iter().zip(after.cells()).filter(|(object, _)| object[0] == 2.0);
    assert!(covered.clone().count() > 50 && covered.clone().all(|(_, noise)| noise[..3] == [0.0; 3]));
}

#[test]
fn passes_show_what_the_drawing_is_made_from() {
    let scene = scene(
        [64, 44],
        json!({ "style": "none", "noises": { "a": { "spacing": 5 }, "ring": { "seed": 4 } },
        "marks": [{ "name": "m", "kind": "ink", "noise": "a", "from": 1, "to": 1, "softness": 0 }] }),
        &[],
    );
    let first = pass(&scene, "noise");
    assert!(first.cells() == pass(&scene, "noise:a").cells() && first.cells() == pass(&scene, "noise:a:ring").cells());
    let other = pass(&scene, "noise:ring");
    assert!(other.cells() != first.cells(), "a noise goes before a layer of the same name");
    let shown: Vec<f64> = first.cells().iter().filter(|cell| cell[3] > 0.0).map(|cell| f64::from(cell[0])).collect();
    let mean = shown.iter().sum::<f64>() / shown.len() as f64;
    let variance = shown.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / shown.len() as f64;
    assert!(mean.abs() < 0.2 && (variance - 1.0).abs() < 0.35, "{mean} {variance}");
    let (tone, ink) = (pass(&scene, "tone"), pass(&scene, "ink"));
    for ((tone, ink), depth) in tone.cells().iter().zip(ink.cells()).zip(pass(&scene, "depth").cells()) {
        assert!((0.0..=1.0).contains(&tone[0]) && (ink[0] == 0.0 || ink[0] == 1.0), "{tone:?} {ink:?}");
        assert!(depth[0] > 0.0 || (tone[3] == 0.0 && ink[3] == 0.0));
    }
    let problem = Asked::parse("noise:b", &scene).unwrap_err();
    assert!(problem.starts_with("there is no noise \"b\" (there are") && problem.contains("no layer"), "{problem}");
}

#[test]
fn memory_is_asked_for_what_is_made_whole() {
    let bytes = |strokes: Value, samples: u32| render::stroke_bytes(&synth(&scene([40, 28], strokes, &[])), samples);
    assert_eq!(bytes(Value::Null, 3), 0);
    assert!(bytes(json!({}), 1) > 40 * 28 * 100 && bytes(json!({}), 3) == 9 * bytes(json!({}), 1));
}

#[test]
fn what_others_show_as_a_texture_is_drawn_too() {
    let shown =
        json!({ "kind": "mesh", "name": "card", "mesh": "ring", "surface": { "kind": "layer", "layer": "ring" } });
    let with = |strokes: Value| cpu::frame(&synth(&scene([40, 28], strokes, std::slice::from_ref(&shown))), 0.0);
    assert!(with(json!({})) != with(Value::Null));
}
