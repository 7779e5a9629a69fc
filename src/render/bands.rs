//! A frame of a large picture, band by band: each band is synthesised, rendered and encoded before the next, so that a
//! frame needs memory for the picture, its own codes and little else. Every band is the same to the bit as those rows
//! from [`super::synth`] and [`super::cpu`].

use std::ops::Range;
use std::sync::Arc;

use kurbo::Vec2;

use super::made::Wholes;
use super::stage::Stage;
use super::{Synth, cpu};
use crate::base::pixels::{Frame, Grid, encode};
use crate::base::problem::Problem;
use crate::layers::Layer;
use crate::layers::parts::materials::Materials;
use crate::layers::parts::moment::CENTER;
use crate::layers::ready::{Making, Prepared, Whole};
use crate::scene::Scene;

/// A scene whose parts can be rendered without the rest.
pub struct Bands<'a> {
    materials: &'a Materials,
    size: (usize, usize),
    stage: Arc<Stage>,
    /// The layers, for every sample of a pixel.
    samples: Vec<Vec<Box<dyn Prepared>>>,
}

impl<'a> Bands<'a> {
    /// Pixels per band: enough for all cores, and small compared with the picture.
    pub const PIXELS: usize = 1 << 20;

    /// Prepares everything that the parts share, for n x n samples per pixel.
    ///
    /// # Errors
    /// As [`super::synth`].
    pub fn new(scene: &Scene, materials: &'a Materials, n: u32) -> Result<Self, Problem> {
        Bands::after(scene, materials, n, None)
    }

    /// The same; what it has in common with `previous` is reused.
    ///
    /// # Errors
    /// As [`super::synth`].
    pub fn after(scene: &Scene, materials: &'a Materials, n: u32, previous: Option<&Synth>) -> Result<Self, Problem> {
        let places = if n == 1 { vec![CENTER] } else { super::places(n).collect() };
        let textures = super::textures(scene, materials, None)?;
        let layers = |place: Vec2, first: Option<&Vec<Box<dyn Prepared>>>| {
            let prepare = |(i, layer): (usize, &Layer)| {
                if let Some(texture) = textures.get(layer.technique().name()) {
                    return Ok(Box::new(Whole(texture.layer.clone())) as Box<dyn Prepared>);
                }
                let making = Making { place, textures: &textures, ..super::making(scene, materials) };
                let first = first.and_then(|layers| layers[i].part(0..0, 0..0, materials).ok());
                let before = first.as_ref().or_else(|| previous?.layers.get(i)).map(|before| &**before);
                layer.technique().prepare(&making, before).map_err(|problem| problem.under(&format!("/layers/{i}")))
            };
            scene.layers.iter().enumerate().map(prepare).collect::<Result<Vec<_>, _>>()
        };
        let mut samples: Vec<Vec<Box<dyn Prepared>>> = Vec::new();
        for place in places {
            samples.push(layers(place, samples.first())?);
        }
        let stage = Arc::new(Stage::of(scene));
        Ok(Bands { materials, size: super::frame_size(scene, materials), stage, samples })
    }

    /// Width and height of a frame.
    pub fn size(&self) -> (usize, usize) {
        self.size
    }

    fn part(&self, columns: Range<usize>, rows: Range<usize>) -> Result<Vec<Synth>, Problem> {
        let synth = |layers: &Vec<Box<dyn Prepared>>| {
            let layers = layers.iter().enumerate().map(|(i, prepared)| {
                let part = prepared.part(columns.clone(), rows.clone(), self.materials);
                part.map_err(|problem| problem.under(&format!("/layers/{i}")))
            });
            let layers = layers.collect::<Result<_, _>>()?;
            Ok(Synth { size: self.size, layers, stage: self.stage.clone(), ..Synth::default() })
        };
        let made = self.samples.iter().map(synth).collect();
        if self.materials.stopped() { Err(Problem::error("", "stopped")) } else { made }
    }

    /// How many rows [`Bands::frame`] tells of in all.
    pub fn steps(&self) -> usize {
        self.size.1 * self.samples.len()
    }

    /// The finished frame at `time`; `done` hears of the rows of its samples as they are made.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn frame(&self, time: f64, done: cpu::Done) -> Result<Frame, Problem> {
        let (width, height) = self.size;
        let mut cells = vec![[0; 4]; width * height];
        let most = (Self::PIXELS / width.max(1)).max(1);
        let wholes = Wholes::new(&self.part(0..width, 0..0)?, time);
        for (i, out) in cells.chunks_mut(most * width.max(1)).enumerate() {
            let rows = i * most..((i + 1) * most).min(height);
            cpu::finish_rows(&self.part(0..width, rows.clone())?, (time, &wholes), rows, out, done);
        }
        if self.materials.stopped() {
            return Err(Problem::error("", "stopped"));
        }
        Ok(Grid::from_cells(width, height, cells))
    }

    /// The layers with nothing that moves.
    pub fn pictures(&self) -> Synth {
        let layers = self.samples.first().into_iter().flatten();
        // A part without pixels needs nothing.
        let layers = layers.filter_map(|prepared| prepared.part(0..0, 0..0, self.materials).ok());
        Synth { size: self.size, layers: layers.collect(), stage: self.stage.clone(), ..Synth::default() }
    }

    /// The color of the pixel in column `x`, row `y` at `time`; transparent beyond the frame.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn pixel(&self, time: f64, (x, y): (usize, usize)) -> Result<[u8; 4], Problem> {
        if x >= self.size.0 || y >= self.size.1 {
            return Ok([0; 4]);
        }
        let made = self.part(x..x + 1, y..y + 1)?;
        let linear = cpu::mean_lattice(&made, time, &[x], &[y]);
        Ok(linear.cells().first().map_or([0; 4], |&color| encode(color)))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::base::picture::Picture;

    #[test]
    fn bands_and_pixels_are_those_of_the_frame() {
        // Wide enough that a band is only a few rows, so that there are several.
        let (width, height) = (Bands::PIXELS / 3, 7);
        let cell = |i: usize| [(i % 251) as f32 / 251.0, (i % 17) as f32 / 17.0, (i % 5) as f32 / 5.0, 1.0];
        let picture = Arc::new(Picture::from_cells(width, height, (0..width * height).map(cell).collect()));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let scene: Scene = serde_json::from_str(
            r#"{"plica": 1, "layers": [{"kind": "picture", "name": "l", "image": "a", "zones": [{"name": "z",
              "outline": {"kind": "rectangle", "x": 100, "y": 1, "width": 300, "height": 5},
              "motion": [{"tool": "point", "at": [200, 3], "jump": [40, 2]}],
              "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 260, "y": 2, "width": 30, "height": 3}]}}]}]}"#,
        )
        .unwrap();
        for n in [1, 2] {
            let bands = Bands::new(&scene, &materials, n).unwrap();
            let samples = if n == 1 {
                vec![crate::render::synth(&scene, &materials, None).unwrap()]
            } else {
                crate::render::samples(&scene, &materials, n).unwrap()
            };
            let whole = cpu::finish(&cpu::mean(&samples, 0.7));
            let done = AtomicUsize::new(0);
            let count = |rows| {
                done.fetch_add(rows, Ordering::Relaxed);
            };
            assert!(bands.frame(0.7, &count).unwrap() == whole, "{n} x {n}");
            assert_eq!(done.into_inner(), bands.steps(), "{n} x {n}");
            assert!(cpu::frames(&samples, 0.7) == whole);
            for at in [(150, 2), (255, 4), (5, 6)] {
                assert_eq!(bands.pixel(0.7, at).unwrap(), *whole.get(at.0, at.1), "{n} x {n} {at:?}");
            }
            assert_eq!(bands.pixel(0.7, (0, 7)).unwrap(), [0; 4]);
        }
    }
}
