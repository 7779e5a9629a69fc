//! From a key press to the drawn screen, on a zone with many anchors and a terminal of 160 x 48, without synthesis.
//! `cargo bench --bench keys`

mod scenes;

use divan::Bencher;
use plica::base::geometry::Xy;
use plica::layers::Layer;
use plica::layers::folding::model::PictureLayer;
use plica::layers::timeline::Timeline;
use plica::scene::Scene;
use plica::tui::Offscreen;

const SIZE: Xy = [512.0, 512.0];

fn main() {
    divan::main();
}

/// What is measured, and its keys: each is one press and one drawing. The first keys lead there and are not measured.
const KEYS: &[(&str, &[&str])] = &[
    ("move", &["j"]),
    ("scroll", &["Ctrl-d"]),
    ("last row", &["G"]),
    ("step", &["+"]),
    ("step and undo", &["+", "u"]),
    ("entry of 5 keys", &["i", "+", "=", "1", "Enter"]),
    ("ten rows in 5 keys", &["v", "9", "j", "+", "Esc"]),
    ("add", &["o"]),
    ("search in 5 keys", &["/", "r", "a", "d", "Enter"]),
];

#[divan::bench(args = KEYS.iter().map(|(name, _)| *name), consts = [1000, 10_000], sample_count = 60)]
fn keys<const ANCHORS: usize>(bencher: Bencher, name: &str) {
    let keys = KEYS.iter().find(|(known, _)| *known == name).map_or(&[][..], |(_, keys)| keys);
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    let mut editor = opened(folder.path(), ANCHORS);
    bencher.bench_local(|| keys.iter().for_each(|key| editor.press(key).expect("a screen in memory is drawn")));
}

/// The editor at the table of anchors, with the cursor on the x of the first.
fn opened(folder: &std::path::Path, anchors: usize) -> Offscreen {
    let [width, height] = SIZE.map(|v| v as usize);
    let zone = scenes::zone((width, height), anchors, r#"{"method":"modified-shepard","radius":60}"#);
    let layer = PictureLayer { name: "face".into(), image: "cat".into(), zones: vec![zone] };
    let timeline = Timeline::default();
    let images = [("cat".to_owned(), plica::scene::Image { path: "cat.png".into() })].into();
    let scene = Scene { timeline, images, layers: vec![Layer::Picture(layer)], ..Scene::default() };
    let path = folder.join("cat.plica.json");
    let text = serde_json::to_string(&scene).expect("a scene is written");
    std::fs::write(&path, text).expect("the folder takes files");
    let mut editor = Offscreen::open(&path, (160, 48)).expect("the scene opens");
    for key in ["/", "m", "o", "t", "i", "o", "n", "Enter", "Enter", "l"] {
        editor.press(key).expect("a screen in memory is drawn");
    }
    assert!(editor.text().contains("point"), "the table of anchors:\n{}", editor.text());
    editor
}
