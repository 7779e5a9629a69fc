//! View maps in frames, over a mesh made here: as text (`PLICA_UPDATE=1 cargo test --test view_maps` writes it again), and
//! what must not change a frame. Photographs beside the repository are looked at where they are there.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails, in its helpers too")]

#[path = "view_maps/photographs.rs"]
mod photographs;
#[path = "view_maps/player.rs"]
mod player;

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use plica::base::budget::Budget;
use plica::base::maths::{TAU, cos, sin, tan};
use plica::base::mesh::{Mesh, Vertex};
use plica::base::picture::Picture;
use plica::base::pixels::{Frame, Linear, Rgba, decode, encode};
use plica::export::textures::{self, Forms};
use plica::files::outputs::Guard;
use plica::layers::parts::marks::{Mark, Shape, View};
use plica::layers::parts::materials::Materials;
use plica::layers::parts::readout::Value as Told;
use plica::layers::space::camera::Camera;
use plica::render::bands::Bands;
use plica::render::overlay;
use plica::render::passes::Asked;
use plica::render::{self, Synth, cpu};
use plica::scene::Scene;
use serde_json::{Value, json};

/// A vase about the y axis.
fn vase() -> Mesh {
    let (around, up) = (24, 12);
    let radius = |v: f64| 0.55 + 0.25 * sin(TAU * (v - 0.1));
    let vertex = |i: usize| {
        let (u, v) = ((i % (around + 1)) as f64 / around as f64, (i / (around + 1)) as f64 / up as f64);
        let (a, slope) = (u * TAU, TAU * 0.25 * cos(TAU * (v - 0.1)) / 2.0);
        let normal = DVec3::new(sin(a), -slope, cos(a)).normalize();
        let position = DVec3::new(sin(a) * radius(v), 2.0 * v - 1.0, cos(a) * radius(v));
        Vertex { position, normal, uv: DVec2::new(u, v) }
    };
    let corner = |x: usize, y: usize| (y * (around + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % around, i / around);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        vertices: (0..(around + 1) * (up + 1)).map(vertex).collect(),
        triangles: (0..around * up).flat_map(pair).collect(),
        ..Mesh::default()
    }
}

/// A gray picture, and one with dots that are all of it that counts.
fn materials() -> Materials {
    const SIZE: usize = 48;
    let picture = |cell: &dyn Fn(f64, f64) -> Rgba| {
        let at = |i: usize| ((i % SIZE) as f64 + 0.5, (i / SIZE) as f64 + 0.5);
        let cells = (0..SIZE * SIZE).map(|i| cell(at(i).0, at(i).1)).collect();
        Arc::new(Picture::from_cells(SIZE, SIZE, cells))
    };
    let dots = |x: f64, y: f64| {
        let inside = sin(TAU * x / 8.0) * sin(TAU * y / 8.0) > 0.3;
        if inside { [0.05, 0.02, 0.0, 1.0] } else { [0.0; 4] }
    };
    let plain = picture(&|_, y| [0.9, 0.6 + y as f32 / 200.0, 0.5, 1.0]);
    Materials {
        meshes: [("vase".to_owned(), Arc::new(vase()))].into(),
        pictures: [("plain".to_owned(), plain), ("dots".to_owned(), picture(&dots))].into(),
        ..Materials::default()
    }
}

/// The vase in gray, with dots that are seen from the front: from so many degrees to the right of it.
fn scene(degrees: f64, layer: &Value) -> Scene {
    let around = |name: &str, angle: f64| {
        let (x, z) = (4.0 * sin(angle.to_radians()), 4.0 * cos(angle.to_radians()));
        json!({ "name": name, "image": "plain", "kind": "independent",
            "camera": { "position": [x, 0, z], "target": [0, 0, 0], "fov": 36 } })
    };
    let dots = json!({ "name": "dots", "image": "dots", "kind": "dependent", "hold": 0.4,
        "camera": { "position": [0, 0, 4], "fov": 36 }, "extremes": { "kind": "cone", "degrees": 50 } });
    let views = json!([around("a", 0.0), around("b", 120.0), around("c", 240.0), dots]);
    let mut mesh = json!({ "kind": "mesh", "name": "vase", "mesh": "vase", "surface": {
        "kind": "view-map", "cells": 16, "levels": 4, "views": views } });
    mesh.as_object_mut().unwrap().extend(layer.as_object().unwrap().clone());
    let angle = degrees.to_radians();
    let camera = json!({ "position": [4.0 * sin(angle), 0.6, 4.0 * cos(angle)], "target": [0, 0, 0], "fov": 36 });
    serde_json::from_value(json!({ "plica": 1, "size": [60, 44], "camera": camera,
        "meshes": { "vase": { "path": "vase.obj" } }, "layers": [mesh],
        "images": { "plain": { "path": "plain.png" }, "dots": { "path": "dots.png" } } }))
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
fn a_pattern_is_seen_from_the_front_as_is_kept() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/view_maps/vase.txt");
    let frames = [0.0, 30.0, 60.0].map(|degrees| letters(&cpu::frame(&synth(&scene(degrees, &json!({}))), 0.0)));
    let found = frames.join("\n");
    if std::env::var_os("PLICA_UPDATE").is_some() {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, &found).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap_or_default(), found);
    assert!(frames[0].contains('%') && !frames[2].contains(['-', '%']), "the pattern comes and goes");
}

#[test]
fn the_bits_do_not_depend_on_threads_and_parts_are_those_of_the_whole() {
    let scene = scene(20.0, &json!({}));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| cpu::linear(&synth(&scene), 0.3))
    };
    let whole = with(1);
    assert!(whole.cells() == with(2).cells());
    let part = cpu::lattice(&synth(&scene), 0.3, &[3, 20, 31, 44], &[5, 18, 30]);
    let expected = [5, 18, 30].iter().flat_map(|y| [3, 20, 31, 44].map(|x| *whole.get(x, *y)));
    assert_eq!(part.cells(), expected.collect::<Vec<Rgba>>());
    let materials = materials();
    let bands = Bands::new(&scene, &materials, 2).unwrap();
    let frame = cpu::frames(&render::samples(&scene, &materials, 2).unwrap(), 0.3);
    assert!(bands.frame(0.3, &|_| ()).unwrap() == frame);
}

#[test]
fn a_model_that_is_moved_and_its_camera_with_it_looks_the_same() {
    let still = cpu::frame(&synth(&scene(20.0, &json!({}))), 0.0);
    let turned = scene(65.0, &json!({ "pose": { "rotate": [0, 45, 0] } }));
    let moved = cpu::frame(&synth(&turned), 0.0);
    let far = still.cells().iter().zip(moved.cells()).filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 2)).count();
    assert!(far < 8, "{far} pixels differ");
}

#[test]
fn passes_tell_what_a_frame_is_made_from() {
    let scene = scene(10.0, &json!({}));
    let [frame, base, pattern, coverage] = [
        cpu::linear(&synth(&scene), 0.0),
        pass(&scene, "independent"),
        pass(&scene, "dependent"),
        pass(&scene, "coverage"),
    ];
    let (mut dotted, mut bare) = (0, 0);
    for i in 0..frame.cells().len() {
        let [own, base, pattern, coverage] = [&frame, &base, &pattern, &coverage].map(|picture| picture.cells()[i]);
        let [opacity, known, number, there] = coverage;
        if there == 0.0 {
            assert_eq!((own[3], base[3]), (0.0, 0.0));
            continue;
        }
        // Cell by cell, the pattern lies over the base coat.
        let expected = pattern[0] + (1.0 - opacity) * base[0];
        assert!((own[0] - expected).abs() < 0.05, "{i}: {own:?} {base:?} {pattern:?}");
        assert!(known > 0.0 && number == if opacity > 1e-6 { 4.0 } else { 0.0 });
        dotted += usize::from(opacity > 0.9);
        bare += usize::from(opacity < 0.1);
    }
    assert!(dotted > 20 && bare > 200, "{dotted} {bare}");
    let colors = Asked::parse("coverage", &scene).unwrap().looked_at().picture(&synth(&scene), 0.0);
    let [r, g, b, _] = encode(*colors.get(30, 4));
    assert!(r > g.min(b) || g > r.min(b), "a view has a color: {r} {g} {b}");
}

#[test]
fn a_pixel_is_explained() {
    let scene = scene(10.0, &json!({}));
    let (synth, materials) = (synth(&scene), materials());
    let (making, moment) = (render::making(&scene, &materials), synth.moment(0.0));
    let coverage = pass(&scene, "coverage");
    let x = (0..60).max_by(|a, b| coverage.get(*a, 20)[0].total_cmp(&coverage.get(*b, 20)[0])).unwrap();
    let layer = scene.layers[0].technique();
    for ready in [Some(&*synth.layers[0]), None] {
        let read = layer.probe(&making, ready, (x, 20), &moment).unwrap().unwrap();
        let Some(Told::Group(map)) =
            read.entries.iter().find(|entry| entry.key == "view_map").map(|entry| &entry.value)
        else {
            panic!("{read:?}")
        };
        let of = |key: &str| &map.iter().find(|entry| entry.key == key).unwrap().value;
        let Told::Number(opacity) = of("opacity") else { panic!() };
        assert!((opacity - f64::from(coverage.get(x, 20)[0])).abs() < 1e-6, "{opacity}");
        let Told::Shares(views) = of("views") else { panic!() };
        assert_eq!(views[0].0, "dots");
        let Told::Coordinates(direction, _) = of("direction") else { panic!() };
        assert!(direction.iter().map(|v| v * v).sum::<f64>() < 0.5, "seen squarely: {direction:?}");
        let Told::Indices(cell) = of("cell") else { panic!() };
        assert!(cell[0] < 4 && cell[1] == 0, "{cell:?}");
    }
}

#[test]
fn blend_points_and_strokes_draw_from_it() {
    let mut blended = scene(0.0, &json!({}));
    let plica::layers::Layer::Mesh(mesh) = &mut blended.layers[0] else { panic!() };
    let plica::layers::mesh::slots::Surface::ViewMap(map) = &mut mesh.surface else { panic!() };
    map.blend.points = serde_json::from_value(json!([{ "position": [0, 0.6, 4] }])).unwrap();
    let (base, shown) = (pass(&blended, "independent"), cpu::linear(&synth(&blended), 0.0));
    let same = |(a, b): (&Rgba, &Rgba)| (0..4).all(|c| (a[c] - b[c]).abs() < 1e-6);
    assert!(base.cells().iter().zip(shown.cells()).all(same), "the base coat alone");
    let strokes =
        json!({ "strokes": { "style": "none", "tone": { "of": "color" }, "marks": [{ "name": "i", "kind": "ink" }] } });
    let tone = pass(&scene(0.0, &strokes), "tone");
    let dark = tone.cells().iter().filter(|cell| cell[3] > 0.0 && cell[0] < 0.3).count();
    assert!(dark > 20, "the pattern is dark: {dark}");
}

#[test]
fn what_is_bent_keeps_its_effects_at_the_same_angle() {
    // All of it is beyond the end of the bend, so it is turned as one: a camera that is turned too sees the same.
    let bent = json!({ "pose": { "bend": { "degrees": 35, "axis": "y", "from": -60, "to": -50 } } });
    let (plain, bent) = (synth(&scene(10.0, &json!({}))), synth(&scene(10.0, &bent)));
    let camera = bent.stage.camera.clone().unwrap();
    let turn = glam::DMat3::from_rotation_z(f64::to_radians(35.0));
    let turned = |at: [f64; 3]| (turn * DVec3::from(at)).to_array();
    let (position, up) = (turned(camera.position), turned(camera.up));
    let seen = cpu::frame(&bent.seen_from(Camera { position, up, ..camera }), 0.0);
    let expected = cpu::frame(&plain, 0.0);
    let far = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 2);
    let off = expected.cells().iter().zip(seen.cells()).filter(|(a, b)| far((a, b))).count();
    let dark = seen.cells().iter().filter(|cell| cell[3] > 0 && cell[0] < 120).count();
    assert!(off < 8 && dark > 20, "{off} pixels differ, {dark} are of the pattern");
}

/// A scene with another surface.
fn changed(scene: &Scene, surface: &Value) -> Scene {
    let mut scene = serde_json::to_value(scene).unwrap();
    scene["layers"][0]["surface"].as_object_mut().unwrap().extend(surface.as_object().unwrap().clone());
    serde_json::from_value(scene).unwrap()
}

/// Writes the textures of a scene to a folder.
fn textures(scene: &Scene, forms: Forms) -> Result<tempfile::TempDir, plica::base::error::Error> {
    let folder = tempfile::tempdir().unwrap();
    let place = Guard::new(false).folder(folder.path(), &|_| true, Default::default())?;
    textures::write(scene, &synth(scene), forms, &place, &mut |_, _| Ok(()))?;
    Ok(folder)
}

#[test]
fn frames_can_be_found_from_what_synth_writes() {
    let near =
        json!({ "points": [{ "position": [0, 0.6, 3.5], "base": 0.6 }, { "position": [3, 1, 0], "base": 0.2 }] });
    for (degrees, surface) in [
        (10.0, json!({ "levels": 2, "directions": 6 })),
        (40.0, json!({ "levels": 2, "directions": 4, "atlas": "box", "blend": near })),
    ] {
        let scene = changed(&scene(degrees, &json!({})), &surface);
        let frame = cpu::frame(&synth(&scene), 0.0);
        let folder = textures(&scene, Forms::default()).unwrap();
        let player = player::Player::read(folder.path());
        let angle = f64::to_radians(degrees);
        let place = DVec3::new(4.0 * sin(angle), 0.6, 4.0 * cos(angle));
        let forward = -place.normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let focal = f64::from(frame.height() as u32) / 2.0 / tan(f64::to_radians(18.0));
        let camera = player::Camera {
            place,
            ways: [right / focal, -right.cross(forward) / focal, forward],
            middle: DVec2::new(frame.width() as f64, frame.height() as f64) / 2.0,
        };
        let (mut seen, mut off) = (0, Vec::new());
        for i in 0..frame.width() * frame.height() {
            let (x, y) = (i % frame.width(), i / frame.width());
            let [r, g, b, a] = *frame.get(x, y);
            let found = player.pixel(&camera, x, y);
            seen += usize::from(found.is_some());
            let far = found.map(|found| found.iter().zip([r, g, b]).map(|(a, b)| a.abs_diff(b)).max().unwrap());
            if far.is_some() != (a > 0) || far > Some(1) {
                off.push((x, y, found, [r, g, b]));
            }
        }
        assert!(seen > 500 && off.is_empty(), "{seen} seen, {} of them off: {:?}", off.len(), off.first());
    }
}

#[test]
fn a_baked_base_coat_is_what_the_mesh_shows_with_it() {
    let scene = changed(&scene(25.0, &json!({})), &json!({ "levels": 2, "directions": 4 }));
    let folder = textures(&scene, Forms { baked_px: Some(64), ..Forms::default() }).unwrap();
    let baked = image::open(folder.path().join("vase-baked.png")).unwrap().to_rgba8();
    assert_eq!((baked.width(), baked.height()), (64, 64));
    let mut with = materials();
    let cells = baked.pixels().map(|texel| decode(texel.0)).collect();
    with.pictures.insert("plain".into(), Arc::new(Picture::from_cells(64, 64, cells)));
    let mut shown = serde_json::to_value(&scene).unwrap();
    shown["layers"][0]["surface"] = json!({ "kind": "texture", "image": "plain" });
    shown["layers"][0]["light"] = json!({ "ambient": 1 });
    let found = render::synth(&serde_json::from_value(shown).unwrap(), &with, None).unwrap();
    let expected = Asked::parse("independent", &scene).unwrap().picture(&synth(&scene), 0.0);
    let pairs = cpu::frame(&found, 0.0).into_cells().into_iter().zip(expected.cells());
    let far = pairs.map(|(a, b)| a.iter().zip(encode(*b)).map(|(a, b)| a.abs_diff(b)).max().unwrap());
    let far: Vec<u8> = far.collect();
    assert!(far.iter().filter(|far| **far > 6).count() * 100 < far.len(), "{far:?}");
}

#[test]
fn cameras_are_drawn_with_their_names_and_how_far_the_selected_one_is_seen() {
    let near = json!({ "blend": { "points": [{ "position": [0.5, 0, 2] }] } });
    let scene = changed(&scene(10.0, &json!({ "pose": { "scale": 0.3 } })), &near);
    let synth = synth(&scene);
    let marks = |selection: &str| {
        let view = View { selection: Some(selection.into()), times: vec![0.0], ..View::of(&["view-views"]) };
        overlay::overlay(&scene, Some(&synth), &view)
    };
    let found = marks("/layers/0/surface/views/3/hold");
    let labels = |found: &[Mark]| {
        let text = |mark: &Mark| match &mark.shape {
            Shape::Label(_, text) => Some((text.clone(), mark.selected)),
            _ => None,
        };
        found.iter().filter_map(text).collect::<Vec<_>>()
    };
    let named = |name: &str, selected| (name.to_owned(), selected);
    let expected = [("a", false), ("b", false), ("c", false), ("dots", true), ("blend 1", false)];
    assert_eq!(labels(&found), expected.map(|(name, selected)| named(name, selected)));
    let count = |found: &[Mark], name: &str| found.iter().filter(|mark| mark.look.name == name).count();
    assert!(count(&found, "where a view is gone") > 60 && count(&found, "where a view is whole") > 60, "{found:?}");
    let other = marks("/layers/0/surface/views/0");
    assert_eq!(count(&other, "where a view is gone"), 0, "the base coat is seen from everywhere");
    assert_eq!(labels(&other).iter().filter(|(_, selected)| *selected).count(), 1);
    // It stands before what the scene's camera looks at, a little below and to the left of that camera.
    let none = marks("");
    let at = none.iter().find_map(|mark| match (&mark.shape, mark.look.name) {
        (Shape::Label(at, text), "view") if text == "dots" => Some(*at),
        _ => None,
    });
    let at = at.unwrap();
    assert!((18.0..30.0).contains(&at.x) && (22.0..34.0).contains(&at.y), "{at:?}");
}

#[test]
fn what_there_is_no_memory_for_is_left_out_where_that_is_told() {
    let surface = json!({ "directions": 8 });
    let scene = changed(&scene(20.0, &json!({})), &surface);
    let made = |bytes: u64, leaves_out: bool| {
        let with = Materials { budget: Budget::new(bytes), leaves_out, ..materials() };
        render::synth(&scene, &with, None)
    };
    let told = |synth: &Synth| synth.lacks().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let refused = made(1000, false).unwrap_err().to_string();
    assert!(refused.contains("make the pictures of its views smaller, or give --limit memory="), "{refused}");
    // With what the message asks for it is made.
    let asked = refused.split("memory=").nth(1).and_then(|text| text.split('M').next()?.parse::<u64>().ok());
    assert!(refused.contains("needs up to ") && made(asked.unwrap() << 20, false).is_ok(), "{refused}");
    let nothing = made(1000, true).unwrap();
    assert!(
        told(&nothing).contains("are allowed: nothing of its views is shown (make the pictures"),
        "{}",
        told(&nothing)
    );
    assert_eq!(nothing.lacks()[0].path, "/layers/0/surface");
    assert_eq!(*cpu::frame(&nothing, 0.0).get(30, 22), [0x80, 0x80, 0x80, 255], "missing");
    // Enough to look with all views, and for exact directions.
    let enough = (48 * 48 * 96 * rayon::current_num_threads() as u64).max(2_000_000);
    assert!(made(enough, false).unwrap_err().to_string().contains("\"levels\": "), "what would fit");
    let coat = made(enough, true).unwrap();
    assert!(told(&coat).contains(": only its base coat is shown (\"levels\": "), "{}", told(&coat));
    assert!(told(&coat).contains(" or no \"directions\" would fit, or give --limit memory="), "{}", told(&coat));
    let exact = changed(&scene, &json!({ "directions": null }));
    let expected = pass(&exact, "independent").cells().iter().map(|color| encode(*color)).collect::<Vec<_>>();
    assert_eq!(cpu::frame(&coat, 0.0).cells(), expected);
    assert_eq!(synth(&exact).lacks(), []);
    // With enough memory again nothing is left out.
    let again = render::synth(&exact, &materials(), Some(&coat)).unwrap();
    assert!(again.lacks().is_empty() && cpu::frame(&again, 0.0) == cpu::frame(&synth(&exact), 0.0));
}
