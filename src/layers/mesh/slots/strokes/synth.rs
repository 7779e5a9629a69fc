//! Strokes ready for any time: what is made of the mesh and the images once.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::check;
use super::curvature::Curvature;
use super::force::Strokes;
use super::model::{Along, By, Direction, ToneOf, Vary};
use super::pieces::Pieces;
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::pixels::{Grid, srgb_from_linear};
use crate::base::problem::Problem;
use crate::layers::ready::Making;

/// How far curvature is smoothed that strokes only vary by.
pub const SMOOTH: f64 = 0.08;

/// Strokes ready for any time.
#[derive(Clone, Debug)]
pub struct Ready {
    /// What they are.
    pub strokes: Strokes,
    /// The pieces of the mesh.
    pub pieces: Arc<Pieces>,
    /// The curvature of the mesh, by how far it is smoothed.
    pub curvatures: Vec<(f64, Arc<Curvature>)>,
    /// The codes of the images that they follow, from 0 to 255, by their names.
    pub images: BTreeMap<String, Arc<Codes>>,
    /// How many pixels of the frame a meter is, for strokes that are a texture.
    pub px_per_m: f64,
    /// How long the timeline is, in seconds.
    pub duration: f64,
    /// How many times larger they are drawn than the document says.
    pub scale: f64,
    /// Once it is set, frames are given up, with anything in them.
    pub stop: Option<Arc<AtomicBool>>,
}

/// The codes of an image: red, green, blue.
pub type Codes = Grid<[f32; 3]>;

impl Ready {
    /// Prepares strokes for a mesh. What it has in common with `previous`, which was made for the same mesh, is reused.
    ///
    /// # Errors
    /// If an image is not there, or there are too many waves; the problem's path is relative to the strokes.
    pub fn new(strokes: &Strokes, mesh: &Mesh, making: &Making, previous: Option<&Ready>) -> Result<Ready, Problem> {
        let areas = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| mesh.vertices[vertex as usize].position);
            (b - a).cross(c - a).length() / 2.0
        });
        let surface_px = areas.sum::<f64>() * making.px_per_m * making.px_per_m;
        if let Some(problem) = check::too_many(strokes, making.size_px, surface_px) {
            return Err(problem);
        }
        let pieces = previous.map_or_else(|| Arc::new(Pieces::new(mesh)), |previous| previous.pieces.clone());
        let curvature = |smooth: f64| {
            let known = previous.and_then(|previous| previous.curvature(smooth));
            (smooth, known.unwrap_or_else(|| Arc::new(Curvature::new(mesh, smooth))))
        };
        let curvatures = smoothings(strokes).into_iter().map(curvature).collect();
        let mut images = BTreeMap::new();
        for (path, name) in check::images(strokes) {
            let picture = making.materials.picture(name, &path)?;
            images.insert(name.to_owned(), Arc::new(codes(&picture)));
        }
        let Making { px_per_m, duration, .. } = *making;
        let stop = making.materials.stop.clone();
        Ok(Ready { strokes: strokes.clone(), pieces, curvatures, images, px_per_m, duration, scale: 1.0, stop })
    }

    /// Whether its marks ask for normals.
    pub fn has_creases(&self) -> bool {
        self.strokes.marks.iter().any(|mark| mark.creases.is_some())
    }

    /// Whether its tones are of the light alone.
    pub fn is_of_light(&self) -> bool {
        self.strokes.tone.of == ToneOf::Light
    }

    /// The curvature smoothed so far.
    pub fn curvature(&self, smooth: f64) -> Option<Arc<Curvature>> {
        self.curvatures.iter().find(|(known, _)| *known == smooth).map(|(_, curvature)| curvature.clone())
    }
}

/// Whether it is set.
pub fn is_set(stop: Option<&AtomicBool>) -> bool {
    stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
}

/// How far the curvatures that strokes need are smoothed.
fn smoothings(strokes: &Strokes) -> Vec<f64> {
    let own = (Some(&strokes.direction), strokes.vary.as_ref());
    let noises = strokes.noises.values().map(|noise| (noise.direction.as_ref(), noise.vary.as_ref()));
    let along = |direction: &Direction| (direction.along == Along::Curvature).then_some(direction.smooth);
    let by = |vary: &Vary| (vary.by == By::Curvature).then_some(SMOOTH);
    let all = std::iter::once(own).chain(noises);
    let mut all: Vec<f64> =
        all.flat_map(|(direction, vary)| [direction.and_then(along), vary.and_then(by)]).flatten().collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// The codes of a picture, whatever they stand for.
fn codes(picture: &Picture) -> Codes {
    let linear = picture.to_linear();
    let code = |[r, g, b, a]: [f32; 4]| {
        let straight = |v: f32| if a > 0.0 { f64::from(v / a) } else { 0.0 };
        [r, g, b].map(|v| (255.0 * srgb_from_linear(straight(v))).round() as f32)
    };
    Grid::from_cells(linear.width(), linear.height(), linear.cells().iter().map(|cell| code(*cell)).collect())
}
