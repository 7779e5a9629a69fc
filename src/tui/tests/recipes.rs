//! The recipes of docs/recipes: their keys are pressed, nothing is refused, and the frames move and come back.

use std::path::Path;

use super::support::press;
use crate::base::pixels::Frame;
use crate::files::session::Mode as Open;
use crate::files::{Options, materials, picture};
use crate::render::{self, cpu};
use crate::tui::commands::update::update;
use crate::tui::document::open_scene::OpenScene;
use crate::tui::events::{Effect, Event};
use crate::tui::state::State;
use crate::tui::text::color::Depth;

/// A block of a recipe: how it is marked, and its lines.
fn blocks(text: &str) -> Vec<(&str, Vec<&str>)> {
    let pieces = text.split("```").skip(1).step_by(2);
    pieces
        .filter_map(|piece| piece.split_once('\n'))
        .map(|(kind, lines)| (kind.trim(), lines.lines().collect()))
        .collect()
}

/// The editor on a recipe's first picture, beside copies of all of them.
fn opened(folder: &Path, text: &str) -> State {
    let line = text.lines().find(|line| line.starts_with("Picture")).expect("a line that names the pictures");
    let named: Vec<&str> = line.split('`').skip(1).step_by(2).collect();
    for name in &named {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        std::fs::copy(&from, folder.join(from.file_name().unwrap())).unwrap();
    }
    let first = folder.join(Path::new(named[0]).file_name().unwrap());
    let scene = OpenScene::open(&first, Open::Edit, &Options::default()).unwrap();
    let mut state = State::new(scene, (120, 40), Depth::None);
    state.picture.size = picture::size(&first, &Options::default().limits).ok();
    state
}

/// How many keys a block takes: a pasted one as many as its text.
fn keys(kind: &str, lines: &[&str]) -> usize {
    let typed = |line: &&str| match kind == "paste" || line.starts_with([':', '/']) {
        true => line.chars().count() + 1,
        false => {
            let words = line.split('"').enumerate();
            words.map(|(i, part)| if i % 2 == 1 { part.chars().count() } else { part.split_whitespace().count() }).sum()
        }
    };
    lines.iter().map(typed).sum()
}

/// Presses what a block says; returns what was asked for outside.
fn follow(state: &mut State, kind: &str, lines: &[&str]) -> Vec<Effect> {
    let mut effects = Vec::new();
    if kind == "paste" {
        effects.extend(update(state, Event::Paste(lines.join("\n"))));
        assert!(!state.message.as_ref().is_some_and(|message| message.bad), "{lines:?}: {:?}", state.message);
        return effects;
    }
    for line in lines {
        match line.strip_prefix([':', '/']) {
            Some(rest) => {
                effects.extend(press(state, &line[..1]));
                for c in rest.chars() {
                    effects.extend(update(state, Event::Key(if c == ' ' { "Space".into() } else { c.to_string() })));
                }
                effects.extend(press(state, "Enter"));
            }
            None => effects.extend(press(state, line)),
        }
        assert!(!state.message.as_ref().is_some_and(|message| message.bad), "{line}: {:?}", state.message);
    }
    effects
}

/// How far two frames differ, in the mean of all channels.
fn difference(a: &Frame, b: &Frame) -> f64 {
    let sum = |y: usize| {
        let pixels = a.row(y).iter().zip(b.row(y));
        pixels.map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>()).sum::<f64>()
    };
    (0..a.height()).map(sum).sum::<f64>() / (a.width() * a.height() * 4) as f64
}

fn followed(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/recipes").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut state = opened(folder.path(), &text);
    let mut effects = Vec::new();
    let blocks = blocks(&text);
    let pressed: usize =
        blocks.iter().filter(|(kind, _)| ["keys", "paste"].contains(kind)).map(|(kind, lines)| keys(kind, lines)).sum();
    assert!(text.contains(&format!("\n{pressed} keys")), "{name} tells how many keys it takes: {pressed}");
    for (kind, lines) in blocks.iter().filter(|(kind, _)| ["keys", "paste"].contains(kind)) {
        effects.extend(follow(&mut state, kind, lines));
    }
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Save { .. })), "{name} is saved");
    assert!(
        effects.iter().any(|effect| matches!(effect, Effect::Run(words) if words[0] == "render")),
        "{name} ends in a loop"
    );
    let scene = state.document().scene();
    let loaded = materials::load(state.scene.path(), scene, &Options::default(), &mut materials::Cache::default());
    let synth = render::synth(scene, &loaded.unwrap().0, None).unwrap();
    let begin = cpu::frame(&synth, 0.0);
    let times = |wanted: &str| -> Vec<f64> {
        let block = blocks.iter().find(|(kind, _)| *kind == wanted).map(|(_, lines)| lines.join(" ")).unwrap();
        block.split_whitespace().map(|time| time.parse().unwrap()).collect()
    };
    for t in times("still") {
        let far = difference(&begin, &cpu::frame(&synth, t));
        assert!(far < 0.05, "{name} at {t}: {far} from its beginning");
    }
    for t in times("moving") {
        let far = difference(&begin, &cpu::frame(&synth, t));
        assert!(far > 0.3, "{name} at {t}: {far}");
    }
}

#[test]
fn an_eyelid() {
    followed("eyelid.md");
}

#[test]
fn a_swash() {
    followed("swash.md");
}

#[test]
fn a_chest_that_breathes() {
    followed("breathing.md");
}

#[test]
fn a_wound() {
    followed("wound.md");
}

#[test]
fn a_car_that_flies_over() {
    followed("fly-over.md");
}
