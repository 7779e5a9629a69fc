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
    /// Where it is in the pictures that lie on a surface: u right and v up, from 0 to 1.
    pub uv: Option<[f64; 2]>,
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

    /// The steepest of its slopes, of either sign.
    pub fn steepest(&self, slope: fn(&Slopes) -> f64) -> f64 {
        let (width, height) = (self.inside.width(), self.inside.height());
        let all = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
        let inside = all.filter(|&(i, j)| *self.inside.get(i, j));
        inside.map(|at| slope(&slopes((self.inside, self.vectors), at)).abs()).fold(0.0, f64::max)
    }

    /// The length of the longest vector, in pixels.
    pub fn longest(&self) -> f64 {
        let squares = self.vectors.cells().iter().map(|[x, y]| x * x + y * y);
        f64::from(squares.fold(0.0, f32::max)).sqrt()
    }
}

/// How a field changes around a pixel, in pixels a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slopes {
    /// How much the vectors lead apart.
    pub divergence: f64,
    /// How much they lead round, clockwise on the screen.
    pub curl: f64,
}

/// The slopes at a pixel of a box: differences of its neighbors, as far as these have vectors.
pub fn slopes((inside, vectors): (&Grid<bool>, &Grid<[f32; 2]>), (i, j): (usize, usize)) -> Slopes {
    let has = |(i, j): (usize, usize)| i < inside.width() && j < inside.height() && *inside.get(i, j);
    let along = |di: usize, dj: usize| {
        let before = i.checked_sub(di).zip(j.checked_sub(dj)).filter(|&at| has(at));
        let after = Some((i + di, j + dj)).filter(|&at| has(at));
        let steps = u8::from(before.is_some()) + u8::from(after.is_some());
        let [from, to] = [before, after].map(|at| at.unwrap_or((i, j))).map(|(i, j)| vector(*vectors.get(i, j)));
        if steps == 0 { Vec2::ZERO } else { (to - from) / f64::from(steps) }
    };
    let (across, down) = (along(1, 0), along(0, 1));
    Slopes { divergence: across.x + down.y, curl: across.y - down.x }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_tell_how_a_field_changes_also_at_its_border() {
        let field = |of: fn(f32, f32) -> [f32; 2]| {
            Grid::from_cells(4, 3, (0..12).map(|i| of((i % 4) as f32, (i / 4) as f32)).collect())
        };
        let inside = Grid::from_cells(4, 3, (0..12).map(|i| i != 5).collect());
        for (name, vectors, divergence, curl) in [
            ("grows", field(|x, y| [0.5 * x, 0.25 * y]), 0.75, 0.0),
            ("turns clockwise", field(|x, y| [-0.5 * y, 0.5 * x]), 0.0, 1.0),
            ("slides", field(|_, _| [3.0, 1.0]), 0.0, 0.0),
        ] {
            for at in [(0, 0), (2, 1), (0, 2), (3, 2)] {
                assert_eq!(slopes((&inside, &vectors), at), Slopes { divergence, curl }, "{name} {at:?}");
            }
        }
        let alone = Grid::from_cells(4, 3, (0..12).map(|i| i == 6).collect());
        assert_eq!(slopes((&alone, &field(|x, _| [x, x])), (2, 1)), Slopes::default());
    }
}
