//! What a waterfall has to look like, over the clip of the demo `falls`: the choice of windows, what is between keys, and
//! how frames follow one another. Each test begins with the number of the check that it is.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::sync::OnceLock;

use glam::DVec2;
use plica::base::maths::{TAU, cos, powi, sin};
use plica::base::pixels::{Frame, Rgba, encode};
use plica::files::{Options, materials};
use plica::layers::parts::materials::Materials;
use plica::layers::parts::moment::Columns;
use plica::layers::waterfall::between::texels;
use plica::layers::waterfall::draw::{Canvas, draw};
use plica::layers::waterfall::frame::places;
use plica::layers::waterfall::model::{Between, Tangents};
use plica::layers::waterfall::splat::{mix, splats};
use plica::layers::waterfall::sprites::{KeyPlace, Source};
use plica::layers::waterfall::synth::Synth as Own;
use plica::render::{Synth, cpu, synth};
use plica::scene::Scene;
use rayon::ThreadPoolBuilder;
use serde_json::{Value, json};

/// Small, since tests run without optimization.
const SIZE: (usize, usize) = (192, 150);

/// Behind the fall.
const DARK: &str = "#101418";

/// The clip, and the windows chosen in it: the same for all.
static MADE: OnceLock<(Materials, Synth)> = OnceLock::new();

/// A scene with nothing but a layer of which this is set, seen by this camera.
fn seen(set: &Value, camera: Value) -> Synth {
    let (materials, before) = MADE.get_or_init(|| {
        let materials = loaded();
        let synth = synth(&scene(&json!({}), json!({})), &materials, None).unwrap();
        (materials, synth)
    });
    synth(&scene(set, camera), materials, Some(before)).unwrap()
}

fn loaded() -> Materials {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/falls/falls.plica.json");
    let scene = scene(&json!({}), json!({}));
    materials::load(&path, &scene, &Options::default(), &mut materials::Cache::default()).unwrap().0
}

fn scene(set: &Value, camera: Value) -> Scene {
    let mut layer = json!({ "kind": "waterfall", "name": "falls", "clip": "water" });
    layer.as_object_mut().unwrap().extend(set.as_object().unwrap().clone());
    let scene = json!({
        "plica": 1, "size": [SIZE.0, SIZE.1], "timeline": { "duration": 1, "fps": 30 }, "camera": camera, "background": DARK,
        "clips": { "water": { "path": "water-%04d.png" } }, "layers": [layer],
    });
    serde_json::from_value(scene).unwrap()
}

fn plain(set: Value) -> Synth {
    seen(&set, json!({}))
}

fn own(synth: &Synth) -> &Own {
    synth.layers[0].downcast().unwrap()
}

/// The brightness of a frame as the eye sees it, row by row.
fn light(synth: &Synth, t: f64) -> Vec<f64> {
    let brightness = |[r, g, b, _]: &[u8; 4]| (f64::from(*r) + f64::from(*g) + f64::from(*b)) / 3.0;
    cpu::frame(synth, t).cells().iter().map(brightness).collect()
}

fn on<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

/// The share of numbers that are larger than `most`, and the largest.
fn changes(a: &Frame, b: &Frame, most: u8) -> (f64, u8) {
    let far = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
    let far: Vec<u8> = a.cells().iter().zip(b.cells()).map(far).collect();
    let above = far.iter().filter(|far| **far > most).count();
    (above as f64 / far.len() as f64, far.into_iter().max().unwrap_or(0))
}

#[test]
fn w6_windows_are_no_more_than_the_law_allows_and_all_distinct() {
    let synth = plain(json!({ "sprites": { "growth": { "max": 9 } } }));
    let windows = own(&synth).pictures.tracks.iter().map(|track| {
        assert_eq!(track.source, Source::Auto);
        track.keys[0].window.unwrap()
    });
    let mut windows: Vec<_> = windows.collect();
    let taken = windows.len();
    windows.sort_unstable();
    windows.dedup();
    assert!((1..=9).contains(&taken) && windows.len() == taken, "{taken} windows, {} of them distinct", windows.len());
}

#[test]
fn w7_keys_left_out_are_made_again_no_worse_than_by_a_fade() {
    let synth = plain(json!({}));
    let own = own(&synth);
    let errors = [Tangents::Zero, Tangents::Advect, Tangents::Catmull].map(|tangents| {
        let between = Between { tangents, noise: 0.0, ..Between::default() };
        let (mut sum, mut out, side) = (0.0, Vec::new(), own.pictures.side);
        for (track, of) in own.pictures.tracks.iter().enumerate() {
            let even: Vec<KeyPlace> = (0..of.keys.len()).step_by(2).map(|key| (track, key)).collect();
            for i in 0..even.len() - 1 {
                let mix = mix(&between, &even, (i, 0.5), |_| DVec2::Y);
                texels((&own.pictures, &own.residues), &mix, 0, 0..side, &mut out);
                let left_out = own.pictures.key((track, 2 * i + 1)).texels(0);
                let far = |(a, b): (&Rgba, Rgba)| (0..4).map(|c| powi(f64::from(a[c] - b[c]), 2)).sum::<f64>();
                sum += out.iter().zip(left_out).map(far).sum::<f64>();
            }
        }
        sum.sqrt()
    });
    let [fade, advect, catmull] = errors;
    assert!(fade > 0.0 && advect <= 1.005 * fade && catmull <= 1.02 * fade, "{errors:?}");
}

#[test]
fn w8_nothing_pops_from_one_instant_to_the_next() {
    let synth = plain(json!({}));
    for t in [0.0, 0.31] {
        let [a, b] = [t, t + 1.0 / 6000.0].map(|t| cpu::frame(&synth, t));
        let (above, most) = changes(&a, &b, 2);
        assert!(most <= 12 && above <= 0.001, "at {t}: up to {most}, {above} above 2");
    }
}

/// Where the middle of a fall is: columns and rows of a frame.
const MIDDLE: [std::ops::Range<usize>; 2] = [66..126, 50..74];

#[test]
fn w9_the_picture_moves_as_the_sprites_do() {
    // Upright sprites of one kind, so that nothing else moves in these rows.
    let synth = plain(json!({ "foam": { "lines": 0 } }));
    let each = 1.0 / 60.0;
    let (mut wanted, mut moved, mut weight) = (DVec2::ZERO, DVec2::ZERO, 0.0);
    for t in [0.05, 0.25, 0.45, 0.65, 0.85] {
        let [before, after] = [t - each / 2.0, t + each / 2.0].map(|t| light(&synth, t));
        moved += flow(&before, &after) / 5.0;
        let moment = synth.moment(t);
        let eye = moment.eye.unwrap();
        let own = own(&synth);
        for splat in splats(own, &moment) {
            let is_in = |at: f64, range: &std::ops::Range<usize>| range.contains(&(at as usize));
            if is_in(splat.middle.x, &MIDDLE[0]) && is_in(splat.middle.y, &MIDDLE[1]) {
                let velocity = eye.turn * own.values.laws.at(&own.lines[splat.line as usize].path, splat.alive.age).1;
                let here = splat.opacity * splat.size_px.x * splat.size_px.y;
                let scale = eye.focal_px / splat.depth * each;
                wanted += DVec2::new(velocity.x, -velocity.y) * scale * here;
                weight += here;
            }
        }
    }
    wanted /= weight;
    let (speed, turn) = (moved.length() / wanted.length(), moved.angle_to(wanted).to_degrees().abs());
    assert!((speed - 1.0).abs() <= 0.1 && turn <= 5.0, "moved {moved}, wanted {wanted}");
}

/// How far the middle of a picture has moved, in pixels: by Lucas and Kanade's method, from a first guess by whole pixels.
fn flow(before: &[f64], after: &[f64]) -> DVec2 {
    let at = |picture: &[f64], x: f64, y: f64| {
        let (i, j) = (x.floor(), y.floor());
        let cell = |i: f64, j: f64| picture[j as usize * SIZE.0 + i as usize];
        let row = |j: f64| cell(i, j) + (cell(i + 1.0, j) - cell(i, j)) * (x - i);
        row(j) + (row(j + 1.0) - row(j)) * (y - j)
    };
    let cells = || MIDDLE[1].clone().flat_map(|y| MIDDLE[0].clone().map(move |x| (x as f64, y as f64)));
    let far =
        |dy: i32| -> f64 { cells().map(|(x, y)| powi(at(after, x, y + f64::from(dy)) - at(before, x, y), 2)).sum() };
    let first = (0..9).min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap();
    let mut moved = DVec2::new(0.0, f64::from(first));
    for _ in 0..20 {
        let (mut square, mut mixed, mut other, mut sum) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for (x, y) in cells() {
            let slope = |dx: f64, dy: f64| (at(before, x + dx, y + dy) - at(before, x - dx, y - dy)) / 2.0;
            let (right, down) = (slope(1.0, 0.0), slope(0.0, 1.0));
            let rest = at(before, x, y) - at(after, x + moved.x, y + moved.y);
            square += right * right;
            mixed += right * down;
            other += down * down;
            sum += DVec2::new(right, down) * rest;
        }
        let whole = square * other - mixed * mixed;
        moved += DVec2::new(other * sum.x - mixed * sum.y, square * sum.y - mixed * sum.x) / whole;
    }
    moved
}

#[test]
fn w10_light_adds_up_in_any_order() {
    let synth = plain(json!({}));
    let (own, moment) = (own(&synth), synth.moment(0.4));
    let rows: Vec<usize> = (0..SIZE.1).collect();
    let mut all = splats(own, &moment);
    let mut drawn = || {
        let places = places(own, &moment, &rows, Columns::All);
        let (mut out, depth) = (vec![[0.01, 0.01, 0.01, 1.0]; SIZE.0 * SIZE.1], vec![f64::INFINITY; SIZE.0 * SIZE.1]);
        draw(own, &all, Canvas { places, depth: &depth, out: &mut out });
        // Any other order: every 1009th, round and round.
        all = (0..all.len()).map(|i| all[i * 1009 % all.len()].clone()).collect();
        out.into_iter().map(encode).collect::<Vec<_>>()
    };
    let [first, second] = [drawn(), drawn()];
    assert!(first.iter().any(|color| color[0] > 100));
    // Sums in single precision: a code may differ by one where light is halfway between two.
    let far = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|c| a[c].abs_diff(b[c])).max();
    let unequal: Vec<_> = first.iter().zip(&second).filter_map(far).filter(|far| *far > 0).collect();
    assert!(unequal.len() <= first.len() / 10_000 && unequal.iter().all(|far| *far == 1), "{unequal:?}");
}

#[test]
fn w11_what_falls_straight_looks_the_same_from_all_sides() {
    let point = json!({
        "lip": [{ "at": [0, 2, 0], "velocity": [0, 0, 0] }], "thickness": 0, "spread": 0, "scatter": [0, 0],
        "surge": { "sway": 0 }, "foam": { "lines": 0 },
    });
    let from = |azimuth: f64| {
        let position = [4.0 * sin(azimuth), 1.0, 4.0 * cos(azimuth)];
        cpu::frame(&seen(&point, json!({ "position": position, "target": [0, 1, 0] })), 0.4)
    };
    let first = from(0.0);
    assert!(first.cells().iter().any(|color| color[0] > 100));
    for eighth in 1..8 {
        assert!(from(TAU * f64::from(eighth) / 8.0) == first, "{eighth}");
    }
}

#[test]
fn w12_frames_are_the_same_on_any_threads_and_the_end_is_the_beginning() {
    let set = json!({ "foam": { "lines": 2 } });
    let first = plain(set.clone());
    let frame = |threads: usize, t: f64| on(threads, || cpu::frame(&first, t));
    assert!(frame(1, 0.4) == frame(2, 0.4));
    let other = synth(&scene(&set, json!({})), &loaded(), None).unwrap();
    assert!(on(2, || cpu::frame(&other, 0.4)) == frame(1, 0.4), "another run");
    assert!(frame(2, 0.0) == frame(1, 1.0), "the frame after the last");
    assert!(frame(2, 0.0) != frame(2, 0.4));
}

#[test]
fn w14_the_fall_has_streaks_and_clumps() {
    let light = light(&plain(json!({ "foam": { "lines": 0 } })), 0.4);
    let at = |x: usize, y: usize| light[y * SIZE.0 + x];
    let cells: Vec<(usize, usize)> = MIDDLE[1].clone().flat_map(|y| MIDDLE[0].clone().map(move |x| (x, y))).collect();
    let energy = |dx: usize, dy: usize| -> f64 {
        cells.iter().map(|&(x, y)| powi(at(x + dx, y + dy) - at(x - dx, y - dy), 2)).sum()
    };
    let ratio = energy(1, 0) / energy(0, 1);
    let mean = cells.iter().map(|&(x, y)| at(x, y)).sum::<f64>() / cells.len() as f64;
    let variance = cells.iter().map(|&(x, y)| powi(at(x, y) - mean, 2)).sum::<f64>() / cells.len() as f64;
    let contrast = variance.sqrt() / mean;
    assert!(ratio >= 3.0 && (0.15..=0.35).contains(&contrast), "ratio {ratio}, contrast {contrast}");
}
