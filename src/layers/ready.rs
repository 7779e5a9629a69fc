//! A layer that is ready for rendering at any time: what every technique makes from its part of the document.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use kurbo::Vec2;
use serde_json::Value;

use super::parts::album::Album;
use super::parts::marks::{Mark, View};
use super::parts::materials::Materials;
use super::parts::moment::{CENTER, Columns, Moment};
use super::parts::pass::{Pass, Which};
use super::parts::picking::{Picking, Subject};
use super::parts::plan::Plan;
use super::parts::readout::{Fact, Under, VectorField};
use super::parts::shots::{Painted, Put, Taken};
use super::space::eye::Ray;
use super::space::fit;
use super::timeline::{Timeline, Wrap};
use crate::base::pixels::{Linear, Rgba};
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::base::reduce::Reduced;

/// What a layer is made with.
#[derive(Clone, Copy)]
pub struct Making<'a> {
    /// What follows the end of the timeline.
    pub wrap: Wrap,
    /// How long the timeline is, in seconds.
    pub duration: f64,
    /// Width and height of the frame, in pixels.
    pub size_px: (usize, usize),
    /// How many pixels of the frame a meter at the camera's target is, at the beginning.
    pub px_per_m: f64,
    /// The files that layers name.
    pub materials: &'a Materials,
    /// The place in each pixel that is evaluated: its center, or another for supersampling.
    pub place: Vec2,
    /// The layers that others show as textures, by name.
    pub textures: &'a Textures,
    /// Whether frames are drawn with it. Where only data passes are, layers leave out what is only in the picture.
    pub painted: bool,
}

impl<'a> Making<'a> {
    /// At the center of each pixel, without layers as textures; the timeline is as long as one that is not set.
    pub fn plain(wrap: Wrap, materials: &'a Materials) -> Self {
        static NONE: Textures = Textures::new();
        let duration = Timeline::default().duration;
        let (size_px, px_per_m, place, painted) = ((0, 0), 1.0, CENTER, true);
        Making { wrap, duration, size_px, px_per_m, materials, place, textures: &NONE, painted }
    }
}

/// The layers that others show as textures, by name.
pub type Textures = BTreeMap<String, Texture>;

/// A layer that others show as a texture.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The layer, at the centers of its pixels.
    pub layer: Arc<dyn Ready>,
    /// Width and height of its picture, in pixels.
    pub size_px: (usize, usize),
}

/// A layer ready for rendering at any time: pure, shared, no handles.
pub trait Ready: Any + Debug + Send + Sync {
    /// The layer at one time, on the CPU: the reference. Called once per frame.
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a>;

    /// The layer at one time, for the GPU: looks the same as [`Ready::at`].
    fn plan(&self, moment: &Moment) -> Plan;

    /// Whether it has sprites: they are drawn after all surfaces of their group.
    fn has_sprites(&self) -> bool {
        false
    }

    /// The same layer, whose frames are given up once `stop` is set, with anything in them; `None` if they never take long.
    fn stoppable(&self, _stop: &Arc<AtomicBool>) -> Option<Arc<dyn Ready>> {
        None
    }

    /// What is known of the pictures with cameras that lie on it, one after the other, and of them all, as objects; with
    /// `compare` also how well each comes back when it is drawn again from its own camera, one piece of work each. `None` if it can
    /// have none.
    fn lying(&self, _compare: Option<&Watch>) -> Option<Vec<Value>> {
        None
    }

    /// What is seen of its model at a scene time from around, as it is without anything drawn on it, in pictures of so many
    /// pixels a side: pictures with cameras that show what its surface does. `None` if it has no such pictures.
    fn around(&self, _t: f64, _side_px: usize, _watch: &Watch) -> Vec<Taken> {
        Vec::new()
    }

    /// What the camera of a picture that lies on it, by its index, sees of it without that picture; `None` if the picture does not
    /// count, or there is none.
    fn guide(&self, _picture: usize, _watch: &Watch) -> Option<Linear> {
        None
    }

    /// What it does not show, as there was too little memory for it; paths are relative to the layer.
    fn lacks(&self) -> Option<Problem> {
        None
    }

    /// The width and height of a picture that lies on it, by its index; `None` if the picture does not count, or there is none.
    fn laid_px(&self, _picture: usize) -> Option<(usize, usize)> {
        None
    }

    /// That picture, so much of it from 0 to 1, over what its camera sees of the layer; `None` likewise. It may take as long as a
    /// frame.
    fn painted(&self, _picture: usize, _share: f64) -> Option<Painted> {
        None
    }

    /// What is put where a ray of the world meets the sphere of a picture that lies on it, by its index, at a scene time: the list
    /// that it goes to, relative to the layer, or what is to be set where there is no such list yet; and its value.
    ///
    /// # Errors
    /// Why there is nothing to put.
    fn put_round(&self, _picture: usize, _put: Put, _ray: &Ray, _t: f64) -> Result<(String, Value), String> {
        Err("no pictures lie on it".into())
    }

    /// The values with which the pictures that lie on it agree in brightness: their paths in the layer. `None` if it can
    /// have none.
    fn balanced(&self) -> Option<Vec<(String, Value)>> {
        None
    }

    /// Whether something is drawn on its surfaces: that needs all of a frame at once ([`Still::strokes`]).
    fn has_strokes(&self) -> bool {
        false
    }

    /// Why the CPU alone can draw it; `None` if a GPU can too.
    fn by_cpu(&self) -> Option<&'static str> {
        None
    }

    /// Whether the CPU takes long for a frame of it, and longer still where it pretends to be a GPU.
    fn takes_long(&self) -> bool {
        self.has_strokes()
    }

    /// The same layer with nothing that moves.
    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready>;

    /// The layer of a frame that is [`Reduced::by`] times smaller on each side.
    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready>;

    /// The vectors that its pixels have, from below to above.
    fn fields(&self) -> Vec<VectorField<'_>> {
        Vec::new()
    }

    /// What the pixel (column, row) shows of it at one time; nothing for layers in the frame.
    fn under(&self, _pixel: (usize, usize), _moment: &Moment) -> Option<Under> {
        None
    }

    /// How far it reaches along each of these ways of the world at scene time `t`; `None` for layers in the frame.
    fn reach(&self, _t: f64, _ways: &[DVec3]) -> Option<Vec<f64>> {
        None
    }

    /// Whether something of it may be in the frame at one time; what stands before it does not count.
    fn is_in_frame(&self, moment: &Moment) -> bool {
        moment.eye.is_none_or(|eye| fit::may_see(&|ways| self.reach(moment.t, ways), &eye))
    }

    /// What is good to know of it as a whole, for a single line.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// The pictures of its sprites, with so many between each two keys; `None` if it has none.
    fn album(&self, _between: usize) -> Option<Album> {
        None
    }

    /// What there is to see of the clip from which its pictures are picked; `None` if there is nothing.
    fn picking(&self, _sight: Subject) -> Option<Picking> {
        None
    }

    /// The largest side of any picture that a frame reads, in pixels.
    fn largest_texture(&self) -> usize;

    /// What the view shows of what was synthesised, as it is at one time, in any order; paths are relative to the layer.
    fn marks(&self, _view: &View, _moment: &Moment) -> Vec<Mark> {
        Vec::new()
    }

    /// Gives a fully transparent pixel (column, row) of a finished frame the color that the layer has there, if it has
    /// one, since straight alpha can keep it.
    fn keep_clear_color(&self, _pixel: (usize, usize), _code: &mut [u8; 4]) {}
}

impl dyn Ready {
    /// The layer as its technique's own type, for that technique.
    pub fn downcast<T: Ready>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// One layer at one time.
pub trait Still: Sync {
    /// Writes row `y` of the frame to `out`, one cell per column, all transparent before: linear light, premultiplied
    /// by alpha. Rows are computed on all cores; a cell does not depend on which columns are wanted.
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]);

    /// The same for all columns of these rows, one after the other.
    fn rows(&self, rows: Range<usize>, width: usize, out: &mut [Rgba]) {
        rows.zip(out.chunks_exact_mut(width.max(1))).for_each(|(y, out)| self.row(y, Columns::All, out));
    }

    /// Writes all columns of these rows as they are finished (sRGB, straight alpha) with the layer alone over a color; `false`
    /// and nothing written if it has no faster way than [`Still::rows`].
    fn codes(&self, _rows: Range<usize>, _background: Rgba, _out: &mut [[u8; 4]]) -> bool {
        false
    }

    /// The same for a layer in space, as one of a group: writes only what is nearer than `depth`, one cell per column,
    /// in meters, and its depth.
    fn surface(&self, _y: usize, _columns: Columns, _depth: &mut [f64], _out: &mut [Rgba]) {}

    /// Draws the sprites of the layer, as one of a group, over `out`: its cells are those of these rows, one after the
    /// other, with all surfaces of the group, whose depths in meters are `depth`. Nothing for layers without sprites.
    fn sprites(&self, _rows: &[usize], _columns: Columns, _depth: &[f64], _out: &mut [Rgba]) {}

    /// The same for all columns of a layer on which something is drawn: writes only depths, and which part of the layer is seen,
    /// in numbers of its own.
    fn parts(&self, _y: usize, _depth: &mut [f64], _parts: &mut [u32]) {}

    /// What a pass has where something is drawn on the surfaces of the layer, as one of a group: writes the pixels that
    /// show the layer. Nothing for layers on which nothing is drawn.
    fn strokes(&self, _which: Which, _surfaces: &Surfaces, _out: &mut [Rgba]) {}

    /// What a pass other than color has in row `y`, as [`Still::surface`]; nothing for layers in the frame.
    fn pass(&self, _pass: &Pass, _y: usize, _columns: Columns, _depth: &mut [f64], _out: &mut [Rgba]) {}
}

/// The surfaces of a group in all pixels of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Surfaces<'a> {
    /// How far away they are, in meters; infinite where there are none.
    pub depth: &'a [f64],
    /// Which layer each is of.
    pub layer: &'a [u32],
    /// Which part of that, if something is drawn on it (see [`Still::parts`]).
    pub part: &'a [u32],
    /// The layer that is asked.
    pub own: u32,
}

/// A layer whose parts can be prepared without the rest, for a single pixel or a band of a large picture.
pub trait Prepared: Send + Sync {
    /// The layer, ready for rendering these columns and rows of the frame; no others may be asked for.
    ///
    /// # Errors
    /// If there is not enough memory or it is cancelled; the problem's path is relative to the layer.
    fn part(&self, columns: Range<usize>, rows: Range<usize>, materials: &Materials)
    -> Result<Arc<dyn Ready>, Problem>;
}

/// A layer whose parts cost what the whole does: each is the whole.
pub struct Whole(pub Arc<dyn Ready>);

impl Prepared for Whole {
    fn part(&self, _: Range<usize>, _: Range<usize>, _: &Materials) -> Result<Arc<dyn Ready>, Problem> {
        Ok(self.0.clone())
    }
}
