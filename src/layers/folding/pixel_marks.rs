//! The marks for single pixels of zones, at a regular spacing: jump vectors as arrows, streamlines and colors, jump paths,
//! where they meet fold regions, and the samplers that move along them.

use std::sync::Arc;

use kurbo::{Point, Vec2};

use super::field::Field;
use super::looks::{FIELD, ONION, PATH, PATHS, RESTING, SAMPLER, SAMPLERS, STREAMLINES, THRESHOLD, THRESHOLDS, WHEEL};
use super::marks::{Drawing, zone_path};
use super::streamlines::streamlines;
use super::synth::{Synth, ZoneSynth};
use crate::layers::parts::marks::{Mark, Shape, VECTOR_COLORS, VECTORS, View};
use crate::layers::parts::readout::{Slopes, slopes, vector};
use crate::layers::parts::vectors::Coloring;

/// The marks of a layer that need its synthesis.
pub fn marks(synth: &Synth, view: &View) -> Vec<Mark> {
    let mut drawing = Drawing::new(view);
    synth.zones.iter().for_each(|zone| drawing.pixels(zone, &zone_path(zone.index).into()));
    drawing.marks
}

/// Points of a piece of a streamline that has one color.
const PIECE: usize = 6;

impl Field {
    /// The pixel of the box that holds a place in it.
    fn pixel(&self, at: Point) -> (usize, usize) {
        ((at.x as usize).saturating_sub(self.x0), (at.y as usize).saturating_sub(self.y0))
    }

    fn jump(&self, at: Point) -> Vec2 {
        let (i, j) = self.pixel(at);
        vector(*self.jumps.get(i, j))
    }

    fn slopes(&self, at: Point) -> Slopes {
        slopes((&self.inside, &self.jumps), self.pixel(at))
    }
}

/// One pixel of a field.
struct Pixel {
    /// Its index in the field's box.
    index: usize,
    /// Its center.
    at: Point,
    /// Its jump vector.
    jump: Vec2,
}

/// One pixel every `spacing`, at the same places whatever the zone's box is.
fn lattice(field: &Field, spacing: f64) -> impl Iterator<Item = Pixel> + '_ {
    let spacing = spacing.max(1.0);
    let steps = move |from: usize, n: usize| {
        let first = ((from as f64) / spacing - 0.5).ceil().max(0.0) as usize;
        (first..)
            .map(move |k| ((k as f64 + 0.5) * spacing) as usize)
            .take_while(move |&p| p < from + n)
            .filter(move |&p| p >= from)
    };
    let (width, height) = (field.inside.width(), field.inside.height());
    let places = steps(field.y0, height).flat_map(move |y| steps(field.x0, width).map(move |x| (x, y)));
    places.filter_map(move |(x, y)| {
        let (i, j) = (x - field.x0, y - field.y0);
        let [dx, dy] = field.jumps.get(i, j).map(f64::from);
        let (at, jump) = (Point::new(x as f64 + 0.5, y as f64 + 0.5), Vec2::new(dx, dy));
        field.inside.get(i, j).then_some(Pixel { index: j * width + i, at, jump })
    })
}

impl Drawing<'_> {
    fn pixels(&mut self, zone: &ZoneSynth, at: &Arc<str>) {
        let view = self.view;
        if view.shows(WHEEL) {
            self.cells(&zone.field, at);
        }
        if view.shows(FIELD) {
            self.arrows(&zone.field, at);
        }
        if view.shows(STREAMLINES) {
            self.streamlines(&zone.field, at);
        }
        if view.shows(PATHS) {
            self.paths(zone, at);
        }
        if view.shows(THRESHOLDS) {
            self.thresholds(&zone.field, at);
        }
        if view.shows(ONION) {
            self.samplers(zone, &view.times, at);
        } else if view.shows(SAMPLERS) {
            self.samplers(zone, &view.times[..view.times.len().min(1)], at);
        }
    }

    fn cells(&mut self, field: &Field, at: &Arc<str>) {
        let View { vectors, reach, .. } = self.view;
        let side = self.view.cell_px.max(1.0);
        for pixel in lattice(field, self.view.cell_px) {
            let tint = Some(vectors.color(pixel.jump, || field.slopes(pixel.at), *reach));
            let mark = Mark::new(&VECTOR_COLORS, at.clone(), Shape::Cell(pixel.at, side));
            self.marks.push(Mark { tint, strength: vectors.opacity as f32, ..mark });
        }
    }

    fn arrows(&mut self, field: &Field, at: &Arc<str>) {
        for pixel in lattice(field, self.view.spacing_px) {
            let shape = Shape::Arrow(pixel.at, pixel.at + self.view.arrow(pixel.jump));
            self.stroke(field, pixel.at, at, shape);
        }
    }

    /// Streamlines, with an arrow's head in the middle of each. One whose color tells something is drawn in pieces, each of
    /// the color of its middle.
    fn streamlines(&mut self, field: &Field, at: &Arc<str>) {
        let spacing = self.view.spacing_px;
        let seeds = lattice(field, spacing).map(|pixel| pixel.at);
        for line in streamlines(field, seeds, spacing) {
            let piece = if self.view.vectors.color == Coloring::Plain { line.len() } else { PIECE };
            for points in (0..line.len() - 1).step_by(piece).map(|i| &line[i..(i + piece + 1).min(line.len())]) {
                let shape = Shape::Line { points: points.to_vec(), closed: false };
                self.stroke(field, points[points.len() / 2], at, shape);
            }
            let middle = line.len() / 2;
            self.stroke(field, line[middle], at, Shape::Arrow(line[middle.saturating_sub(PIECE / 2)], line[middle]));
        }
    }

    /// Adds an arrow or a line of the field, in the color of the vector at a place. Over colors it would not be seen in its own.
    fn stroke(&mut self, field: &Field, of: Point, at: &Arc<str>, shape: Shape) {
        let View { vectors, reach, .. } = self.view;
        let tint = vectors.stroke_color(field.jump(of), || field.slopes(of), *reach);
        let tint = tint.filter(|_| !self.view.shows(WHEEL));
        self.marks.push(Mark { tint, strength: vectors.opacity as f32, ..Mark::new(&VECTORS, at.clone(), shape) });
    }

    /// The jump paths: from s = 0 to 1, and as far as the position function goes beyond.
    fn paths(&mut self, zone: &ZoneSynth, at: &Arc<str>) {
        let (low, high) = zone.clock.position.range();
        let pixels = lattice(&zone.field, self.view.spacing_px);
        for Pixel { at: q, jump, .. } in pixels.filter(|pixel| pixel.jump != Vec2::ZERO) {
            let points = vec![q + jump * low.min(0.0), q + jump * high.max(1.0)];
            self.add(&PATH, at, Shape::Line { points, closed: false });
        }
    }

    fn thresholds(&mut self, field: &Field, at: &Arc<str>) {
        let Some(folds) = &field.folds else { return };
        for pixel in lattice(field, self.view.spacing_px) {
            for s in folds.behind.of(pixel.index).iter().chain(folds.ahead.of(pixel.index)) {
                self.add(&THRESHOLD, at, Shape::Dot(pixel.at + pixel.jump * *s));
            }
        }
    }

    /// The samplers at their effective places; the earlier ones first, so that they are below.
    fn samplers(&mut self, zone: &ZoneSynth, times: &[f64], at: &Arc<str>) {
        let fading = times.len() as f32;
        for (age, &time) in times.iter().enumerate().rev() {
            let s = zone.clock.s(time);
            for pixel in lattice(&zone.field, self.view.spacing_px) {
                let effective = zone.field.folds.as_ref().map_or(Some(s), |folds| folds.effective(pixel.index, s));
                let look = if effective.is_some() { &SAMPLER } else { &RESTING };
                if age == 0 || effective.is_some() {
                    let shape = Shape::Dot(pixel.at + pixel.jump * effective.unwrap_or(0.0));
                    let strength = 1.0 - age as f32 / fading;
                    self.marks.push(Mark { strength, ..Mark::new(look, at.clone(), shape) });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::picture::Picture;
    use crate::base::pixels::Grid;
    use crate::layers::folding::model::PictureLayer;
    use crate::layers::folding::synth::synth;
    use crate::layers::parts::materials::Materials;
    use crate::layers::parts::vectors::Reach;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;

    #[test]
    fn pixels_are_taken_from_one_lattice() {
        let field = Field {
            x0: 3,
            y0: 0,
            inside: Arc::new(Grid::filled(10, 3, true)),
            jumps: Arc::new(Grid::filled(10, 3, [2.0, 0.0])),
            folds: None,
        };
        let found: Vec<_> = lattice(&field, 4.0).map(|pixel| (pixel.index, pixel.at)).collect();
        assert_eq!(found, [(23, Point::new(6.5, 2.5)), (27, Point::new(10.5, 2.5))]);
    }

    /// The marks of a zone whose only path of interest jumps 8 to the right and meets a region at s = 0.25 and 0.5.
    fn shapes(shown: &'static str, times: &[f64]) -> Vec<(&'static str, Shape, f32)> {
        let layer: PictureLayer = serde_json::from_str(
            r#"{ "name": "l", "image": "a",
              "zones": [{ "name": "z", "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 4, "height": 4},
                "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 4.5, "y": 0, "width": 2, "height": 9}]},
                "motion": [{"tool": "point", "at": [2, 2], "jump": [8, 0]}]}]}"#,
        )
        .unwrap();
        let picture = Arc::new(Picture::filled(16, 16, [1.0; 4]));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let synth = synth(&layer, &Making::plain(Wrap::default(), &materials), None).unwrap();
        let reach = Reach { longest_px: 8.0, ..Reach::default() };
        let view = View { spacing_px: 4.0, cell_px: 4.0, reach, times: times.into(), ..View::of(&[shown]) };
        marks(&synth, &view).into_iter().map(|mark| (mark.look.name, mark.shape, mark.strength)).collect()
    }

    #[test]
    fn what_is_drawn_of_a_pixel() {
        let at = |x: f64| Point::new(x, 2.5);
        let path = Shape::Line { points: vec![at(2.5), at(10.5)], closed: false };
        for (shown, times, expected) in [
            (FIELD, &[][..], vec![("vector field", Shape::Arrow(at(2.5), at(6.5)), 1.0)]),
            (PATHS, &[], vec![("jump path", path, 1.0)]),
            (THRESHOLDS, &[], vec![("threshold", Shape::Dot(at(4.5)), 1.0), ("threshold", Shape::Dot(at(6.5)), 1.0)]),
            (SAMPLERS, &[0.375], vec![("sampler", Shape::Dot(at(4.5)), 1.0)]),
            (SAMPLERS, &[0.375, 0.125], vec![("sampler", Shape::Dot(at(4.5)), 1.0)]),
            (ONION, &[0.75, 0.125], vec![("sampler", Shape::Dot(at(3.5)), 0.5), ("sampler", Shape::Dot(at(8.5)), 1.0)]),
            (WHEEL, &[], vec![("vector field as colors", Shape::Cell(at(2.5), 4.0), 1.0)]),
        ] {
            assert_eq!(shapes(shown, times), expected, "{shown}");
        }
    }
}
