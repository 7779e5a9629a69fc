//! The interface of techniques: of a layer ([`Technique`]), and without one ([`Kind`]). Paths are JSON pointers
//! relative to the layer.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use kurbo::{Point, Rect, Vec2};
use serde_json::{Map, Value};

use super::parts::bundle::{Names, Sink};
use super::parts::derived::Derived;
use super::parts::goal::Goal;
use super::parts::marks::{Hit, Look, Mark, Overlay, View};
use super::parts::materials::{Materials, Use};
use super::parts::measures::Measures;
use super::parts::moment::{Moment, Space};
use super::parts::moving::Mover;
use super::parts::pass::Pass;
use super::parts::picking::Picks;
use super::parts::plan::{Program, Routine};
use super::parts::readout::{Curve, Entry, ReadOut};
use super::parts::repeat::Repeat;
use super::parts::shots::{Laid, Laying, Lying};
use super::parts::sketch::Sketch;
use super::parts::twin::Twin;
use super::ready::{Making, Prepared, Ready, Whole};
use super::shapes::node::Node;
use super::shapes::shape::Shape;
use super::space::eye::Ray;
use super::starts::{Comparison, Preset, Starts, Styles, Template};
use super::timeline::{Timeline, Wrap};
use crate::base::change::Change;
use crate::base::error::Error;
use crate::base::problem::Problem;

/// The interface of a layer in the document.
pub trait Technique: Any + Send + Sync {
    /// Its technique.
    fn kind(&self) -> &'static Kind;

    /// The layer's name, unique in its scene.
    fn name(&self) -> &str;

    /// Checks the layer on its own. Parts that are the same as in the layer `before`, if that is of the same technique,
    /// keep their results.
    fn check(&self, before: Option<(&dyn Technique, &Checked)>) -> Checked;

    /// Every problem that a check has found; without parts, what it holds.
    fn problems(&self, checked: &Checked) -> Vec<Problem> {
        checked.0.iter().flat_map(|part| part.iter().cloned()).collect()
    }

    /// Calls `each` with the numbers of things that the layer asks for, place by place, before any are made.
    fn counts(&self, _each: &mut dyn FnMut(Count)) {}

    /// Bytes of memory that places in the layer need during synthesis, one place after the other.
    fn memory(&self) -> Vec<(String, u64)> {
        Vec::new()
    }

    /// The problems that only show with the pictures and fields that the layer names.
    fn check_materials(&self, _materials: &Materials) -> Vec<Problem> {
        Vec::new()
    }

    /// Whether the layer changes while the time runs, as far as the document tells.
    fn moves(&self) -> bool {
        false
    }

    /// A warning with the reason, if nothing of the layer is in the frame at any of these moments.
    fn unseen(&self, _moments: &[Moment], _materials: &Materials) -> Option<Problem> {
        None
    }

    /// Whether nothing of what is beneath the layer is seen in a frame of this width and height, at any time.
    fn covers(&self, _size_px: (usize, usize), _materials: &Materials) -> bool {
        false
    }

    /// The problems that only show when the layer is made, which takes as long; asked for where there are no others.
    fn check_made(&self, _making: &Making) -> Vec<Problem> {
        Vec::new()
    }

    /// The images and files that the layer names, each as often as it is named.
    fn uses(&self) -> Vec<Use<'_>> {
        Vec::new()
    }

    /// The image whose size a frame may take, if the layer has one.
    fn frame_of(&self) -> Option<&str> {
        None
    }

    /// The `old` thing at `path`, turned into the variant `to`; `None` if there is nothing to do but keep fields with
    /// the same name.
    fn turned(&self, _path: &str, _old: &Value, _to: &str) -> Option<Turned> {
        None
    }

    /// What moves, turns or stretches the things of the layer in its picture; `None` if they have no place there.
    fn mover(&self) -> Option<Mover> {
        None
    }

    /// Looks up the shapes of the scene that the layer names.
    fn resolve(&mut self, _shapes: &BTreeMap<String, Shape>) {}

    /// What leads the samplers along the shape of this name somewhere, for what is at `path`; and where that is to be written. `None` if
    /// nothing there moves so.
    fn along(&self, _path: &str, _shape: (&str, &[Node]), _lead: Lead) -> Option<(String, Value)> {
        None
    }

    /// Whether the thing at `path` can be left out by itself.
    fn can_mute(&self, _path: &str) -> bool {
        false
    }

    /// The layer as if the things at these paths, each of which can be left out, were not there, with the others in their
    /// places.
    #[must_use]
    fn without(&self, _paths: &[&str]) -> Self
    where
        Self: Sized + Clone,
    {
        self.clone()
    }

    /// The layer that `json` means, if `change` is how it differs from what this one was read from; `None` if it must
    /// be read as a whole.
    fn reread(&self, _json: &Value, _change: &Change) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// The part of the layer's picture for something new at `path`.
    fn bounds(&self, path: &str) -> Rect;

    /// How far the layer reaches along each of these ways of the world at any time, if the document alone tells.
    fn reach(&self, _ways: &[DVec3]) -> Option<Vec<f64>> {
        None
    }

    /// The name of the item at `path`, if it is in a list whose items have names.
    fn item_name(&self, _path: &str) -> Option<&str> {
        None
    }

    /// The value that stands for the field at `path` while it is not set, if the layer has one for it that is not in
    /// the schema.
    fn automatic(&self, _path: &str) -> Option<Value> {
        None
    }

    /// The names of the items that the list or map at `path` has without their being written, in order: those of a style,
    /// for example. An item that is written replaces the fields that it sets of the one of its name. `None` if there are none.
    fn laid(&self, _path: &str) -> Option<Vec<String>> {
        None
    }

    /// The columns that follow from the items of the list at `path`.
    fn derived(&self, _path: &str) -> &'static [Derived] {
        &[]
    }

    /// The number that an item, as it is in the document, has in a column of [`Technique::derived`], if it has one.
    fn derive(&self, _column: &Derived, _item: &Value) -> Option<f64> {
        None
    }

    /// The value of the field [`Derived::of`] with which the item has this number in the column.
    ///
    /// # Errors
    /// Why there is none.
    fn solve(&self, column: &Derived, _item: &Value, _to: f64) -> Result<Value, String> {
        Err(format!("{} cannot be set", column.name))
    }

    /// Where the layer's pictures are picked from a clip, if they are; `Ready::picking` shows it.
    fn picks(&self) -> Option<Picks> {
        None
    }

    /// The path and the value of a field with which the item at `path` goes to where a ray points: what a line ends at,
    /// say.
    ///
    /// # Errors
    /// Why there is none.
    fn aimed(&self, path: &str, _ray: &Ray) -> Result<(String, Value), String> {
        self.goal(path)?;
        Err("this cannot be moved".into())
    }

    /// How the item at `path` would be drawn if it went to where a ray of the world points; nothing if it cannot.
    fn aimed_marks(&self, _path: &str, _ray: &Ray, _moment: &Moment) -> Vec<Mark> {
        Vec::new()
    }

    /// Where the item at `path` goes now.
    ///
    /// # Errors
    /// It goes nowhere.
    fn goal(&self, _path: &str) -> Result<Goal, String> {
        Err("nothing here goes to a place: select a point that does (w, b)".into())
    }

    /// The names of what a pass can be of in the layer, if it is of things that have names.
    fn pass_names(&self, _pass: &Pass) -> Vec<&str> {
        Vec::new()
    }

    /// What the colors mean in which a pass of codes is looked at, by names.
    fn pass_colors(&self, _pass: &Pass) -> Vec<(&str, [u8; 3])> {
        Vec::new()
    }

    /// Whether the layer shows something in a pass: one that all layers in space share, or one that its technique adds.
    fn has_pass(&self, _pass: &Pass) -> bool {
        true
    }

    /// The pictures with cameras that lie on the layer; `None` if it can have none.
    fn lying(&self) -> Option<Vec<Lying<'_>>> {
        None
    }

    /// What is odd about how pictures with cameras lie on it, as far as the files that it names tell.
    fn check_lying(&self, _materials: &Materials) -> Vec<Problem> {
        Vec::new()
    }

    /// How more pictures with cameras come to lie on the layer; `None` if it can have none.
    fn lay(&self, _pictures: &[Laid]) -> Option<Laying> {
        None
    }

    /// From the coordinates of the layer's model to the world, at a scene time, but for how it bends; `None` if it has no
    /// model.
    fn model_to_world(&self, _t: f64) -> Option<DAffine3> {
        None
    }

    /// Whether the places at `path` are in the coordinates of the layer's model, not in those of the world.
    fn is_in_model(&self, _path: &str) -> bool {
        false
    }

    /// What changes in the layer over the scene time, item by item.
    fn curves(&self, _wrap: Wrap) -> Vec<Curve<'_>> {
        Vec::new()
    }

    /// What of the layer has a small drawing, in words.
    fn sketched(&self) -> &'static [&'static str] {
        &[]
    }

    /// A small drawing of what is at `path`, if it has one.
    fn sketch(&self, _path: &str) -> Option<Sketch> {
        None
    }

    /// What the pixel (column, row) of the layer does at one time; `None` if there is nothing to say about
    /// pixels. `ready` is what was made of the layer, if that is at hand.
    ///
    /// # Errors
    /// As [`Technique::synth`].
    fn probe(
        &self,
        _making: &Making,
        _ready: Option<&dyn Ready>,
        _pixel: (usize, usize),
        _moment: &Moment,
    ) -> Result<Option<ReadOut>, Problem> {
        Ok(None)
    }

    /// How what is drawn on the layer moves with it, while the camera goes so many steps in several ways, in numbers; `None` if
    /// nothing is drawn on it, or once `step`, which is told how much is done of how much, says that it is cancelled.
    ///
    /// # Errors
    /// As [`Technique::synth`].
    fn measure(
        &self,
        _making: &Making,
        _moment: &Moment,
        _steps: u32,
        _step: &mut dyn FnMut(u64, u64) -> bool,
    ) -> Result<Option<Measures>, Problem> {
        Ok(None)
    }

    /// Calls `each` with every flow line, in order, with so many places along it; whether there can be any.
    fn flow_lines(&self, _samples: usize, _each: &mut dyn FnMut(Vec<Entry>)) -> bool {
        false
    }

    /// What the view shows of the document alone, in any order.
    fn marks(&self, _view: &View) -> Vec<Mark> {
        Vec::new()
    }

    /// What of the layer stands at a place of the picture: the nearest thing not farther than `reach_px`, else the
    /// topmost area that holds the place. Both in pixels of the picture.
    fn pick(&self, _at: Point, _reach_px: f64) -> Option<Hit> {
        None
    }

    /// What happens to the layer when time starts over.
    fn repeat(&self, _timeline: &Timeline, _materials: &Materials) -> Repeat {
        Repeat::default()
    }

    /// Prepares the layer for rendering at any time. What it has in common with `previous` is reused.
    ///
    /// # Errors
    /// If something that the layer names is not among the materials, or the synthesis is cancelled.
    fn synth(&self, making: &Making, previous: Option<&dyn Ready>) -> Result<Arc<dyn Ready>, Problem>;

    /// Makes what all parts of the layer share; without a shortcut, all of it, and then what it has in common with `previous` is
    /// reused.
    ///
    /// # Errors
    /// As [`Technique::synth`].
    fn prepare(&self, making: &Making, previous: Option<&dyn Ready>) -> Result<Box<dyn Prepared>, Problem> {
        Ok(Box::new(Whole(self.synth(making, previous)?)))
    }
}

/// A technique, as far as it is known without a layer.
#[derive(Debug)]
pub struct Kind {
    /// Its name in the document's `kind`.
    pub name: &'static str,
    /// Where its layers are.
    pub space: Space,
    /// All programs that its layers are drawn with.
    pub programs: &'static [&'static [&'static Program]],
    /// All routines that compute for that.
    pub routines: &'static [&'static Routine],
    /// What these read of structs.
    pub twins: &'static [&'static [Twin]],
    /// What becomes of its layers for other engines; `None` if it has no textures for them.
    pub bundle: Option<Bundle>,
    /// The things whose number in a scene is limited.
    pub counted: &'static [Counted],
    /// What can be drawn over the picture to explain it.
    pub overlays: &'static [&'static [Overlay]],
    /// What its frames are made from, besides what all layers in space have.
    pub passes: &'static [&'static [Pass]],
    /// How that looks, in ascending order.
    pub looks: &'static [&'static [&'static Look]],
    /// What makes a new layer, if the technique can start from something. A layer in space brings a camera.
    pub template: Option<Template>,
    /// A layer of this name that shows nothing, if the technique is the one that has such layers.
    pub blank: Option<fn(name: &str) -> Value>,
    /// How new things in its layers begin.
    pub starts: Starts,
    /// Settings that change what its layers look like.
    pub presets: &'static [Preset],
    /// The styles that its layers can be drawn in, if they can.
    pub styles: Option<&'static Styles>,
    /// The comparisons that its layers offer: the same layer in several ways.
    pub comparisons: &'static [Comparison],
    /// A small scene that uses most of it, for tests: frames of at most 96 x 64 pixels.
    pub example: &'static str,
}

/// All layers of one technique as textures for other engines.
#[derive(Debug)]
pub struct Bundle {
    /// The names that the files may have.
    pub names: fn(layers: &[&dyn Technique]) -> Names,
    /// Writes the textures, and gives what the manifest says about them, in order.
    pub write: fn(layers: &[Bundled], to: &mut dyn Sink) -> Result<Map<String, Value>, Error>,
}

/// A layer to be bundled.
#[derive(Clone, Copy)]
pub struct Bundled<'a> {
    /// What stands in the document.
    pub layer: &'a dyn Technique,
    /// What was made of it.
    pub ready: &'a dyn Ready,
}

/// Where samplers along a shape are led.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lead<'a> {
    /// So far away, in pixels: nothing moves by nothing.
    By(Vec2),
    /// To the same part of another path.
    To(&'a [Node]),
}

/// A kind of thing whose number in a scene is limited: a row of `--limit`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Its name, such as "anchors".
    pub name: &'static str,
    /// What it limits, in words.
    pub help: &'static str,
    /// How many a scene may have by default.
    pub most: u64,
}

/// How many things a place in the document asks for.
pub struct Count<'a> {
    /// What is counted: the name of one of the technique's [`Counted`].
    pub what: &'static str,
    /// The place.
    pub path: &'a dyn Fn() -> String,
    /// How many; an upper bound.
    pub count: f64,
}

/// The result of changing the kind of a thing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turned {
    /// What replaces it; more than one thing only in a list, in order.
    pub items: Vec<Value>,
    /// What could not be kept, in words.
    pub lost: Option<String>,
}

impl Turned {
    /// One thing that keeps everything.
    pub fn whole(item: Value) -> Turned {
        Turned { items: vec![item], lost: None }
    }

    /// The same, with a message that something is lost.
    pub fn but(self, lost: impl Into<String>) -> Turned {
        Turned { lost: Some(lost.into()), ..self }
    }

    /// The same, with a message if something is lost.
    pub fn but_if(self, lost: Option<String>) -> Turned {
        Turned { lost, ..self }
    }
}

/// The problems of a layer, part by part, each relative to its part: parts that an edit does not touch keep theirs.
#[derive(Clone, Debug, Default)]
pub struct Checked(pub Vec<Arc<[Problem]>>);
