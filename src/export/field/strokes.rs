//! What a plot is drawn with: strokes and fills, and the dots and arrows that are made of them.

use kurbo::{Point, Vec2};

use crate::base::maths::{TAU, atan2, cos, sin};
use crate::layers::parts::marks::Dot;

/// A stroke or a fill, in pixels of the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotMark {
    /// At least two points.
    pub points: Vec<Point>,
    /// Whether the last point joins the first.
    pub closed: bool,
    /// The width of the stroke; `None` fills the inside, even-odd.
    pub stroke: Option<f64>,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Length of a dash and of the gap after it.
    pub dash: Option<(f64, f64)>,
}

pub fn dot(at: Point, shape: Dot, radius: f64) -> Vec<Point> {
    let (corners, first) = match shape {
        Dot::Disc => (16, 0.0),
        Dot::Square => (4, 0.125),
        Dot::Diamond => (4, 0.0),
    };
    (0..corners).map(|k| at + turned(first + f64::from(k) / f64::from(corners)) * radius).collect()
}

/// The unit vector `turns` of a turn from the x axis.
pub fn turned(turns: f64) -> Vec2 {
    let angle = turns * TAU;
    Vec2::new(cos(angle), sin(angle))
}

pub fn fill(points: Vec<Point>, color: [u8; 4]) -> PlotMark {
    PlotMark { points, closed: true, stroke: None, color, dash: None }
}

pub fn line(points: Vec<Point>, width: f64, color: [u8; 4]) -> PlotMark {
    PlotMark { points, closed: false, stroke: Some(width), color, dash: None }
}

/// An arrow with its tail at `at`; a dot where there is no jump. `room` is the distance of arrows, which bounds how heavy they
/// look.
pub fn draw_arrow(at: Point, vector: Vec2, (room, color): (f64, [u8; 4]), marks: &mut Vec<PlotMark>) {
    let length = vector.hypot2().sqrt();
    if length < 0.75 {
        marks.push(fill(dot(at, Dot::Disc, 0.9), [120, 126, 136, 200]));
        return;
    }
    let (along, across) = (vector / length, Vec2::new(-vector.y, vector.x) / length);
    let width = (room * 0.075).clamp(0.8, 2.2);
    let head = (width * 4.2).min(length * 0.6);
    let (tip, neck) = (at + vector, at + along * (length - head));
    marks.push(line(vec![at, at + along * (length - head * 0.8)], width, color));
    marks.push(fill(vec![tip, neck + across * head * 0.42, neck - across * head * 0.42], color));
}

/// Degrees from the x axis toward the y axis: clockwise on the screen.
pub fn degrees(vector: Vec2) -> f64 {
    atan2(vector.y, vector.x).to_degrees()
}
