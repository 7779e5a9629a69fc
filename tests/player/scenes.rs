//! Scenes for the player: every position function with usual and with nasty numbers, every rule, layers of other sizes.

use std::sync::Arc;

use plica::base::maths::sin;
use plica::base::picture::Picture;
use plica::base::pixels::Frame;
use plica::layers::parts::materials::Materials;
use plica::scene::Scene;
use serde_json::{Value, json};

/// The variants of a tagged type of the document, from its schema.
pub fn variants<T: schemars::JsonSchema>(tag: &str) -> Vec<String> {
    let schema = Value::from(schemars::schema_for!(T));
    let branches = schema["oneOf"].as_array().unwrap();
    branches.iter().map(|branch| branch["properties"][tag]["const"].as_str().unwrap().to_owned()).collect()
}

pub struct Case {
    pub name: String,
    pub scene: Scene,
    pub materials: Materials,
}

fn materials() -> Materials {
    let smooth = |x: usize, y: usize, k: usize| {
        let wave = |a: usize| ((a * 37 % 256) as f64 / 255.0 * 0.1 + 0.45 + 0.4 * sin(a as f64 / 9.0)) * 255.0;
        [wave(x + k) as u8, wave(y + 2 * k) as u8, wave(x + y + 5 * k) as u8]
    };
    let picture = |w: usize, h: usize, alpha: &dyn Fn(usize, usize) -> u8, k: usize| -> Arc<Picture> {
        let cell = |i: usize| {
            let [r, g, b] = smooth(i % w, i / w, k);
            [r, g, b, alpha(i % w, i / w)]
        };
        Arc::new(Frame::from_cells(w, h, (0..w * h).map(cell).collect()).to_linear().into())
    };
    let hole = |x: usize, y: usize| if x.abs_diff(45) + y.abs_diff(30) < 15 { 0 } else { 255 };
    let bright = (0..80 * 60).map(|i| [(i % 80) as f32 / 5.0, (i / 80) as f32 / 90.0, 0.2, 1.0]).collect();
    Materials {
        pictures: [
            ("cat".to_owned(), picture(80, 60, &|_, _| 255, 0)),
            ("mask".to_owned(), picture(80, 60, &hole, 0)),
            ("other".to_owned(), picture(31, 23, &|x, _| if x < 10 { 200 } else { 255 }, 40)),
            ("wide".to_owned(), picture(100, 50, &|x, y| (x * 2 + y) as u8, 9)),
            ("bright".to_owned(), Arc::new(Picture::from_cells(80, 60, bright))),
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

/// Layers of (image, zones).
fn case(name: &str, wrap: &str, layers: Vec<(&str, Vec<Value>)>) -> Case {
    let layer = |(i, (image, zones)): (usize, (&str, Vec<Value>))| json!({ "kind": "picture", "name": format!("layer {i}"), "image": image, "zones": zones });
    let layers: Vec<Value> = layers.into_iter().enumerate().map(layer).collect();
    let images = ["cat", "mask", "other", "wide", "bright"].map(|name| (name.to_owned(), json!({ "path": name })));
    let scene = serde_json::from_value(json!({
        "plica": 1, "timeline": { "duration": 1.0, "fps": 12, "loop": wrap },
        "images": serde_json::Map::from_iter(images), "layers": layers
    }));
    Case { name: name.to_owned(), scene: scene.unwrap(), materials: materials() }
}

/// Every position function.
pub fn functions() -> Vec<Case> {
    let functions = [
        r#"{"function":"linear"}"#,
        r#"{"function":"exponential"}"#,
        r#"{"function":"exponential","rate":-40}"#,
        r#"{"function":"exponential","rate":1500}"#,
        r#"{"function":"exponential-inverse"}"#,
        r#"{"function":"sigmoid"}"#,
        r#"{"function":"sigmoid","rate":1500}"#,
        r#"{"function":"sine"}"#,
        r#"{"function":"sine","cycles":-40.3,"phase":0.2,"amplitude":-2,"offset":0.3}"#,
        r#"{"function":"cosine"}"#,
        r#"{"function":"cosine","cycles":300}"#,
        r#"{"function":"cubic-bezier","x1":0.25,"y1":0.1,"x2":0.25,"y2":1.4}"#,
        r#"{"function":"cubic-bezier","x1":1,"y1":0,"x2":0,"y2":1}"#,
        r#"{"function":"cubic-bezier","x1":0,"y1":1,"x2":1,"y2":0}"#,
        r#"{"function":"keyframes","points":[[0.1,0.5],[0.4,1.5],[0.8,-0.25]]}"#,
        r#"{"function":"keyframes","points":[[0,0],[0.3,0],[0.3001,2.5],[0.30015,-3],[0.301,0],[1,1]]}"#,
        r#"{"function":"keyframes","points":[[0.2,0],[0.3,0.2],[0.5,0.9],[0.9,1]],"between":"smooth"}"#,
        r#"{"function":"keyframes","points":[[0.1,0.2],[0.3,1.3],[0.5,0],[1,2]],"between":"step"}"#,
        r#"{"function":"piecewise","segments":[{"until":0.5,"from":0,"to":1.2,"ease":{"function":"sigmoid"}},{"until":1,"from":0.5,"to":-1,"ease":{"function":"sine"}}]}"#,
        r#"{"function":"piecewise","segments":[{"until":0.3,"from":0,"to":1},{"until":0.3005,"from":-1,"to":2},{"until":1,"from":1,"to":0,"ease":{"function":"keyframes","points":[[0,0],[0.5,1],[1,0]]}}]}"#,
    ];
    let kinds = [("repeat", 1.0, 0.0), ("ping-pong", -1.5, 0.2), ("once", 2.0, -0.3)];
    let each = functions.iter().enumerate().map(|(i, function)| {
        let (wrap, speed, shift) = kinds[i % 3];
        let position: Value = serde_json::from_str(function).unwrap();
        let zone = zone(json!({ "position": position, "speed": speed, "shift": shift }));
        case(function, wrap, vec![("cat", vec![zone])])
    });
    let plain = functions.iter().map(|function| {
        let position: Value = serde_json::from_str(function).unwrap();
        case(function, "repeat", vec![("cat", vec![zone(json!({ "position": position }))])])
    });
    each.chain(plain).collect()
}

/// Every rule, with functions that go back and forth, overshoot, turn back below 0 and teleport; layers; light above
/// white.
pub fn rules() -> Vec<Case> {
    let regions = json!([
        { "kind": "rectangle", "x": 38, "y": 10, "width": 9.5, "height": 40 },
        { "kind": "ellipse", "center": [55, 25], "radii": [4, 6] }
    ]);
    let fold = |rule: &str| json!({ "rule": rule, "regions": regions });
    let sine = json!({ "function": "sine", "cycles": 1.0, "amplitude": 1.4 });
    let teleport = json!({ "function": "piecewise", "segments": [
        { "until": 0.5, "from": 0.0, "to": 1.0 },
        { "until": 1.0, "from": -0.5, "to": 0.5, "ease": { "function": "sigmoid" } }] });
    let steps = json!({ "function": "keyframes", "between": "step", "points": [[0.1, 0.2], [0.5, 1.3], [0.75, 0.0]] });
    let one = |name: &str, wrap: &str, extra: Value| case(name, wrap, vec![("cat", vec![zone(extra)])]);
    let other = json!({ "name": "Second/zone", "sampler": { "image": "other", "offset": [-30.25, -20] }, "fold": fold("fly-over") });
    let small = zone(json!({
        "outline": { "kind": "rectangle", "x": 5, "y": 3, "width": 20, "height": 15 },
        "motion": [{ "tool": "translate", "by": [3.5, 2] }], "position": sine
    }));
    vec![
        one("none", "repeat", json!({ "feather": 4.0, "speed": 2.0, "shift": 0.1 })),
        one("cover", "repeat", json!({ "fold": fold("cover") })),
        one("cover there and back", "ping-pong", json!({ "fold": fold("cover"), "position": sine })),
        one("return", "once", json!({ "fold": fold("return"), "position": { "function": "cosine" } })),
        one("return overshooting", "repeat", json!({ "fold": fold("return"), "position": sine })),
        one("fly-over", "repeat", json!({ "fold": fold("fly-over"), "position": teleport, "speed": -1.0 })),
        one("mask", "repeat", json!({ "fold": { "rule": "mask", "image": "mask" }, "position": steps })),
        case("a sampler image over another zone", "repeat", vec![("cat", vec![zone(json!({})), zone(other)])]),
        case("no zones", "repeat", vec![("cat", vec![])]),
        case(
            "a layer that is wider and lower",
            "repeat",
            vec![("cat", vec![zone(json!({}))]), ("wide", vec![zone(json!({}))])],
        ),
        case("a small layer", "repeat", vec![("wide", vec![]), ("other", vec![small]), ("mask", vec![])]),
        case("light above white", "repeat", vec![("bright", vec![zone(json!({}))])]),
    ]
}

/// A zone that never moves.
pub fn still() -> Case {
    case("still", "repeat", vec![("cat", vec![zone(json!({ "speed": 0.0 }))])])
}
