//! Photographs beside the repository: how near a view map comes to those that it is made of, and to those that it is not.

use std::io::Write;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use plica::base::maths::{atan2, ln};
use plica::base::pixels::{Frame, encode};
use plica::base::progress::Watch;
use plica::files::{materials, picture};
use plica::layers::space::camera::Camera;
use plica::render::passes::Asked;
use plica::render::{self, Synth, cpu};
use plica::scene::Scene;
use serde_json::{Value, json};

/// The least cosine between the normal and the way to the camera that is compared.
const LEAST_NORMAL: f64 = 0.2;

/// The folder of the photographs and the list of their cameras.
fn photographs() -> Option<(PathBuf, Vec<Value>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let Ok(text) = std::fs::read_to_string(folder.join("multiview/spot_glossy/cameras.json")) else {
        let _ = writeln!(std::io::stderr(), "not run: {} is not there", folder.display());
        return None;
    };
    let cameras: Value = serde_json::from_str(&text).unwrap();
    Some((folder, cameras["views"].as_array().unwrap().clone()))
}

/// A map of these views.
fn map(folder: &Path, views: &[&Value]) -> Synth {
    let row = |view: &Value, k: usize| {
        let turn = view["R"][k].as_array().unwrap().clone();
        json!([turn[0], turn[1], turn[2], view["t"][k]])
    };
    let lying = views.iter().enumerate().map(|(i, view)| {
        json!({ "name": i.to_string(), "image": i.to_string(), "camera": {
            "focal": [view["fx"], view["fy"]], "center": [view["cx"], view["cy"]],
            "matrix": [row(view, 0), row(view, 1), row(view, 2)] } })
    });
    let image = |(i, view): (usize, &&Value)| {
        let file = view["file"].as_str().unwrap();
        (i.to_string(), json!({ "path": format!("multiview/spot_glossy/{file}") }))
    };
    let images: Value = views.iter().enumerate().map(image).collect::<serde_json::Map<_, _>>().into();
    let lying: Vec<Value> = lying.collect();
    let scene: Scene = serde_json::from_value(json!({ "plica": 1, "camera": {}, "images": images,
        "size": [320, 320], "meshes": { "spot": { "path": "meshes/spot.obj" } },
        "layers": [{ "kind": "mesh", "name": "spot", "mesh": "spot", "surface": { "kind": "view-map", "views": lying } }] }))
    .unwrap();
    let path = folder.join("scene.plica.json");
    let (materials, _) = materials::load(&path, &scene, &Default::default(), &mut Default::default()).unwrap();
    render::synth(&scene, &materials, None).unwrap()
}

/// How near views come back from their own cameras, in dB.
fn come_back(synth: &Synth) -> Vec<f64> {
    let told = synth.layers[0].lying(Some(&Watch::NONE)).unwrap();
    told.iter().filter_map(|view| view.get("psnr")?.as_f64()).collect()
}

fn mean(all: &[f64]) -> f64 {
    all.iter().sum::<f64>() / all.len() as f64
}

fn numbers(value: &Value) -> [f64; 3] {
    serde_json::from_value(value.clone()).unwrap()
}

/// Turns directions of the model into those of the camera: x right, y down, z forward.
fn turn(view: &Value) -> DMat3 {
    DMat3::from_cols_array_2d(&[0, 1, 2].map(|k| numbers(&view["R"][k]))).transpose()
}

/// The camera of a view, whose axis meets the middle of its picture.
fn camera(view: &Value) -> Camera {
    let turn = turn(view);
    let position = -(turn.transpose() * DVec3::from(numbers(&view["t"])));
    let [_, down, forward] = [0, 1, 2].map(|k| turn.row(k));
    let fov = 2.0 * atan2(view["height"].as_f64().unwrap() / 2.0, view["fy"].as_f64().unwrap()).to_degrees();
    let ([position, target, up], fov) = ([position, position + forward, -down].map(|at| at.to_array()), fov);
    Camera { position, target, up, fov, ..Camera::default() }
}

/// How near a map comes to a picture that it is not made of, and how near its base coat alone does, in dB: over what is whole in
/// that and not seen too askew.
fn nearness(synth: &Synth, folder: &Path, view: &Value) -> [f64; 2] {
    let seen = synth.seen_from(camera(view));
    let file = folder.join("multiview/spot_glossy").join(view["file"].as_str().unwrap());
    let photograph = picture::read(&file, &Default::default()).unwrap().picture.to_linear();
    let pass = |name: &str| Asked::parse(name, &Scene::default()).unwrap().picture(&seen, 0.0);
    let (normals, coat, shown) = (pass("normal"), pass("independent"), cpu::linear(&seen, 0.0));
    let (turn, focal_px) = (turn(view), view["fy"].as_f64().unwrap());
    let (mut sums, mut count) = ([0_u64; 2], 0_u64);
    for (i, expected) in photograph.cells().iter().enumerate() {
        let across = [i % 320, i / 320].map(|at| (at as f64 + 0.5 - 160.0) / focal_px);
        let toward = turn.transpose() * -DVec3::new(across[0], across[1], 1.0).normalize();
        let [x, y, z, _] = normals.cells()[i].map(f64::from);
        let own = [&shown, &coat].map(|picture| picture.cells()[i]);
        if expected[3] < 1.0 || own[0][3] < 1.0 || DVec3::new(x, y, z).dot(toward) < LEAST_NORMAL {
            continue;
        }
        let expected = encode(*expected);
        for (sum, own) in sums.iter_mut().zip(own) {
            *sum += encode(own)
                .iter()
                .zip(expected)
                .map(|(own, expected)| u64::from(own.abs_diff(expected)).pow(2))
                .sum::<u64>();
        }
        count += 3;
    }
    sums.map(|sum| 10.0 / ln(10.0) * ln(255.0 * 255.0 * count as f64 / sum as f64))
}

#[test]
fn a_lone_view_comes_back_from_its_own_camera() {
    let Some((folder, views)) = photographs() else { return };
    for view in [&views[0], &views[10]] {
        let found = come_back(&map(&folder, &[view]));
        assert!(found[0] >= 36.0, "{found:?}");
    }
}

/// The photographs for testing have highlights that no other has: 27.0 dB, where the base coat has 26.0.
#[test]
fn photographs_come_back_and_others_are_nearer_than_the_base_coat() {
    let Some((folder, views)) = photographs() else { return };
    let (trained, tests): (Vec<&Value>, Vec<&Value>) = views.iter().partition(|view| view["split"] != "test");
    let synth = map(&folder, &trained);
    let found = come_back(&synth);
    let least = found.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(found.len() == 20 && mean(&found) >= 38.0 && least >= 35.0, "{} {least}: {found:?}", mean(&found));
    let near: Vec<[f64; 2]> = tests.iter().map(|view| nearness(&synth, &folder, view)).collect();
    let [shown, coat] = [0, 1].map(|k| mean(&near.iter().map(|near| near[k]).collect::<Vec<f64>>()));
    assert!(shown >= 26.95 && shown >= coat + 1.0, "{shown} dB, the base coat {coat}: {near:?}");
    nothing_pops(&synth, tests[0]);
}

/// Frames along a path of the camera change evenly: round what it looks at, and nearer.
fn nothing_pops(synth: &Synth, view: &Value) {
    const FRAMES: usize = 40;
    let start = camera(view);
    let place = |turn_degrees: f64, distance: f64| {
        let turn = DMat3::from_rotation_y(turn_degrees.to_radians());
        Camera {
            position: (turn * DVec3::from(start.position) * distance).to_array(),
            target: [0.0; 3],
            ..start.clone()
        }
    };
    let turned: Vec<Camera> = (0..FRAMES).map(|i| place(i as f64 * 1.5, 1.0)).collect();
    let distances = std::iter::successors(Some(1.6), |distance| Some(0.98 * distance)).take(FRAMES);
    let nearer: Vec<Camera> = distances.map(|distance| place(0.0, distance)).collect();
    for (path, cameras) in [("round", turned), ("nearer", nearer)] {
        let frame = |camera: &Camera| cpu::frame(&Synth { size: (120, 120), ..synth.seen_from(camera.clone()) }, 0.0);
        let frames: Vec<Frame> = cameras.iter().map(frame).collect();
        let mut steps: Vec<f64> = frames.windows(2).map(|pair| step(&pair[0], &pair[1])).collect();
        steps.sort_by(f64::total_cmp);
        let (median, most) = (steps[steps.len() / 2], steps[steps.len() - 1]);
        assert!(median > 0.5 && most < 3.0 * median, "{path}: {steps:?}");
    }
}

/// The root of the mean square of what changes between two frames, where both show the mesh.
fn step(a: &Frame, b: &Frame) -> f64 {
    let both = a.cells().iter().zip(b.cells()).filter(|(a, b)| a[3] > 0 && b[3] > 0);
    let (sum, count) = both.fold((0_u64, 0_u64), |(sum, count), (a, b)| {
        (sum + a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>(), count + 3)
    });
    (sum as f64 / count as f64).sqrt()
}
