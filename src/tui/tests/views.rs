//! Pictures with cameras: painting over what is seen, looking from a view, and giving it the eye's place.

use std::path::Path;
use std::sync::Arc;

use kurbo::Point;
use serde_json::json;

use super::support::{at, press, said, said_last};
use crate::base::maths::tan;
use crate::base::progress::Watch;
use crate::files::materials::{self, Cache};
use crate::layers::parts::marks::Shape;
use crate::layers::space::camera::Camera;
use crate::preview::wire::message::Gesture;
use crate::render::sight::Sight;
use crate::render::{self, cpu};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::graphics::TerminalPicture;
use crate::tui::layout::{self, picture};
use crate::tui::panes;
use crate::tui::state::painting::Sees;
use crate::tui::state::{State, painting, place};
use crate::tui::text::color::Depth;

const SCENE: &str = r##"{
  "plica": 1, "size": [24, 16], "camera": { "position": [0, 0, 4], "target": [0, 0, 0] },
  "meshes": { "wall": { "path": "wall.obj" } },
  "layers": [{ "kind": "mesh", "name": "wall", "mesh": "wall", "pose": { "position": [0, 1, 0], "scale": 2 },
    "surface": { "kind": "plain", "color": "#a01020" }, "light": { "ambient": 1 } }]
}"##;

fn opened(folder: &Path) -> State {
    std::fs::write(folder.join("wall.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n").unwrap();
    let path = folder.join("a.plica.json");
    std::fs::write(&path, SCENE).unwrap();
    let mut state = State::new(OpenScene::in_memory(&path), (80, 24), Depth::None);
    show(&mut state);
    state
}

fn show(state: &mut State) {
    let scene = state.document().scene().clone();
    let (materials, problems) =
        materials::gather(state.scene.path(), &scene, state.scene.options(), &mut Cache::default());
    assert_eq!(problems, []);
    state.picture.synth = Some(Arc::new(render::synth(&scene, &materials, None).unwrap()));
}

/// As the editor does once it has opened the picture, or has not.
fn told_of_image(state: &mut State, effects: &[Effect], opened: Result<String, String>) {
    let after = effects.iter().find_map(|effect| match effect {
        Effect::EditImage { after, .. } => Some(after.clone()),
        _ => None,
    });
    after.into_iter().for_each(|after| state.opened_image(after, opened.clone()));
}

fn run(state: &mut State, line: &str) -> (String, Vec<Effect>) {
    let mut effects = press(state, &format!(": \"{line}\" Enter"));
    // As the editor does beside the keys.
    if let Some(at) = effects.iter().position(|effect| matches!(effect, Effect::Draw(_)))
        && let Effect::Draw(asked) = effects.remove(at)
    {
        let drawn = asked.wanted.draw(&asked.document, &asked.synth, &Watch::NONE).map_err(|error| error.to_string());
        effects.extend(update(state, Event::Drawn(Box::new(drawn.map(|drawn| (asked.wanted, drawn))))));
    }
    told_of_image(state, &effects, Ok("gimp has the picture".into()));
    (state.message.as_ref().map(|message| message.text.clone()).unwrap_or_default(), effects)
}

#[test]
fn what_is_seen_is_painted_over_from_where_it_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    let (told, effects) = run(&mut state, "views add flowers");
    assert_eq!(told, "1 picture laid on wall; 5 pictures of it as it was are its base coat; gimp has the picture");
    press(&mut state, "j");
    assert_eq!(said_last(&state).1, told, "keys are gone on with beside it");
    let picture = folder.path().join("views/flowers.png");
    assert!(
        effects.iter().any(|effect| matches!(effect, Effect::EditImage { path, .. } if *path == picture)),
        "{effects:?}"
    );
    let [own, guide] = ["flowers", "flowers-guide"].map(|name| folder.path().join(format!("views/{name}.png")));
    let [own, guide] = [own, guide].map(|path| std::fs::read(path).unwrap());
    assert_eq!(own, guide);
    // In the model: the pose puts it two times larger and one meter higher.
    let view = at(&state, "/layers/0/surface/views/5");
    assert_eq!(view["camera"], json!({ "position": [0, -0.5, 2], "target": [0, -0.5, 0], "fov": 40 }));
    assert_eq!((&view["kind"], &view["changed"]), (&json!("dependent"), &json!("flowers-guide")));
    assert_eq!(at(&state, "/images/flowers/path"), json!("views/flowers.png"));
    // Nothing is painted yet: the surface looks as it did.
    let before = cpu::frame(state.picture.synth.as_ref().unwrap(), 0.0);
    show(&mut state);
    let after = cpu::frame(state.picture.synth.as_ref().unwrap(), 0.0);
    let far = before.cells().iter().zip(after.cells()).flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| a.abs_diff(*b));
    assert!(far.max().unwrap() <= 1 && before.get(12, 8)[0] == 0xa0);
    assert!(run(&mut state, "views add flowers").0.contains("is taken"), "the name");
    press(&mut state, "u");
    assert_eq!(at(&state, "/layers/0/surface/kind"), json!("plain"), "one step of undo");
    assert!(run(&mut state, "views add flowers").0.contains("is there already"), "the file");
    assert!(run(&mut state, "views add ../x").0.contains("is no name for a file"));
    for (line, told) in [
        ("views add", "add is followed by a name"),
        ("views import", "import is followed by a file"),
        ("views tak", "views takes no \"tak\" (did you mean \"take\"?)"),
        (
            "views frob",
            "views takes no \"frob\" (there are \"go\", \"take\", \"next\", \"previous\", \"add\", \"guide\", \"import\", \"balance\")",
        ),
    ] {
        assert_eq!(run(&mut state, line).0, told, "{line}");
    }
    assert!(run(&mut state, "views add big both 99999x1").0.contains("1 to 16384 pixels"));
    (state.picture.synth, state.picture.synthesising, state.picture.read) = (None, true, Some(34));
    assert!(run(&mut state, "views add soon").0.contains("still being made (34 %)"));
}

#[test]
fn the_eye_goes_to_a_view_and_a_view_comes_to_the_eye() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    run(&mut state, "views add a both 8x8");
    show(&mut state);
    assert!(
        run(&mut state, "views go").0.starts_with("a is painted on, but there is no window"),
        "{:?}",
        state.message
    );
    assert!(run(&mut state, "views go nope").0.starts_with("there is no view \"nope\" (there are "));
    state.outside.window = "window".into();
    let looked = |effects: Vec<Effect>| {
        let camera = effects.into_iter().find_map(|effect| match effect {
            Effect::Look(camera) => camera,
            _ => None,
        });
        *camera.unwrap()
    };
    let camera = looked(run(&mut state, "views go a").1);
    assert_eq!((camera.position, camera.target, camera.fov), ([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0));
    assert!(run(&mut state, "views go b").0.contains("there is no view \"b\""));
    let own = Camera { position: [2.0, 1.0, 0.0], target: [0.0, 1.0, 0.0], fov: 50.0, ..Camera::default() };
    update(&mut state, said(Gesture::Camera(Some(own))));
    assert_eq!(run(&mut state, "views take a").0, "a is seen from here now");
    let camera = at(&state, "/layers/0/surface/views/5/camera");
    assert_eq!(camera, json!({ "position": [1, 0, 0], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 50 }));
    state.outside.camera = None;
    assert!(run(&mut state, "views take a").0.contains("the scene's camera now: the window looks from there too"));
    state.outside.window.clear();
    assert!(run(&mut state, "views take a").0.contains("open the window (:view) to aim"));
}

#[test]
fn what_the_shell_does_is_done_with_the_open_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    let scene = state.scene.path().display().to_string();
    for (line, words) in [
        ("views", vec!["views", &scene]),
        ("views --compare", vec!["views", &scene, "--compare"]),
        ("views import x.json --every 2", vec!["views", "import", "x.json", &scene, "--every", "2"]),
        ("views balance", vec!["views", "balance", &scene]),
        ("views add a --image b", vec!["views", "add", "a", &scene, "--image", "b"]),
        ("views guide a -o b.png", vec!["views", "guide", "a", &scene, "-o", "b.png"]),
    ] {
        let effects = run(&mut state, line).1;
        let ran = effects.iter().find_map(|effect| match effect {
            Effect::Run(words) => Some(words.clone()),
            _ => None,
        });
        assert_eq!(ran.unwrap(), words, "{line}");
    }
}

/// In select, of the view that is selected there.
fn points_go_on_the_sphere(state: &mut State) {
    // The first extreme point makes a ring where the view was gone; the next goes where the cursor is, between its neighbors.
    let extremes = "/layers/0/surface/views/5/extremes";
    let before = at(state, extremes);
    press(state, "a");
    let ring = json!([[45, 0], [0, 45], [-45, 0], [0, -45]]);
    assert_eq!(at(state, extremes), json!({ "kind": "points", "points": ring }));
    show(state);
    press(state, "2 l 2 k a");
    let points = at(state, &format!("{extremes}/points"));
    let new: [f64; 2] = serde_json::from_value(points[1].clone()).unwrap();
    assert!(points.as_array().unwrap().len() == 5 && new.iter().all(|angle| *angle > 2.0), "{points}");
    press(state, "h r");
    let moved: [f64; 2] = serde_json::from_value(at(state, &format!("{extremes}/points/1"))).unwrap();
    // The sphere is small here: beside it, the place is on its edge.
    assert!(moved[1] > new[1] + 5.0 && moved[0] > 2.0, "{moved:?} {new:?}");
    press(state, "s");
    assert_eq!(state.message.as_ref().unwrap().text, "blend point 0 stands here now");
    let blend = at(state, "/layers/0/surface/blend/points/0");
    assert_eq!(blend["target"], at(state, "/layers/0/surface/views/5/camera/target"));
    press(state, "u u u u");
    assert_eq!((at(state, extremes), at(state, "/layers/0/surface/blend")), (before, json!(null)));
}

#[test]
fn the_view_that_was_selected_last_is_painted_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    run(&mut state, "views add a both 8x6");
    show(&mut state);
    let name = |state: &State| painting::current(state).map(|(.., name)| name).unwrap();
    assert_eq!(name(&state), "a", "it has come last");
    run(&mut state, "go layers.wall.surface.views.1");
    let second = name(&state);
    run(&mut state, "go timeline");
    assert!(name(&state) == second && second != "a");
    state.outside.window = "window".into();
    run(&mut state, "views go a");
    assert_eq!(name(&state), "a");
    // From the row of another one, too.
    run(&mut state, "views next");
    assert_ne!(name(&state), "a");
    run(&mut state, "views go a");
    assert_eq!(name(&state), "a");
    run(&mut state, "views next");
    run(&mut state, "views add b both 8x6");
    assert_eq!(name(&state), "b");
}

#[test]
fn of_the_three_views_one_is_shown_and_its_marks_are_of_what_is_painted_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    run(&mut state, "views add a both 8x6");
    show(&mut state);
    state.outside.window = "window".into();
    let sees = |state: &State| (picture::sees(state), state.picture.told.is_some());
    for (layout, shown) in [("select", true), ("painting", true), ("results", false)] {
        run(&mut state, &format!("layout {layout}"));
        assert_eq!(sees(&state).1, shown, "{layout}");
        // One looks at the result.
        let effects = run(&mut state, "views go a").1;
        assert_eq!(sees(&state), (Sees::Results, false), "{layout}");
        assert_eq!(effects.iter().any(|effect| matches!(effect, Effect::Sight)), shown, "{layout}");
        assert!(run(&mut state, "sphere blend").0.contains(":layout select shows it"), "{layout}");
    }
    let row = |index: usize| format!("/layers/0/surface/views/{index}");
    let selection = |state: &State| picture::overlays(state).selection.unwrap();
    for (line, marked) in [
        ("go layers.wall.pose", "/layers/0/pose/position"),
        ("layout select", &row(5)),
        ("views next", &row(0)),
        ("go layers.wall.surface.views.2.camera", &format!("{}/camera/position", row(2))),
        ("go layers.wall.pose", &row(2)),
        ("layout results", "/layers/0/pose/position"),
    ] {
        let effects = run(&mut state, line).1;
        assert_eq!(selection(&state), marked, "{line}");
        assert!(line.starts_with("views") || effects.iter().any(|effect| matches!(effect, Effect::Show)), "{line}");
    }
}

#[test]
fn what_is_no_key_here_is_told_where_it_is_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    run(&mut state, "views add a both 8x6");
    show(&mut state);
    run(&mut state, "go layers.wall.pose");
    for (keys, told) in [
        ("g i Ctrl-n", "Ctrl-n is not a key here, but of the picture, in the layout for painting (? shows the keys)"),
        ("F12", "F12 is not a key here (? shows the keys)"),
        (
            "a",
            "no list in focus takes points: go to one that does first, and points of views are put in select (:layout select)",
        ),
        (
            ": \"layout painting\" Enter a",
            "things are placed in the results (:layout results), and points of views in select (:layout select)",
        ),
    ] {
        press(&mut state, keys);
        assert_eq!(said_last(&state), (true, told.to_owned()), "{keys}");
    }
}

#[test]
fn keys_do_not_wait_for_what_is_painted_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    let effects = press(&mut state, ": \"views add a\" Enter");
    let asked = effects.into_iter().find_map(|effect| match effect {
        Effect::Draw(asked) => Some(asked),
        _ => None,
    });
    let asked = *asked.unwrap();
    assert_eq!((state.outside.work.as_deref(), asked.wanted.pieces()), (Some("views add"), 15));
    assert!(run(&mut state, "views add b").0.contains("something is running already"));
    // Meanwhile another edit, which stays.
    run(&mut state, "set layers.wall.pose.scale=3");
    let drawn = |state: &State| {
        let synth = state.picture.synth.clone().unwrap();
        asked.wanted.draw(&asked.document, &synth, &Watch::NONE).map_err(|error| error.to_string())
    };
    let event = |drawn| Event::Drawn(Box::new(drawn));
    let ended = event(drawn(&state).map(|drawn| (asked.wanted.clone(), drawn)));
    let effects = update(&mut state, ended);
    told_of_image(&mut state, &effects, Err("there is no gimp here".into()));
    let told = "1 picture laid on wall; 5 pictures of it as it was are its base coat, but there is no gimp here";
    assert_eq!(said_last(&state), (true, told.to_owned()));
    assert_eq!(at(&state, "/layers/0/pose/scale"), json!(3));
    let count = |state: &State| at(state, "/layers/0/surface/views").as_array().unwrap().len();
    assert_eq!(count(&state), 6);
    // What comes when nothing is awaited is of a scene that has been left.
    let late = event(drawn(&state).map(|drawn| (asked.wanted.clone(), drawn)));
    update(&mut state, late);
    assert_eq!(count(&state), 6);
    state.outside.work = Some("views add".into());
    update(&mut state, event(Err("interrupted, nothing is added".into())));
    assert_eq!(said_last(&state), (true, "views add: interrupted, nothing is added".to_owned()));
    press(&mut state, "u u");
    state.outside.work = Some("views add".into());
    std::fs::remove_dir_all(folder.path().join("views")).unwrap();
    run(&mut state, "set layers.wall.surface.kind=view-map");
    let other = event(drawn(&state).map(|drawn| (asked.wanted.clone(), drawn)));
    update(&mut state, other);
    assert!(said_last(&state).1.contains("the surface has become another meanwhile"), "{:?}", said_last(&state));
}

#[test]
fn views_are_gone_through_by_a_key_and_a_far_one_makes_none_small() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    for line in ["views next", "views guide", "views take", "views take x"] {
        assert!(run(&mut state, line).0.contains(":views add NAME lays one"), "{line}: there is none yet");
    }
    run(&mut state, "views add a both 8x6");
    run(&mut state, "views add b both 8x6");
    show(&mut state);
    press(&mut state, ": \"layout select\" Enter Ctrl-n");
    let now = |state: &State| (painting::current(state).unwrap().1, said_last(state).1);
    assert_eq!((now(&state).0, now(&state).1.ends_with(", 1 of 7")), (0, true), "after the last comes the first");
    press(&mut state, "Ctrl-p");
    assert_eq!(now(&state), (6, "b, 7 of 7".to_owned()));
    assert!(
        matches!(press(&mut state, ": \"views guide\" Enter").first(), Some(Effect::Run(words)) if words[2] == "b")
    );
    press(&mut state, "Ctrl-p");
    let distance = |state: &State| match painting::sight(state) {
        Some(Sight::From(camera)) => glam::DVec3::from(camera.position).length(),
        other => panic!("{other:?}"),
    };
    let near = distance(&state);
    run(&mut state, "set layers.wall.surface.views.b.camera.position=[0, 0, 900]");
    assert!(distance(&state) < 2.0 * near, "{} {near}", distance(&state));
    press(&mut state, "Ctrl-n");
    assert!(distance(&state) > 100.0, "it is seen while it is selected");
}

#[test]
pub fn one_paints_in_three_views() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    assert!(run(&mut state, "layout paint").0.contains(":views add NAME lays one"), "there is none yet");
    run(&mut state, "views add a both 8x6");
    show(&mut state);
    run(&mut state, "go layers.wall.surface.views.5.hold");
    let made = |state: &State| {
        let wanted = picture::request(state).picture.unwrap();
        let synth = state.picture.synth.as_ref().unwrap();
        TerminalPicture::new(synth, state.document().scene(), 0.0, wanted, None)
    };
    let title = |state: &State| panes::picture::title(state).split("  ").next().unwrap().to_owned();
    let width = |state: &State| layout::picture_area(state).map(|area| area.width);
    assert_eq!(width(&state), None, "there is no room for it beside the others");
    run(&mut state, "layout paint");
    assert_eq!((title(&state).as_str(), width(&state), state.picture.size), ("results", Some(78), Some((24, 16))));
    let results = made(&state);
    press(&mut state, "Tab");
    assert_eq!((title(&state).as_str(), state.picture.size), ("painting a, 50 % of it", Some((8, 6))));
    let sight = |share: f64| Some(Sight::Painting { layer: 0, picture: 5, share });
    let painting = made(&state);
    assert_eq!(painting.wanted.sight, sight(0.5));
    // The picture is what its camera sees.
    let places = [painting.wanted.part, results.wanted.part].map(|part| part.place_of(Point::new(39.0, 20.0)));
    let colors = [painting.color_at(places[0]), results.color_at(places[1])];
    assert!(colors[0] == colors[1] && colors[0].is_some_and(|[r, ..]| r == 0xa0), "{colors:?}");
    assert_eq!(press(&mut state, "z )").iter().filter(|effect| matches!(effect, Effect::Sight)).count(), 1);
    assert_eq!((&made(&state).wanted.sight, &state.picture.told), (&sight(0.625), &sight(0.625)), "windows too");
    assert!(run(&mut state, "place add").0.contains(":layout results"));
    assert!(run(&mut state, "probe").0.contains(":layout results"));
    press(&mut state, "Tab");
    assert_eq!((title(&state).as_str(), state.picture.size), ("select", Some((24, 16))));
    let whole = panes::picture::title(&state);
    assert!(whole.contains("° right ") && whole.contains("° up  x "), "where the cursor is on the sphere: {whole}");
    let select = made(&state);
    let names: Vec<&str> = select
        .over
        .iter()
        .filter_map(|mark| match &mark.shape {
            Shape::Label(_, name) => Some(name.as_str()),
            _ => None,
        })
        .collect();
    assert!(names.len() == 6 && names.contains(&"a"), "all cameras are seen: {names:?}");
    points_go_on_the_sphere(&mut state);
    show(&mut state);
    press(&mut state, "Alt-Right Alt-Up");
    let turned = made(&state);
    assert!(turned.wanted.sight != select.wanted.sight && turned.frame != select.frame);
    assert_eq!(turned.over.iter().filter(|mark| matches!(mark.shape, Shape::Label(..))).count(), 6);
    press(&mut state, "Tab");
    assert_eq!((title(&state).as_str(), made(&state).frame == results.frame), ("results", true));
    press(&mut state, "Shift-Tab Shift-Tab Esc");
    assert_eq!((state.picture.size, state.picture.painting), (Some((24, 16)), None));
    assert_eq!(state.picture.told, None, "windows show the results again");
    assert!(run(&mut state, "layout twice").0.starts_with("layout takes "));
}

#[test]
fn what_is_in_the_model_is_seen_and_moved_through_its_pose() {
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path());
    run(&mut state, "views add flowers");
    run(&mut state, "set camera.position=[0, 0, 8]");
    show(&mut state);
    state.picture.size = Some((24, 16));
    let camera = "/layers/0/surface/views/5/camera";
    run(&mut state, &format!("go {camera}"));
    run(&mut state, "pane table");
    // In the world it is on the way from the camera to the middle.
    let middle = Point::new(12.0, 8.0);
    let seen = place::selected(&state).unwrap();
    assert!(seen.distance(middle) < 1e-9, "{seen:?}");
    state.picture.cursor = middle;
    run(&mut state, "place move");
    assert_eq!(at(&state, &format!("{camera}/position")), json!([0, -0.5, 2]), "it stays where it is");
    state.picture.cursor = Point::new(18.0, 8.0);
    run(&mut state, "place move");
    let moved = at(&state, &format!("{camera}/position"));
    let x = moved[0].as_f64().unwrap();
    // 6 px at 4 m, with a focal length of 8 px over the tangent of 20 degrees, and the model two times larger.
    let expected = 6.0 * 4.0 * tan(20_f64.to_radians()) / 8.0 / 2.0;
    assert!((x - expected).abs() < 1e-3 && moved[1] == json!(-0.5) && moved[2] == json!(2), "{moved} {expected}");
}
