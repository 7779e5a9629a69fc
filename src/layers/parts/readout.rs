//! Views into a layer: a pixel explained, vectors, curves over time. Plain data, for the command line, the panes and
//! the window.

use kurbo::{Point, Vec2};

use crate::base::pixels::Grid;

/// What one pixel of a layer does at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOut {
    /// The entries, in order. The first says what the pixel belongs to.
    pub entries: Vec<Entry>,
    /// Where it is along its path.
    pub axis: Option<Axis>,
}

impl ReadOut {
    /// Whether the pixel belongs to something.
    pub fn is_of_something(&self) -> bool {
        self.entries.iter().any(|entry| matches!(entry.value, Value::Of(Some(_))))
    }
}

/// A number that is good to know of a layer as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fact {
    /// Its name, as short as can be.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
}

/// What a pixel shows of a layer in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Under {
    /// The triangle, by its number from 0.
    pub triangle: usize,
    /// How far away it is, in meters.
    pub depth_m: f64,
}

/// One entry of a [`ReadOut`].
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its key in JSON: "thresholds".
    pub key: &'static str,
    /// Its label for people: "thresholds", "τ".
    pub label: &'static str,
    /// The value.
    pub value: Value,
}

/// The value of an [`Entry`].
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// What the pixel belongs to, by its name; `None` if it belongs to none.
    Of(Option<String>),
    /// A vector, in pixels.
    Vector(Vec2),
    /// A place, in pixels.
    Place(Point),
    /// Several numbers, ascending.
    List(Vec<f64>),
    /// A number.
    Number(f64),
    /// The number of something in its list, from 0.
    Index(usize),
    /// Coordinates, and their unit; empty if they have none.
    Coordinates(Vec<f64>, &'static str),
    /// Something that is true or false.
    Flag {
        /// Whether it is true.
        on: bool,
        /// The word if it is false.
        off: &'static str,
    },
    /// Red, green, blue and alpha, as codes.
    Color([u8; 4]),
    /// Numbers of things in their lists, or codes.
    Indices(Vec<usize>),
    /// How much each of several things counts, by their names: the greatest first.
    Shares(Vec<(String, f64)>),
    /// Entries that belong together.
    Group(Vec<Entry>),
    /// Several things, each with its own entries; those without a label are not told to people.
    Items(Vec<Vec<Entry>>),
}

/// A path from 0 to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The active stretches, ascending, each as (from, to).
    pub stretches: Vec<(f64, f64)>,
    /// Where something changes.
    pub ticks: Vec<f64>,
    /// Where the pixel is, with the labels of entries; the first is the most important. May be beyond the ends.
    pub points: Vec<(&'static str, f64)>,
}

/// Vectors of some pixels of a picture.
pub struct VectorField<'a> {
    /// What the vectors belong to: a JSON pointer relative to the layer.
    pub path: String,
    /// The name of what they belong to.
    pub name: &'a str,
    /// Column and row of the first pixel.
    pub corner: (usize, usize),
    /// Which pixels of the box have a vector.
    pub inside: &'a Grid<bool>,
    /// The vectors in pixels, x right and y down.
    pub vectors: &'a Grid<[f32; 2]>,
    /// Another property that some pixels of the box have, with its name; `None` if there is none.
    pub flag: Option<Flag<'a>>,
}

/// The name of a property, and whether pixel i of the box, row by row, has it.
pub type Flag<'a> = (&'static str, Box<dyn Fn(usize) -> bool + 'a>);

impl VectorField<'_> {
    /// The vector of the pixel in this column and row of the picture, if it has one.
    pub fn at(&self, (x, y): (usize, usize)) -> Option<Vec2> {
        let (i, j) = (x.checked_sub(self.corner.0)?, y.checked_sub(self.corner.1)?);
        let within = i < self.inside.width() && j < self.inside.height() && *self.inside.get(i, j);
        within.then(|| vector(*self.vectors.get(i, j)))
    }

    /// The length of the longest vector, in pixels.
    pub fn longest(&self) -> f64 {
        let squares = self.vectors.cells().iter().map(|[x, y]| x * x + y * y);
        f64::from(squares.fold(0.0, f32::max)).sqrt()
    }
}

/// A vector of a field, in double precision.
pub fn vector([x, y]: [f32; 2]) -> Vec2 {
    Vec2::new(x.into(), y.into())
}

/// A number as a function of scene time.
pub struct Curve<'a> {
    /// What it belongs to: a JSON pointer relative to the layer.
    pub path: String,
    /// The name of what it belongs to.
    pub name: &'a str,
    /// Its letter in formulas.
    pub symbol: &'static str,
    /// Its value at a scene time.
    pub value: Box<dyn Fn(f64) -> f64 + 'a>,
}
