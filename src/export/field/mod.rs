//! Vector fields as plots and tables. A plot is a list of strokes and fills that the SVG and the PNG both only draw, so
//! that they look the same; letters are strokes too, and need no font.

use kurbo::{Point, Rect};

use crate::base::pixels::Frame;
use crate::layers::parts::marks::{self, InPlots, Shape, View};
use crate::layers::parts::readout::VectorField;
use crate::render::overlay::{overlay, overlays};
use crate::render::{Synth, cpu};
use crate::scene::Scene;

mod legend;
mod letters;
mod model;
mod raster;
mod strokes;
mod svg;
mod table;
#[cfg(test)]
mod tests;

pub use model::{Arrow, FAINT, Plot};
pub use raster::png;
pub use strokes::PlotMark;
pub use svg::svg;
pub use table::csv;

use strokes::{dot, draw_arrow, fill};

/// Pixels that a plot is at least long.
const LONG: f64 = 900.0;
/// Arrows along the longer side, unless a step is given.
const ARROWS: f64 = 42.0;
/// Around the picture.
const MARGIN: f64 = 14.0;
/// Below the picture, for the legend.
const LEGEND: f64 = 62.0;

/// The jump vectors of every `step`-th pixel in both directions, zone after zone, row after row.
pub fn arrows(synth: &Synth, step: usize) -> Vec<Arrow> {
    fields(synth).flat_map(|field| arrows_of(&field, step.max(1))).collect()
}

fn fields(synth: &Synth) -> impl Iterator<Item = VectorField<'_>> {
    synth.layers.iter().flat_map(|layer| layer.fields())
}

fn arrows_of(field: &VectorField, step: usize) -> Vec<Arrow> {
    let on_lattice = move |from: usize, n: usize| (from..from + n).filter(move |i| i % step == step / 2);
    let (width, height) = (field.inside.width(), field.inside.height());
    let mut arrows = Vec::new();
    for y in on_lattice(field.corner.1, height) {
        for x in on_lattice(field.corner.0, width) {
            let (i, j) = (x - field.corner.0, y - field.corner.1);
            if *field.inside.get(i, j) {
                arrows.push(Arrow { at: Point::new(x as f64 + 0.5, y as f64 + 0.5), jump: *field.vectors.get(i, j) });
            }
        }
    }
    arrows
}

/// Plots the field of `scene`, whose synthesis is `synth`: an arrow every `step` pixels, as many as fit without it. The
/// plot shows the zones with a little around them; `picture` lays them over what they move.
pub fn plot(scene: &Scene, synth: &Synth, step: Option<usize>, picture: bool) -> Plot {
    let shown = shown(synth);
    let long = shown.width().max(shown.height());
    let scale = (LONG / long).clamp(1.0, 16.0);
    let step = step.unwrap_or((long / ARROWS).round().max(1.0) as usize);
    let frame = Rect::new(MARGIN, MARGIN, MARGIN + shown.width() * scale, MARGIN + shown.height() * scale);
    let arrows = arrows(synth, step);
    let longest = arrows.iter().map(|arrow| arrow.vector().hypot2().sqrt()).fold(0.0, f64::max);
    // The longest arrow reaches a little beyond its neighbor.
    let stretch = if longest > 0.0 { 1.4 * step as f64 * scale / longest } else { 1.0 };
    let plot_from_image = |p: Point| frame.origin() + (p - shown.origin()) * scale;

    let mut marks = marks_of(scene, InPlots::Beneath, &plot_from_image);
    for arrow in &arrows {
        draw_arrow(plot_from_image(arrow.at), arrow.vector() * stretch, step as f64 * scale, &mut marks);
    }
    marks.extend(marks_of(scene, InPlots::Above, &plot_from_image));
    let height = frame.y1 + LEGEND;
    let width = (frame.x1 + MARGIN).max(360.0);
    marks.extend(margins(frame, Rect::new(0.0, 0.0, width, height)));
    legend::legend(Point::new(MARGIN, frame.y1 + LEGEND / 2.0), stretch, longest, scale, &mut marks);
    let title =
        format!("Vector field: {} arrows, one every {step} px; the longest jump is {longest:.2} px", arrows.len());
    let picture = picture.then(|| (part(synth, shown), frame));
    Plot { width, height, picture, marks, title }
}

/// The part of the picture that the plot shows: the zones and a little around them, in whole pixels.
fn shown(synth: &Synth) -> Rect {
    let whole = Rect::new(0.0, 0.0, synth.size.0 as f64, synth.size.1 as f64);
    let bounds = fields(synth).map(|field| {
        let (x, y) = (field.corner.0 as f64, field.corner.1 as f64);
        Rect::new(x, y, x + field.inside.width() as f64, y + field.inside.height() as f64)
    });
    let Some(zones) = bounds.reduce(|a, b| a.union(b)) else { return whole };
    let around = (zones.width().max(zones.height()) * 0.08).ceil();
    zones.inflate(around, around).intersect(whole)
}

fn part(synth: &Synth, shown: Rect) -> Frame {
    let frame = cpu::frame(synth, 0.0);
    let (x0, x1) = (shown.x0 as usize, shown.x1 as usize);
    let rows = (shown.y0 as usize..shown.y1 as usize).flat_map(|y| frame.row(y)[x0..x1].iter().copied());
    Frame::from_cells(x1 - x0, (shown.y1 - shown.y0) as usize, rows.collect())
}

/// White over what reaches out of the picture.
fn margins(frame: Rect, all: Rect) -> impl Iterator<Item = PlotMark> {
    let sides = [
        Rect::new(all.x0, all.y0, all.x1, frame.y0),
        Rect::new(all.x0, frame.y1, all.x1, all.y1),
        Rect::new(all.x0, frame.y0, frame.x0, frame.y1),
        Rect::new(frame.x1, frame.y0, all.x1, frame.y1),
    ];
    let corners = |r: Rect| vec![r.origin(), (r.x1, r.y0).into(), (r.x1, r.y1).into(), (r.x0, r.y1).into()];
    sides.into_iter().map(move |side| fill(corners(side), [255; 4]))
}

/// What the techniques want to be drawn there, in the look that it has everywhere.
fn marks_of(scene: &Scene, place: InPlots, plot_from_image: &impl Fn(Point) -> Point) -> Vec<PlotMark> {
    let shown = overlays().filter(|overlay| overlay.in_plots == Some(place)).map(|overlay| overlay.name);
    let view = View::of(&shown.collect::<Vec<_>>());
    let mark = |mark: marks::Mark| {
        let look = mark.look;
        let dash = look.dash_px.map(|(on, off)| (f64::from(on), f64::from(off)));
        match mark.shape {
            Shape::Line { points, closed } => {
                let points = points.into_iter().map(plot_from_image).collect();
                Some(PlotMark { points, closed, stroke: Some(look.width_px.into()), color: look.color, dash })
            }
            Shape::Dot(at) => Some(fill(dot(plot_from_image(at), look.dot, f64::from(look.dot_px) * 0.8), look.color)),
            // The arrows of the field say more.
            Shape::Fill(_) | Shape::Arrow(..) | Shape::Label(..) | Shape::Cell(..) => None,
        }
    };
    overlay(scene, None, &view).into_iter().filter_map(mark).collect()
}
