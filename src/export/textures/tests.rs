//! A player that reads nothing but the written files shows what `render` shows, under every rule.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::base::pixels::{Frame, Linear, decode, encode, over};
use crate::files::outputs::Guard;
use crate::layers::Materials;
use crate::render;

/// A texture as read from its file: numbers, by the codes that the manifest gives.
struct Read {
    width: usize,
    values: Vec<[f64; 4]>,
}

impl Read {
    fn new(dir: &Path, note: &Value) -> Self {
        let file = dir.join(note["file"].as_str().unwrap());
        let image = image::open(&file).unwrap();
        let floats: Vec<[f64; 4]> = match note["bits"].as_u64().unwrap() {
            32 => image.to_rgba32f().pixels().map(|p| p.0.map(f64::from)).collect(),
            16 => image.to_rgba16().pixels().map(|p| p.0.map(f64::from)).collect(),
            _ => image.to_rgba8().pixels().map(|p| p.0.map(f64::from)).collect(),
        };
        let channels = note["channels"].as_array().unwrap();
        let value = |i: usize, code: f64| match channels.get(i) {
            Some(c) if c["zero"].is_number() => {
                let number = |name: &str| c[name].as_f64().unwrap();
                (code - number("zero")) / (number("one") - number("zero")) * number("scale")
            }
            _ => code,
        };
        let values = floats.into_iter().map(|p| std::array::from_fn(|i| value(i, p[i]))).collect();
        assert_eq!(
            (image.width() as u64, image.height() as u64),
            (number(note, "width") as u64, number(note, "height") as u64)
        );
        Read { width: image.width() as usize, values }
    }

    fn at(&self, x: usize, y: usize) -> [f64; 4] {
        self.values[y * self.width + x]
    }
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

fn index(value: &Value, name: &str) -> usize {
    number(value, name) as usize
}

/// The player.
struct Player {
    manifest: Value,
    colour: Linear,
    function: Read,
    /// The zones of each layer.
    zones: Vec<Vec<Played>>,
}

/// A zone: its note in the manifest, and its textures.
struct Played {
    note: Value,
    init: Read,
    jump: Read,
    thresholds: Option<Read>,
}

impl Player {
    fn open(dir: &Path) -> Self {
        let manifest: Value = serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap();
        assert_eq!(manifest["plica_textures"], 1);
        let image = image::open(dir.join(manifest["colour"]["file"].as_str().unwrap())).unwrap().to_rgba8();
        let cells = image.pixels().map(|p| decode(p.0)).collect();
        let colour = Grid::from_cells(image.width() as usize, image.height() as usize, cells);
        let zone = |zone: &Value| {
            let thresholds = zone["thresholds"].is_object().then(|| Read::new(dir, &zone["thresholds"]));
            let (init, jump) = (Read::new(dir, &zone["init"]), Read::new(dir, &zone["jump"]));
            Played { note: zone.clone(), init, jump, thresholds }
        };
        let layer = |layer: &Value| layer["zones"].as_array().unwrap().iter().map(zone).collect();
        let zones = manifest["layers"].as_array().unwrap().iter().map(layer).collect();
        Player { function: Read::new(dir, &manifest["function"]), manifest, colour, zones }
    }

    fn frame(&self, t: f64) -> Frame {
        let [width, height] = [0, 1].map(|i| self.manifest["size"][i].as_u64().unwrap() as usize);
        let mut frame = Grid::filled(width, height, [0.0; 4]);
        for (layer, zones) in self.manifest["layers"].as_array().unwrap().iter().zip(&self.zones) {
            let piece = self.piece(layer);
            let (w, h) = (index(piece, "width"), index(piece, "height"));
            let own = |i: usize| *self.colour.get(index(piece, "x") + i % w, index(piece, "y") + i / w);
            let mut shown: Linear = Grid::from_cells(w, h, (0..w * h).map(own).collect());
            for zone in zones {
                self.zone(zone, t, &mut shown);
            }
            for y in 0..h.min(height) {
                for x in 0..w.min(width) {
                    let beneath = &mut frame.cells_mut()[y * width + x];
                    *beneath = over(*shown.get(x, y), *beneath);
                }
            }
        }
        Grid::from_cells(width, height, frame.cells().iter().map(|&c| encode(c)).collect())
    }

    fn piece(&self, of: &Value) -> &Value {
        &self.manifest["colour"]["pieces"][index(of, "piece")]
    }

    fn zone(&self, Played { note: zone, init, jump, thresholds }: &Played, t: f64, shown: &mut Linear) {
        let bounds = &zone["box"];
        let (x0, y0, w, h) = (index(bounds, "x"), index(bounds, "y"), index(bounds, "width"), index(bounds, "height"));
        let columns = shown.width();
        let rows = index(&self.manifest["function"], "height") as f64;
        let (piece, rule, speed) = (self.piece(zone), zone["rule"].as_str().unwrap(), number(zone, "speed"));
        let slot_ends = thresholds.as_ref().map(|_| {
            let slots = &zone["thresholds"]["slots"];
            (1 + index(slots, "ahead"), 1 + index(slots, "ahead") + index(slots, "behind"))
        });
        let mut known = None;
        for (x, y) in (0..w * h).map(|i| (i % w, i / w)) {
            let [u, v, shift, row] = init.at(x, y);
            if row == 0.0 {
                continue;
            }
            // One zone has one shift and one row.
            let s = *known.get_or_insert_with(|| self.s(zone, (row * rows) as usize, speed * (t + shift)));
            let [jx, jy, s0, s1] = jump.at(x, y);
            let slots = thresholds.as_ref().zip(slot_ends).map(|(texture, (ahead, behind))| {
                let slot = |n: usize| texture.at(x, y + n / 4 * h)[n % 4];
                let side = if s < 0.0 { ahead..behind } else { 1..ahead };
                (slot(0), side.map(slot).collect::<Vec<f64>>(), number(&zone["thresholds"], "tolerance"))
            });
            let Some(e) = effective(rule, s, (s0, s1), slots) else { continue };
            let read = self.read(piece, u + e * jx, v + e * jy);
            let beneath = &mut shown.cells_mut()[(y0 + y) * columns + x0 + x];
            *beneath = if zone["lay"] == "over" { over(read, *beneath) } else { read };
        }
    }

    fn s(&self, zone: &Value, row: usize, x: f64) -> f64 {
        let part = x - x.floor();
        let tau = match zone["wrap"].as_str().unwrap() {
            "repeat" => part,
            "ping-pong" => 1.0 - (1.0 - 2.0 * part).abs(),
            _ => x.clamp(0.0, 1.0),
        };
        let last = self.function.width - 1;
        let place = tau * last as f64;
        let i = (place.floor() as usize).min(last - 1);
        let breaks = zone["breaks"].as_array().unwrap();
        let s = |column: usize| self.function.at(column, row)[0];
        let within = breaks.iter().find(|b| (i as f64..=(i + 1) as f64).contains(&(number(b, "tau") * last as f64)));
        let before = |b: &Value| tau < number(b, "tau") || (tau == number(b, "tau") && b["holds"] == "before");
        let from = match within {
            None => i,
            Some(b) if before(b) && i == 0 => return s(0),
            Some(b) if before(b) => i - 1,
            Some(_) if i + 1 == last => return s(last),
            Some(_) => i + 1,
        };
        s(from) + (s(from + 1) - s(from)) * (place - from as f64)
    }

    fn read(&self, piece: &Value, u: f64, v: f64) -> [f32; 4] {
        let clamp = |at: f64, first: &str, side: &str| {
            at.clamp(number(piece, first) + 0.5, number(piece, first) + number(piece, side) - 0.5)
        };
        let x = clamp(u * self.colour.width() as f64, "x", "width");
        let y = clamp(v * self.colour.height() as f64, "y", "height");
        self.colour.read(x, y, Beyond::Clamp)
    }
}

fn effective(rule: &str, s: f64, (s0, s1): (f64, f64), slots: Option<(f64, Vec<f64>, f64)>) -> Option<f64> {
    if rule == "none" || rule == "mask" {
        return Some(s);
    }
    let Some((inside, crossings, tolerance)) = slots else {
        let at = s.clamp(0.0, 1.0);
        let active = if at == 0.0 { s0 == 0.0 && s1 > 0.0 } else { s0 + TOLERANCE < at && at <= s1 + TOLERANCE };
        return active.then_some(s);
    };
    let passed = crossings.iter().take_while(|c| s.abs() > c.abs() + tolerance).count();
    let inside = (inside > 0.5) ^ (passed % 2 == 1);
    match rule {
        "return" => (!inside).then_some(s),
        "fly-over" => inside.then_some(s),
        "cover" if inside => passed.checked_sub(1).map(|last| crossings[last]),
        _ => Some(s),
    }
}

fn materials() -> Materials {
    let smooth = |x: usize, y: usize, k: usize| {
        let wave = |a: usize| {
            ((a * 37 % 256) as f64 / 255.0 * 0.1 + 0.45 + 0.4 * crate::base::maths::sin(a as f64 / 9.0)) * 255.0
        };
        [wave(x + k) as u8, wave(y + 2 * k) as u8, wave(x + y + 5 * k) as u8, 255]
    };
    let picture = |w: usize, h: usize, alpha: &dyn Fn(usize, usize) -> u8, k: usize| {
        let cell = |i: usize| {
            let [r, g, b, _] = smooth(i % w, i / w, k);
            [r, g, b, alpha(i % w, i / w)]
        };
        Arc::new(Frame::from_cells(w, h, (0..w * h).map(cell).collect()).to_linear().into())
    };
    let hole = |x: usize, y: usize| if x.abs_diff(45) + y.abs_diff(30) < 15 { 0 } else { 255 };
    Materials {
        pictures: [
            ("cat".to_owned(), picture(80, 60, &|_, _| 255, 0)),
            ("mask".to_owned(), picture(80, 60, &hole, 0)),
            ("other".to_owned(), picture(31, 23, &|x, _| if x < 10 { 200 } else { 255 }, 40)),
        ]
        .into(),
        ..Materials::default()
    }
}

fn zone(extra: Value) -> Value {
    let mut zone = json!({
        "name": "zone", "outline": { "kind": "ellipse", "center": [40, 30], "radii": [25, 20] },
        "motion": [{ "tool": "point", "at": [40, 30], "jump": [18, -11.3] }, { "tool": "still-border", "spacing": 5 }],
        "interpolation": { "method": "shepard", "power": 1.5 }
    });
    for (name, value) in extra.as_object().unwrap() {
        zone[name] = value.clone();
    }
    zone
}

fn scene(wrap: &str, zones: Vec<Value>) -> Scene {
    serde_json::from_value(json!({
        "plica": 1, "title": "Test", "timeline": { "duration": 1.0, "fps": 12, "loop": wrap },
        "images": { "cat": { "path": "cat.png" }, "mask": { "path": "m.png" }, "other": { "path": "o.png" } },
        "layers": [{ "kind": "picture", "name": "face", "image": "cat", "zones": zones }]
    }))
    .unwrap()
}

fn regions() -> Value {
    json!([{ "kind": "rectangle", "x": 38, "y": 10, "width": 9.5, "height": 40 }, { "kind": "ellipse", "center": [55, 25], "radii": [4, 6] }])
}

/// Scenes of every rule, with functions that go back and forth, overshoot, turn back below 0 and teleport.
fn scenes() -> Vec<(&'static str, Scene)> {
    let fold = |rule: &str| json!({ "rule": rule, "regions": regions() });
    let sine = json!({ "function": "sine", "cycles": 1.0, "amplitude": 1.4 });
    let teleport = json!({ "function": "piecewise", "segments": [
        { "until": 0.5, "from": 0.0, "to": 1.0 }, { "until": 1.0, "from": -0.5, "to": 0.5, "ease": { "function": "sigmoid" } }] });
    let steps = json!({ "function": "keyframes", "between": "step", "points": [[0.1, 0.2], [0.5, 1.3], [0.75, 0.0]] });
    vec![
        ("none", scene("repeat", vec![zone(json!({ "feather": 4.0, "speed": 2.0, "shift": 0.1 }))])),
        ("cover", scene("repeat", vec![zone(json!({ "fold": fold("cover") }))])),
        (
            "cover there and back",
            scene("ping-pong", vec![zone(json!({ "fold": fold("cover"), "position": sine.clone() }))]),
        ),
        ("return", scene("once", vec![zone(json!({ "fold": fold("return"), "position": { "function": "cosine" } }))])),
        ("return overshooting", scene("repeat", vec![zone(json!({ "fold": fold("return"), "position": sine }))])),
        (
            "fly-over",
            scene("repeat", vec![zone(json!({ "fold": fold("fly-over"), "position": teleport, "speed": -1.0 }))]),
        ),
        (
            "mask",
            scene("repeat", vec![zone(json!({ "fold": { "rule": "mask", "image": "mask" }, "position": steps }))]),
        ),
        (
            "sampler image over another zone",
            scene(
                "repeat",
                vec![
                    zone(json!({})),
                    zone(
                        json!({ "name": "Second/zone", "sampler": { "image": "other", "offset": [-30.25, -20] }, "fold": fold("fly-over") }),
                    ),
                ],
            ),
        ),
        ("no zones", scene("repeat", vec![])),
    ]
}

fn place(dir: &Path) -> FolderPlace {
    Guard::new(false).folder(dir, &|_| true, earlier(dir)).unwrap()
}

fn written(scene: &Scene, materials: &Materials, depth: Depth) -> (tempfile::TempDir, Synth) {
    let dir = tempfile::tempdir().unwrap();
    let synth = render::synth(scene, materials, None).unwrap();
    write(scene, &synth, depth, &place(&dir.path().join("out")), &mut |_, _| Ok(())).unwrap();
    (dir, synth)
}

/// The largest difference of a channel, and how many pixels differ by more than `bound`.
fn compare(a: &Frame, b: &Frame, bound: u8) -> (u8, usize) {
    let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|i| a[i].abs_diff(b[i])).max().unwrap();
    let offs: Vec<u8> = a.cells().iter().zip(b.cells()).map(off).collect();
    (*offs.iter().max().unwrap(), offs.iter().filter(|&&o| o > bound).count())
}

#[test]
fn a_player_of_the_exact_form_shows_what_render_shows() {
    let materials = materials();
    for (name, scene) in scenes() {
        let (dir, synth) = written(&scene, &materials, Depth::Float);
        let player = Player::open(&dir.path().join("out"));
        for k in [0, 3, 6, 7, 10, 11] {
            let t = scene.timeline.time_of(k);
            let (worst, _) = compare(&render::cpu::frame(&synth, t), &player.frame(t), 2);
            assert!(worst <= 2, "{name}: frame {k} differs by {worst}");
        }
    }
}

#[test]
fn a_player_of_rounded_forms_is_near() {
    let materials = materials();
    for (depth, bound, share) in [(Depth::Sixteen, 3, 50), (Depth::Eight, 40, 10)] {
        for (name, scene) in scenes() {
            let (dir, synth) = written(&scene, &materials, depth);
            let player = Player::open(&dir.path().join("out"));
            let (_, far) = compare(&render::cpu::frame(&synth, 0.25), &player.frame(0.25), bound);
            assert!(far <= 80 * 60 / share, "{name} {depth:?}: {far} pixels are more than {bound} off");
        }
    }
}

#[test]
fn names_are_plain_and_nothing_else_is_left() {
    let (dir, _) = written(&scenes()[7].1, &materials(), Depth::Float);
    let mut names: Vec<_> = std::fs::read_dir(dir.path().join("out"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let wanted = [
        "Second-zone-init.exr",
        "Second-zone-jump.exr",
        "Second-zone-thresholds.exr",
        "colour.png",
        "function.exr",
        "manifest.json",
        "zone-init.exr",
        "zone-jump.exr",
    ];
    assert_eq!(names, wanted);
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn an_interrupt_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let scene = &scenes()[7].1;
    let synth = render::synth(scene, &materials(), None).unwrap();
    let mut step = |done, _| if done == 1 { Err(Error::Interrupted) } else { Ok(()) };
    assert!(write(scene, &synth, Depth::Float, &place(&dir.path().join("out")), &mut step).is_err());
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn pieces_are_cropped_to_what_is_reached() {
    let (dir, _) = written(&scenes()[7].1, &materials(), Depth::Float);
    let player = Player::open(&dir.path().join("out"));
    let pieces = player.manifest["colour"]["pieces"].as_array().unwrap();
    assert_eq!((pieces.len(), index(&pieces[0], "width"), index(&pieces[0], "height")), (2, 80, 60));
    assert!(index(&pieces[1], "width") <= 33 && index(&pieces[1], "height") <= 25, "{}", pieces[1]);
}
