//! What a technique draws over the picture to explain it: marks in pixels of the picture, their looks, and the overlays
//! that switch them on. The window, plots and the terminal only draw them.

use std::collections::BTreeSet;
use std::sync::Arc;

use kurbo::{Point, Vec2};

use super::vectors::{Reach, VectorLook};
use crate::layers::space::hidden::Depths;

/// An overlay: one switch of the window and of the editor's view menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// The command that switches it, `view-...`. Techniques that share a name share the switch.
    pub name: &'static str,
    /// Its key in the window; in the editor it follows `z`.
    pub key: &'static str,
    /// What it shows, in a few words.
    pub help: &'static str,
    /// What its marks depend on, and so when they change.
    pub when: When,
    /// Whether surfaces in space hide its marks.
    pub hidden: bool,
    /// Whether it shows what one selects pictures on a mesh by, and so always where one does.
    pub selects: bool,
    /// Whether it is words alone, which the terminal's picture has no room for.
    pub is_words: bool,
    /// Where plots of vector fields draw it; `None` if they leave it out.
    pub in_plots: Option<InPlots>,
    /// The legend that explains it in the window, if it needs one.
    pub legend: Option<Legend>,
}

impl Overlay {
    /// An overlay that no surface hides, that is in no plot and needs no legend.
    pub const fn new(name: &'static str, key: &'static str, help: &'static str, when: When) -> Overlay {
        let (hidden, selects, is_words) = (false, false, false);
        Overlay { name, key, help, when, hidden, selects, is_words, in_plots: None, legend: None }
    }

    /// The same, of words alone.
    pub const fn words(self) -> Overlay {
        Overlay { is_words: true, ..self }
    }

    /// The same, drawn in plots too.
    pub const fn plotted(self, place: InPlots) -> Overlay {
        Overlay { in_plots: Some(place), ..self }
    }

    /// The same with a legend.
    pub const fn explained(self, legend: Legend) -> Overlay {
        Overlay { legend: Some(legend), ..self }
    }
}

/// Where a plot of a vector field draws an overlay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InPlots {
    /// Beneath the field.
    Beneath,
    /// As the field itself, where it is asked for.
    Field,
    /// Above it.
    Above,
}

/// A legend of the vector field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// The color of each direction and length.
    Colors,
    /// The length of an arrow.
    Arrows,
    /// What the color of a streamline tells, if it tells something.
    Lines,
}

impl Legend {
    /// What it explains.
    pub fn word(self) -> &'static str {
        match self {
            Legend::Colors => "colors",
            Legend::Arrows => "arrows",
            Legend::Lines => "streamlines",
        }
    }
}

/// What the marks of an overlay depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// The document alone.
    Document,
    /// The vectors of pixels: the layer must be synthesised.
    Synthesis,
    /// The same, and the scene time: they change with every frame.
    EveryFrame,
}

/// Which overlays are shown, and how densely.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Overlays, by their names.
    pub shown: BTreeSet<&'static str>,
    /// The only layer whose marks are shown, by its index; `None` for all of them.
    pub only: Option<usize>,
    /// The distance between pixels that have marks, in pixels of the picture.
    pub spacing_px: f64,
    /// The same for marks that are cells of color.
    pub cell_px: f64,
    /// Lines shorter than this, in pixels of the picture, run together.
    pub least_px: f64,
    /// Scene times in [0, 1] for marks that change with every frame: the current one, then earlier ones, each drawn
    /// fainter.
    pub times: Vec<f64>,
    /// How vectors of pixels are drawn.
    pub vectors: VectorLook,
    /// What the longest arrows and the fullest colors are; filled in when the marks of all layers are collected.
    pub reach: Reach,
    /// How near surfaces in space are that may hide marks of a layer, if marks are shown that are hidden; filled in when
    /// the marks of all layers are collected.
    pub nearest: Option<Arc<Depths>>,
    /// JSON pointer of what is selected; relative to the layer for the marks of a layer that is ready.
    pub selection: Option<String>,
    /// Whether layers that are only seen on others have marks too: in the frame their places mean nothing.
    pub of_textures: bool,
}

impl View {
    /// A view with these overlays.
    pub fn of(names: &[&'static str]) -> View {
        View { shown: names.iter().copied().collect(), ..View::default() }
    }

    /// Whether an overlay is shown.
    pub fn shows(&self, name: &str) -> bool {
        self.shown.contains(name)
    }

    /// The length of a drawn arrow as a share of its vector, so that arrows do not overlap: the longest in the scene
    /// reaches the next arrow, unless it is to be longer.
    pub fn arrow_scale(&self) -> f64 {
        (self.spacing_px.max(1.0) / self.reach.longest_px).min(1.0) * self.vectors.length
    }

    /// The arrow of a vector, in pixels of the picture.
    pub fn arrow(&self, vector: Vec2) -> Vec2 {
        let length = vector.hypot2().sqrt();
        if length == 0.0 {
            return Vec2::ZERO;
        }
        let drawn = if self.vectors.equal {
            self.spacing_px.max(1.0) * self.vectors.length
        } else {
            length.min(self.reach.longest_px) * self.arrow_scale()
        };
        vector * (drawn / length)
    }
}

/// One thing to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// How it looks.
    pub look: &'static Look,
    /// Its shape, in pixels of the picture.
    pub shape: Shape,
    /// JSON pointer of what it shows, in its layer; of what belongs to none, in the document.
    pub path: Arc<str>,
    /// Which layer made it; set when collected.
    pub layer: Option<usize>,
    /// Whether it belongs to what is selected; set when collected.
    pub selected: bool,
    /// Opacity, multiplied by that of its color, 0 to 1.
    pub strength: f32,
    /// Its own color in place of that of its look and of what is selected.
    pub tint: Option<[u8; 3]>,
}

impl Mark {
    /// A mark for what is at `path`, not selected, of full strength.
    pub fn new(look: &'static Look, path: impl Into<Arc<str>>, shape: Shape) -> Mark {
        Mark { look, shape, path: path.into(), layer: None, selected: false, strength: 1.0, tint: None }
    }

    /// JSON pointer of what it shows, in the document.
    pub fn pointer(&self) -> String {
        self.layer.map_or_else(|| self.path.to_string(), |layer| format!("/layers/{layer}{}", self.path))
    }

    /// Its color: sRGB with straight alpha.
    pub fn color(&self) -> [u8; 4] {
        let of_look = self.look.color;
        let [r, g, b, a] = match (&self.shape, self.tint) {
            (_, Some([r, g, b])) => [r, g, b, of_look[3]],
            (Shape::Cell(..), None) => of_look,
            (_, None) => {
                if self.selected {
                    SELECTED
                } else {
                    of_look
                }
            }
        };
        [r, g, b, (f32::from(a) * self.strength).round() as u8]
    }
}

/// A shape in pixels of the picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through points.
    Line {
        /// At least two points.
        points: Vec<Point>,
        /// Whether the last joins the first.
        closed: bool,
    },
    /// The inside of a polygon, even-odd.
    Fill(Vec<Point>),
    /// A square around a point: center and side.
    Cell(Point, f64),
    /// A dot at a point.
    Dot(Point),
    /// An arrow; its head is at the second point.
    Arrow(Point, Point),
    /// Text beside a point.
    Label(Point, String),
}

/// How marks of one kind look. Looks differ in more than their colors. Lengths are in logical pixels of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// What has this look: "zone outline".
    pub name: &'static str,
    /// Marks of a higher order are drawn above.
    pub order: u8,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Width of lines.
    pub width_px: f32,
    /// Length of a dash and of the gap after it; `None` for solid lines.
    pub dash_px: Option<(f32, f32)>,
    /// The shape of dots.
    pub dot: Dot,
    /// Radius of dots.
    pub dot_px: f32,
    /// The character of lines in a terminal without pictures.
    pub stroke: &'static str,
    /// Whether labels avoid its dots and arrows.
    pub keeps_labels_off: bool,
    /// Whether the mouse can drag its dots: what is at the path of the mark then goes to another place.
    pub is_grip: bool,
}

impl Look {
    /// A look of solid lines and discs.
    pub const fn new(name: &'static str, order: u8, color: [u8; 4], width_px: f32) -> Look {
        let (dot, dot_px) = (Dot::Disc, 1.0);
        let (dash_px, stroke, keeps_labels_off, is_grip) = (None, "·", false, false);
        Look { name, order, color, width_px, dash_px, dot, dot_px, stroke, keeps_labels_off, is_grip }
    }

    /// The same with these dots.
    pub const fn dots(self, dot: Dot, dot_px: f32) -> Look {
        Look { dot, dot_px, ..self }
    }

    /// The same with dashed lines.
    pub const fn dashed(self, dash: f32, gap: f32) -> Look {
        Look { dash_px: Some((dash, gap)), ..self }
    }

    /// The same with another character in terminals.
    pub const fn stroke(self, stroke: &'static str) -> Look {
        Look { stroke, ..self }
    }

    /// The same with dots that can be dragged.
    pub const fn grip(self) -> Look {
        Look { is_grip: true, ..self }
    }

    /// The same, with labels avoiding it.
    pub const fn off_labels(self) -> Look {
        Look { keeps_labels_off: true, ..self }
    }
}

/// The shape of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dot {
    /// A filled disc.
    Disc,
    /// A filled square.
    Square,
    /// A filled square on its corner.
    Diamond,
}

/// The color of what is selected; its lines and dots are larger by [`SELECTED_GROWTH`].
pub const SELECTED: [u8; 4] = [255, 255, 255, 255];
/// See [`SELECTED`].
pub const SELECTED_GROWTH: f32 = 1.6;
/// Opacity of a [`Shape::Fill`] in the color of its look.
pub const FILL_ALPHA: f32 = 0.16;

/// Vectors of pixels as colors, for all techniques.
pub static VECTOR_COLORS: Look =
    Look::new("vector field as colors", 0, [255, 255, 255, 220], 0.0).dots(Dot::Square, 0.0).stroke("▒");
/// Vectors of pixels as arrows and streamlines, for all techniques.
pub static VECTORS: Look = Look::new("vector field", 1, [190, 205, 220, 230], 1.0);

/// What is at a place of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// Its JSON pointer, relative like the path of a [`Mark`].
    pub path: String,
    /// How far away it is, in pixels of the picture; infinite for an area that contains the place, so that anything
    /// near takes precedence.
    pub distance_px: f64,
    /// What to append to the path for the cell that the editor's cursor goes to.
    pub cell: &'static str,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_are_as_long_as_the_look_says() {
        for (words, vector, drawn) in [
            ("", 40.0, 8.0),
            ("", 10.0, 2.0),
            ("length=2", 10.0, 4.0),
            ("equal=on", 10.0, 8.0),
            ("equal=on length=0.5", 1.0, 4.0),
            ("equal=on", 0.0, 0.0),
        ] {
            let mut vectors = VectorLook::default();
            vectors.set(words).unwrap();
            let reach = Reach { longest_px: 40.0, ..Reach::default() };
            let view = View { spacing_px: 8.0, vectors, reach, ..View::default() };
            assert_eq!(view.arrow(Vec2::new(0.0, vector)), Vec2::new(0.0, drawn), "{words} {vector}");
            let short = View { reach: Reach { longest_px: 4.0, ..reach }, ..view };
            assert!(short.arrow(Vec2::new(vector, 0.0)).x <= 8.0 * short.vectors.length, "no longer than its range");
        }
    }
}
