//! The technique as a whole: fields, frames and probes of small layers.

use std::sync::Arc;

use kurbo::Vec2;

use super::model::PictureLayer;
use super::{frame::Frame, probe, synth};
use crate::base::clip::Clip;
use crate::base::half::half_of_value;
use crate::base::picture::{Channels, Light, Picture, SRGB_8, SRGB_16, Samples};
use crate::base::pixels::{Grid, Rgba, encode, over};
use crate::base::progress::Progress;
use crate::base::reduce::Reduced;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::Columns;
use crate::layers::parts::moment::Moment;
use crate::layers::ready::{Making, Ready, Still};
use crate::layers::technique::Technique;
use crate::layers::timeline::Wrap;

/// A picture whose red encodes the column and whose green the row.
fn ramp(width: usize, height: usize) -> Grid<Rgba> {
    let cell = |i: usize| [(i % width) as f32 / 100.0, (i / width) as f32 / 100.0, 0.0, 1.0];
    Grid::from_cells(width, height, (0..width * height).map(cell).collect())
}

fn materials() -> Materials {
    let mut materials = Materials::default();
    materials.pictures.insert("ramp".into(), Arc::new(ramp(40, 30).into()));
    let mut mask = ramp(40, 30);
    mask.cells_mut().iter_mut().enumerate().filter(|(i, _)| i % 40 >= 20).for_each(|(_, c)| *c = [0.0; 4]);
    materials.pictures.insert("mask".into(), Arc::new(mask.into()));
    materials.pictures.insert("dot".into(), Arc::new(Picture::filled(1, 1, [0.5, 0.5, 0.5, 0.5])));
    let frames = (0..4).map(|k| Arc::new(Picture::filled(20, 20, [k as f32 / 10.0, 0.0, 0.0, 1.0]))).collect();
    materials.clips.insert("clip".into(), Arc::new(Clip { fps: 4.0, frames }));
    materials
}

fn layer(zones: &str) -> PictureLayer {
    serde_json::from_str(&format!(r#"{{"name":"l","image":"ramp","zones":[{zones}]}}"#)).unwrap()
}

/// A zone over columns 5 to 24 and rows 5 to 14 that moves by `jump`, with more fields.
fn zone(jump: &str, more: &str) -> String {
    format!(
        r#"{{"name":"z","outline":{{"kind":"rectangle","x":5,"y":5,"width":20,"height":10}},
            "motion":[{{"tool":"translate","by":{jump}}}]{more}}}"#
    )
}

fn shown(layer: &PictureLayer, time: f64, (x, y): (usize, usize)) -> Rgba {
    let synth = synth::synth(layer, &Making::plain(Wrap::Once, &materials()), None).unwrap();
    let mut row = vec![[0.0; 4]; 40];
    Frame::new(&synth, time).row(y, Columns::All, &mut row);
    row[x]
}

#[test]
fn pixels_show_what_their_samplers_read() {
    let cover = r#","fold":{"rule":"cover","regions":[{"kind":"rectangle","x":20,"y":0,"width":10,"height":30}]}"#;
    let fly = r#","fold":{"rule":"fly-over","regions":[{"kind":"rectangle","x":20,"y":0,"width":10,"height":30}]}"#;
    let mask = r#","fold":{"rule":"mask","image":"mask"}"#;
    let dot = r#","sampler":{"image":"dot","offset":[-10,-10]}"#;
    for (zone, time, pixel, red) in [
        (zone("[8,0]", ""), 0.0, (10, 10), 0.10),
        (zone("[8,0]", ""), 0.5, (10, 10), 0.14),
        (zone("[8,0]", ""), 1.0, (24, 10), 0.32),
        (zone("[8,0]", ""), 1.0, (25, 10), 0.25),  // the right edge is out
        (zone("[80,0]", ""), 1.0, (10, 10), 0.39), // clamps
        (zone("[8,0]", r#","feather":2"#), 1.0, (5, 10), 0.05 + 0.08 * 0.15625),
        (zone("[8,0]", r#","speed":0.5"#), 1.0, (10, 10), 0.14),
        (zone("[8,0]", cover), 1.0, (10, 10), 0.18),
        (zone("[8,0]", cover), 1.0, (16, 10), 0.195), // waits at the edge, x = 20
        (zone("[8,0]", cover), 1.0, (21, 10), 0.21),  // never leaves the region: still
        (zone("[8,0]", fly), 1.0, (10, 10), 0.10),
        (zone("[8,0]", fly), 1.0, (16, 10), 0.24),
        (zone("[8,0]", mask), 1.0, (10, 10), 0.18),
        (zone("[8,0]", mask), 1.0, (16, 10), 0.16), // over alpha 0: its own color
        (zone("[0,0]", dot), 1.0, (10, 10), 0.5 + 0.05),
        (zone("[0,0]", dot), 1.0, (12, 10), 0.12), // beyond the sampler image
    ] {
        let found = shown(&layer(&zone), time, pixel)[0];
        assert!((f64::from(found) - red).abs() < 1e-6, "{zone} at {time}, {pixel:?}: {found}, not {red}");
    }
}

#[test]
fn later_zones_lie_over_earlier_ones_and_read_the_picture_itself() {
    let both = format!("{},{}", zone("[8,0]", ""), zone("[4,0]", "").replace(r#""z""#, r#""y""#));
    assert_eq!(shown(&layer(&both), 1.0, (10, 10))[0], 0.14);
}

#[test]
fn a_probe_tells_what_the_frame_shows() {
    let cover = r#","fold":{"rule":"cover","regions":[{"kind":"rectangle","x":20,"y":0,"width":10,"height":30}]}"#;
    let layer = layer(&zone("[8,0]", cover));
    let probe = probe::probe(&layer, &Making::plain(Wrap::Once, &materials()), (16, 10), 0.75).unwrap().unwrap();
    assert_eq!((probe.zone.as_str(), probe.jump, probe.active), ("z", Vec2::new(8.0, 0.0), true));
    assert_eq!((probe.tau, probe.s, probe.e), (0.75, 0.75, 0.4375));
    assert_eq!((probe.thresholds, probe.read), (vec![0.4375], (20.0, 10.5).into()));
    assert_eq!(probe::probe(&layer, &Making::plain(Wrap::Once, &materials()), (30, 10), 0.75).unwrap(), None);
}

#[test]
fn unchanged_zones_are_taken_over() {
    let make = |more: &str, before: Option<&synth::Synth>| {
        let both = format!("{},{}", zone("[8,0]", ""), zone("[4,0]", more));
        synth::synth(&layer(&both), &Making::plain(Wrap::Repeat, &materials()), before).unwrap()
    };
    let before = make("", None);
    let after = make(r#","feather":3"#, Some(&before));
    assert!(Arc::ptr_eq(&before.zones[0].field, &after.zones[0].field));
    assert!(!Arc::ptr_eq(&before.zones[1].field, &after.zones[1].field));
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let zone = r#"{"name":"z","outline":{"kind":"ellipse","center":[20,15],"radii":[18,13]},
        "motion":[{"tool":"point","at":[9,9],"jump":[3,4]},{"tool":"still-border","spacing":2}],
        "interpolation":{"method":"modified-shepard-random","radius":30,"ring":12},"feather":3,
        "fold":{"rule":"return","regions":[{"kind":"ellipse","center":[22,15],"radii":[6,5]}]}}"#;
    let field = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let synth = || synth::synth(&layer(zone), &Making::plain(Wrap::Repeat, &materials()), None).unwrap();
        pool.install(synth).zones[0].field.clone()
    };
    assert_eq!(field(1), field(5));
}

/// A picture of some tiles in each direction, of every kind of samples.
fn kinds_of_pictures((width, height): (usize, usize)) -> Vec<Picture> {
    let code = |i: usize| (i * 37 + i / 7 * 11 + (i >> 9) * 101) as u8;
    let words = |i: usize| (u16::from(code(i)) * 257) ^ 77;
    let mut all = Vec::new();
    for channels in (1..=4).filter_map(Channels::of) {
        let samples = 0..width * height * channels.count();
        let bytes: Vec<u8> = samples.clone().map(code).collect();
        let other = Arc::new(Light::of_curve(|code| code * code));
        for samples in [
            Samples::Bytes(bytes.clone(), SRGB_8.clone()),
            Samples::Bytes(bytes, other),
            Samples::Words(samples.clone().map(words).collect(), SRGB_16.clone()),
            Samples::Halves(samples.clone().map(|i| half_of_value(f32::from(code(i)) / 200.0)).collect()),
            Samples::Floats(samples.map(|i| f32::from(code(i)) / 255.0).collect()),
        ] {
            all.push(Picture::new(width, height, channels, samples));
        }
    }
    let opaque = |i: usize| if i % 4 == 3 { 255 } else { code(i) };
    let codes = Samples::Bytes((0..4 * width * height).map(opaque).collect(), SRGB_8.clone());
    all.push(Picture::new(width, height, Channels::Rgba, codes));
    all
}

#[test]
fn tiles_show_what_each_pixel_shows_to_the_bit() {
    let size = (301, 11);
    let pictures = kinds_of_pictures(size);
    let all = r#""outline":{"kind":"rectangle","x":0,"y":0,"width":301,"height":11}"#;
    let some = r#""outline":{"kind":"ellipse","center":[200,5],"radii":[130,5]}"#;
    let moved =
        r#""motion":[{"tool":"point","at":[60,5],"jump":[30.3,-6.7]},{"tool":"point","at":[240,3],"jump":[-9.2,4]}]"#;
    let region = r#""regions":[{"kind":"ellipse","center":[150,5],"radii":[60,4]}]"#;
    let there_and_back = r#""position":{"function":"sine","cycles":1,"amplitude":1.3}"#;
    let fold = |rule: &str| format!(r#"{all},{moved},{there_and_back},"fold":{{"rule":"{rule}",{region}}}"#);
    let scenes = [
        String::new(),
        format!("{all},{moved}"),
        format!(r#"{some},{moved},"feather":3"#),
        fold("cover"),
        fold("return"),
        fold("fly-over"),
        format!(r#"{some},{moved},"fold":{{"rule":"mask","image":"clear"}}"#),
        format!(r#"{all},{moved},"sampler":{{"image":"dot","offset":[-90,-2]}}"#),
        format!(r#"{some},{moved},"sampler":{{"clip":"clip","offset":[-150.5,1.25]}}"#),
        // Still; far beyond all edges; torn so far apart that a tile reads from everywhere.
        format!(r#"{some},"motion":[{{"tool":"still-border","spacing":9}}]"#),
        format!(r#"{all},"motion":[{{"tool":"translate","by":[5e12,-400]}}]"#),
        format!(r#"{all},"motion":[{{"tool":"scale","center":[99,9],"factor":[60,90]}}]"#),
    ];
    let last = format!(r#""outline":{{"kind":"rectangle","x":250,"y":4,"width":40,"height":5}},{moved}"#);
    let mut materials = materials();
    for (i, own) in scenes.iter().enumerate() {
        for (k, picture) in
            pictures.iter().enumerate().filter(|(k, _)| i == 3 || k % 8 == i % 8 || *k + 1 == pictures.len())
        {
            for name in ["ramp", "clear"] {
                materials.pictures.insert(name.into(), Arc::new(picture.clone()));
            }
            let zones = [Some(own).filter(|own| !own.is_empty()), Some(&last).filter(|_| k % 2 == 0)];
            let zones: Vec<_> = zones.into_iter().flatten().map(|zone| format!(r#"{{"name":"z",{zone}}}"#)).collect();
            let layer = layer(&zones.join(","));
            let synth = synth::synth(&layer, &Making::plain(Wrap::Once, &materials), None).unwrap();
            let (t, width) = [(0.3, 301), (0.8, 270), (0.8, 310)][(i + k) % 3];
            tiles_are_pixels(&Frame::new(&synth, t), width, &format!("{own}, picture {k}, at {t}"));
        }
    }
}

fn tiles_are_pixels(frame: &Frame, width: usize, what: &str) {
    let rows = 1..13;
    let mut pixels = vec![[0.0; 4]; rows.len() * width];
    let mut tiles = pixels.clone();
    rows.clone().zip(pixels.chunks_mut(width)).for_each(|(y, out)| frame.row(y, Columns::All, out));
    frame.rows(rows, width, &mut tiles);
    // Of zeros there are two.
    let bits = |all: &[Rgba]| all.iter().map(|color| color.map(|v| (v + 0.0).to_bits())).collect::<Vec<_>>();
    assert!(bits(&pixels) == bits(&tiles), "{what}");
    let rows = 2..11;
    let mut codes = vec![[0; 4]; rows.len() * width];
    for background in [[0.0; 4], [0.2, 0.1, 0.0, 0.5]] {
        let written = frame.codes(rows.clone(), background, &mut codes);
        assert_eq!(written, width <= 301, "{what}");
        let pixels = &pixels[width..];
        let differ = |(code, light): (&[u8; 4], &Rgba)| *code != encode(over(*light, background));
        assert!(!written || !codes.iter().zip(pixels).any(differ), "{what}, over {background:?}");
    }
}

#[test]
fn a_missing_picture_is_a_problem_with_its_place() {
    let zone = zone("[1,1]", r#","sampler":{"image":"gone"}"#);
    let problem = synth::synth(&layer(&zone), &Making::plain(Wrap::Repeat, &materials()), None).unwrap_err();
    assert_eq!(problem.path, "/zones/0/sampler/image");
}

#[test]
fn a_synthesis_that_nobody_wants_ends() {
    let layer = layer(&zone("[4, 0]", ""));
    for stopped in [false, true] {
        let stop = Some(Arc::new(std::sync::atomic::AtomicBool::new(stopped)));
        let materials = Materials { stop, ..materials() };
        let made = synth::synth(&layer, &Making::plain(Wrap::Once, &materials), None);
        assert_eq!(made.is_err(), stopped);
    }
}

#[test]
fn a_frame_may_be_smaller_or_larger_than_the_picture() {
    let layer = layer(&zone("[8,0]", ""));
    let synth = synth::synth(&layer, &Making::plain(Wrap::Once, &materials()), None).unwrap();
    let frame = Frame::new(&synth, 0.5);
    let row = |y: usize, columns: Columns, width: usize| {
        let mut row = vec![[0.0; 4]; width];
        frame.row(y, columns, &mut row);
        row
    };
    let whole = row(10, Columns::All, 40);
    for width in [3, 12, 24] {
        assert_eq!(row(10, Columns::All, width), whole[..width], "{width}");
    }
    assert_eq!(row(10, Columns::All, 44), [&whole[..], &[[0.0; 4]; 4]].concat());
    assert_eq!(row(10, Columns::Some(&[2, 7, 39, 41]), 4), [whole[2], whole[7], whole[39], [0.0; 4]]);
    assert_eq!(row(30, Columns::All, 40), [[0.0; 4]; 40]);
}

#[test]
fn a_synthesis_counts_the_pixels_that_are_not_taken_over() {
    let told = Arc::new(std::sync::Mutex::new(Vec::new()));
    let progress = |told: &Arc<std::sync::Mutex<Vec<u8>>>| {
        let heard = told.clone();
        Some(Arc::new(Progress::new(move |percent| heard.lock().unwrap().push(percent))))
    };
    let layer = layer(&zone("[4, 0]", ""));
    let counting = Materials { progress: progress(&told), ..materials() };
    let first = synth::synth(&layer, &Making::plain(Wrap::Once, &counting), None).unwrap();
    assert_eq!(told.lock().unwrap().last(), Some(&100));
    told.lock().unwrap().clear();
    let again = Materials { progress: progress(&told), ..counting };
    synth::synth(&layer, &Making::plain(Wrap::Once, &again), Some(&first)).unwrap();
    assert!(told.lock().unwrap().is_empty(), "nothing was left to do");
}

#[test]
fn a_clip_is_read_frame_by_frame() {
    // 3 s at 4 frames a second: the four frames three times.
    let layer = layer(&zone("[2,0]", r#","sampler":{"clip":"clip","offset":[0,0]}"#));
    let materials = materials();
    let making = Making { duration: 3.0, ..Making::plain(Wrap::Repeat, &materials) };
    let synth = synth::synth(&layer, &making, None).unwrap();
    let bands = layer.prepare(&making, None).unwrap();
    let band = bands.part(0..40, 8..9, &materials).unwrap();
    let small = synth.reduced(&mut Reduced::new(2));
    let still = Arc::new(synth.clone()).unmoved();
    let seen = |layer: &dyn Ready, t: f64, (x, y): (usize, usize)| {
        let mut row = vec![[0.0; 4]; 40];
        layer.at(&Moment { t, size_px: (40, 30), eye: None, left_out: 0, magnified: 1 }).row(y, Columns::All, &mut row);
        row[x][0]
    };
    for (t, frame) in [(0.0, 0), (1.0 / 12.0, 1), (0.2, 2), (0.25, 3), (1.0 / 3.0, 0), (0.99, 3), (1.0, 0)] {
        let red = frame as f32 / 10.0;
        assert_eq!(seen(&synth, t, (8, 8)), red, "at {t}");
        assert_eq!(seen(&*band, t, (8, 8)), red, "at {t}, in a band");
        assert_eq!(seen(&*small, t, (4, 4)), red, "at {t}, reduced");
        assert_eq!(seen(&*still, t, (8, 8)), 0.08, "at {t}, still");
        assert_eq!(seen(&synth, t, (22, 8)), 0.22, "at {t}: beyond the clip's edge");
        let probe = probe::probe(&layer, &making, (8, 8), t).unwrap().unwrap();
        assert_eq!(probe.frame, Some(frame), "at {t}");
    }
    let gone = Materials { clips: Default::default(), ..materials.clone() };
    let problem = synth::synth(&layer, &Making { materials: &gone, ..making }, None).unwrap_err();
    assert_eq!(problem.path, "/zones/0/sampler/clip");
}

/// A layer of one zone of 20 anchors and one that can be edited, as can a corner, the region and what more there is.
fn edited(method: &str, [anchor, corner, region, more]: [&str; 4]) -> PictureLayer {
    let point =
        |k: usize| format!(r#"{{"tool":"point","at":[{},{}],"jump":[{},9]}}"#, k * 37 % 100, k * 23 % 70, k % 5);
    let points: Vec<String> = (0..20).map(point).collect();
    layer(&format!(
        r#"{{"name":"z","interpolation":{method},"outline":{{"kind":"polygon","points":[[4,3],{corner},[98,66],[9,69]]}},
            "motion":[{},{anchor}],"fold":{{"rule":"cover","regions":[{region}]}}{more}}}"#,
        points.join(",")
    ))
}

#[test]
fn an_edit_leads_to_the_field_of_a_whole_synthesis() {
    let mut materials = materials();
    materials.pictures.insert("ramp".into(), Arc::new(Picture::filled(100, 70, [0.5; 4])));
    let making = Making::plain(Wrap::Once, &materials);
    let anchor = |x: usize, y: usize| format!(r#"{{"tool":"point","at":[{x},{y}],"jump":[1,2]}}"#);
    let (own, corner) = (anchor(40, 30), "[80,20]");
    let region = r#"{"kind":"rectangle","x":60,"y":30,"width":20,"height":30}"#;
    let edits = [
        [r#"{"tool":"point","at":[40,30],"jump":[1,4000]}"#, corner, region, ""],
        [r#"{"tool":"still-border","spacing":30}"#, corner, region, ""],
        [r#"{"tool":"rotate","center":[50,50],"degrees":5}"#, corner, region, ""],
        [&own, "[99,0]", region, ""],
        [&own, "[60,40]", region, ""],
        [&own, corner, r#"{"kind":"ellipse","center":[50,50],"radii":[9,20]}"#, ""],
        [&own, corner, region, r#","feather":7"#],
        [&own, corner, region, r#","position":{"function":"sine","cycles":1,"amplitude":1.3}"#],
    ];
    let moved: Vec<String> = (0..11).map(|k| anchor(k * 31 % 100, k * 47 % 70)).collect();
    let moves = moved.iter().map(|moved| [moved, corner, region, ""]);
    let [near, random] = [
        r#"{"method":"modified-shepard","radius":45}"#,
        r#"{"method":"modified-shepard-random","radius":14,"ring":6}"#,
    ];
    let far = r#"{"method":"shepard"}"#;
    for (method, edits) in [
        (far, &edits[..]),
        (near, &edits),
        (near, &moves.clone().collect::<Vec<_>>()),
        (random, &moves.collect::<Vec<_>>()),
    ] {
        let make = |what: [&str; 4], before: Option<&synth::Synth>| {
            synth::synth(&edited(method, what), &making, before).unwrap().zones[0].clone()
        };
        let begin = [&own, corner, region, ""];
        let before = synth::synth(&edited(method, begin), &making, None).unwrap();
        for edit in edits {
            let [after, whole] = [Some(&before), None].map(|before| make(*edit, before).field);
            assert!(after == whole, "{method}, {edit:?}");
            let same = Arc::ptr_eq(&after.jumps, &before.zones[0].field.jumps);
            assert_eq!(same, edit[..2] == begin[..2] && !edit[3].contains("feather"), "{method}, {edit:?}");
        }
    }
}
