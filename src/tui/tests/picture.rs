//! The picture in the terminal: zoom and pan, every protocol, the limit of bytes, the read-out of a pixel.

use std::sync::Arc;

use crate::base::problem::Problem;
use crate::scene::Edit;
use crate::tui::layout;
use kurbo::Point;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, CellDiffOption};
use ratatui::layout::Rect;
use ratatui::style::Color;
use serde_json::json;

use super::screens::{STATES, changed, opened, screen, see};
use super::support::{press, said, said_last, state, state_of};
use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::marks::View;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::readout::{Entry, Value};
use crate::preview::wire::message::Gesture;
use crate::tui::commands::update::update;
use crate::tui::events::{Effect, Event};
use crate::tui::graphics::{Protocol, TerminalPicture, Wanted};
use crate::tui::layout::picture;
use crate::tui::panes::marks::Kept;
use crate::tui::panes::view;
use crate::tui::state::State;
use crate::tui::text::color::Depth;

/// The screen as cells.
fn cells(state: &State) -> Buffer {
    let mut terminal = Terminal::new(TestBackend::new(state.size.0, state.size.1)).unwrap();
    terminal.draw(|frame| view::draw(frame, state, &mut Kept::default())).unwrap().buffer.clone()
}

#[test]
fn a_click_belongs_to_the_pane_that_is_seen_there() {
    use crate::tui::state::Pane::{Picture, Table, Tree};
    for (size, keys, at, pane) in [
        ((80, 24), "g i", (50, 8), Picture),
        ((80, 24), "g i", (50, 20), Picture),
        ((100, 30), "g i", (60, 10), Picture),
        ((100, 30), "g i", (3, 3), Tree),
        ((100, 30), "", (60, 10), Table),
        ((119, 30), "g i", (60, 10), Table),
        ((160, 50), "", (150, 40), Picture),
    ] {
        let mut state = opened(size);
        press(&mut state, keys);
        update(&mut state, Event::Click(at.0, at.1));
        assert_eq!(state.cursor.focus, pane, "{size:?} {keys} {at:?}");
    }
}

/// The editor with the picture in a protocol, on a wide terminal.
fn shown_by(protocol: Protocol, keys: &str) -> State {
    let mut state = opened((160, 48));
    state.depth = Depth::True;
    state.picture.graphics.forced = Some(protocol);
    press(&mut state, keys);
    see(&mut state);
    state
}

#[test]
pub fn zooming_keeps_the_cursor_and_panning_takes_it_along() {
    // The picture has 64 x 64 pixels, its pane 62 x 44 dots.
    const FIT: f64 = 64.0 / 44.0;
    for (keys, scale, corner, cursor) in [
        ("", FIT, None, (30.5, 25.5)),
        ("z 1", 1.0, Some((1.0, 8.0)), (30.5, 25.5)),
        ("z 1 z z", 1.0, Some((0.0, 4.0)), (30.5, 25.5)),
        ("z + z +", 0.5, Some((16.0, 17.0)), (30.5, 25.5)),
        ("z + z + z z", 0.5, Some((15.0, 15.0)), (30.5, 25.5)),
        ("z + z + z l", 0.5, Some((24.0, 17.0)), (30.5, 25.5)),
        ("z + z + z l z l", 0.5, Some((32.0, 17.0)), (32.5, 25.5)),
        ("z + z + z h z h z h", 0.5, Some((0.0, 17.0)), (30.5, 25.5)),
        ("2 z + z f", FIT, None, (30.5, 25.5)),
        ("g i + + 0", FIT, None, (30.5, 25.5)),
        ("g i + + -", 1.0, None, (30.5, 25.5)),
        ("g i + + 9 L", 0.5, Some((33.0, 17.0)), (63.5, 25.5)),
    ] {
        let mut state = opened((160, 48));
        press(&mut state, keys);
        let part = picture::part(&state).unwrap();
        assert_eq!(part.dots, (62, 44), "{keys}");
        assert!((part.scale - scale).abs() < 1e-9, "{keys}: {}", part.scale);
        corner.into_iter().for_each(|corner| assert_eq!(part.corner, Point::from(corner), "{keys}"));
        assert_eq!(state.picture.cursor, Point::from(cursor), "{keys}");
    }
}

#[test]
fn nothing_is_asked_for_that_no_pane_shows() {
    let mut state = opened((80, 24));
    assert!(picture::request(&state).picture.is_none());
    press(&mut state, "g i");
    let wanted = picture::request(&state).picture.unwrap();
    assert_eq!((wanted.cells, wanted.part.dots), ((55, 20), (55, 40)));
    assert!(picture::request(&state) == picture::request(&state));
    press(&mut state, "l");
    assert_eq!(picture::request(&state).picture, Some(wanted), "half-blocks have their cursor over them");
}

#[test]
fn every_protocol_fills_its_pane_and_stays_within_its_bytes() {
    for (protocol, start) in
        [(Protocol::Kitty, "\x1b_Gi="), (Protocol::Iterm2, "\x1b]1337;File=inline=1"), (Protocol::Sixel, "\x1bP0;1;0q")]
    {
        for bytes in [4_000, 64_000] {
            let state = shown_by(protocol, &format!(": \"graphics bytes {bytes}\" Enter"));
            let shown = state.picture.latest.clone().unwrap();
            assert!(shown.bytes <= bytes, "{protocol:?}: {} bytes", shown.bytes);
            assert_eq!(shown.by > 1, bytes == 4_000, "{protocol:?} {bytes}: by {}", shown.by);
            let area = layout::picture_area(&state).unwrap();
            let found = cells(&state);
            let first = found.cell(area.as_position()).unwrap();
            assert!(first.symbol().contains(start), "{protocol:?}: {:.60}", first.symbol());
            let title =
                format!("{}{}", protocol.name(), if shown.by > 1 { format!(" /{}", shown.by) } else { String::new() });
            let text: String =
                found.content().iter().filter(|cell| cell.symbol().len() < 20).map(|c| c.symbol()).collect();
            assert!(text.contains(&title), "{title}: {text}");
        }
    }
}

#[test]
fn half_blocks_stay_within_their_bytes_too() {
    let state = shown_by(Protocol::Blocks, ": \"graphics bytes 8000\" Enter");
    let shown = state.picture.latest.clone().unwrap();
    assert!(shown.bytes <= 8000 && shown.by > 1 && shown.cells.is_none());
}

#[test]
fn a_picture_is_sharp_again_after_playing() {
    let mut state = shown_by(Protocol::Sixel, "");
    assert_eq!(state.picture.latest.as_ref().unwrap().by, 1);
    state.picture.graphics.bytes = (4_000, 256_000);
    for (playing, reduced) in [(true, true), (false, false)] {
        state.play.playing = playing;
        see(&mut state);
        assert_eq!(state.picture.latest.as_ref().unwrap().by > 1, reduced, "playing: {playing}");
    }
}

#[test]
fn what_lies_over_a_picture_is_not_painted_over() {
    for protocol in [Protocol::Kitty, Protocol::Iterm2, Protocol::Sixel] {
        let mut state = shown_by(protocol, "");
        press(&mut state, "g");
        let (found, area) = (cells(&state), layout::picture_area(&state).unwrap());
        let pixels = area.positions().filter(|&at| {
            let cell = found.cell(at).unwrap();
            cell.diff_option == CellDiffOption::Skip || cell.symbol().contains('\x1b')
        });
        // Kitty's picture is sent once, with its first cell; other protocols give way.
        assert_eq!(pixels.count(), usize::from(protocol == Protocol::Kitty), "{protocol:?}");
        let text: String = found.content().iter().map(|cell| cell.symbol()).collect();
        assert!(text.contains("Go to the tree"), "{protocol:?}");
        press(&mut state, "t");
        see(&mut state);
        assert!(
            cells(&state).cell(area.as_position()).unwrap().symbol().contains('\x1b'),
            "{protocol:?}: it comes back"
        );
    }
}

#[test]
pub fn graphics_are_told_and_set() {
    for (keys, said, bad) in [
        (": \"graphics\" Enter", "graphics: blocks (the terminal: blocks)", false),
        (": \"graphics sixel\" Enter", "graphics: sixel", false),
        (": \"graphics sixl\" Enter", "sixel", true),
        (": \"graphics bytes 5\" Enter", "1000", true),
        (": \"graphics bytes 20000\" Enter", "at most 20000 bytes", false),
        (": \"graphics rate 9000\" Enter", "9000 a second while blocks play", false),
        (": \"graphics rate 9\" Enter", "from 1000", true),
        (": \"vectors\" Enter", "vectors color=plain length=1 equal=off longest=auto steepest=auto opacity=1", false),
        (": \"vectors color=curl length=2\" Enter", "color=curl length=2 equal=off", false),
        (": \"vectors lenght=2\" Enter", "did you mean \"length\"?", true),
        ("z *", "vectors color=plain length=1.4", false),
        (": \"zoom sideways\" Enter", "in, out, fit or one", true),
    ] {
        let mut state = state();
        state.depth = Depth::Ansi;
        press(&mut state, keys);
        let message = state.message.clone().unwrap();
        assert!(message.bad == bad && message.text.contains(said), "{keys}: {message:?}");
    }
}

#[test]
pub fn a_pass_is_shown_in_place_of_the_picture() {
    for (keys, title, wrong) in [
        (": \"pass depth\" Enter", "picture depth  x", None),
        (": \"pass normal:face\" Enter", "picture normal:face  x", None),
        (": \"pass depth\" Enter : \"pass\" Enter", "picture  x", None),
        (": \"pass depth\" Enter : \"pass color\" Enter", "picture  x", None),
        (": \"pass dept\" Enter", "picture  x", Some("did you mean \"depth\"?")),
        (": \"pass uv:fce\" Enter", "picture  x", Some("did you mean \"face\"?")),
        (": \"pass bogus\" Enter", "picture  x", Some("\"bogus\" (there is \"color\")")),
    ] {
        let mut state = opened((160, 48));
        press(&mut state, keys);
        assert!(screen(&state).contains(title), "{keys}: {}", screen(&state));
        let said = state.message.as_ref().filter(|message| message.bad).map(|message| message.text.clone());
        assert_eq!(said.is_some(), wrong.is_some(), "{keys}: {said:?}");
        assert!(wrong.is_none_or(|wrong| said.unwrap_or_default().contains(wrong)), "{keys}");
    }
}

#[test]
fn without_colors_kitty_is_not_used() {
    let mut state = opened((160, 48));
    press(&mut state, ": \"graphics kitty\" Enter");
    assert_eq!(picture::protocol(&state), Protocol::Blocks);
    assert!(screen(&state).contains("blocks"));
}

#[test]
pub fn the_read_out_opens_follows_and_closes() {
    for (keys, open, pixel) in [
        ("g p", true, Some((30, 25))),
        ("g p l l j", true, Some((32, 26))),
        ("g p g p", false, None),
        ("g i Enter", true, Some((30, 25))),
        ("g i Enter Enter", false, None),
        (": \"probe 12,13\" Enter", true, Some((12, 13))),
        (": \"probe 12,13\" Enter : \"probe 14,15\" Enter", true, Some((14, 15))),
        (": \"probe 12,13\" Enter : \"probe off\" Enter", false, None),
        (": \"probe 63.5,13\" Enter", true, Some((63, 13))),
        (": \"probe 1e9,13\" Enter", false, None),
    ] {
        let mut state = opened((80, 24));
        press(&mut state, keys);
        see(&mut state);
        assert_eq!(state.picture.probing, open, "{keys}");
        assert_eq!(picture::probe_at(&state).map(|asked| asked.pixel), pixel, "{keys}");
        assert_eq!(screen(&state).contains("┬ probe ─") || screen(&state).contains(" probe ─"), open, "{keys}");
    }
    let mut state = opened((160, 48));
    press(&mut state, "g p");
    see(&mut state);
    let text = screen(&state);
    for part in [
        "pixel 30,25",
        "left eye   active",
        "jump 3.034, 3.936 px   length 4.969 px   -52.378°",
        "s 0.707",
        "no thresholds",
        "reads 32.645, 28.283",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
    press(&mut state, "] ]");
    assert_ne!(picture::probe_at(&state), state.picture.probed.as_ref().map(|probed| probed.at), "it follows the time");
}

#[test]
fn thresholds_stand_on_the_path() {
    let mut old = Vec::new();
    for size in [(80, 24), (160, 48)] {
        let mut state = opened(size);
        let region = json!({"kind": "rectangle", "x": 15, "y": 10, "width": 20, "height": 4});
        let fold = json!({"rule": "return", "regions": [region]});
        let edit = Edit::set(state.document(), "/layers/0/zones/0/fold", fold);
        state.edit(edit, false).unwrap();
        press(&mut state, ": \"probe 20,20\" Enter g i");
        see(&mut state);
        let read = state.picture.probed.clone().unwrap().read.clone().unwrap();
        let axis = read.axis.as_ref().unwrap();
        assert_eq!((axis.ticks.len(), axis.stretches.len()), (2, 2), "{axis:?}");
        let active = |entry: &Entry| matches!(entry.value, Value::Flag { on: true, .. });
        assert!(read.entries.iter().any(active), "{read:?}");
        let text = screen(&state);
        assert!(
            text.contains('┃') && text.contains('━') && text.contains('┄') && text.contains("thresholds 0."),
            "{text}"
        );
        old.extend(changed("probe", &state));
    }
    assert!(old.is_empty(), "PLICA_UPDATE=1 writes these anew:\n{}", old.join("\n"));
}

#[test]
fn long_work_says_how_far_it_is_and_how_to_end_it() {
    let mut old = Vec::new();
    for size in [(80, 24), (160, 48)] {
        let mut state = opened(size);
        update(&mut state, Event::Progress("render: frame 12/60 █░░░░░░░ 20%, 6 s left".into()));
        let text = screen(&state);
        assert!(text.contains("render: frame 12/60 █░░░░░░░ 20%, 6 s left  Esc cancels"), "{text}");
        old.extend(changed("work", &state));
    }
    assert!(old.is_empty(), "PLICA_UPDATE=1 writes these anew:\n{}", old.join("\n"));
    let mut state = opened((80, 24));
    update(&mut state, Event::Done(Err("/a: is wrong\n/b: too\ncheck: s: 2 errors".into())));
    let text = screen(&state);
    assert!(text.contains("/a: is wrong") && text.contains("/b: too") && text.contains("check: s: 2 errors"), "{text}");
    let mut state = opened((80, 24));
    update(&mut state, Event::Synthesising);
    assert!(screen(&state).contains("field ..."));
    update(&mut state, Event::Reading(34));
    assert!(screen(&state).contains("files 34 %"));
    update(&mut state, Event::Reading(100));
    update(&mut state, Event::Filling(12));
    assert!(screen(&state).contains("field 12 %"));
    update(&mut state, Event::Filling(100));
    assert!(screen(&state).contains("field ..."));
    update(&mut state, Event::Synthesised(Box::new(Err(Problem::error("", "no")))));
    assert!(!screen(&state).contains("field ..."));
}

#[test]
fn every_zone_has_its_curve_and_few_rows_its_place() {
    let state = opened((160, 48));
    let text = screen(&state);
    assert!(text.contains("a left eye s 0.707  b mouth"), "{text}");
    let text = screen(&opened((112, 24)));
    assert!(text.contains("a left eye s 0.707"), "{text}");
}

#[test]
fn a_scene_in_which_nothing_has_a_curve_leaves_their_room_to_the_picture() {
    let mut mesh = state_of(r#"{"plica": 1, "layers": [{"kind": "fill", "name": "sky"}]}"#);
    let mut zones = opened((160, 48));
    for (state, has) in [(&mut mesh, false), (&mut zones, true)] {
        state.size = (160, 48);
        let areas = layout::areas(Rect::new(0, 0, 160, 48), state);
        assert_eq!(areas.plots.is_some(), has);
        assert_eq!(areas.picture.unwrap().height == 46, !has, "{areas:?}");
        assert_eq!((screen(state).contains("field"), screen(state).contains("position")), (has, has));
    }
}

/// Outside pictures and fields, a screen has the same text with and without colors, and only the terminal's own 16 colors.
#[test]
fn colors_say_nothing_by_themselves() {
    let chrome = |state: &State| {
        let areas = layout::areas(Rect::new(0, 0, 160, 48), state);
        let (field, picture) = (areas.plots.unwrap()[0], areas.picture.unwrap());
        let all = cells(state);
        let kept = all.area.positions().filter(|at| !field.contains(*at) && !picture.contains(*at));
        kept.map(|at| all.cell(at).unwrap().clone()).collect::<Vec<_>>()
    };
    for (name, keys) in STATES {
        let mut plain = None;
        for depth in [Depth::None, Depth::Ansi, Depth::Indexed, Depth::True] {
            let mut state = opened((160, 48));
            state.depth = depth;
            press(&mut state, keys);
            see(&mut state);
            let found = chrome(&state);
            let text: String = found.iter().map(|cell| cell.symbol()).collect();
            let covered = !state.typing.pressed.is_empty() || name == &"help";
            assert!(covered || *plain.get_or_insert_with(|| text.clone()) == text, "{name} {depth:?}");
            for color in found.iter().flat_map(|cell| [cell.fg, cell.bg]) {
                let own = !matches!(color, Color::Rgb(..) | Color::Indexed(_));
                assert!(own && (depth != Depth::None || color == Color::Reset), "{name} {depth:?}: {color:?}");
            }
            for color in cells(&state).content().iter().flat_map(|cell| [cell.fg, cell.bg]) {
                let allowed = match color {
                    Color::Rgb(..) => depth == Depth::True,
                    Color::Indexed(_) => depth == Depth::Indexed,
                    Color::Reset => true,
                    _ => depth != Depth::None,
                };
                assert!(allowed, "{name} {depth:?}: {color:?}");
            }
        }
    }
}

#[test]
fn panes_say_what_the_items_of_a_layer_are_called() {
    let fill = r#"{"kind": "fill", "name": "sky"}"#;
    let empty = r#"{"kind": "picture", "name": "face", "image": "cat"}"#;
    for (layer, words) in [
        (fill, ["this layer has no vector field", "nothing here moves"]),
        (empty, ["select a zone", "the layer has no zones"]),
    ] {
        let zone = r#"{"name": "all", "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9}}"#;
        let mut state = state_of(&format!(
            r#"{{"plica": 1, "images": {{"cat": {{"path": "cat.png"}}}},
                "layers": [{layer}, {{"kind": "picture", "name": "other", "image": "cat", "zones": [{zone}]}}]}}"#
        ));
        state.size = (160, 48);
        let shown = screen(&state);
        assert!(words.iter().all(|word| shown.contains(word)), "{shown}");
    }
}

#[test]
fn a_legend_tells_what_is_shown_of_the_field_until_it_is_hidden() {
    let mut state = shown_by(Protocol::Blocks, "");
    state.size = (160, 48);
    for (keys, has, has_not) in [
        ("", "", "every"),
        ("z v", "arrows to ", "length"),
        (": \"vectors color=length longest=20\" Enter", "every 8  length 0 to 20 px", "directions"),
        ("z Y", "arrows equal every ", "arrows to "),
        ("z v z d", "length 0 to 20 px  here ", "arrows"),
        (": \"vectors default\" Enter", "directions to ", "length"),
        ("z E", "", "directions"),
        ("z E z d z y", "here ", "directions"),
    ] {
        press(&mut state, keys);
        state.message = None;
        see(&mut state);
        let legend = crate::tui::panes::picture::legend(&state).unwrap_or_default();
        assert!(legend.contains(has) && !legend.contains(has_not), "{keys}: {legend}");
        let begins: String = legend.chars().take(20).collect();
        assert!(screen(&state).contains(&begins), "{keys}: {legend}");
    }
}

#[test]
fn overlays_that_are_switched_on_are_in_the_picture() {
    for protocol in [Protocol::Blocks, Protocol::Kitty] {
        let mut state = shown_by(protocol, "");
        let shown = |state: &State| (state.picture.latest.as_ref().unwrap().frame.clone(), screen(state));
        let before = shown(&state);
        let told = press(&mut state, "z v");
        assert!(told.iter().any(|effect| matches!(effect, Effect::View(Some(view)) if view == "view-field on")));
        state.message = None;
        see(&mut state);
        let arrows = shown(&state);
        match protocol {
            Protocol::Blocks => assert!(before.0 == arrows.0 && before.1 != arrows.1),
            _ => assert!(before.0 != arrows.0),
        }
        update(&mut state, said(Gesture::Command("view-field off".into())));
        see(&mut state);
        assert!(shown(&state) == before, "a window has switched it off: {protocol:?}");
    }
}

#[test]
fn the_edges_of_a_mesh_are_made_for_every_protocol() {
    let scene = r#"{ "plica": 1, "size": [60, 60], "camera": {"position": [0, 0, 4], "target": [0, 0, 0]},
        "meshes": {"m": {"path": "m.obj"}}, "layers": [{"kind": "mesh", "name": "m", "mesh": "m"}] }"#;
    let scene = serde_json::from_str(scene).unwrap();
    let corner = |[x, y]: [f64; 2]| Vertex { position: [x, y, 0.0].into(), ..Vertex::default() };
    let vertices = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner).to_vec();
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh))].into(), ..Materials::default() };
    let synth = crate::render::synth(&scene, &materials, None).unwrap();
    for protocol in [Protocol::Blocks, Protocol::Kitty] {
        let shown = |over: View| {
            let mut state = shown_by(protocol, "");
            state.picture.size = Some((60, 60));
            let wanted = Wanted { over, ..picture::request(&state).picture.unwrap() };
            TerminalPicture::new(&synth, &scene, 0.0, wanted, None)
        };
        let [plain, edges] = [shown(View::default()), shown(View::of(&["view-wires"]))];
        assert_eq!((plain.over.len(), edges.over.len()), (0, 5));
        assert_eq!(plain.frame != edges.frame, protocol == Protocol::Kitty, "half-blocks have them over the picture");
    }
}

#[test]
fn what_is_turned_off_in_windows_is_off_here_too() {
    let mut state = state();
    let shown = |state: &State| picture::overlays(state).shown.contains("view-outlines");
    assert!(shown(&state), "at first");
    for (keys, on, said) in
        [("z o", true, "Zone outlines: on"), ("z o", false, "Zone outlines: off"), ("z o", true, "on")]
    {
        press(&mut state, keys);
        assert_eq!(shown(&state), on, "{keys}");
        assert!(said_last(&state).1.contains(said), "{:?}", said_last(&state));
    }
}
