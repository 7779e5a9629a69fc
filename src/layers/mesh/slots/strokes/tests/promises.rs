//! What strokes promise, on meshes made here: as many waves everywhere, none of which comes or goes at once, that go with the
//! surface.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use serde_json::{Value, json};

use super::super::measure::{Frame, flatness_of};
use super::super::noise::Scene;
use super::super::synth::Ready;
use super::super::tone::threshold;
use crate::base::maths::{TAU, atan2, cos, pow, sin};
use crate::base::mesh::{Mesh, Vertex};
use crate::base::statistics::{correlation, percentile};
use crate::layers::mesh::drawing::Given;
use crate::layers::mesh::frame::MeshAt;
use crate::layers::mesh::model::MeshLayer;
use crate::layers::mesh::synth::Synth;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::readout::{Entry, Value as EntryValue};
use crate::layers::ready::Making;
use crate::layers::space::eye::Eye;
use crate::layers::space::raster::NONE;
use crate::layers::technique::Technique;
use crate::layers::timeline::Wrap;

/// A square of 4 m in so many times so many cells, seen from the front.
fn plane(cells: usize) -> Mesh {
    let at = |i: usize| 4.0 * i as f64 / cells as f64 - 2.0;
    let vertex = |i: usize| Vertex {
        position: DVec3::new(at(i % (cells + 1)), at(i / (cells + 1)), 0.0),
        normal: DVec3::Z,
        ..Vertex::default()
    };
    grid((cells, cells), vertex)
}

/// A ball of radius 1.
fn ball(around: usize, down: usize) -> Mesh {
    let vertex = |i: usize| {
        let (a, b) = (TAU * (i % (around + 1)) as f64 / around as f64, PI * (i / (around + 1)) as f64 / down as f64);
        let normal = DVec3::new(sin(b) * sin(a), -cos(b), sin(b) * cos(a));
        Vertex { position: normal, normal, ..Vertex::default() }
    };
    grid((around, down), vertex)
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

/// Strokes of one noise.
fn one(noise: Value) -> Value {
    let mut own = json!({ "spacing": 16, "spread": 0 });
    noise.as_object().unwrap().iter().for_each(|(name, value)| own[name] = value.clone());
    json!({ "style": "none", "noises": { "a": own }, "marks": [{ "name": "m", "kind": "ink", "noise": "a" }] })
}

fn layer(strokes: &Value) -> MeshLayer {
    serde_json::from_value(json!({ "name": "m", "mesh": "m", "strokes": strokes })).unwrap()
}

fn synth(mesh: &Mesh, strokes: &Value) -> Synth {
    let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh.clone()))].into(), ..Materials::default() };
    Synth::new(&layer(strokes), &Making::plain(Wrap::Repeat, &materials), None).unwrap()
}

/// Its strokes.
fn ready_of(synth: &Synth) -> &Ready {
    synth.strokes.as_deref().and_then(|strokes| strokes.downcast()).unwrap()
}

/// Looks at what is at the origin from this place in front of it, in a square frame of this side.
fn moment(from: DVec3, side: usize) -> Moment {
    let middle_px = DVec2::splat(side as f64 / 2.0);
    let eye = Eye { position: from, turn: DMat3::IDENTITY, focal_px: side as f64 * 420.0 / 512.0, middle_px };
    Moment { t: 0.0, size_px: (side, side), eye: Some(eye), left_out: 0, magnified: 1 }
}

/// What is made of what a frame shows.
fn seen<R>(synth: &Synth, moment: &Moment, make: impl FnOnce(&Given) -> R) -> R {
    make(&MeshAt::new(synth, moment).given_alone().unwrap())
}

/// The values and the shares of the variance of the noise, on the pixels of the layer.
fn noise(synth: &Synth, given: &Given) -> (Vec<f32>, Vec<f32>) {
    let ready = ready_of(synth);
    let found = Scene::new(ready, given).noise_with_shares(&ready.strokes.noises["a"]);
    let own = |values: Vec<f32>| values.into_iter().zip(&given.triangle).filter(|(_, t)| **t != NONE).map(|(v, _)| v);
    (own(found.value).collect(), own(found.share).collect())
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn square(value: f64) -> f64 {
    value * value
}

type Found = BTreeMap<[u32; 3], (DVec2, f64)>;

/// The impulses of a frame, with their places and their factors.
fn impulses(synth: &Synth, moment: &Moment) -> Found {
    let ready = ready_of(synth);
    seen(synth, moment, |given| {
        let found = Scene::new(ready, given).impulses(&ready.strokes.noises["a"]).unwrap();
        found.into_iter().map(|impulse| (impulse.of, (impulse.at, impulse.factor))).collect()
    })
}

#[test]
fn impulses_of_a_distance_are_among_those_of_a_nearer_one_and_count_no_less() {
    for cells in [1, 12] {
        let synth = synth(&plane(cells), &one(json!({})));
        let [far, near] = [2.4, 1.5].map(|distance| impulses(&synth, &moment(DVec3::Z * distance, 256)));
        let grown = |at: DVec2| 128.0 + (at - 128.0) * (2.4 / 1.5);
        let inside = |at: DVec2| at.min_element() > 0.0 && at.max_element() < 256.0;
        let stay: Vec<_> = far.iter().filter(|(_, (at, _))| inside(grown(*at))).collect();
        assert!(stay.len() > 400, "{}", stay.len());
        for (of, (at, factor)) in stay {
            let (there, more) = near[of];
            assert!(more >= *factor && (there - grown(*at)).length() < 1e-9, "{of:?}");
        }
    }
}

#[test]
fn the_order_of_vertices_in_memory_changes_no_bit() {
    let mesh = ball(24, 12);
    let count = mesh.vertices.len();
    // Steps that have no divisor in common with the count visit all of them.
    let moved = |i: usize| (i * 7 + 3) % count;
    assert_ne!(count % 7, 0);
    let mut other = mesh.clone();
    (0..count).for_each(|i| other.vertices[moved(i)] = mesh.vertices[i]);
    other.triangles.iter_mut().flatten().for_each(|corner| *corner = moved(*corner as usize) as u32);
    let strokes = one(json!({ "direction": { "along": "outline" }, "spread": 8 }));
    let moment = moment(DVec3::Z * 3.0, 96);
    let [a, b] = [mesh, other].map(|mesh| {
        let synth = synth(&mesh, &strokes);
        seen(&synth, &moment, |given| noise(&synth, given))
    });
    assert!(a == b && a.0.len() > 1000);
}

#[test]
fn there_are_as_many_impulses_whatever_the_mesh_and_the_distance() {
    let mut counts = Vec::new();
    for cells in [1, 48] {
        let synth = synth(&plane(cells), &one(json!({})));
        let found = [0.5, 1.0, 2.4].map(|distance| impulses(&synth, &moment(DVec3::Z * distance, 512)).len());
        counts.extend(found);
    }
    let mean = mean(counts.iter().map(|count| *count as f64));
    assert!(counts.iter().all(|count| (*count as f64 / mean - 1.0).abs() < 0.03), "{counts:?}");
}

#[test]
fn the_variance_is_one_and_its_share_is_one() {
    for cells in [1, 48] {
        let found = [(0.6, 1), (2.4, 1), (0.6, 2), (2.4, 2)].map(|(distance, seed)| {
            let synth = synth(&plane(cells), &one(json!({ "seed": seed, "spacing": 8 })));
            seen(&synth, &moment(DVec3::Z * distance, 256), |given| {
                let (values, shares) = noise(&synth, given);
                let average = mean(values.iter().map(|v| f64::from(*v)));
                let variance = mean(values.iter().map(|v| square(f64::from(*v) - average)));
                (mean(shares.iter().map(|v| f64::from(*v))), variance)
            })
        });
        let of = |part: fn(&(f64, f64)) -> f64| mean(found.iter().map(part));
        let (share, variance) = (of(|found| found.0), of(|found| found.1));
        assert!((share - 1.0).abs() < 0.06 && (variance - 1.0).abs() < 0.06, "{cells}: {share} {variance}");
    }
}

/// The mean of the frequencies of a square of values that are round about 1/16 in both directions, in cycles a pixel, and how far they are from
/// it: the deviation in one direction.
fn spectrum(values: &[f32], side: usize) -> (DVec2, f64) {
    // Frequencies that a whole number of waves has, up to 1/8.
    let (count, turn) = (side / 8, TAU / side as f64);
    let hann = |i: usize| 0.5 - 0.5 * cos(turn * i as f64);
    let wave: Vec<DVec2> = (0..side).map(|i| DVec2::new(cos(turn * i as f64), -sin(turn * i as f64))).collect();
    let times = |a: DVec2, b: DVec2| DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
    let rows: Vec<Vec<DVec2>> = (0..side)
        .map(|y| {
            let row: Vec<f64> = (0..side).map(|x| f64::from(values[y * side + x]) * hann(x) * hann(y)).collect();
            (1..=count).map(|k| row.iter().enumerate().map(|(x, v)| wave[k * x % side] * *v).sum()).collect()
        })
        .collect();
    let mut found = Vec::new();
    for (kx, ky) in (1..=count).flat_map(|x| (1..=count).map(move |y| (x, y))) {
        let sum: DVec2 = rows.iter().enumerate().map(|(y, row)| times(row[kx - 1], wave[ky * y % side])).sum();
        found.push((DVec2::new(kx as f64, ky as f64) / side as f64, sum.length_squared()));
    }
    let total: f64 = found.iter().map(|(_, power)| power).sum();
    let middle = found.iter().map(|(at, power)| *at * *power).sum::<DVec2>() / total;
    let spread = found.iter().map(|(at, power)| (*at - middle).length_squared() * power).sum::<f64>() / total;
    // The window's own spread, in both directions.
    let of_window = 2.0 / (3.0 * square(side as f64));
    (middle, ((spread - of_window) / 2.0).sqrt())
}

#[test]
fn waves_are_as_long_and_run_as_they_should() {
    let (side, radius) = (384, 20.0);
    let found = [1, 2].map(|seed| {
        let strokes =
            one(json!({ "seed": seed, "regularity": radius / 16.0, "direction": { "along": "screen", "angle": 45 } }));
        let synth = synth(&plane(8), &strokes);
        spectrum(&seen(&synth, &moment(DVec3::Z, side), |given| noise(&synth, given).0), side)
    });
    let middle = (found[0].0 + found[1].0) / 2.0;
    let width = mean(found.iter().map(|(_, width)| *width));
    assert!((middle.length() * 16.0 - 1.0).abs() < 0.01, "{middle}");
    assert!((atan2(middle.y, middle.x).to_degrees() - 45.0).abs() < 1.0, "{middle}");
    // The deviation of the frequencies of W: the root of the sum of W' squared over that of W squared, over 2 pi.
    let gauss = |x: f64| pow(std::f64::consts::E, -PI * x * x);
    let steps = (0..2000).map(|i| f64::from(i) / 1000.0 - 1.0);
    let (kernel, slope) = steps.fold((0.0, 0.0), |(kernel, slope), x| {
        (kernel + square(gauss(x) - gauss(1.0)), slope + square(TAU * x * gauss(x)))
    });
    let expected = (slope / kernel).sqrt() / TAU / radius;
    assert!((expected - 0.015).abs() < 5e-5, "as in the contract: {expected}");
    assert!((width / expected - 1.0).abs() < 0.05, "{width} for {expected}");
}

/// A frame of the noise itself.
fn frame(synth: &Synth, moment: &Moment) -> Frame {
    let ready = ready_of(synth);
    seen(synth, moment, |given| {
        let found = Scene::new(ready, given).noise(&ready.strokes.noises["a"]);
        Frame::of(given, vec![found.value])
    })
}

#[test]
fn the_noise_goes_with_the_surface_and_fades_slowly() {
    let synth = synth(&plane(24), &one(json!({})));
    let at = |x: f64, distance: f64| moment(DVec3::new(x, 0.0, distance), 192);
    let first = frame(&synth, &at(0.0, 2.0));
    let about = DMat3::from_rotation_y(1_f64.to_radians());
    let (turned, straight) = (about * DVec3::Z * 2.0, at(0.0, 2.0));
    let eye = Eye { position: turned, turn: about.transpose(), ..straight.eye.unwrap() };
    let turned = Moment { eye: Some(eye), ..straight };
    let px = 2.0 / (192.0 * 420.0 / 512.0);
    for (name, other, least) in [
        ("pan of 5.3 px", at(5.3 * px, 2.0), 0.9999),
        ("zoom of 0.5 %", at(0.0, 2.0 / 1.005), 0.9997),
        ("zoom of 1 %", at(0.0, 2.0 / 1.01), 0.999),
        ("zoom of 3 %", at(0.0, 2.0 / 1.03), 0.992),
        ("zoom of 11 %", at(0.0, 2.0 / 1.11), 0.92),
        ("turn of 1 degree", turned, 0.999),
    ] {
        let pairs = first.pairs(&frame(&synth, &other), 0);
        let found = correlation(pairs.iter().copied()).unwrap();
        assert!(found >= least && pairs.len() > 25_000, "{name}: {found}");
    }
    // In small steps nothing happens to many at once.
    let mut steps: Vec<f64> = Vec::new();
    let residuals: Vec<f64> = (0..6)
        .map(|k| 2.0 / pow(1.003, f64::from(k)))
        .collect::<Vec<_>>()
        .windows(2)
        .map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|distance| frame(&synth, &at(0.0, distance)));
            let pairs = a.pairs(&b, 0);
            steps.extend(pairs.iter().map(|(v, w)| f64::from((v - w).abs())));
            mean(pairs.iter().map(|(v, w)| square(f64::from(v - w)))).sqrt()
        })
        .collect();
    let (most, average) = (residuals.iter().copied().fold(0.0, f64::max), mean(residuals.iter().copied()));
    assert!(most <= 0.012 && most <= 1.1 * average, "{residuals:?}");
    let rare = percentile(&mut steps, 0.999).unwrap();
    assert!(rare <= 0.045, "one in a thousand differs by {rare}");
}

#[test]
fn the_inked_share_is_as_dark_as_it_should_be() {
    for (kind, even) in [
        (json!({}), false),
        (json!({ "spread": 90, "regularity": 0.9 }), false),
        (json!({ "regularity": 2.4, "spread": 6 }), false),
        (json!({ "even": true, "regularity": 2 }), true),
    ] {
        let mut strokes = one(kind.clone());
        strokes["noises"]["a"]["spacing"] = json!(6);
        let synth = synth(&plane(1), &strokes);
        let values = seen(&synth, &moment(DVec3::Z, 320), |given| noise(&synth, given).0);
        for level in [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95] {
            let inked = values.iter().filter(|v| **v < threshold(level, even)).count();
            let share = inked as f64 / values.len() as f64;
            assert!((share - f64::from(level)).abs() <= 0.025, "{kind} {level}: {share}");
        }
    }
}

#[test]
fn strokes_are_as_strong_beside_silhouettes() {
    let side = 200;
    let mut near = Vec::new();
    for seed in 1..=6 {
        let synth = synth(&ball(48, 24), &one(json!({ "seed": seed, "spacing": 8 })));
        seen(&synth, &moment(DVec3::Z * 2.6, side), |given| {
            let ready = ready_of(&synth);
            let found = Scene::new(ready, given).noise(&ready.strokes.noises["a"]);
            let own = |x: usize, y: usize| given.triangle[y * side + x] != NONE;
            for (y, x) in (3..side - 3).flat_map(|y| (3..side - 3).map(move |x| (y, x))) {
                let rim = [(x - 3, y), (x + 3, y), (x, y - 3), (x, y + 3)].iter().any(|(x, y)| !own(*x, *y));
                near.extend((own(x, y) && rim).then(|| f64::from(found.value[y * side + x])));
            }
        });
    }
    let deviation = mean(near.iter().map(|v| v * v)).sqrt();
    assert!((0.9..=1.1).contains(&deviation) && near.len() > 5000, "{deviation} of {}", near.len());
}

#[test]
fn what_is_in_front_changes_nothing_beside_it() {
    let synth = synth(&ball(24, 12), &one(json!({})));
    let ready = ready_of(&synth);
    let moment = moment(DVec3::Z * 2.6, 128);
    let alone = seen(&synth, &moment, |given| Scene::new(ready, given).noise(&ready.strokes.noises["a"]).value);
    let seen_again = MeshAt::new(&synth, &moment);
    let mut given = seen_again.given_alone().unwrap();
    for i in (0..given.triangle.len()).filter(|i| i % 128 < 50) {
        (given.inverse[i], given.triangle[i]) = (1.0, NONE);
    }
    let behind = Scene::new(ready, &given).noise(&ready.strokes.noises["a"]).value;
    let shown: Vec<usize> = (0..alone.len()).filter(|i| given.triangle[*i] != NONE).collect();
    assert!(shown.len() > 2000 && shown.iter().all(|i| alone[*i].to_bits() == behind[*i].to_bits()));
}

#[test]
fn strokes_are_of_one_size_on_a_round_form() {
    let mesh = ball(48, 24);
    let flatness = ["surface", "screen", "texture"].map(|anchor| {
        let strokes = json!({ "style": "hatching", "anchor": anchor, "noises": { "a": { "spacing": 4 } } });
        let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh.clone()))].into(), ..Materials::default() };
        let making = Making { px_per_m: 60.0, ..Making::plain(Wrap::Repeat, &materials) };
        let synth = Synth::new(&layer(&strokes), &making, None).unwrap();
        let ready = ready_of(&synth);
        seen(&synth, &moment(DVec3::Z * 2.6, 192), |given| flatness_of(ready, given).unwrap())
    });
    let [surface, screen, texture] = flatness;
    assert!(surface >= screen - 0.04 && surface >= texture + 0.08, "{flatness:?}");
}

#[test]
fn measures_tell_the_anchors_apart() {
    let strokes = json!({ "style": "hatching" });
    let materials = Materials { meshes: [("m".to_owned(), Arc::new(plane(8)))].into(), ..Materials::default() };
    let making = Making { px_per_m: 70.0, ..Making::plain(Wrap::Repeat, &materials) };
    let moment = moment(DVec3::Z * 2.6, 160);
    let mut told = Vec::new();
    let mut step = |done, total| {
        told.push((done, total));
        true
    };
    let found = layer(&strokes).measure(&making, &moment, 1, &mut step).unwrap().unwrap();
    assert_eq!((found.of.as_str(), told), ("a", vec![(0, 4), (1, 4), (2, 4), (3, 4), (4, 4)]));
    let of = |way: usize, name: &str| {
        let (_, figures) = &found.ways[way];
        figures.moves.iter().find(|(own, _)| *own == name).unwrap().1
    };
    let slides = [0, 1, 2].map(|way| of(way, "pan").slide.unwrap());
    assert!(slides[0] <= 0.1 && (3.9..=4.1).contains(&slides[1]) && slides[2] <= 0.1, "{slides:?}");
    for name in ["pan", "turn", "zoom"] {
        let (surface, screen) = (of(0, name), of(1, name));
        assert!(surface.continuity.unwrap() >= 0.93, "{name}: {surface:?}");
        assert!(surface.coherence > screen.coherence, "{name}: {surface:?} {screen:?}");
    }
    assert_eq!(layer(&strokes).measure(&making, &moment, 1, &mut |_, _| false).unwrap(), None, "cancelled");
    let none = layer(&json!({ "style": "none", "marks": [{ "name": "o", "kind": "outline" }] }));
    let problem = none.measure(&making, &moment, 1, &mut |_, _| true).unwrap_err();
    assert_eq!(problem.path, "/strokes/marks");
}

#[test]
fn the_probe_tells_why_there_is_ink() {
    let materials = Materials { meshes: [("m".to_owned(), Arc::new(plane(4)))].into(), ..Materials::default() };
    let making = Making::plain(Wrap::Repeat, &materials);
    let layer = layer(&json!({ "style": "hatching" }));
    let moment = moment(DVec3::Z, 64);
    let read = layer.probe(&making, None, (20, 30), &moment).unwrap().unwrap();
    let rows = |key: &str| match entry(&read.entries, key) {
        EntryValue::Items(items) => items.clone(),
        other => panic!("{other:?}"),
    };
    let number = |entries: &[Entry], key: &str| match entry(entries, key) {
        EntryValue::Number(number) => *number,
        EntryValue::Index(index) => *index as f64,
        other => panic!("{key}: {other:?}"),
    };
    let synth = synth(&plane(4), &json!({ "style": "hatching" }));
    let x = seen(&synth, &moment, |given| noise(&synth, given).0[30 * 64 + 20]);
    let (noises, marks) = (rows("noises"), rows("marks"));
    assert_eq!((number(&noises[0], "x") as f32, noises.len(), marks.len()), (x, 3, 4));
    assert!(number(&noises[0], "impulses") > 5.0 && number(&noises[0], "factor") > 0.0, "{noises:?}");
    assert!(number(&noises[0], "triangle") < 32.0 && (0.0..180.0).contains(&number(&noises[0], "angle")));
    assert_eq!(*entry(&marks[3], "share"), EntryValue::Of(None), "an outline has none");
    let inked = marks.iter().find(|mark| matches!(entry(mark, "threshold"), EntryValue::Number(_))).unwrap();
    assert!(number(inked, "share") > 0.0 && (0.0..=1.0).contains(&number(inked, "covered")));
    assert!((0.0..=1.0).contains(&number(&read.entries, "tone")));
}

fn entry<'a>(entries: &'a [Entry], key: &str) -> &'a EntryValue {
    &entries.iter().find(|entry| entry.key == key).unwrap().value
}
