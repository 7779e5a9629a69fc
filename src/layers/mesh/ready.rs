//! What a mesh layer gives once it is ready.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use rayon::prelude::*;
use serde_json::Value;

use super::frame::MeshAt;
use super::synth::Synth;
use super::{around, marks, plan, probe, unseen};
use crate::base::geometry;
use crate::base::pixels::Linear;
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::base::reduce::Reduced;
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::Plan;
use crate::layers::parts::readout::Under;
use crate::layers::parts::shots::{Painted, Put, Taken};
use crate::layers::ready::{Ready, Still};
use crate::layers::space::eye::Ray;

impl Ready for Synth {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(MeshAt::new(self, moment))
    }

    fn stoppable(&self, stop: &Arc<AtomicBool>) -> Option<Arc<dyn Ready>> {
        let strokes = Some(self.strokes.as_ref()?.stoppable(stop));
        Some(Arc::new(Synth { strokes, ..self.clone() }))
    }

    fn has_strokes(&self) -> bool {
        self.strokes.is_some()
    }

    fn by_cpu(&self) -> Option<&'static str> {
        self.surface.by_cpu()
    }

    fn takes_long(&self) -> bool {
        self.has_strokes() || self.surface.takes_long()
    }

    fn lying(&self, compare: Option<&Watch>) -> Option<Vec<Value>> {
        self.surface.lying(compare)
    }

    fn around(&self, t: f64, side_px: usize, watch: &Watch) -> Vec<Taken> {
        around::around(self, t, side_px, watch)
    }

    fn guide(&self, picture: usize, watch: &Watch) -> Option<Linear> {
        self.surface.guide(picture, watch)
    }

    fn lacks(&self) -> Option<Problem> {
        self.surface.lacks().map(|problem| problem.under("/surface"))
    }

    fn laid_px(&self, picture: usize) -> Option<(usize, usize)> {
        self.surface.laid_px(picture)
    }

    fn painted(&self, picture: usize, share: f64) -> Option<Painted> {
        self.surface.painted(picture, share)
    }

    fn put_round(&self, picture: usize, put: Put, ray: &Ray, t: f64) -> Result<(String, Value), String> {
        let placed = self.pose.at(if self.still { 0.0 } else { t });
        let (path, value) = self.surface.put_round(picture, put, ray, &placed)?;
        Ok((format!("/surface{path}"), value))
    }

    fn balanced(&self) -> Option<Vec<(String, Value)>> {
        let balanced = self.surface.balanced()?;
        Some(balanced.into_iter().map(|(path, value)| (format!("/surface{path}"), value)).collect())
    }

    fn plan(&self, moment: &Moment) -> Plan {
        plan::plan(self, moment)
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        Arc::new(Synth { still: true, surface: self.surface.clone().unmoved(), ..(*self).clone() })
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        let strokes = self.strokes.as_ref().map(|strokes| strokes.reduced(pictures.by));
        Arc::new(Synth { surface: self.surface.clone().reduced(pictures), strokes, ..self.clone() })
    }

    fn marks(&self, view: &View, moment: &Moment) -> Vec<Mark> {
        marks::marks(self, view, moment)
    }

    fn under(&self, pixel: (usize, usize), moment: &Moment) -> Option<Under> {
        probe::under(self, pixel, moment)
    }

    fn is_in_frame(&self, moment: &Moment) -> bool {
        unseen::is_in_frame(self, moment)
    }

    fn reach(&self, t: f64, ways: &[DVec3]) -> Option<Vec<f64>> {
        let placed = self.pose.at(if self.still { 0.0 } else { t });
        // A mesh without a size is nowhere.
        if placed.scale == 0.0 {
            return None;
        }
        if placed.bend_radians != 0.0 {
            let world = self.mesh.vertices.par_iter().map(|vertex| placed.point(vertex.position, DVec3::ZERO).0);
            return geometry::reach(world, ways);
        }
        // Ways are fewer than vertices: they are turned in place of those.
        let own: Vec<DVec3> = ways.iter().map(|way| placed.turn.transpose() * *way * placed.scale).collect();
        let far = self.mesh.reach(&own)?;
        Some(far.into_iter().zip(ways).map(|(far, way)| far + way.dot(placed.position)).collect())
    }

    fn largest_texture(&self) -> usize {
        self.surface.largest_texture()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::mesh::{Mesh, Vertex};
    use crate::layers::mesh::model::MeshLayer;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::timeline::Wrap;

    #[test]
    fn it_reaches_as_far_as_what_the_pose_makes_of_the_mesh() {
        let corner = |[x, y]: [f64; 2]| Vertex { position: DVec3::new(x, y, 0.0), ..Vertex::default() };
        let vertices = [[0.0, 0.0], [0.0, 2.0], [0.5, 2.0]].map(corner).to_vec();
        let mesh = Arc::new(Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() });
        let materials = Materials { meshes: [("m".to_owned(), mesh)].into(), ..Materials::default() };
        for (pose, t, low, high) in [
            (r#"{"position": [1, 0, 0], "scale": 2}"#, 0.0, [1.0, 0.0, 0.0], [2.0, 4.0, 0.0]),
            (r#"{"spin": 360}"#, 0.25, [0.0, 0.0, -0.5], [0.0, 2.0, 0.0]),
            (r#"{"bend": {"degrees": 90}}"#, 0.0, [-2.0, 0.0, 0.0], [0.0, 0.5, 0.0]),
        ] {
            let layer = format!(r#"{{"name": "m", "mesh": "m", "pose": {pose}}}"#);
            let layer: MeshLayer = serde_json::from_str(&layer).unwrap();
            let synth = Synth::new(&layer, &Making::plain(Wrap::Repeat, &materials), None).unwrap();
            let ways = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [axis, -axis]).concat();
            let found = synth.reach(t, &ways).unwrap();
            let expected = (0..3).flat_map(|axis| [high[axis], -low[axis]]);
            let far = found.iter().zip(expected).map(|(a, b): (&f64, f64)| (a - b).abs()).fold(0.0, f64::max);
            assert!(far < 1e-12, "{pose}: {found:?}");
            let flat = Synth { pose: crate::layers::mesh::pose::Pose { scale: 0.0, ..synth.pose.clone() }, ..synth };
            assert_eq!(flat.reach(t, &ways), None, "{pose}");
        }
    }
}
