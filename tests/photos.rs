//! Scenes over real photographs: `tests/photos/NAME.plica.json`, with the photographs in `shared/data/photos` of any
//! folder above this one. They are not part of the project; if they are missing, each test says so and is skipped.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and says what it leaves out"
)]

use std::path::{Path, PathBuf};

use kurbo::Point;
use plica::base::pixels::Frame;
use show::{Show, TIMES, at, no_seam, step, still_outside};

mod show;

const SCENES: [&str; 5] = ["cat", "hand", "face", "beach", "pecs"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn photographs() -> Option<PathBuf> {
    let found = root().ancestors().map(|folder| folder.join("shared/data/photos")).find(|folder| folder.is_dir());
    if found.is_none() {
        println!("skipped: there is no shared/data/photos above {}", root().display());
    }
    found
}

/// The scene beside its pictures in a separate folder.
fn open(name: &str) -> Option<Show> {
    let photographs = photographs()?;
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.plica.json");
    std::fs::copy(root().join(format!("tests/photos/{name}.plica.json")), &scene).unwrap();
    for from in [&photographs, &root().join("tests/photos")] {
        for file in std::fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()) {
            if file.extension().is_some_and(|end| end == "png" || end == "jpg") {
                std::fs::copy(&file, folder.path().join(file.file_name().unwrap())).unwrap();
            }
        }
    }
    Some(Show::open(&scene))
}

/// The share of a zone's fold regions that looks as in the still picture.
fn uncovered(show: &Show, zone: &str, frame: &Frame) -> f64 {
    let zone = show.layer().zones.iter().find(|z| z.name == zone).unwrap();
    let regions: Vec<_> = zone.fold.iter().flat_map(|fold| fold.regions()).map(|region| region.polygon()).collect();
    let still = show.frame(0.0);
    let (mut all, mut same) = (0.0, 0.0);
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            if regions.iter().any(|region| region.contains(Point::new(x as f64 + 0.5, y as f64 + 0.5))) {
                all += 1.0;
                same += f64::from(u8::from(at(frame, x, y) == at(&still, x, y)));
            }
        }
    }
    same / all
}

#[test]
fn photographs_keep_still_outside_their_zones_and_have_no_seam() {
    for name in SCENES {
        let Some(show) = open(name) else { return };
        still_outside(name, &show);
        no_seam(name, &show);
        for time in TIMES {
            let linear = plica::render::cpu::linear(&show.synth, time);
            assert!(linear.cells().iter().flatten().all(|c| c.is_finite()), "{name} at {time}");
        }
    }
}

#[test]
fn the_cat_squints() {
    let Some(show) = open("cat") else { return };
    for eye in ["left eye", "right eye"] {
        let squint = uncovered(&show, eye, &show.frame(0.34));
        assert!((0.2..0.7).contains(&squint), "{eye}: {squint} of it is left");
        assert_eq!(uncovered(&show, eye, &show.frame(0.9)), 1.0);
    }
    // The pupil of the left eye, which the lid does not reach.
    assert_eq!(at(&show.frame(0.34), 169, 120), at(&show.still(), 169, 120));
}

#[test]
fn the_face_blinks() {
    let Some(show) = open("face") else { return };
    let (still, closed) = (show.still(), show.frame(0.52));
    for (eye, (x, y)) in [("left eye", (204, 100)), ("right eye", (246, 102))] {
        let left = uncovered(&show, eye, &closed);
        assert!(left < 0.1, "{eye}: {left} of it is left");
        let (pupil, lid) = (at(&still, x, y), at(&closed, x, y));
        assert!(pupil[0] < 60 && lid[0] > 90, "{eye}: {lid:?} stands where {pupil:?} was");
    }
}

#[test]
fn the_wound_on_the_hand_closes() {
    let Some(show) = open("hand") else { return };
    assert_eq!(show.layer().zones[1].anchors().len(), 62);
    let flesh = |time: f64| {
        let frame = show.frame(time);
        let cut = (488..608).flat_map(|y| (270..420).map(move |x| (x, y)));
        cut.filter(|&(x, y)| at(&frame, x, y)[1] < 28).count()
    };
    let (open, closed) = (flesh(0.0), flesh(0.5));
    assert!(open > 1000 && closed * 2 < open, "flesh {open} -> {closed}");
}

#[test]
fn water_covers_the_sand() {
    let Some(show) = open("beach") else { return };
    let (low, high) = (show.frame(0.0), show.frame(0.43));
    let covered = |x: usize, y: usize| at(&low, x, y) != at(&high, x, y);
    // Beside the waterline, from far to near: wet where the water reaches, dry beyond.
    for (y, wet, dry) in [(260, 600, 640), (330, 570, 620), (420, 535, 590)] {
        assert!(covered(wet, y) && !covered(dry, y), "row {y}");
    }
}

#[test]
fn the_pecs_bounce_in_turn() {
    let Some(show) = open("pecs") else { return };
    let still = show.still();
    let moved = |frame: &Frame, from: usize| {
        let half = (140..340).flat_map(|y| (from..from + 180).map(move |x| (x, y)));
        half.filter(|&(x, y)| step(at(frame, x, y), at(&still, x, y)) > 4).count()
    };
    let (left, right) = (show.frame(0.07), show.frame(0.57));
    assert!(moved(&left, 138) > 500 && moved(&left, 320) == 0);
    assert!(moved(&right, 320) > 500 && moved(&right, 138) == 0);
}
