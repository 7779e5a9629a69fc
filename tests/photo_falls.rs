//! Waterfalls over real clips: one in a photograph that folds elsewhere, behind its rocks, and what is cut out of water and
//! fire. The photograph and the clips are in `shared/data` of any folder above this one; where they are missing, each test
//! says so and is skipped.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use kurbo::Point;
use plica::base::geometry::Polygon;
use plica::base::pixels::encode;
use plica::files;
use plica::render::{self, Synth, cpu};
use plica::scene::Document;

fn data() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found = root.ancestors().map(|folder| folder.join("shared/data")).find(|folder| folder.join("clips").is_dir());
    if found.is_none() {
        println!("skipped: there is no shared/data/clips above {}", root.display());
    }
    found
}

/// Copies the frames of a clip that scenes here use.
fn copy_clip(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for number in 0..24 {
        let name = format!("{number:04}.jpg");
        std::fs::copy(from.join(&name), to.join(&name)).unwrap();
    }
}

fn synth(scene: &Path) -> (Document, Synth) {
    let options = files::Options::default();
    let document = files::scene::open(scene, &options).unwrap();
    let loaded = files::materials::load(scene, document.scene(), &options, &mut Default::default());
    let (materials, problems) = loaded.unwrap();
    assert!(problems.is_empty(), "{problems:?}");
    let synth = render::synth(document.scene(), &materials, None).unwrap();
    (document, synth)
}

/// The rocks in front of the fall: left of the river, and right of it.
const ROCKS: [&[(f64, f64)]; 2] = [
    &[
        (0.0, 200.0),
        (140.0, 290.0),
        (250.0, 410.0),
        (330.0, 420.0),
        (470.0, 478.0),
        (555.0, 512.0),
        (553.0, 540.0),
        (0.0, 540.0),
    ],
    &[
        (470.0, 440.0),
        (535.0, 408.0),
        (632.0, 420.0),
        (650.0, 380.0),
        (735.0, 325.0),
        (960.0, 350.0),
        (960.0, 540.0),
        (840.0, 540.0),
        (605.0, 492.0),
    ],
];

#[test]
fn a_fall_in_a_photograph_moves_behind_its_rocks() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    copy_clip(&data.join("clips/waterfall"), &at("falls"));
    let photo = data.join("photos/waterfall_landscape.jpg");
    std::fs::copy(&photo, at("waterfall_landscape.jpg")).unwrap();
    let rocks = ROCKS.map(|corners| Polygon::new(corners.iter().map(|&corner| Point::from(corner)).collect()));
    let mut cut = image::open(&photo).unwrap().to_rgba8();
    for (x, y, pixel) in cut.enumerate_pixels_mut() {
        let center = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        pixel.0[3] = if rocks.iter().any(|rock| rock.contains(center)) { 255 } else { 0 };
    }
    cut.save(at("rocks.png")).unwrap();
    let scene = include_str!("photos/falls.plica.json");
    assert_eq!(Document::parse(scene).unwrap().to_text(), scene, "it is written as the program writes it");
    std::fs::write(at("scene.plica.json"), scene).unwrap();
    let (_, synth) = synth(&at("scene.plica.json"));
    // Of the fall, the rocks left and right, the meadow, and the river: two times of each pixel.
    let spots = [(420, 120), (350, 260), (480, 250), (280, 470), (760, 400), (120, 440), (930, 480), (680, 520)];
    let looks = [0.2, 0.7].map(|time| spots.map(|(x, y)| encode(*cpu::lattice(&synth, time, &[x], &[y]).get(0, 0))));
    let changes = looks[0].iter().zip(looks[1]).map(|(a, b)| a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 1));
    let changes: Vec<bool> = changes.collect();
    assert_eq!(changes[..3], [true; 3], "water falls: {looks:?}");
    assert_eq!(changes[3..7], [false; 4], "rocks and meadows keep still: {looks:?}");
    assert!(changes[7], "the river folds: {looks:?}");
    let own = cut.get_pixel(280, 470).0;
    assert!(looks[0][3].iter().zip(own).all(|(a, b)| a.abs_diff(b) <= 1), "the rock hides the fall");
}

#[test]
fn windows_of_real_clips_are_all_distinct_and_within_them() {
    let Some(data) = data() else { return };
    for (clip, (width, height)) in [("waterfall", (512, 400)), ("fire_cg", (320, 180))] {
        let folder = tempfile::tempdir().unwrap();
        copy_clip(&data.join("clips").join(clip), &folder.path().join("clip"));
        let scene = plica::scene::Start::default().clip("clip", "clip/%04d.jpg", 0, None).document().unwrap();
        std::fs::write(folder.path().join("scene.plica.json"), scene.to_text()).unwrap();
        let (document, synth) = synth(&folder.path().join("scene.plica.json"));
        let album = synth.layers[0].album(0).unwrap();
        let [(path, picks)] = album.taken.as_slice() else { panic!("{clip}: nothing was chosen") };
        assert_eq!(path, "/sprites/picks");
        let picks = picks.as_array().unwrap();
        let distinct: BTreeSet<String> = picks.iter().map(|pick| pick.to_string()).collect();
        assert_eq!(distinct.len(), picks.len(), "{clip}");
        assert!((4..=24).contains(&picks.len()), "{clip}: {} windows", picks.len());
        for pick in picks {
            let [x, y] = [0, 1].map(|i| pick["at"][i].as_f64().unwrap());
            let within = |v: f64, most: f64| (32.0..=most - 32.0).contains(&v);
            assert!(within(x, width.into()) && within(y, height.into()), "{clip}: {pick}");
        }
        assert_eq!(document.scene().layers.len(), 1);
        let seen = cpu::lattice(&synth, 0.5, &(0..1280).step_by(40).collect::<Vec<_>>(), &[300]);
        let lit = seen.cells().iter().filter(|cell| cell[3] > 0.1).count();
        assert!(lit > 5, "{clip}: {lit} of 32 places of the middle row show something");
    }
}
