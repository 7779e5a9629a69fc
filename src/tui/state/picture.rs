//! The picture: which part of it is visible, and what the worker has made of the scene.

use std::collections::BTreeSet;
use std::sync::Arc;

use kurbo::{Point, Vec2};

use crate::layers::parts::picking::Subject;
use crate::preview::views::Switches;
use crate::render::Synth;
use crate::render::passes::Asked;
use crate::render::sight::Sight;
use crate::scene::Scene;
use crate::tui::graphics::counts::Counts;
use crate::tui::graphics::probed::Probed;
use crate::tui::graphics::viewport::Viewport;
use crate::tui::graphics::{Graphics, TerminalPicture};

/// The picture and its read-out. What the worker has made is outdated while it works on a newer scene.
#[derive(Clone)]
pub struct Picture {
    /// The cursor, in pixels of the picture; on the center of a pixel unless a number has set it.
    pub cursor: Point,
    /// Which part is visible.
    pub viewport: Viewport,
    /// Width and height of the picture, once known.
    pub size: Option<(usize, usize)>,
    /// The pass that is shown in place of the frame.
    pub pass: Option<Asked>,
    /// What is looked at of a clip in place of the scene.
    pub looking: Option<Looking>,
    /// How one paints on a mesh, in the layout for that.
    pub painting: Option<Painting>,
    /// The picture on a mesh that was selected last, by its layer and its index: it is painted on while the cursor is elsewhere.
    pub laid: Option<(usize, usize)>,
    /// The row that windows were told to mark in place of what is under the cursor.
    pub marked: Option<String>,
    /// What windows were told to show in place of what the camera sees.
    pub told: Option<Sight>,
    /// Which overlays are shown here and in the windows. Those of the document alone are shown here until they are turned off.
    pub switches: Switches,
    /// Those of the document that were.
    pub off: BTreeSet<String>,
    /// How pictures are sent to the terminal.
    pub graphics: Graphics,
    /// The picture that the worker made last.
    pub latest: Option<Arc<TerminalPicture>>,
    /// How long that took, in milliseconds.
    pub frame_ms: Option<f64>,
    /// Whether the read-out of the pixel under the cursor is open.
    pub probing: bool,
    /// The last answer of the worker about a pixel.
    pub probed: Option<Arc<Probed>>,
    /// What it counted last.
    pub counts: Option<Arc<Counts>>,
    /// Whether the worker is synthesising.
    pub synthesising: bool,
    /// How much of the scene's files it has read, in percent, while that is what it waits for.
    pub read: Option<u8>,
    /// How far it is with what takes longest, in percent, once that is known.
    pub filled: Option<u8>,
    /// The last synthesis.
    pub synth: Option<Arc<Synth>>,
    /// The scene of which it was, also if it failed.
    pub made: Option<Arc<Scene>>,
    /// How long the last synthesis took, in milliseconds.
    pub synth_ms: Option<f64>,
    /// The longest vector of every field, by its pointer.
    pub longest: Vec<(String, f64)>,
}

impl Picture {
    /// With the cursor at a place, the whole picture visible, and nothing made yet.
    pub fn new(cursor: Point) -> Picture {
        Picture {
            cursor,
            viewport: Viewport { zoom: None, center: cursor },
            size: None,
            pass: None,
            looking: None,
            painting: None,
            laid: None,
            marked: None,
            told: None,
            switches: Switches::default(),
            off: BTreeSet::new(),
            graphics: Graphics::default(),
            latest: None,
            frame_ms: None,
            probing: false,
            probed: None,
            counts: None,
            synthesising: false,
            read: None,
            filled: None,
            synth: None,
            made: None,
            synth_ms: None,
            longest: Vec::new(),
        }
    }

    /// Moves the cursor, within the picture if its size is known.
    pub fn step(&mut self, by: Vec2) {
        let moved = self.cursor + by;
        let (w, h) = self.size.map_or((1e6, 1e6), |(w, h)| (w as f64, h as f64));
        self.cursor = Point::new(moved.x.clamp(0.5, (w - 0.5).max(0.5)), moved.y.clamp(0.5, (h - 0.5).max(0.5)));
    }
}

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looking {
    /// The layer whose pictures are picked.
    pub layer: usize,
    /// The frame of its clip.
    pub frame: usize,
    /// Whether what is cut out of the frame is seen, over black.
    pub cut: bool,
    /// Whether the sheet of all that is cut out is seen.
    pub sheet: bool,
    /// How many frames there are.
    pub frames: usize,
    /// How many of them what is picked is followed through.
    pub followed: usize,
    /// The side of the square that is picked, in pixels.
    pub side: f64,
}

impl Looking {
    /// The first frame of a layer's clip.
    pub fn at(layer: usize) -> Looking {
        Looking { layer, frame: 0, cut: false, sheet: false, frames: 1, followed: 1, side: 1.0 }
    }

    /// Why what is picked in the frame that is seen cannot be followed, if it cannot.
    pub fn unfollowed(self) -> Option<String> {
        let Looking { frame, frames, followed, .. } = self;
        (frame + followed > frames)
            .then(|| format!("a track of {followed} frames would pass the clip's end ({frames})"))
    }

    /// What is seen.
    pub fn sight(self) -> Subject {
        match self {
            Looking { sheet: true, .. } => Subject::Sheet,
            Looking { cut: true, frame, .. } => Subject::Cut(frame),
            Looking { frame, .. } => Subject::Frame(frame),
        }
    }
}

/// The three views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sees {
    /// The frame.
    #[default]
    Results,
    /// A picture that lies on the mesh, over what its camera sees.
    Painting,
    /// The mesh with the cameras of all of them, from elsewhere.
    Select,
}

/// The views, in the order in which one goes from one to the next.
pub const ALL: [Sees; 3] = [Sees::Results, Sees::Painting, Sees::Select];

/// How one paints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Painting {
    /// Which view is shown.
    pub sees: Sees,
    /// How much of the picture is shown over what is beneath, from 0 to 1.
    pub share: f64,
    /// How far one has gone round what is selected from, in degrees to the right and up.
    pub around: (f64, f64),
}

impl Default for Painting {
    fn default() -> Self {
        Painting { sees: Sees::default(), share: 0.5, around: (0.0, 0.0) }
    }
}
