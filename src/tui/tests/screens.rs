//! Compares the screens of the main states with tests/screens. PLICA_UPDATE=1 writes these files again.

use crate::tui::graphics::probed;
use std::path::Path;
use std::sync::Arc;

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::support::{press, state};
use crate::base::picture::Picture;
use crate::layers::parts::materials::Materials;
use crate::tui::commands::update::update;
use crate::tui::events::{Event, Synthesis};
use crate::tui::graphics::TerminalPicture;
use crate::tui::graphics::probed::Probed;
use crate::tui::layout::picture;
use crate::tui::panes::marks::Kept;
use crate::tui::panes::view;
use crate::tui::state::State;

/// The states: a name, and the keys that lead there.
pub const STATES: &[(&str, &str)] = &[
    ("start", ""),
    ("motion", "/ \"motion\" Enter Enter j 2 l"),
    ("entry", "/ \"motion\" Enter Enter 5 l i \"*1.1\""),
    ("selection", "/ \"motion\" Enter Enter l v j"),
    ("selection-entry", "/ \"motion\" Enter Enter l v 2 j i \"*1.1\""),
    ("pasted", "/ \"points\" Enter Enter j : \"paste [[1.5,2],[3,4.25]]\" Enter"),
    ("long", "/ \"motion\" Enter Enter 9 9 7 D l V i \"v+i\" Enter 5 0 0 g g"),
    ("outline", "/ \"outline\" Enter Enter"),
    ("choice", "/ \"interpolation\" Enter Enter Enter j"),
    ("optional", "/ \"fold\" Enter o"),
    ("refused", "/ \"radius\" Enter i \"-5\" Enter"),
    ("picture", "/ \"motion\" Enter g i w s 5 l 8 k"),
    ("command", ": \"und\" Tab"),
    ("hints", "z"),
    ("help", "?"),
    ("outside", ": \"probe 60,5\" Enter"),
    ("leader", "Space"),
    ("palette", "Space Space \"eye interp rad\""),
    ("help-of-a-field", "/ \"radius\" Enter ?"),
    ("found", "/ \"25\" Enter n"),
    ("searching", "/ \"25\""),
    ("unsaved", "/ \"speed\" Enter +"),
];

/// The editor with the picture read, on a terminal of this size.
pub fn opened(size: (u16, u16)) -> State {
    let mut state = state();
    update(&mut state, Event::Resize(size.0, size.1));
    state.play.time = 0.25;
    see(&mut state);
    state
}

/// Answers the request of the panes as the worker would.
pub fn see(state: &mut State) {
    let shade = |i: usize| [(i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0, 0.3, 1.0];
    let picture = Arc::new(Picture::from_cells(64, 64, (0..64 * 64).map(shade).collect()));
    let materials = Materials { pictures: [("cat".to_string(), picture)].into(), ..Materials::default() };
    let request = picture::request(state);
    let synth = Arc::new(crate::render::synth(&request.scene, &materials, None).unwrap());
    let longest = probed::longest(&synth);
    update(
        state,
        Event::Synthesised(Box::new(Ok(Synthesis { synth: synth.clone(), ms: 12.0, longest, warning: None }))),
    );
    if let Some(asked) = request.probe {
        let probed = Probed::new(asked, &request.scene, &synth, &materials).unwrap();
        update(state, Event::Probed(Arc::new(probed)));
    }
    if let Some(wanted) = request.picture {
        let before = state.picture.latest.clone();
        let shown = TerminalPicture::new(&synth, &request.scene, request.time, wanted, before.as_deref());
        update(state, Event::Picture(shown, 7.0));
    }
}

/// The text of the screen, with the cursor's place below.
pub fn screen(state: &State) -> String {
    let mut terminal = Terminal::new(TestBackend::new(state.size.0, state.size.1)).unwrap();
    terminal.draw(|frame| view::draw(frame, state, &mut Kept::default())).unwrap();
    let cursor = terminal.get_cursor_position().unwrap();
    let buffer = terminal.backend().buffer();
    let mut text = String::new();
    for row in buffer.content().chunks(usize::from(state.size.0)) {
        let line: String = row.iter().map(|cell| cell.symbol()).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    format!("{text}cursor {} {}\n", cursor.x, cursor.y)
}

/// The screen, if it differs from the file of this name.
pub fn changed(name: &str, state: &State) -> Option<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/screens");
    let path = folder.join(format!("{name}-{}x{}.txt", state.size.0, state.size.1));
    let found = screen(state);
    if std::env::var_os("PLICA_UPDATE").is_some() {
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(&path, &found).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    (kept != found).then(|| format!("{}:\n{found}", path.display()))
}

#[test]
fn screens_are_as_kept() {
    let mut old = Vec::new();
    for size in [(60, 20), (80, 24), (160, 48)] {
        for (name, keys) in STATES {
            let mut state = opened(size);
            press(&mut state, keys);
            see(&mut state);
            old.extend(changed(name, &state));
        }
    }
    assert!(old.is_empty(), "PLICA_UPDATE=1 writes these anew:\n{}", old.join("\n"));
}

#[test]
fn every_size_is_drawn_and_small_ones_say_so() {
    for (width, height) in [
        (1, 1),
        (20, 5),
        (59, 24),
        (60, 19),
        (60, 20),
        (79, 24),
        (80, 23),
        (80, 24),
        (111, 24),
        (112, 30),
        (200, 50),
        (400, 120),
    ] {
        for (_, keys) in STATES {
            let mut state = opened((width, height));
            press(&mut state, keys);
            see(&mut state);
            let small = width < 60 || height < 20;
            let text = screen(&state);
            assert!(!small || width < 20 || text.contains("Plica needs 60 x 20"), "{width} x {height}:\n{text}");
        }
    }
}
