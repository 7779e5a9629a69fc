//! A player of the textures, written from the pseudo-code in docs/textures.md and nothing else: it uses none of the
//! prose in the manifest and no code of the program that wrote the files. Its frames are compared with those of
//! `render`, for every rule and every position function.

#![allow(clippy::unwrap_used, reason = "a test fails where its helpers do")]

#[path = "player/scenes.rs"]
mod scenes;

use std::path::Path;

use plica::base::pixels::Frame;
use plica::export::textures::{Depth, write};
use plica::layers::folding::{fold::Fold, position::Position};
use plica::render;
use serde_json::Value;

type Rgba = [f64; 4];

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

fn index(value: &Value, name: &str) -> usize {
    number(value, name) as usize
}

/// A data texture, its codes converted to values.
struct Texture {
    width: usize,
    texels: Vec<Rgba>,
}

impl Texture {
    fn read(dir: &Path, note: &Value) -> Texture {
        let image = image::open(dir.join(note["file"].as_str().unwrap())).unwrap();
        let codes: Vec<Rgba> = match index(note, "bits") {
            32 => image.to_rgba32f().pixels().map(|p| p.0.map(f64::from)).collect(),
            16 => image.to_rgba16().pixels().map(|p| p.0.map(f64::from)).collect(),
            _ => image.to_rgba8().pixels().map(|p| p.0.map(f64::from)).collect(),
        };
        let channels = note["channels"].as_array().unwrap();
        let value = |texel: Rgba| {
            std::array::from_fn(|i| match channels.iter().find(|c| c["channel"] == ["R", "G", "B", "A"][i]) {
                Some(c) if index(note, "bits") < 32 => {
                    (texel[i] - number(c, "zero")) / (number(c, "one") - number(c, "zero")) * number(c, "scale")
                }
                _ => texel[i],
            })
        };
        Texture { width: index(note, "width"), texels: codes.into_iter().map(value).collect() }
    }

    fn at(&self, x: usize, y: usize) -> Rgba {
        self.texels[y * self.width + x]
    }
}

fn linear(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { plica::base::maths::pow((c + 0.055) / 1.055, 2.4) }
}

fn code(light: f64) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let c = if light <= 0.0031308 { light * 12.92 } else { 1.055 * plica::base::maths::pow(light, 1.0 / 2.4) - 0.055 };
    (c * 255.0).round() as u8
}

fn over(a: Rgba, b: Rgba) -> Rgba {
    std::array::from_fn(|i| a[i] + b[i] * (1.0 - a[3]))
}

struct Zone {
    note: Value,
    init: Texture,
    jump: Texture,
    thresholds: Option<Texture>,
    /// How far off a rounded s0 or s1 may be.
    tolerance: f64,
}

struct Player {
    manifest: Value,
    atlas: Texture,
    function: Texture,
    layers: Vec<Vec<Zone>>,
    /// Whether places are computed from `origin` instead of the init texture.
    by_origin: bool,
}

impl Player {
    fn open(dir: &Path, by_origin: bool) -> Player {
        let manifest: Value = serde_json::from_slice(&std::fs::read(dir.join("manifest.json")).unwrap()).unwrap();
        assert_eq!(manifest["plica_textures"], 1);
        let colour = &manifest["colour"];
        let texels = match colour.get("float") {
            Some(float) => {
                let image = image::open(dir.join(float["file"].as_str().unwrap())).unwrap().to_rgba32f();
                image.pixels().map(|p| p.0.map(f64::from)).collect()
            }
            None => {
                let image = image::open(dir.join(colour["file"].as_str().unwrap())).unwrap().to_rgba8();
                let texel = |p: &image::Rgba<u8>| {
                    let [r, g, b, a] = p.0.map(|c| f64::from(c) / 255.0);
                    [linear(r) * a, linear(g) * a, linear(b) * a, a]
                };
                image.pixels().map(texel).collect()
            }
        };
        let atlas = Texture { width: index(colour, "width"), texels };
        let zone = |note: &Value| Zone {
            init: Texture::read(dir, &note["init"]),
            jump: Texture::read(dir, &note["jump"]),
            thresholds: note["thresholds"].is_object().then(|| Texture::read(dir, &note["thresholds"])),
            tolerance: number(&note["jump"]["channels"][2], "error").max(1e-6),
            note: note.clone(),
        };
        let list = |value: &Value| value.as_array().unwrap().clone();
        let zones = |layer: Value| list(&layer["zones"]).iter().map(zone).collect();
        let layers = list(&manifest["layers"]).into_iter().map(zones).collect();
        Player { layers, function: Texture::read(dir, &manifest["function"]), atlas, manifest, by_origin }
    }

    /// s of a zone at the time of frame `k`, which may have a fraction.
    fn s_at(&self, zone: &Value, k: f64) -> f64 {
        let frames = number(&self.manifest, "frames");
        let once = self.manifest["timeline"]["loop"] == "once";
        let t = if once { k / (frames - 1.0).max(1.0) } else { k / frames };
        let x = number(zone, "speed") * (t + number(zone, "shift"));
        let tau = match zone["wrap"].as_str().unwrap() {
            "repeat" => x - x.floor(),
            "ping-pong" => 1.0 - (1.0 - 2.0 * (x - x.floor())).abs(),
            _ => x.clamp(0.0, 1.0),
        };
        self.s(zone, tau)
    }

    fn s(&self, zone: &Value, tau: f64) -> f64 {
        let n = self.function.width - 1;
        let i = ((tau * n as f64).floor() as usize).min(n - 1);
        let place = |i: usize| (i as f64 / n as f64, self.function.at(i, index(zone, "row"))[0]);
        let (mut left, mut right) = (place(i), place(i + 1));
        for knot in zone["knots"].as_array().unwrap() {
            let [t, before, at, after] = [0, 1, 2, 3].map(|k| knot[k].as_f64().unwrap());
            if t < i as f64 / n as f64 {
                continue;
            }
            if t == tau {
                return at;
            }
            if t < tau {
                left = (t, after);
            } else {
                if t <= right.0 {
                    right = (t, before);
                }
                break;
            }
        }
        left.1 + (right.1 - left.1) * (tau - left.0) / (right.0 - left.0)
    }

    fn bilinear(&self, piece: &Value, x: f64, y: f64) -> Rgba {
        let clamp = |at: f64, from: &str, side: &str| {
            at.clamp(number(piece, from) + 0.5, number(piece, from) + number(piece, side) - 0.5)
        };
        let (x, y) = (clamp(x, "x", "width") - 0.5, clamp(y, "y", "height") - 0.5);
        let (i, j) = (x.floor() as usize, y.floor() as usize);
        let (wx, wy) = (x - x.floor(), y - y.floor());
        let last = self.atlas.texels.len() / self.atlas.width - 1;
        let texel = |dx: usize, dy: usize| self.atlas.at((i + dx).min(self.atlas.width - 1), (j + dy).min(last));
        let (a, b, c, d) = (texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1));
        std::array::from_fn(|k| (a[k] * (1.0 - wx) + b[k] * wx) * (1.0 - wy) + (c[k] * (1.0 - wx) + d[k] * wx) * wy)
    }

    fn effective(zone: &Zone, x: usize, y: usize, [.., s0, s1]: Rgba, s: f64) -> Option<f64> {
        let rule = zone.note["rule"].as_str().unwrap();
        if rule == "none" || rule == "mask" {
            return Some(s);
        }
        let Some(texture) = &zone.thresholds else {
            let (at, tolerance) = (s.clamp(0.0, 1.0), zone.tolerance);
            let active = if at == 0.0 { s0 == 0.0 && s1 > 0.0 } else { s0 + tolerance < at && at <= s1 + tolerance };
            return active.then_some(s);
        };
        let note = &zone.note["thresholds"];
        let slot = |m: usize| texture.at(x, y + index(&zone.note["box"], "height") * (m / 4))[m % 4];
        let (ahead, behind) = (index(&note["slots"], "ahead"), index(&note["slots"], "behind"));
        let slots = if s >= 0.0 { 1..=ahead } else { ahead + 1..=ahead + behind };
        let passed: Vec<f64> = slots.map(slot).take_while(|c| s.abs() > c.abs() + number(note, "tolerance")).collect();
        let inside = (slot(0) > 0.5) != (passed.len() % 2 == 1);
        match (rule, inside) {
            ("return" | "cover", false) | ("fly-over", true) => Some(s),
            ("cover", true) => passed.last().copied(),
            _ => None,
        }
    }

    fn pixel(&self, zone: &Zone, (x, y): (usize, usize), s: f64, beneath: Rgba) -> Rgba {
        let (init, jump) = (zone.init.at(x, y), zone.jump.at(x, y));
        if init[3] == 0.0 {
            return beneath;
        }
        let Some(e) = Player::effective(zone, x, y, jump, s) else { return beneath };
        let (width, height) = (number(&self.manifest["colour"], "width"), number(&self.manifest["colour"], "height"));
        let origin = |i: usize| zone.note["origin"][i].as_f64().unwrap();
        let (px, py) = match self.by_origin {
            true => (origin(0) + x as f64, origin(1) + y as f64),
            false => (init[0] * width, init[1] * height),
        };
        let piece = &self.manifest["colour"]["pieces"][index(&zone.note, "piece")];
        let read = self.bilinear(piece, px + e * jump[0] * width, py + e * jump[1] * height);
        if zone.note["lay"] == "replace" { read } else { over(read, beneath) }
    }

    fn frame(&self, k: f64) -> Frame {
        let [width, height] = [0, 1].map(|i| self.manifest["size"][i].as_u64().unwrap() as usize);
        let mut frame = vec![[0.0; 4]; width * height];
        for (layer, zones) in self.manifest["layers"].as_array().unwrap().iter().zip(&self.layers) {
            let piece = &self.manifest["colour"]["pieces"][index(layer, "piece")];
            let (w, h) = (index(piece, "width"), index(piece, "height"));
            let texel = |i: usize| self.atlas.at(index(piece, "x") + i % w, index(piece, "y") + i / w);
            let mut picture: Vec<Rgba> = (0..w * h).map(texel).collect();
            for zone in zones {
                let s = self.s_at(&zone.note, k);
                let bounds = &zone.note["box"];
                for y in 0..index(bounds, "height") {
                    for x in 0..index(bounds, "width") {
                        let at = (index(bounds, "y") + y) * w + index(bounds, "x") + x;
                        picture[at] = self.pixel(zone, (x, y), s, picture[at]);
                    }
                }
            }
            for (x, y) in (0..w.min(width) * h.min(height)).map(|i| (i % w.min(width), i / w.min(width))) {
                frame[y * width + x] = over(picture[y * w + x], frame[y * width + x]);
            }
        }
        let encoded = |[r, g, b, a]: Rgba| match a {
            a if a <= 0.0 => [0; 4],
            a => [code(r / a), code(g / a), code(b / a), (a * 255.0).round() as u8],
        };
        Frame::from_cells(width, height, frame.into_iter().map(encoded).collect())
    }
}

/// How many pixels of a frame differ by more than `bound` in a channel, at time `k / frames` of scene `at`.
fn far(case: &scenes::Case, depth: Depth, by_origin: bool, ks: &[f64], bound: u8) -> usize {
    let dir = tempfile::tempdir().unwrap();
    let synth = render::synth(&case.scene, &case.materials, None).unwrap();
    let out = dir.path().join("out");
    let place = plica::files::outputs::Guard::new(false).folder(&out, &|_| true, Default::default()).unwrap();
    write(&case.scene, &synth, depth.into(), &place, &mut |_, _| Ok(())).unwrap();
    let player = Player::open(&out, by_origin);
    let differ = |&k: &f64| {
        let n = case.scene.timeline.frames() as f64;
        let t = if case.scene.timeline.wrap == plica::layers::timeline::Wrap::Once { k / (n - 1.0) } else { k / n };
        let (wanted, got) = (render::cpu::frame(&synth, t), player.frame(k));
        assert_eq!((wanted.width(), wanted.height()), (got.width(), got.height()));
        let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|i| a[i].abs_diff(b[i])).max().unwrap();
        wanted.cells().iter().zip(got.cells()).map(off).filter(|&off| off > bound).count()
    };
    ks.iter().map(differ).max().unwrap()
}

const TIMES: [f64; 9] = [0.0, 1.0, 3.6, 3.6005, 5.3, 6.0, 7.2, 10.0, 11.9993];

#[test]
fn every_position_function_plays() {
    let cases = scenes::functions();
    for function in scenes::variants::<Position>("function") {
        assert!(cases.iter().any(|case| case.name.contains(&format!("\"{function}\""))), "no scene with {function}");
    }
    for case in cases {
        let far = far(&case, Depth::Float, false, &TIMES, 2);
        assert!(far * 1000 <= 80 * 60, "{}: {far} pixels", case.name);
    }
}

#[test]
fn every_rule_and_several_layers_play() {
    let cases = scenes::rules();
    for rule in scenes::variants::<Fold>("rule") {
        assert!(cases.iter().any(|case| case.name.starts_with(&rule)), "no scene folds by {rule}");
    }
    for case in cases {
        let far = far(&case, Depth::Float, false, &TIMES, 2);
        assert!(far * 1000 <= 80 * 60, "{}: {far} pixels", case.name);
    }
}

#[test]
fn rounded_forms_are_near_and_what_stands_still_is_still() {
    for case in scenes::rules() {
        for (depth, bound, share) in [(Depth::Sixteen, 3, 50), (Depth::Eight, 40, 10)] {
            let far = far(&case, depth, true, &[3.0], bound);
            assert!(far <= 80 * 60 / share, "{} {depth:?}: {far} pixels are more than {bound} off", case.name);
        }
    }
    let still = scenes::still();
    for (depth, by_origin) in [(Depth::Float, false), (Depth::Sixteen, true), (Depth::Eight, true)] {
        assert_eq!(far(&still, depth, by_origin, &[0.0, 5.0], 1), 0, "{depth:?}");
    }
}
