//! The demo scenes that ship, over pictures and meshes made by the project's own code. Besides small golden pictures there are
//! checks of what a fold means: the eyeball is covered, nothing moves outside the zones, no seam opens at a zone's
//! edge.
//!
//! `PLICA_UPDATE=1 cargo test --test profiles` rewrites pictures, meshes, golden frames and the layout of the scenes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::PathBuf;

use glam::DVec2;
use plica::base::pixels::Frame;
use plica::files::profiles;
use plica::layers::Layer;
use plica::layers::folding::synth::Synth;
use plica::render::seams;
use plica::scene::{Document, presets};
use show::{Show, TIMES, at, no_seam, step, still_outside};

#[path = "../profiles/draw/meshes/mod.rs"]
mod meshes;
#[path = "../profiles/draw/pictures/mod.rs"]
mod pictures;
mod show;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn shipped(name: &str) -> Show {
    // Some share pictures with another, so that no folder here has all files.
    let folder = tempfile::tempdir().unwrap();
    Show::open(&profiles::find(name).unwrap().unpack(folder.path()).unwrap())
}

fn updating() -> bool {
    std::env::var_os("PLICA_UPDATE").is_some()
}

#[test]
fn pictures_are_what_the_program_draws() {
    for (path, draw) in pictures::PICTURES {
        let file = root().join(path);
        let canvas = draw();
        if updating() {
            std::fs::write(&file, canvas.to_png().unwrap()).unwrap();
        }
        let drawn = canvas.to_bytes();
        let committed = image::open(&file).unwrap_or_else(|error| panic!("{path}: {error}"));
        let same = if drawn.1 {
            committed.to_rgb8().into_raw() == drawn.0
        } else {
            committed.to_rgba8().into_raw() == drawn.0
        };
        assert!(same, "{path} is not what its program draws: PLICA_UPDATE=1 draws it anew");
        assert!(std::fs::metadata(&file).unwrap().len() < 300_000, "{path} is large");
    }
}

#[test]
fn clips_are_what_the_program_draws() {
    for (pattern, count, draw) in pictures::CLIPS {
        for number in 0..*count {
            let (file, canvas) = (root().join(pictures::frame_file(pattern, number)), draw(number));
            if updating() {
                std::fs::write(&file, canvas.to_png().unwrap()).unwrap();
            }
            let committed = image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            assert!(
                committed.to_rgb8().into_raw() == canvas.to_bytes().0,
                "{}: PLICA_UPDATE=1 draws it anew",
                file.display()
            );
            assert!(std::fs::metadata(&file).unwrap().len() < 40_000, "{} is large", file.display());
        }
    }
}

#[test]
fn meshes_are_what_the_program_writes() {
    for (path, write) in meshes::MESHES {
        let (file, text) = (root().join(path), write());
        if updating() {
            std::fs::write(&file, &text).unwrap();
        }
        let committed = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(committed == text, "{path} is not what its program writes: PLICA_UPDATE=1 writes it anew");
    }
}

#[test]
fn shipped_scenes_are_written_as_the_program_writes_them() {
    for profile in profiles::TABLE {
        let file = root().join(format!("profiles/{0}/{0}.plica.json", profile.name));
        let text = std::fs::read_to_string(&file).unwrap();
        let own = Document::parse(&text).unwrap().to_text();
        if updating() {
            std::fs::write(&file, &own).unwrap();
        } else {
            assert!(text == own, "{}: saving it without an edit would change it", profile.name);
        }
    }
}

#[test]
fn the_demo_of_a_preset_is_the_default_layer_with_it() {
    for found in presets::all() {
        let name = found.preset.name;
        let text = std::fs::read_to_string(root().join(format!("profiles/{name}/{name}.plica.json"))).unwrap();
        let mut scene = Document::parse(&text).unwrap().json().clone();
        let layer = scene["layers"][0].as_object_mut().unwrap();
        layer.retain(|key, _| ["kind", "name", "clip"].contains(&key.as_str()));
        let plain = Document::from_json(scene).unwrap();
        let with = plain.apply(&found.apply(&plain, None).unwrap().edit).unwrap();
        assert_eq!(with.to_text(), text, "{name}");
    }
}

#[test]
fn shipped_frames_are_golden_and_no_loop_snaps() {
    for profile in profiles::TABLE {
        let show = shipped(profile.name);
        golden(profile.name, &show);
        let snaps = seams::warnings(show.document.scene(), &show.materials, || Some(&show.synth));
        assert!(snaps.is_empty(), "{}: {snaps:?}", profile.name);
    }
}

#[test]
fn shipped_scenes_are_still_outside_their_zones_and_have_no_seam() {
    for profile in profiles::TABLE {
        // In space there is no picture to compare with: its own scene is compared.
        let scene = profile.files().find(|(file, _)| *file == profile.scene_file()).unwrap().1;
        if Document::parse(std::str::from_utf8(scene).unwrap()).unwrap().scene().camera.is_none() {
            let show = shipped(profile.name);
            still_outside(profile.name, &show);
            no_seam(profile.name, &show);
        }
    }
}

/// Compares three frames, 64 pixels wide, with `tests/golden/NAME.png`.
fn golden(name: &str, show: &Show) {
    let (width, height) = show.synth.size;
    let small = (64, (64 * height / width) as u32);
    let mut strip = image::RgbaImage::new(64 * 3, small.1);
    for (i, time) in TIMES.into_iter().enumerate() {
        let frame = show.frame(time);
        let bytes = frame.cells().iter().flatten().copied().collect();
        let whole = image::RgbaImage::from_raw(width as u32, height as u32, bytes).unwrap();
        image::imageops::replace(&mut strip, &image::imageops::thumbnail(&whole, small.0, small.1), i as i64 * 64, 0);
    }
    let file = root().join(format!("tests/golden/{name}.png"));
    if updating() {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        strip.save(&file).unwrap();
    }
    let expected = image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).to_rgba8();
    assert_eq!(expected.dimensions(), strip.dimensions(), "{name}");
    let worst = expected.as_raw().iter().zip(strip.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    assert!(worst <= 1, "{name}: frames differ from tests/golden by {worst}: PLICA_UPDATE=1 writes them anew");
}

#[test]
fn the_lid_covers_the_pupil_and_gives_it_back() {
    let show = shipped("blink");
    let (open, closed) = (show.frame(0.0), show.frame(0.44));
    assert!(at(&open, 243, 190)[..3].iter().all(|&c| c < 40), "the pupil is black");
    // The color of the lid's skin, at its crown above the open eye.
    let skin = at(&show.still(), 243, 120);
    let lid = at(&closed, 243, 190);
    assert!(step(skin, lid) < 60, "at the closed time {lid:?} stands where the pupil was; skin is {skin:?}");
    // Nothing of the eyeball's blue or white is left between the lids.
    let (upper, lower) = (130..236, 200..290);
    let bluish = upper.flat_map(|y| lower.clone().map(move |x| (x, y))).filter(|&(x, y)| {
        let [r, _, b, _] = at(&closed, x, y);
        b > r.saturating_add(4)
    });
    assert_eq!(bluish.count(), 0, "some of the iris shows through the closed lid");
    assert!(show.frame(0.9) == open, "the eye ends as it began");
}

#[test]
fn the_lid_slides_over_an_eyeball_that_keeps_still() {
    let show = shipped("blink");
    let (still, half) = (show.still(), show.frame(0.372));
    // In the column of the pupil: skin of the lid down to its edge, and below it the eyeball unchanged.
    let same = |y: usize| at(&half, 243, y) == at(&still, 243, y);
    let edge = (140..237).rev().find(|&y| !same(y)).unwrap();
    assert!((160..225).contains(&edge), "half closed, the lid's edge is at {edge}");
    assert!((edge + 1..237).all(same));
    let dark = (edge - 9..=edge).any(|y| at(&half, 243, y)[0] < 70);
    assert!(dark, "the line of the lashes came along");
}

#[test]
fn the_cat_squints_with_both_eyes() {
    let show = shipped("cat");
    let green = |frame: &Frame, x0: usize| {
        let eye = (150..230).flat_map(|y| (x0..x0 + 100).map(move |x| (x, y)));
        eye.filter(|&(x, y)| at(frame, x, y)[1] > at(frame, x, y)[0].saturating_add(8)).count()
    };
    let (open, squint) = (show.frame(0.0), show.frame(0.34));
    for x0 in [120, 260] {
        let (before, after) = (green(&open, x0), green(&squint, x0));
        assert!(before > 800 && after * 10 < before * 7 && after > 0, "green pixels {before} -> {after}");
    }
}

#[test]
fn the_wound_closes() {
    let show = shipped("wound");
    let flesh = |frame: &Frame| frame.cells().iter().filter(|c| c[0] < 150 && c[1] < 45).count();
    let (open, closed) = (flesh(&show.frame(0.0)), flesh(&show.frame(0.5)));
    assert!(open > 4000 && closed * 2 < open, "flesh {open} -> {closed}");
    assert_eq!(show.layer().zones[0].anchors().len(), 62);
    let synth = show.synth.layers[0].downcast::<Synth>().unwrap();
    let folds = synth.zones[0].field.folds.as_ref().unwrap();
    let thresholds = |i: usize| folds.ahead.of(i).iter().filter(|&&s| s > 0.0 && s <= 1.0).count();
    let most = (0..folds.inside.cells().len()).map(thresholds).max();
    assert_eq!(most, Some(1), "one threshold a pixel");
}

#[test]
fn water_covers_the_sand() {
    let show = shipped("waves");
    let white = |frame: &Frame, x: usize| (180..330).rev().find(|&y| at(frame, x, y)[2] > 215).unwrap_or(0);
    let (low, high) = (show.frame(0.0), show.frame(0.42));
    for x in [60, 140, 240, 330, 420] {
        let (from, to) = (white(&low, x), white(&high, x));
        assert!(to > from + 30, "at {x} the foam goes from {from} to {to} only");
    }
    // Dry sand that the water does not reach keeps still.
    assert!((0..480).all(|x| at(&high, x, 335) == at(&low, x, 335)));
}

#[test]
fn the_pecs_bounce_in_turn() {
    let show = shipped("pecs");
    let still = show.still();
    let moved = |frame: &Frame, from: usize| {
        let half = (90..260).flat_map(|y| (from..from + 200).map(move |x| (x, y)));
        half.filter(|&(x, y)| step(at(frame, x, y), at(&still, x, y)) > 6).count()
    };
    let (left, right) = (show.frame(0.07), show.frame(0.57));
    assert!(moved(&left, 40) > 500 && moved(&left, 240) == 0);
    assert!(moved(&right, 240) > 500 && moved(&right, 40) == 0);
}

#[test]
fn the_car_flies_from_left_to_right_behind_the_sign() {
    let show = shipped("car");
    let still = show.still();
    let middle = |time: f64| {
        let frame = show.frame(time);
        let changed = (0..frame.cells().len()).filter(|&i| step(frame.cells()[i], still.cells()[i]) > 40);
        let columns: Vec<usize> = changed.map(|i| i % frame.width()).collect();
        columns.iter().sum::<usize>() / columns.len().max(1)
    };
    let places = [0.1, 0.3, 0.5, 0.8].map(middle);
    assert!(places.is_sorted() && places[3] > places[0] + 200, "{places:?}");
    // The sign is in front of it.
    let passing = show.frame(0.12);
    assert!((140..200).all(|y| at(&passing, 97, y) == at(&still, 97, y)));
}

/// Where the frame shows the pixel of a picture that is on the last layer, a mesh: of several places the nearest.
fn seen(show: &Show, time: f64, pixel: [f64; 2]) -> (f64, f64) {
    let scene = show.document.scene();
    let Layer::Mesh(layer) = scene.layers.last().unwrap() else { panic!("no mesh") };
    let (mesh, placed) = (&show.materials.meshes[&layer.mesh], layer.pose.at(time));
    let eye = scene.camera.as_ref().unwrap().at(time, show.synth.size);
    let picture = &show.materials.pictures[&show.layer().image];
    let uv = DVec2::new(pixel[0] / picture.width() as f64, 1.0 - pixel[1] / picture.height() as f64);
    let places = mesh.triangles.iter().filter_map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let whole = (b.uv - a.uv).perp_dot(c.uv - a.uv);
        let (of_b, of_c) = ((uv - a.uv).perp_dot(c.uv - a.uv) / whole, (b.uv - a.uv).perp_dot(uv - a.uv) / whole);
        let inside = of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0;
        let model = a.position + (b.position - a.position) * of_b + (c.position - a.position) * of_c;
        inside.then(|| eye.seen(placed.point(model, a.normal).0))
    });
    let nearest = places.max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    eye.project(nearest).into()
}

/// The color that a frame has where it shows the pixel of a picture on a mesh.
fn color_of(show: &Show, time: f64, pixel: [f64; 2]) -> [u8; 4] {
    let (x, y) = seen(show, time, pixel);
    at(&show.frame(time), x as usize, y as usize)
}

#[test]
fn the_eye_on_the_ball_looks_around_and_blinks() {
    let show = shipped("ball");
    const PUPIL: [f64; 2] = [243.0, 190.0];
    let mut places = Vec::new();
    for time in [0.0, 0.2, 0.45, 0.66] {
        let [r, g, b, _] = color_of(&show, time, PUPIL);
        assert!(r < 40 && g < 40 && b < 40, "at {time} the pupil is {:?}", [r, g, b]);
        places.push(seen(&show, time, PUPIL));
    }
    let [ahead, right, left, up] = places[..] else { panic!() };
    assert!(left.0 < ahead.0 - 30.0 && right.0 > ahead.0 + 30.0 && up.1 < ahead.1 - 30.0, "{places:?}");
    let [r, g, b, _] = color_of(&show, 0.325, PUPIL);
    assert!(r > 100 && r > g && g > b, "closed, the lid is {:?}", [r, g, b]);
    assert!(at(&show.frame(0.0), 20, 20) == [29, 35, 44, 255], "behind the ball is nothing");
    assert!(show.frame(0.9) == show.frame(0.0), "it ends as it began");
}

#[test]
fn the_cat_on_the_mug_is_upright_and_squints() {
    let show = shipped("mug");
    // Each print is in front once.
    for turn in [0.0, 0.5] {
        let (ahead, aside) = (1.0 / 9.0 + turn, 0.222 + turn);
        let is_green = |time: f64, pixel| {
            let [r, g, b, _] = color_of(&show, time, pixel);
            g > r && g > b
        };
        for eye in [[147.0, 171.0], [333.0, 171.0]] {
            assert!(is_green(aside, eye) && !is_green(ahead, eye), "{eye:?}: open, then squinting");
        }
        let [r, g, ..] = color_of(&show, ahead, [240.0, 268.0]);
        assert!(r > g + 40, "the nose is pink");
        let (crown, chin) = (seen(&show, ahead, [240.0, 70.0]), seen(&show, ahead, [240.0, 350.0]));
        assert!(crown.1 + 150.0 < chin.1 && (crown.0 - chin.0).abs() < 3.0, "{crown:?} {chin:?}");
        let (left, right) = (seen(&show, ahead, [20.0, 200.0]), seen(&show, ahead, [460.0, 200.0]));
        assert!(left.0 + 150.0 < right.0, "{left:?} {right:?}");
    }
    // The handle comes round to the front between them.
    let ceramic = |time: f64| at(&show.frame(time), 300, 240)[..3].iter().all(|&c| c > 120);
    assert!(ceramic(0.361) && ceramic(0.861) && !ceramic(1.0 / 9.0));
}
