//! What is drawn of single pixels of zones, one every so many: jump vectors as arrows and colours, jump paths, where they
//! meet fold regions, and the samplers that run along them.

use kurbo::{Point, Vec2};

use super::style::wheel;
use super::{Drawing, Kind, Mark, Samplers, Shape, zone_pointer};
use crate::layers::folding::synth::ZoneSynth;
use crate::layers::folding::{self, field::Field};
use crate::render::Synth;

/// The longest jump vector of a scene, in pixels.
pub fn longest(synth: &Synth) -> f64 {
    let jumps = zones(synth).flat_map(|(_, zone)| zone.field.jumps.cells());
    jumps.map(|&[x, y]| f64::from(x * x + y * y)).fold(0.0, f64::max).sqrt()
}

/// By how much the arrows of a field are shorter than its jump vectors, so that they keep apart: the longest of the scene
/// reaches to the next arrow.
pub fn field_scale(synth: &Synth, spacing: f64) -> f64 {
    (spacing.max(1.0) / longest(synth)).min(1.0)
}

/// Zones and the indices of their layers.
fn zones(synth: &Synth) -> impl Iterator<Item = (usize, &ZoneSynth)> {
    let layers = synth.layers.iter().enumerate();
    let folding = layers.filter_map(|(i, layer)| Some((i, layer.downcast::<folding::synth::Synth>()?)));
    folding.flat_map(|(i, layer)| layer.zones.iter().map(move |zone| (i, zone)))
}

/// One pixel of a field.
struct Pixel {
    /// Its index in the field's box.
    index: usize,
    /// Its centre.
    at: Point,
    /// Its jump vector.
    jump: Vec2,
}

/// One pixel every `spacing`, the same ones whatever the zone's box is.
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
    /// All that the view asks for.
    pub(super) fn pixels(&mut self, synth: &Synth) {
        let (view, longest) = (self.view, if self.view.wheel.is_some() { longest(synth) } else { 0.0 });
        let arrows = view.field.map(|spacing| (spacing, field_scale(synth, spacing)));
        for (layer, zone) in zones(synth) {
            let at = &zone_pointer(layer, zone.index);
            if let Some(spacing) = view.wheel {
                self.cells(&zone.field, spacing, longest, at);
            }
            if let Some((spacing, scale)) = arrows {
                self.arrows(&zone.field, spacing, scale, at);
            }
            if let Some(spacing) = view.paths {
                self.paths(zone, spacing, at);
            }
            if let Some(spacing) = view.thresholds {
                self.thresholds(zone, spacing, at);
            }
            if let Some(samplers) = &view.samplers {
                self.samplers(zone, samplers, at);
            }
        }
    }

    fn cells(&mut self, field: &Field, spacing: f64, longest: f64, at: &str) {
        for pixel in lattice(field, spacing) {
            self.add(Kind::Wheel, at, Shape::Cell(pixel.at, spacing.max(1.0), wheel(pixel.jump, longest)));
        }
    }

    fn arrows(&mut self, field: &Field, spacing: f64, scale: f64, at: &str) {
        for pixel in lattice(field, spacing) {
            self.add(Kind::Field, at, Shape::Arrow(pixel.at, pixel.at + pixel.jump * scale));
        }
    }

    /// The jump paths: from s = 0 to 1, and as far as the position function goes beyond.
    fn paths(&mut self, zone: &ZoneSynth, spacing: f64, at: &str) {
        let (low, high) = zone.clock.position.range();
        for Pixel { at: q, jump, .. } in lattice(&zone.field, spacing).filter(|pixel| pixel.jump != Vec2::ZERO) {
            let points = vec![q + jump * low.min(0.0), q + jump * high.max(1.0)];
            self.add(Kind::Path, at, Shape::Line { points, closed: false });
        }
    }

    fn thresholds(&mut self, zone: &ZoneSynth, spacing: f64, at: &str) {
        let Some(folds) = &zone.field.folds else { return };
        for pixel in lattice(&zone.field, spacing) {
            for s in folds.behind.of(pixel.index).iter().chain(folds.ahead.of(pixel.index)) {
                self.add(Kind::Threshold, at, Shape::Dot(pixel.at + pixel.jump * *s));
            }
        }
    }

    /// The samplers at their effective places; the earlier ones first, so that they lie below.
    fn samplers(&mut self, zone: &ZoneSynth, samplers: &Samplers, at: &str) {
        let fading = samplers.times.len() as f32;
        for (age, &time) in samplers.times.iter().enumerate().rev() {
            let s = zone.clock.s(time);
            for pixel in lattice(&zone.field, samplers.spacing) {
                let effective = zone.field.folds.as_ref().map_or(Some(s), |folds| folds.effective(pixel.index, s));
                let kind = if effective.is_some() { Kind::Sampler } else { Kind::Resting };
                if age == 0 || effective.is_some() {
                    self.add(kind, at, Shape::Dot(pixel.at + pixel.jump * effective.unwrap_or(0.0)));
                    let strength = 1.0 - age as f32 / fading;
                    self.marks.last_mut().into_iter().for_each(|mark: &mut Mark| mark.strength = strength);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{View, overlay};
    use super::*;
    use crate::base::picture::Picture;
    use crate::base::pixels::Grid;
    use crate::layers::parts::materials::Materials;
    use std::sync::Arc;

    #[test]
    fn pixels_are_taken_from_one_lattice() {
        let field = Field {
            x0: 3,
            y0: 0,
            inside: Grid::filled(10, 3, true),
            jumps: Grid::filled(10, 3, [2.0, 0.0]),
            folds: None,
        };
        let found: Vec<_> = lattice(&field, 4.0).map(|pixel| (pixel.index, pixel.at)).collect();
        assert_eq!(found, [(23, Point::new(6.5, 2.5)), (27, Point::new(10.5, 2.5))]);
    }

    /// What is drawn of a zone whose only path of interest jumps 8 to the right and meets a region at s = 0.25 and 0.5.
    fn shapes(view: &View) -> Vec<(Kind, Shape, f32)> {
        let scene = serde_json::from_str(
            r#"{ "plica": 1, "images": {"a": {"path": "a.png"}}, "layers": [{ "kind": "picture", "name": "l", "image": "a",
              "zones": [{ "name": "z", "outline": {"kind": "rectangle", "x": 0, "y": 0, "width": 4, "height": 4},
                "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 4.5, "y": 0, "width": 2, "height": 9}]},
                "motion": [{"tool": "point", "at": [2, 2], "jump": [8, 0]}]}]}]}"#,
        )
        .unwrap();
        let picture = Arc::new(Picture::filled(16, 16, [1.0; 4]));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let synth = crate::render::synth(&scene, &materials, None).unwrap();
        overlay(&scene, Some(&synth), view).into_iter().map(|mark| (mark.kind, mark.shape, mark.strength)).collect()
    }

    #[test]
    fn what_is_drawn_of_a_pixel() {
        let spacing = Some(4.0);
        let at = |x: f64| Point::new(x, 2.5);
        let dots = |times: &[f64]| Some(Samplers { spacing: 4.0, times: times.to_vec() });
        let path = Shape::Line { points: vec![at(2.5), at(10.5)], closed: false };
        for (view, expected) in [
            (View { field: spacing, ..View::default() }, vec![(Kind::Field, Shape::Arrow(at(2.5), at(6.5)), 1.0)]),
            (View { paths: spacing, ..View::default() }, vec![(Kind::Path, path, 1.0)]),
            (
                View { thresholds: spacing, ..View::default() },
                vec![(Kind::Threshold, Shape::Dot(at(4.5)), 1.0), (Kind::Threshold, Shape::Dot(at(6.5)), 1.0)],
            ),
            (View { samplers: dots(&[0.375]), ..View::default() }, vec![(Kind::Sampler, Shape::Dot(at(4.5)), 1.0)]),
            (
                View { samplers: dots(&[0.75, 0.125]), ..View::default() },
                vec![(Kind::Sampler, Shape::Dot(at(3.5)), 0.5), (Kind::Sampler, Shape::Dot(at(8.5)), 1.0)],
            ),
            (
                View { wheel: spacing, ..View::default() },
                vec![(Kind::Wheel, Shape::Cell(at(2.5), 4.0, wheel(Vec2::new(8.0, 0.0), 8.0)), 1.0)],
            ),
        ] {
            assert_eq!(shapes(&view), expected, "{view:?}");
        }
    }
}
