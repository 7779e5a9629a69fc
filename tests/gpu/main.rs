//! The GPU shows what the CPU shows: every pixel within 2/255, except for at most 0.1 % on silhouette edges, where
//! single precision may fall on the other side. Runs on Mesa's software driver as well. If there is no adapter the
//! reason is printed; in CI that is a failure.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]
#![cfg(feature = "window")]

mod examples;
mod shaders;
mod strokes;
mod view_maps;

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
use plica::layers::mesh::slots::Surface;
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

/// The variants of a tagged type of the document, from its schema.
fn variants<T: schemars::JsonSchema>(tag: &str) -> BTreeSet<String> {
    let schema = Value::from(schemars::schema_for!(T));
    let variant = |branch: &Value| branch["properties"][tag]["const"].as_str().unwrap().to_owned();
    schema["oneOf"].as_array().unwrap().iter().map(variant).collect()
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
    for rule in variants::<Fold>("rule") {
        assert!(scenes.iter().any(|(name, _)| *name == rule), "no scene folds by {rule}");
    }
    assert!(WITHOUT_SILHOUETTES.iter().all(|name| scenes.iter().any(|(known, _)| known == name)));
    for (name, synth) in &scenes {
        TIMES.into_iter().for_each(|time| check(&mut gpu, name, synth, time));
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
