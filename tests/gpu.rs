//! The GPU shows what the CPU shows: every pixel within 2/255, except for at most 0.1 % on silhouette edges, where
//! single precision may fall on the other side. Runs on Mesa's software driver as well. If there is no adapter the
//! reason is printed; in CI that is a failure.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]
#![cfg(feature = "window")]

use std::collections::BTreeSet;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

use glam::{DVec2, DVec3};
use plica::base::clip::Clip;
use plica::base::maths::{self, TAU};
use plica::base::mesh::{Mesh, Vertex};
use plica::base::picture::Picture;
use plica::base::pixels::{Frame, Grid, decode, encode};
use plica::base::progress::Progress;
use plica::export::textures::{self, Depth};
use plica::files::{self, outputs::Guard};
use plica::layers::KINDS;
use plica::layers::folding::fold::Fold;
use plica::layers::mesh::slots::strokes::model::{Along, Anchor, By, Trim};
use plica::layers::parts::marks::View;
use plica::layers::parts::materials::{List, Materials, Of, Use, What};
use plica::layers::parts::plan::{Bind, Compute, Groups, Plan, Step};
use plica::layers::ready::Making;
use plica::layers::space::camera::Camera;
use plica::layers::technique::Kind;
use plica::render::{self, Synth, bands::Bands, cpu, gpu::Gpu, reduce::reduced};
use plica::scene::Scene;
use serde_json::{Value, json};
use wgpu::naga::{AddressSpace, Type, TypeInner, front::wgsl, valid};

/// Times on frames and between them; s reaches below 0 and above 1.
const TIMES: [f64; 6] = [0.0, 0.13, 0.25, 0.5, 0.77, 1.0];

fn gpu() -> Option<Gpu> {
    match Gpu::new() {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var_os("CI").is_some() => panic!("in CI there has to be an adapter: {error}"),
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "not run: {error}");
            None
        }
    }
}

/// A picture of smooth waves with some hard edges; `alpha` leaves parts of it transparent.
fn waves(width: usize, height: usize, seed: usize, alpha: bool) -> Arc<Picture> {
    let cells = (0..width * height).map(|i| {
        let (x, y) = (i % width + seed * 7, i / width + seed * 13);
        let wave = |period: usize| (127.0 + 127.0 * maths::sin((x * 3 + y * seed) as f64 / period as f64)) as u8;
        let opacity = if alpha { (((x / 5 + y / 7) % 4) * 85) as u8 } else { 255 };
        decode([wave(17), if (x / 9 + y / 6) % 2 == 0 { 230 } else { 20 }, wave(29), opacity])
    });
    Arc::new(Picture::from_cells(width, height, cells.collect()))
}

fn materials() -> Materials {
    let pictures = [
        ("own", waves(96, 64, 1, false)),
        ("clear", waves(96, 64, 2, true)),
        ("other", waves(50, 40, 3, true)),
        ("mask", waves(96, 64, 4, true)),
    ];
    let frames = (0..5).map(|frame| waves(50, 40, 5 + frame, true)).collect();
    Materials {
        pictures: pictures.map(|(name, picture)| (name.to_owned(), picture)).into(),
        clips: [("clip".to_owned(), Arc::new(Clip { fps: 6.5, frames }))].into(),
        ..Materials::default()
    }
}

fn with(mut a: Value, b: &Value) -> Value {
    a.as_object_mut().unwrap().extend(b.as_object().unwrap().clone());
    a
}

fn zone(name: &str, extra: Value) -> Value {
    let zone = json!({
        "name": name,
        "outline": {"kind": "ellipse", "center": [48, 30], "radii": [37, 25]},
        "motion": [
            {"tool": "point", "at": [30, 20], "jump": [11, 6.5]},
            {"tool": "point", "at": [60, 40], "jump": [-9, 14]},
            {"tool": "still-border", "spacing": 9}],
        "position": {"function": "sine", "cycles": 1, "amplitude": 1.7, "offset": 0.2}
    });
    with(zone, &extra)
}

fn layer(name: &str, image: &str, zones: &[Value]) -> Value {
    json!({"kind": "picture", "name": name, "image": image, "zones": zones})
}

fn fold(rule: &str) -> Value {
    json!({"fold": {"rule": rule, "regions": [
        {"kind": "ellipse", "center": [40, 28], "radii": [9, 7]},
        {"kind": "polygon", "points": [[55, 20], [66, 24], [58, 44], [50, 38]]}]}})
}

fn synth(layers: &[Value]) -> Synth {
    let scene = serde_json::from_value(json!({"plica": 1, "layers": layers})).unwrap();
    render::synth(&scene, &materials(), None).unwrap()
}

/// Every rule, source and composition.
fn scenes() -> Vec<(&'static str, Synth)> {
    let other = json!({"sampler": {"image": "other", "offset": [-20.25, -11.5]}});
    let clip = json!({"sampler": {"clip": "clip", "offset": [-20.25, -11.5]}});
    let mask = json!({"fold": {"rule": "mask", "image": "mask"}});
    let corner = json!({"outline": {"kind": "rectangle", "x": -8.5, "y": -3, "width": 60, "height": 44.5}});
    let own = |zone_fields: Value| synth(&[layer("a", "own", &[zone("z", zone_fields)])]);
    let clear = |zone_fields: Value| synth(&[layer("a", "clear", &[zone("z", zone_fields)])]);
    let two_zones = [zone("y", fold("cover")), zone("z", with(corner.clone(), &other))];
    let three_layers = [
        layer("a", "own", &[zone("y", fold("return"))]),
        layer("b", "other", &[zone("z", corner.clone())]),
        layer("c", "clear", &[zone("z", fold("cover"))]),
    ];
    vec![
        ("no zone", synth(&[layer("a", "own", &[])])),
        ("no fold", own(json!({}))),
        ("cover", own(fold("cover"))),
        ("return", own(fold("return"))),
        ("fly-over", own(fold("fly-over"))),
        ("mask", own(mask.clone())),
        ("mask, transparent picture", clear(mask)),
        ("sampler image", own(other.clone())),
        ("sampler image and cover", own(with(fold("cover"), &other))),
        ("sampler image and fly-over", clear(with(fold("fly-over"), &other))),
        ("clip", own(clip.clone())),
        ("clip and cover", clear(with(fold("cover"), &clip))),
        ("zone over the corner", own(with(fold("return"), &corner))),
        ("zones over one another", synth(&[layer("a", "clear", &two_zones)])),
        ("layers over one another", synth(&three_layers)),
    ]
}

/// Scenes in which neighboring samplers always read neighboring places, so that no pixel can fall on the other side of
/// an edge.
const WITHOUT_SILHOUETTES: &[&str] =
    &["no zone", "no fold", "mask", "mask, transparent picture", "sampler image", "clip"];

/// The largest difference in any channel, and the share of pixels that differ by more than 2.
fn difference(a: &Frame, b: &Frame) -> (u8, f64) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let of = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|i| a[i].abs_diff(b[i])).max().unwrap();
    let all: Vec<u8> = a.cells().iter().zip(b.cells()).map(of).collect();
    let more = all.iter().filter(|&&d| d > 2).count();
    (all.iter().copied().max().unwrap_or(0), more as f64 / all.len() as f64)
}

/// By how much a pixel is at most beyond what is in it and the eight around it in the other frame. A pixel on the other side
/// of an edge shows what is there: that is no difference here, but anything else is.
fn beyond(by_gpu: &Frame, by_cpu: &Frame) -> u8 {
    let (width, height) = (by_cpu.width(), by_cpu.height());
    let of = |i: usize| {
        let (x, y) = (i % width, i / width);
        let (columns, rows) = (x.saturating_sub(1)..(x + 2).min(width), y.saturating_sub(1)..(y + 2).min(height));
        let around: Vec<[u8; 4]> = rows.flat_map(|y| columns.clone().map(move |x| *by_cpu.get(x, y))).collect();
        let channel = |channel: usize| {
            let range = around.iter().map(|cell| cell[channel]);
            let (least, most) = (range.clone().min().unwrap(), range.max().unwrap());
            let own = by_gpu.cells()[i][channel];
            least.saturating_sub(own).max(own.saturating_sub(most))
        };
        (0..4).map(channel).max().unwrap()
    };
    (0..width * height).map(of).max().unwrap_or(0)
}

/// Fails if frames differ by more than 2 in more than this share of the pixels, or if one that does shows something that is
/// not beside it; tells the largest difference.
fn within(name: &str, by_gpu: &Frame, by_cpu: &Frame, most: f64) -> u8 {
    let ((largest, share), beyond) = (difference(by_gpu, by_cpu), beyond(by_gpu, by_cpu));
    let told = format!("{name}: {:.3} % differ, by up to {largest}, {beyond} beyond what is around", share * 100.0);
    println!("{told}");
    assert!(share <= most && beyond <= BEYOND, "{told}");
    largest
}

/// See [`beyond`].
const BEYOND: u8 = 2;

fn check(gpu: &mut Gpu, name: &str, synth: &Synth, time: f64) {
    let by_gpu = gpu.frame(synth, time).unwrap();
    let largest = within(&format!("{name} at {time}"), &by_gpu, &cpu::frame(synth, time), 0.001);
    assert!(largest <= 2 || !WITHOUT_SILHOUETTES.contains(&name), "{name} at {time}: {largest}");
}

/// The fold rules of the schema.
fn rules() -> Vec<String> {
    let schema = Value::from(schemars::schema_for!(Fold));
    let rule = |branch: &Value| branch["properties"]["rule"]["const"].as_str().unwrap().to_owned();
    schema["oneOf"].as_array().unwrap().iter().map(rule).collect()
}

/// The words that a choice of the schema allows.
fn words<T: schemars::JsonSchema>() -> Vec<String> {
    let schema = Value::from(schemars::schema_for!(T));
    let of = |list: &Value| list.as_array().cloned().unwrap_or_default();
    let word = |one: Value| one.get("const").unwrap_or(&one).as_str().map(str::to_owned);
    of(&schema["oneOf"]).into_iter().chain(of(&schema["enum"])).filter_map(word).collect()
}

#[test]
fn the_gpu_shows_what_the_cpu_shows() {
    let Some(mut gpu) = gpu() else { return };
    let scenes = scenes();
    for rule in rules() {
        assert!(scenes.iter().any(|(name, _)| *name == rule), "no scene folds by {rule}");
    }
    assert!(WITHOUT_SILHOUETTES.iter().all(|name| scenes.iter().any(|(known, _)| known == name)));
    for (name, synth) in &scenes {
        TIMES.into_iter().for_each(|time| check(&mut gpu, name, synth, time));
    }
}

/// Three quarters of a ring about the z axis, of radius 1 and thickness 0.35; its inside is seen at the ends.
fn ring() -> Mesh {
    let (around, across) = (24, 12);
    let vertex = |i: usize| {
        let (u, v) = ((i % (around + 1)) as f64 / around as f64, (i / (around + 1)) as f64 / across as f64);
        let (a, b) = (u * TAU, v * TAU);
        let normal = DVec3::new(maths::cos(b) * maths::cos(a), maths::cos(b) * maths::sin(a), maths::sin(b));
        let middle = DVec3::new(maths::cos(a), maths::sin(a), 0.0);
        Vertex { position: middle + normal * 0.35, normal, uv: DVec2::new(u * 3.0, v) }
    };
    let corner = |x: usize, y: usize| (y * (around + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % around, i / around);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        vertices: (0..(around + 1) * (across + 1)).map(vertex).collect(),
        triangles: (0..around * across).filter(|i| i % around < around * 3 / 4).flat_map(pair).collect(),
        ..Mesh::default()
    }
}

/// The example of each technique, with pictures of 96 x 64 for the images that it names.
fn examples() -> Vec<(&'static str, Scene, Materials)> {
    let example = |kind: &&'static Kind| {
        let scene: Scene = serde_json::from_str(kind.example).unwrap();
        let mut materials = Materials::default();
        let uses = scene.layers.iter().flat_map(|layer| layer.technique().uses());
        for (seed, Use { of, what, .. }) in uses.enumerate() {
            match of {
                Of::Name(List::Layers | List::Shapes, _) => {}
                Of::Name(List::Meshes, name) => drop(materials.meshes.insert(name.to_owned(), Arc::new(ring()))),
                Of::Name(List::Clips, name) => {
                    let frames = (0..5).map(|frame| waves(96, 64, seed + 7 * frame, true)).collect();
                    drop(materials.clips.insert(name.to_owned(), Arc::new(Clip { fps: 12.5, frames })));
                }
                Of::Name(List::Images, name) => {
                    let picture = waves(96, 64, seed + 1, what != What::Picture || seed > 0);
                    drop(materials.pictures.insert(name.to_owned(), picture));
                }
                Of::Path(path) => {
                    let vector = |i: usize| [(i % 96) as f32 / 12.0, (i / 96) as f32 / -9.0];
                    let field = Grid::from_cells(96, 64, (0..96 * 64).map(vector).collect());
                    drop(materials.fields.insert(path.to_owned(), Arc::new(field)));
                }
            }
        }
        (kind.name, scene, materials)
    };
    KINDS.iter().map(example).collect()
}

/// The examples, and one of a view map with strokes, for what only these have.
fn examples_of_all() -> Vec<(&'static str, Scene, Materials)> {
    let strokes = json!({"strokes": {"style": "hatching"}});
    let (scene, materials) = with_views(strokes, &json!({}), &vec![json!({}); 3]);
    examples().into_iter().chain([("mesh", scene, materials)]).collect()
}

#[test]
fn every_overlay_draws_something_over_an_example_of_its_technique() {
    let (mut something, mut all) = (BTreeSet::new(), BTreeSet::new());
    for (kind, scene, materials) in examples_of_all() {
        let synth = render::synth(&scene, &materials, None).unwrap();
        // From elsewhere, so that the scene's camera is seen too.
        let elsewhere = Camera { position: [2.5, -2.0, 2.5], target: [0.0; 3], ..Camera::default() };
        let synth = synth.seen_from(elsewhere);
        let overlays =
            KINDS.iter().filter(|row| row.name == kind).flat_map(|row| row.overlays.iter().copied().flatten());
        // Labels are texts at the marks of others.
        for overlay in overlays.filter(|overlay| overlay.name != "view-labels") {
            let view = View { spacing_px: 8.0, cell_px: 2.0, times: vec![0.4], ..View::of(&[overlay.name]) };
            all.insert((kind, overlay.name));
            if !render::overlay::overlay(&scene, Some(&synth), &view).is_empty() {
                something.insert((kind, overlay.name));
            }
        }
        let all_off = View { times: vec![0.4], ..View::default() };
        assert!(render::overlay::overlay(&scene, Some(&synth), &all_off).is_empty(), "{kind}");
    }
    let nothing: Vec<_> = all.difference(&something).collect();
    assert!(nothing.is_empty(), "nothing is drawn: {nothing:?}");
}

#[test]
fn every_technique_with_textures_bundles_its_example() {
    let mut bundled = BTreeSet::new();
    for (kind, scene, materials) in examples_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let place = Guard::new(false).folder(&folder.path().join("textures"), &|_| true, BTreeSet::new()).unwrap();
        let synth = render::synth(&scene, &materials, None).unwrap();
        let written = textures::write(&scene, &synth, Depth::Float.into(), &place, &mut |_, _| Ok(())).unwrap();
        if written.names.iter().any(|name| name != "manifest.json") {
            bundled.insert(kind);
        }
        for name in &written.names {
            assert!(folder.path().join("textures").join(name).metadata().unwrap().len() > 0, "{kind}: {name}");
        }
    }
    let expected = KINDS.iter().filter(|row| row.bundle.is_some()).map(|row| row.name).collect();
    assert_eq!(bundled, expected);
}

#[test]
fn every_technique_answers_everything() {
    let mut gpu = gpu();
    let mut probed = BTreeSet::new();
    for (kind, scene, materials) in examples_of_all() {
        // At the edges of strokes single precision may decide otherwise.
        let most = if scene.layers.iter().any(|layer| layer.technique().sketched() != [""; 0]) { 0.005 } else { 0.001 };
        assert!(scene.layers.iter().any(|layer| layer.technique().kind().name == kind));
        let problems: Vec<_> = scene.layers.iter().map(|layer| layer.technique()).collect();
        let problems = problems.iter().flat_map(|layer| layer.problems(&layer.check(None)));
        assert_eq!(problems.collect::<Vec<_>>(), [], "{kind}");
        let synth = render::synth(&scene, &materials, None).unwrap();
        let making = Making::plain(scene.timeline.wrap, &materials);
        let making = Making { duration: scene.timeline.duration, ..making };
        for (layer, ready) in scene.layers.iter().zip(&synth.layers) {
            let probe = |ready| layer.technique().probe(&making, ready, (40, 28), &synth.moment(0.5)).unwrap();
            let told = probe(None);
            assert_eq!(probe(Some(&**ready)), told, "{kind}: what is made already says the same");
            assert!(told.as_ref().is_none_or(|told| !told.entries.is_empty()), "{kind}: a probe that says nothing");
            probed.extend(told.map(|_| layer.technique().kind().name));
        }
        let again = render::synth(&scene, &materials, Some(&synth)).unwrap();
        let samples = render::samples(&scene, &materials, 2).unwrap();
        let small = reduced(&synth, 4);
        let still = synth.unmoved();
        let bands = Bands::new(&scene, &materials, 1).unwrap();
        for time in [0.13, 0.77] {
            let frame = cpu::frame(&synth, time);
            assert_eq!(cpu::frame(&again, time), frame, "{kind} at {time}: made from the one before");
            assert_eq!(bands.frame(time, &|_| ()).unwrap(), frame, "{kind} at {time}: in bands");
            let rows: Vec<usize> = (0..synth.size.1).step_by(7).collect();
            let columns: Vec<usize> = (3..synth.size.0).step_by(5).collect();
            let some = cpu::lattice(&synth, time, &columns, &rows);
            let at = |(i, j): (usize, usize)| encode(*some.get(i, j)) == *frame.get(columns[i], rows[j]);
            let places = (0..rows.len()).flat_map(|j| (0..columns.len()).map(move |i| (i, j)));
            assert!(places.into_iter().all(at), "{kind} at {time}: some columns");
            assert_eq!(cpu::frame(&still, time), cpu::frame(&still, 0.0), "{kind} at {time}: still");
            let (_, share) = difference(&cpu::frames(&samples, time), &frame);
            assert!(share < 0.5, "{kind} at {time}: {share} differ between samples and the middle of each pixel");
            assert_eq!(cpu::frame(&small, time).width(), synth.size.0.div_ceil(4));
            if let Some(gpu) = &mut gpu {
                for (name, synth) in [("whole", &synth), ("reduced", &small), ("still", &still)] {
                    let by_gpu = gpu.frame(synth, time).unwrap();
                    within(&format!("{kind}, {name} at {time}"), &by_gpu, &cpu::frame(synth, time), most);
                }
                let mean = cpu::finish(&gpu.mean(&samples, time).unwrap());
                within(&format!("{kind}, samples at {time}"), &mean, &cpu::frames(&samples, time), most);
            }
        }
    }
    let silent: Vec<_> = KINDS.iter().map(|kind| kind.name).filter(|name| !probed.contains(name)).collect();
    assert_eq!(silent, [""; 0], "these say nothing of any pixel");
}

/// A ring with pictures on it, taken from around; `extra` goes over its surface, `views` over each of its views in turn.
fn viewed(layer: Value, extra: &Value, views: &[Value]) -> Synth {
    let (scene, materials) = with_views(layer, extra, views);
    render::synth(&scene, &materials, None).unwrap()
}

fn with_views(layer: Value, extra: &Value, views: &[Value]) -> (Scene, Materials) {
    let view = |(i, own): (usize, &Value)| {
        let angle = i as f64 * TAU / 5.0;
        let at = [3.0 * maths::sin(angle), 1.0 + 0.4 * i as f64, 3.0 * maths::cos(angle)];
        let all = json!({"name": i.to_string(), "image": format!("p{}", i % 3), "camera": {"position": at, "fov": 50}});
        with(all, own)
    };
    let views: Vec<Value> = views.iter().enumerate().map(view).collect();
    let surface = with(json!({"kind": "view-map", "cells": 16, "levels": 3, "atlas": "box", "views": views}), extra);
    let mesh = json!({"kind": "mesh", "name": "ring", "mesh": "ring", "surface": surface});
    let scene = json!({"plica": 1, "size": [96, 72], "layers": [with(mesh, &layer)],
        "camera": {"position": [0.6, 1.5, 2.6], "target": [0, 0, 0], "fov": 50}});
    let pictures = (0..3).map(|i| (format!("p{i}"), waves(48, 48, i + 1, i == 2)));
    let materials = Materials {
        meshes: [("ring".to_owned(), Arc::new(ring()))].into(),
        pictures: pictures.collect(),
        ..Materials::default()
    };
    (serde_json::from_value(scene).unwrap(), materials)
}

#[test]
fn the_gpu_shows_view_maps_as_the_cpu_does() {
    let Some(mut gpu) = gpu() else { return };
    let (none, both) = (json!({}), vec![json!({}); 5]);
    let cone = json!({"kind": "dependent", "hold": 0.3, "extremes": {"kind": "cone", "degrees": 70}});
    let linear = with(cone.clone(), &json!({"fade": "linear", "gain": [1.5, 0.8, 0.3], "feather": 9}));
    let points = json!({"kind": "dependent",
        "extremes": {"kind": "points", "points": [[-60, 0], [0, -50], [70, 0], [0, 60]]}});
    let coat = json!({"kind": "independent"});
    let near = json!({"closer": 0.2, "extremes": {"kind": "auto", "reach": 80}});
    let far = json!({"farther": 0.3, "camera": {"position": [0.5, 1.2, 9], "fov": 12}});
    let blend = json!({"blend": {"points": [
        {"position": [0.6, 1.5, 2.6], "base": 0.8}, {"position": [4, 1, 0], "base": 0.1}]}});
    let bent = json!({"pose": {"rotate": [20, 40, 10], "scale": 1.3, "position": [0.1, -0.2, 0.3],
        "bend": {"degrees": 50, "from": -1, "to": 1}}});
    let scenes = [
        ("views up to one another", viewed(none.clone(), &none, &both)),
        ("no view", viewed(none.clone(), &json!({"missing": "#4080c0"}), &[])),
        ("one view, the rest missing", viewed(none.clone(), &none, std::slice::from_ref(&near))),
        ("cones over a coat", viewed(none.clone(), &none, &[coat.clone(), cone, linear, coat.clone()])),
        ("places over a coat", viewed(none.clone(), &none, &[points.clone(), coat, points])),
        ("near and far", viewed(none.clone(), &json!({"levels": 5}), &[near, far, json!({})])),
        ("blend points", viewed(none.clone(), &blend, &both)),
        ("arrays of directions", viewed(none.clone(), &json!({"directions": 8}), &both)),
        ("bent", viewed(bent.clone(), &none, &both)),
        ("bent, arrays of directions", viewed(bent, &json!({"directions": 6}), &both)),
        ("both sides, by texture", viewed(json!({"sides": "both"}), &json!({"atlas": "uv"}), &both)),
        ("under strokes", viewed(json!({"strokes": {"style": "painterly"}}), &none, &both)),
        (
            "arrays under strokes",
            viewed(
                json!({"strokes": {"style": "hatching", "ground": "scene", "tone": {"of": "light"}}}),
                &json!({"directions": 8}),
                &both,
            ),
        ),
    ];
    let frames = scenes.map(|(name, synth)| {
        assert_eq!(gpu.by_cpu(&synth), None, "{name}");
        let frame = gpu.frame(&synth, 0.0).unwrap();
        within(name, &frame, &cpu::frame(&synth, 0.0), 0.005);
        frame
    });
    let distinct: BTreeSet<&[[u8; 4]]> = frames.iter().map(Frame::cells).collect();
    assert_eq!(distinct.len(), frames.len(), "each shows something else");
}

/// A ring that is drawn with strokes, one behind it that is not, and one in front.
fn drawn(strokes: &Value, surface: &Value) -> Synth {
    let placed = |name: &str, at: [f64; 3], scale: f64, extra: &Value| {
        let pose = json!({"position": at, "scale": scale, "rotate": [55, 10, 0]});
        with(json!({"kind": "mesh", "name": name, "mesh": "ring", "sides": "both", "pose": pose}), extra)
    };
    let scene = json!({"plica": 1, "size": [64, 48], "background": "#f6f1e6",
        "camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "meshes": {"ring": {"path": "ring.obj"}},
        "layers": [
            placed("behind", [0.6, 0.3, -1.0], 1.2, &json!({})),
            placed("drawn", [0.0, 0.0, 0.0], 1.0, &json!({"strokes": strokes, "surface": surface})),
            placed("before", [-0.9, 0.2, 0.8], 0.4, &json!({}))]});
    let scene = serde_json::from_value(scene).unwrap();
    let materials = Materials { meshes: [("ring".to_owned(), Arc::new(ring()))].into(), ..materials() };
    render::synth(&scene, &materials, None).unwrap()
}

/// Every style, and everything that a noise or a mark can be beside what styles make of them. There half of all is inked with
/// hard edges, so that one pixel in a hundred changes where the noise does by a fortieth of its standard deviation.
fn all_strokes() -> Vec<Value> {
    let noise = |noise: Value| {
        let own = with(json!({"spacing": 7.5, "regularity": 2}), &noise);
        let mark = json!({"name": "m", "kind": "ink", "noise": "a", "from": 2, "to": 1, "amount": 0.5, "softness": 0});
        json!({"style": "none", "noises": {"a": own}, "marks": [mark]})
    };
    let along = |along: &str| noise(json!({"direction": {"along": along, "image": "other", "turn": 20}}));
    let by = |by: &str| noise(json!({"vary": {"by": by, "image": "other", "low": 0.7, "high": 1.6}}));
    let anchor = |anchor: &str| noise(json!({"anchor": anchor}));
    let trim = |trim: &str, reach: f64| noise(json!({"trim": trim, "reach": reach}));
    let hatching = |more: Value| with(json!({"style": "hatching"}), &more);
    let styles = KINDS.iter().filter_map(|kind| kind.styles).flat_map(|styles| styles.list);
    let styles = styles.map(|style| json!({"style": style.name}));
    let others = [
        noise(json!({})),
        anchor("screen"),
        anchor("texture"),
        noise(json!({"anchor": "texture", "direction": {"along": "curvature"}})),
        along("curvature"),
        along("light"),
        along("axis"),
        along("outline"),
        along("image"),
        by("light"),
        by("curvature"),
        by("facing"),
        by("image"),
        trim("object", 0.5),
        trim("triangle", 0.5),
        trim("depth", 0.05),
        noise(json!({"overlap": 64, "spread": 90})),
        hatching(json!({"ground": "clear", "tone": {"of": "light", "gamma": 2}, "size": 0.6, "amount": 1.5})),
        hatching(json!({"redraw": 9, "marks": [{"name": "contour", "creases": 15, "step": 1, "width": 3}]})),
        hatching(json!({"marks": [{"name": "r", "kind": "relief", "noise": "a"}, {"name": "light", "side": "high"}]})),
    ];
    styles.chain(others).collect()
}

#[test]
fn the_gpu_draws_strokes_as_the_cpu_does() {
    let Some(mut gpu) = gpu() else { return };
    let (plain, pictured) =
        (json!({"kind": "plain", "color": "#c8b8a0c0"}), json!({"kind": "texture", "image": "own"}));
    let mut frames = BTreeSet::new();
    let strokes = all_strokes();
    let all = Value::from(strokes.clone()).to_string();
    for word in [words::<Along>(), words::<By>(), words::<Anchor>(), words::<Trim>()].concat() {
        // What is by default need not be written.
        let known = all.contains(&format!("\"{word}\"")) || ["surface", "screen"].contains(&word.as_str());
        assert!(known, "no strokes with {word}");
    }
    for (i, own) in strokes.iter().enumerate() {
        let synth = drawn(own, if i % 2 == 0 { &pictured } else { &plain });
        assert_eq!(gpu.by_cpu(&synth), None, "{own}");
        let (by_gpu, by_cpu) = (gpu.frame(&synth, 0.3).unwrap(), cpu::frame(&synth, 0.3));
        within(&own.to_string(), &by_gpu, &by_cpu, 0.005);
        frames.insert(by_gpu.cells().to_vec());
    }
    assert_eq!(frames.len(), strokes.len(), "each shows something else");
}

#[test]
fn samples_of_strokes_are_drawn_in_one_frame_and_left_to_the_cpu_beside_pictures() {
    let Some(mut gpu) = gpu() else { return };
    let mesh =
        |name: &str, extra: Value| with(json!({"kind": "mesh", "name": name, "mesh": "ring", "sides": "both"}), &extra);
    let drawn = mesh("drawn", json!({"strokes": {"style": "hatching"}, "pose": {"rotate": [55, 10, 0]}}));
    let behind = mesh("behind", json!({"pose": {"position": [0.6, 0.3, -1.0]}}));
    let materials = Materials { meshes: [("ring".to_owned(), Arc::new(ring()))].into(), ..materials() };
    for (layers, left) in [([behind, drawn.clone()], false), ([layer("a", "own", &[]), drawn], true)] {
        let scene = json!({"plica": 1, "size": [64, 48], "camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "layers": layers});
        let samples = render::samples(&serde_json::from_value(scene).unwrap(), &materials, 2).unwrap();
        assert_eq!(gpu.samples_by_cpu(&samples).is_some(), left);
        let (by_gpu, by_cpu) = (cpu::finish(&gpu.mean(&samples, 0.3).unwrap()), cpu::frames(&samples, 0.3));
        within("samples", &by_gpu, &by_cpu, 0.005);
    }
}

#[test]
fn a_gpu_that_cannot_compute_leaves_strokes_to_the_cpu_and_says_so() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::GL;
    let Ok(mut gpu) = Gpu::open(wgpu::Instance::new(descriptor), None) else { return };
    let synth = drawn(&json!({"style": "hatching"}), &json!({"kind": "plain", "color": "#c8b8a0"}));
    let (frame, by_cpu) = (gpu.frame(&synth, 0.3).unwrap(), cpu::frame(&synth, 0.3));
    match gpu.by_cpu(&synth) {
        None => drop(within("OpenGL", &frame, &by_cpu, 0.005)),
        Some(why) => assert_eq!((&frame, why), (&by_cpu, format!("{} cannot compute strokes", gpu.device().name()))),
    }
}

/// A plane of so many squares on each side, so often before itself: the last is what is seen.
fn sheets(side: usize, count: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for sheet in 0..count {
        let first = mesh.vertices.len() as u32;
        for i in 0..(side + 1) * (side + 1) {
            let at = DVec2::new((i % (side + 1)) as f64, (i / (side + 1)) as f64) / side as f64;
            let position = DVec3::new(2.0 * at.x - 1.0, 2.0 * at.y - 1.0, 0.01 * sheet as f64);
            mesh.vertices.push(Vertex { position, normal: DVec3::Z, uv: at });
        }
        let row = side as u32 + 1;
        let corners = (0..side * side).map(|i| first + (i / side) as u32 * row + (i % side) as u32);
        mesh.triangles.extend(corners.flat_map(|a| [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]));
    }
    mesh
}

#[test]
fn the_gpu_makes_impulses_of_many_pieces_and_more_of_them_than_there_was_room_for() {
    let Some(mut gpu) = gpu() else { return };
    let mark = json!({"name": "m", "kind": "ink", "noise": "a", "from": 2, "to": 1, "amount": 0.5, "softness": 0});
    // More than 256 blocks of pieces; more impulses than there is room for at first.
    for (mesh, size, spacing) in [(sheets(190, 1), [48, 36], 6.0), (sheets(4, 12), [128, 96], 2.0)] {
        let noise = json!({"spacing": spacing, "overlap": 8, "regularity": 1, "direction": {"along": "axis"}});
        let scene = json!({"plica": 1, "size": size, "camera": {"position": [0.3, 0.2, 3], "target": [0, 0, 0], "fov": 30},
            "layers": [{"kind": "mesh", "name": "m", "mesh": "m",
                "strokes": {"style": "none", "noises": {"a": noise}, "marks": [mark.clone()]}}]});
        let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh))].into(), ..Materials::default() };
        let synth = render::synth(&serde_json::from_value(scene).unwrap(), &materials, None).unwrap();
        assert_eq!(gpu.by_cpu(&synth), None);
        let frame = gpu.frame(&synth, 0.0).unwrap();
        within(&format!("{size:?}"), &frame, &cpu::frame(&synth, 0.0), 0.005);
        let inked = frame.cells().iter().filter(|[r, _, _, a]| *r < 128 && *a > 0).count();
        assert!((0.3..0.6).contains(&(inked as f64 / frame.cells().len() as f64)), "{inked}");
    }
}

#[test]
fn the_gpu_shows_the_demo_scenes_as_the_cpu_does() {
    let Some(mut gpu) = gpu() else { return };
    for profile in files::profiles::TABLE {
        let folder = tempfile::tempdir().unwrap();
        let path = profile.unpack(folder.path()).unwrap();
        let options = files::Options::default();
        let document = files::scene::open(&path, &options).unwrap();
        let (loaded, _) = files::materials::load(&path, document.scene(), &options, &mut Default::default()).unwrap();
        let synth = render::synth(document.scene(), &loaded, None).unwrap();
        // A frame of thousands of sprites takes the CPU seconds without optimisation.
        let is_slow = synth.takes_long() || synth.layers.iter().any(|layer| layer.has_sprites());
        let times = if is_slow { &TIMES[..2] } else { &TIMES[..] };
        times.iter().for_each(|time| check(&mut gpu, profile.name, &synth, *time));
    }
}

#[test]
fn what_another_thread_uploads_is_drawn_without_being_uploaded_again() {
    let Some(mut gpu) = gpu() else { return };
    let (name, synth) = &scenes()[4];
    let (told, go_on) = (Arc::new(AtomicU8::new(0)), AtomicBool::new(false));
    let heard = told.clone();
    let sent = Progress::new(move |percent| heard.store(percent, Ordering::Relaxed));
    let uploader = gpu.uploader();
    let uploaded = std::thread::scope(|scope| scope.spawn(|| uploader.upload(&[synth], &sent, &go_on)).join());
    let uploaded = uploaded.unwrap().unwrap();
    assert!(uploaded.count() > 1 && told.load(Ordering::Relaxed) >= 99, "{} of {}", told.load(Ordering::Relaxed), name);
    assert!(uploader.upload(&[synth], &Progress::new(|_| {}), &AtomicBool::new(true)).is_err(), "stopped");
    gpu.take(uploaded);
    let again = gpu.uploader().upload(&[synth], &Progress::new(|_| {}), &go_on).unwrap();
    assert_eq!(again.count(), 0, "all of it is there");
    check(&mut gpu, name, synth, 0.25);
    // What another device was given is of no use after a loss.
    let late = uploader.upload(&[synth], &Progress::new(|_| {}), &go_on);
    gpu.device().raw.destroy();
    drop(gpu.frame(synth, 0.0).unwrap());
    late.into_iter().for_each(|late| gpu.take(late));
    check(&mut gpu, name, synth, 0.25);
}

#[test]
fn the_scenes_move() {
    for (name, synth) in scenes().iter().skip(1) {
        let (_, share) = difference(&cpu::frame(synth, 0.0), &cpu::frame(synth, 0.25));
        assert!(share > 0.05, "{name}: {share}");
    }
}

#[test]
fn a_lost_device_is_replaced() {
    let Some(mut gpu) = gpu() else { return };
    let (_, synth) = &scenes()[2];
    let before = gpu.frame(synth, 0.3).unwrap();
    gpu.device().raw.destroy();
    assert!(gpu.device().is_lost());
    assert_eq!(gpu.frame(synth, 0.3).unwrap(), before);
}

#[test]
fn what_is_too_large_is_refused_with_the_way_out() {
    let Some(mut gpu) = gpu() else { return };
    let side = gpu.device().max_side() + 1;
    let wide = Arc::new(Picture::filled(side, 1, [0.0; 4]));
    let materials = Materials { pictures: [("own".to_owned(), wide)].into(), ..Materials::default() };
    let scene = serde_json::from_value(json!({"plica": 1, "layers": [layer("a", "own", &[])]})).unwrap();
    let synth = render::synth(&scene, &materials, None).unwrap();
    let error = gpu.frame(&synth, 0.0).unwrap_err().to_string();
    assert!(error.contains(&side.to_string()) && error.contains("--gpu"), "{error}");
}

/// What a plan reads of its own before a step of it has written that.
fn unwritten(plan: &Plan) -> Vec<String> {
    let (mut written, mut early) = (BTreeSet::new(), Vec::new());
    for step in &plan.steps {
        for bind in step.binds() {
            match bind {
                Bind::Scratch(number) if !written.contains(number) => early.push(format!("{number} by {step:?}")),
                Bind::Drawn(drawn) => early.extend(unwritten(&drawn.plan)),
                // Arrays are all 0 at first, which is what a routine adds to.
                Bind::Written(number) => drop(written.insert(*number)),
                Bind::Scratch(_) | Bind::Bytes(_) | Bind::List(_) | Bind::Upload(..) | Bind::Depth | Bind::Linear => {}
            }
        }
        match step {
            Step::Compute(Compute { groups: Groups::Found(tally), .. }) if !written.contains(tally) => {
                early.push(format!("tally {tally} by {step:?}"));
            }
            Step::Compute(_) => {}
            Step::Draw(draw) => {
                let tally = draw.found.filter(|tally| !written.contains(tally));
                early.extend(tally.map(|tally| format!("tally {tally} by {step:?}")));
                let into = draw.into.iter();
                written
                    .extend(into.flat_map(|into| into.textures.iter().map(|(number, _)| *number).chain(into.depths)));
            }
        }
    }
    early
}

#[test]
fn what_a_plan_reads_of_its_own_was_written_before() {
    let (plain, mut seen) = (json!({"kind": "plain", "color": "#c8b8a0c0"}), 0);
    let strokes = all_strokes().into_iter().map(|own| drawn(&own, &plain));
    let examples = examples_of_all().into_iter().map(|(_, scene, own)| render::synth(&scene, &own, None).unwrap());
    for synth in examples.chain(strokes) {
        for layer in &synth.layers {
            let plan = layer.plan(&synth.moment(0.3));
            seen += plan.scratch.len();
            assert_eq!(unwritten(&plan), [""; 0]);
        }
    }
    assert!(seen > 100, "{seen}");
}

/// The name and the WGSL of all shaders of a kind.
fn shaders(kind: &Kind) -> impl Iterator<Item = (&'static str, String)> {
    let programs = kind.programs.iter().copied().flatten().map(|program| (program.name, program.text()));
    programs.chain(kind.routines.iter().map(|routine| (routine.name, routine.text())))
}

/// The members of a struct that mean something, with where they begin; and its size.
fn layout(found: &Type) -> (Vec<(String, usize)>, usize) {
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{found:?}") };
    let named = members.iter().map(|member| (member.name.clone().unwrap(), member.offset as usize));
    (named.filter(|(name, _)| name != "unused").collect(), *span as usize)
}

#[test]
fn what_shaders_read_lies_where_rust_puts_it() {
    for kind in KINDS {
        let twins: Vec<_> = kind.twins.iter().copied().flatten().collect();
        let mut seen = BTreeSet::new();
        for (shader, text) in shaders(kind) {
            let module = wgsl::parse_str(&text).unwrap();
            let uniforms = module.global_variables.iter().filter(|(_, of)| of.space == AddressSpace::Uniform);
            for (_, uniform) in uniforms {
                let name = module.types[uniform.ty].name.as_deref();
                assert!(twins.iter().any(|twin| Some(twin.name) == name), "{shader}: Rust knows no {name:?}");
            }
            let strides = module.types.iter().filter_map(|(_, found)| match found.inner {
                TypeInner::Array { base, stride, .. } => Some((module.types[base].name.as_deref()?, stride as usize)),
                _ => None,
            });
            let strides: Vec<_> = strides.collect();
            for twin in &twins {
                let Some((_, found)) = module.types.iter().find(|(_, found)| found.name.as_deref() == Some(twin.name))
                else {
                    continue;
                };
                let (members, span) = layout(found);
                let fields: Vec<_> = twin.fields.iter().map(|(name, at)| ((*name).to_owned(), *at)).collect();
                assert_eq!(members, fields, "{shader}: {}", twin.name);
                assert!((span..span + 16).contains(&twin.size), "{shader}: {}: {span}, {}", twin.name, twin.size);
                let stride = strides.iter().find(|(name, _)| *name == twin.name);
                assert!(stride.is_none_or(|(_, stride)| *stride == twin.size), "{shader}: {}", twin.name);
                seen.insert(twin.name);
            }
        }
        assert_eq!(seen.len(), twins.len(), "{}: {seen:?}", kind.name);
    }
}

#[test]
fn every_shader_is_valid() {
    let own = render::gpu::PROGRAMS.iter().map(|program| (program.name, program.text()));
    let window = [plica::layers::parts::plan::COMMON, include_str!("../src/preview/window/screen.wgsl")].concat();
    for (name, source) in KINDS.iter().flat_map(|kind| shaders(kind)).chain(own).chain([("screen.wgsl", window)]) {
        let source = source.as_str();
        let module = wgsl::parse_str(source).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)));
        let mut validator = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::empty());
        validator.validate(&module).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)));
    }
}
