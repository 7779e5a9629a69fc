//! What the panes see of the picture: which part they want from the worker, as a function of the state, and what it has
//! answered. The runner asks whenever this is something else than it asked for last.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use kurbo::Point;

use crate::base::pixels::encode;
use crate::layers::Layer;
use crate::layers::folding::{
    self,
    probe::{Probe, probe},
};
use crate::layers::parts::materials::Materials;
use crate::render::overlay::View;
use crate::render::part::Part;
use crate::render::{Synth, cpu};
use crate::scene::Scene;
use crate::tui::document::tree;
use crate::tui::graphics::sight;
use crate::tui::graphics::{Graphics, Marks, Protocol, Shown, Wanted};
use crate::tui::panes::view;
use crate::tui::state::place;
use crate::tui::state::{Mode, State};

/// What there is to see.
#[derive(Clone, Debug, Default)]
pub struct Seeing {
    /// What pictures the terminal takes.
    pub graphics: Graphics,
    /// The picture that the worker made last.
    pub shown: Option<Arc<Shown>>,
    /// Whether the read-out of the pixel under the cursor is open.
    pub probing: bool,
    /// What the worker said about a pixel last.
    pub probed: Option<Arc<Probed>>,
    /// The longest jump vector of every zone, by layer and zone.
    pub longest: Vec<(usize, usize, f64)>,
    /// Whether the worker synthesises.
    pub synthesising: bool,
}

/// A pixel that is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// The layer.
    pub layer: usize,
    /// Column and row.
    pub pixel: (usize, usize),
    /// Scene time.
    pub time: f64,
}

/// What one pixel does.
#[derive(Clone, Debug, PartialEq)]
pub struct Probed {
    /// What was asked.
    pub asked: Asked,
    /// What it does; none outside every zone.
    pub probe: Option<Probe>,
    /// The colour that the frame shows there: sRGB, straight alpha.
    pub colour: [u8; 4],
}

impl Probed {
    /// The answer, as `plica probe` has it; `None` if there is no such pixel.
    pub fn new(asked: Asked, scene: &Scene, synth: &Synth, materials: &Materials) -> Option<Probed> {
        let Layer::Picture(layer) = scene.layers.get(asked.layer)?;
        let (x, y) = asked.pixel;
        let probe = probe(layer, scene.timeline.wrap, materials, asked.pixel, asked.time).ok()?;
        let within = x < synth.size.0 && y < synth.size.1;
        let colour = within.then(|| encode(*cpu::lattice(synth, asked.time, &[x], &[y]).get(0, 0)));
        Some(Probed { asked, probe, colour: colour.unwrap_or_default() })
    }
}

/// The longest jump vector of every zone, in pixels.
pub fn longest(synth: &Synth) -> Vec<(usize, usize, f64)> {
    let mut all = Vec::new();
    for (i, layer) in synth.layers.iter().enumerate() {
        for zone in layer.downcast::<folding::synth::Synth>().iter().flat_map(|layer| &layer.zones) {
            let squares = zone.field.jumps.cells().iter().map(|&[x, y]| x * x + y * y);
            all.push((i, zone.index, f64::from(squares.fold(0.0, f32::max)).sqrt()));
        }
    }
    all
}

/// What the panes want to show.
#[derive(Clone)]
pub struct Request {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its file, which its pictures are relative to.
    pub path: PathBuf,
    /// Scene time.
    pub time: f64,
    /// Whether files may have changed since the last time.
    pub fresh: bool,
    /// The picture, where there is room for it.
    pub picture: Option<Wanted>,
    /// The pixel whose read-out is open.
    pub probe: Option<Asked>,
}

impl PartialEq for Request {
    /// Whether the same is to be seen.
    fn eq(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.path == other.path
            && self.time == other.time
            && self.picture == other.picture
            && self.probe == other.probe
    }
}

/// What the panes want now.
pub fn request(state: &State) -> Request {
    let scene = state.document().scene().clone();
    let path = state.door.path().to_owned();
    Request { scene, path, time: state.time, fresh: false, picture: wanted(state), probe: asked(state) }
}

/// The pixel under the cursor, where its read-out is open.
pub fn asked(state: &State) -> Option<Asked> {
    let at = state.placing.cursor;
    let pixel = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
    let layer = tree::place(&state.node).0.unwrap_or(0);
    state.seeing.probing.then_some(Asked { layer, pixel, time: state.time })
}

/// The protocol in force.
pub fn protocol(state: &State) -> Protocol {
    state.seeing.graphics.protocol(state.depth)
}

/// The part of the picture that its pane shows; `None` if there is no such pane on the screen.
pub fn part(state: &State) -> Option<Part> {
    let area = view::picture(state)?;
    let dots = state.seeing.graphics.dots(protocol(state), (area.width, area.height));
    Some(sight::part(&state.placing, state.picture_size?, dots))
}

/// Remembers what is in sight, so that the picture only moves when the cursor would leave it.
pub fn settle(state: &mut State) {
    if let Some(part) = part(state) {
        state.placing.middle = part.corner + part.seen() / 2.0;
    }
}

/// What is drawn over the picture, and how the selection stands out.
pub fn overlays(state: &State) -> View {
    let selection = Some(state.focused());
    View { outlines: true, regions: true, anchors: true, curves: true, selection, ..View::default() }
}

fn wanted(state: &State) -> Option<Wanted> {
    let area = view::picture(state)?;
    let graphics = &state.seeing.graphics;
    let (playing, still) = graphics.bytes;
    let protocol = protocol(state);
    let marks = || Marks {
        view: overlays(state),
        cursor: state.placing.cursor,
        aim: place::selected(state).filter(|_| matches!(state.mode, Mode::Aim)),
    };
    Some(Wanted {
        part: part(state)?,
        cells: (area.width, area.height),
        protocol,
        tmux: graphics.tmux,
        bytes: if state.playing { playing } else { still },
        marks: (protocol != Protocol::Blocks).then(marks),
    })
}

/// The place of the cursor on its pane, in cells from its corner.
pub fn cursor_cell(state: &State, part: &Part) -> Point {
    let (across, down) = state.seeing.graphics.dots_a_cell(protocol(state));
    let dot = part.dot_of(state.placing.cursor);
    Point::new((dot.x / across as f64).floor(), (dot.y / down as f64).floor())
}

/// What was asked of the worker, and when it may be asked for the next picture. Writing a picture to a slow link takes
/// time, in which keys would wait: after it the link is left to them for twice as long. Pictures in between are dropped,
/// never queued.
#[derive(Default)]
pub struct Eyes {
    asked: Option<Request>,
    written: Option<Arc<Shown>>,
    free: Option<Instant>,
}

/// However slow the link, a picture comes as often as this.
const LONGEST: Duration = Duration::from_secs(5);

impl Eyes {
    /// What to ask the worker for now: something new, and a picture only where the link is free for one.
    pub fn request(&mut self, state: &State) -> Option<Request> {
        let mut request = request(state);
        if self.asked.as_ref() == Some(&request) {
            return None;
        }
        if !self.left().is_zero() {
            let same = |asked: &Request| Arc::ptr_eq(&asked.scene, &request.scene) && asked.probe == request.probe;
            if self.asked.as_ref().is_some_and(same) {
                return None;
            }
            request.picture = None;
        }
        self.asked = Some(request.clone());
        Some(request)
    }

    /// A screen has been written, and it took so long.
    pub fn wrote(&mut self, state: &State, took: Duration) {
        let shown = state.seeing.shown.as_ref();
        if self.written.as_ref().map(Arc::as_ptr) != shown.map(Arc::as_ptr) {
            self.written = shown.cloned();
            self.free = Some(Instant::now() + (took * 2).min(LONGEST));
        }
    }

    /// How long to wait for events: `otherwise`, or until a picture may be asked for that is wanted by then.
    pub fn patience(&self, otherwise: Duration) -> Duration {
        let left = self.left();
        if left.is_zero() { otherwise } else { left.min(otherwise) }
    }

    fn left(&self) -> Duration {
        self.free.map_or(Duration::ZERO, |free| free.saturating_duration_since(Instant::now()))
    }
}
