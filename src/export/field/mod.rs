//! Vector fields as plots and tables. A plot is a list of strokes and fills that the SVG and the PNG both only draw, so
//! that they look the same; letters are strokes too, and need no font.

use kurbo::{Point, Rect, Vec2};

use crate::base::pixels::Frame;
use crate::layers::parts::marks::{InPlots, Mark, Overlay, Shape, View};
use crate::layers::parts::readout::VectorField;
use crate::layers::parts::vectors::{Coloring, VectorLook};
use crate::render::overlay::{overlay, overlays, reach};
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
/// How long arrows are, in times of their distance.
const LONGER: f64 = 1.4;
/// Squares of color between two arrows.
const CELLS: f64 = 4.0;
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

/// What a plot shows.
#[derive(Clone, Debug, Default)]
pub struct PlotLook {
    /// An arrow every so many pixels; as many as fit without it.
    pub step: Option<usize>,
    /// The overlays that show the field, by their names; arrows if there are none.
    pub overlays: Vec<&'static str>,
    /// How vectors are drawn. Their colors tell at least the direction.
    pub vectors: VectorLook,
    /// Whether the picture is left out beneath.
    pub no_picture: bool,
    /// Whether the legend is left out below.
    pub no_legend: bool,
}

/// The overlays that plots can show a field by.
pub fn overlays_of_fields() -> impl Iterator<Item = &'static Overlay> {
    overlays().filter(|overlay| overlay.in_plots == Some(InPlots::Field))
}

/// Plots the field of `scene`, whose synthesis is `synth`. The plot shows the zones with a little around them, over what they
/// move; over nothing if that lies on another layer, as the frame does not show it flat.
pub fn plot(scene: &Scene, synth: &Synth, look: &PlotLook) -> Plot {
    let lies = scene.textures().iter().any(|&layer| !synth.layers[layer].fields().is_empty());
    let shown = if lies { zones(synth) } else { zones(synth).intersect(whole(synth)) };
    let long = shown.width().max(shown.height());
    let scale = (LONG / long).clamp(1.0, 16.0);
    let step = look.step.unwrap_or((long / ARROWS).round().max(1.0) as usize);
    let frame = Rect::new(MARGIN, MARGIN, MARGIN + shown.width() * scale, MARGIN + shown.height() * scale);
    let view = view(synth, look, step as f64);
    let longest_px = view.reach.longest_px;

    let origin = frame.origin() - shown.origin().to_vec2() * scale;
    let mut plotter = Plotter { origin, scale, room: step as f64 * scale, marks: Vec::new() };
    plotter.draw(&overlay(scene, None, &shown_at(InPlots::Beneath)), false);
    plotter.draw(&overlay(scene, Some(synth), &view), true);
    plotter.draw(&overlay(scene, None, &shown_at(InPlots::Above)), false);
    let mut marks = plotter.marks;
    let height = frame.y1 + if look.no_legend { MARGIN } else { LEGEND };
    let width = if look.no_legend { frame.x1 + MARGIN } else { (frame.x1 + MARGIN).max(360.0) };
    marks.extend(margins(frame, Rect::new(0.0, 0.0, width, height)));
    if !look.no_legend {
        legend::legend(Point::new(MARGIN, frame.y1 + LEGEND / 2.0), &view, scale, &mut marks);
    }
    let title = format!("Vector field, every {step} px; the longest jump is {longest_px:.2} px");
    let picture = (!look.no_picture && !lies).then(|| (part(synth, shown), frame));
    Plot { width, height, picture, marks, title }
}

/// How the field is shown, with marks so many pixels apart.
fn view(synth: &Synth, look: &PlotLook, spacing_px: f64) -> View {
    let mut vectors = look.vectors.clone();
    let reach = reach(synth, &vectors);
    // The longest arrow reaches a little beyond its neighbor, also where it is longer than its vector then.
    let short = if reach.longest_px > 0.0 { (spacing_px / reach.longest_px).max(1.0) } else { 1.0 };
    vectors.length *= LONGER * if vectors.equal { 1.0 } else { short };
    if vectors.color == Coloring::Plain {
        vectors.color = Coloring::Direction;
    }
    let arrows = overlays_of_fields().map(|overlay| overlay.name).take(1);
    let shown = if look.overlays.is_empty() { arrows.collect() } else { look.overlays.iter().copied().collect() };
    View {
        shown,
        spacing_px,
        // Whole pixels: no gaps between cells.
        cell_px: (spacing_px / CELLS).round().max(1.0),
        vectors,
        reach,
        of_textures: true,
        ..View::default()
    }
}

fn shown_at(place: InPlots) -> View {
    let shown = overlays().filter(|overlay| overlay.in_plots == Some(place)).map(|overlay| overlay.name);
    View { shown: shown.collect(), of_textures: true, ..View::default() }
}

/// The zones and a little around them, in whole pixels; everything if there are none.
fn zones(synth: &Synth) -> Rect {
    let bounds = fields(synth).map(|field| {
        let (x, y) = (field.corner.0 as f64, field.corner.1 as f64);
        Rect::new(x, y, x + field.inside.width() as f64, y + field.inside.height() as f64)
    });
    let Some(zones) = bounds.reduce(|a, b| a.union(b)) else { return whole(synth) };
    let around = (zones.width().max(zones.height()) * 0.08).ceil();
    zones.inflate(around, around)
}

fn whole(synth: &Synth) -> Rect {
    Rect::new(0.0, 0.0, synth.size.0 as f64, synth.size.1 as f64)
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
    sides.into_iter().map(move |side| fill(corners(side), [255; 4]))
}

fn corners(r: Rect) -> Vec<Point> {
    vec![r.origin(), (r.x1, r.y0).into(), (r.x1, r.y1).into(), (r.x0, r.y1).into()]
}

/// Draws marks, in the look that they have everywhere.
struct Plotter {
    /// Where the corner of the picture would be.
    origin: Point,
    /// Pixels of the plot a pixel of the picture.
    scale: f64,
    /// The distance of arrows, in pixels of the plot.
    room: f64,
    marks: Vec<PlotMark>,
}

impl Plotter {
    fn place(&self, at: Point) -> Point {
        self.origin + at.to_vec2() * self.scale
    }

    /// Draws marks of the document, or of the field, whose arrows say more than those of anchors.
    fn draw(&mut self, marks: &[Mark], is_field: bool) {
        for mark in marks {
            let (look, color) = (mark.look, mark.color());
            let dash = look.dash_px.map(|(on, off)| (f64::from(on), f64::from(off)));
            match &mark.shape {
                Shape::Line { points, closed } => {
                    let points = points.iter().map(|&at| self.place(at)).collect();
                    let stroke = Some(look.width_px.into());
                    self.marks.push(PlotMark { points, closed: *closed, stroke, color, dash });
                }
                Shape::Dot(at) => {
                    let points = dot(self.place(*at), look.dot, f64::from(look.dot_px) * 0.8);
                    self.marks.push(fill(points, color));
                }
                Shape::Cell(at, side) => {
                    // On whole pixels, so that neighbors meet without a seam.
                    let [a, b] = [-0.5, 0.5].map(|half| self.place(*at + Vec2::new(side * half, side * half)).round());
                    self.marks.push(fill(corners(Rect::from_points(a, b)), color));
                }
                Shape::Arrow(from, to) if is_field => {
                    let (at, vector) = (self.place(*from), (*to - *from) * self.scale);
                    draw_arrow(at, vector, (self.room, color), &mut self.marks);
                }
                Shape::Fill(_) | Shape::Arrow(..) | Shape::Label(..) => {}
            }
        }
    }
}
