//! What is odd about a mesh as a layer shows it, which no one would see in the picture.

use super::model::{MeshLayer, Sides};
use crate::base::maths::nice;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::base::text;
use crate::layers::space::eye::{FAR_M, NEAR_M};

/// The largest scale of a pose.
const MOST_SCALE: f64 = 1e6;

/// The warnings; paths are relative to the layer.
pub fn warnings(layer: &MeshLayer, mesh: &Mesh) -> Vec<Problem> {
    inside_out(layer, mesh).into_iter().chain(out_of_size(layer, mesh)).collect()
}

fn inside_out(layer: &MeshLayer, mesh: &Mesh) -> Option<Problem> {
    (mesh.inside_out && layer.sides == Sides::Front).then(|| {
        let message = format!("the mesh \"{}\" is inside out: only its far side is seen, from within", layer.mesh);
        Problem::warning("/sides", message).hint("make sides \"both\", or turn its faces outward where it was made")
    })
}

fn out_of_size(layer: &MeshLayer, mesh: &Mesh) -> Option<Problem> {
    let (low, high) = mesh.bounds()?;
    // Halves do not overflow.
    let half = (high * 0.5 - low * 0.5).max_element();
    let size = half * layer.pose.scale * 2.0;
    let why = match size {
        0.0 => return None,
        _ if size < NEAR_M => format!("the camera sees nothing nearer than {NEAR_M} m, and this stays small"),
        _ if size > FAR_M => format!("no camera stands so far away that it sees more than {FAR_M:e} m"),
        _ => return None,
    };
    let message = format!("the mesh \"{}\" is {} m large here: {why}", layer.mesh, rough(size));
    let cure = match nice(0.5 / half).filter(|scale| *scale <= MOST_SCALE) {
        Some(scale) => format!("make pose.scale {}", rough(scale)),
        None => "scale it where it was made, and export it again".to_owned(),
    };
    Some(Problem::warning("/pose/scale", message).hint(cure))
}

/// A number by its first digits.
fn rough(number: f64) -> String {
    if (1e-3..1e7).contains(&number) { text::short(number, 4) } else { format!("{number:.0e}") }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::base::mesh::Vertex;

    fn told(layer: &str, size: f64, inside_out: bool) -> Vec<String> {
        let vertices = [DVec3::ZERO, DVec3::Y * size].map(|position| Vertex { position, ..Vertex::default() }).to_vec();
        let mesh = Mesh { vertices, triangles: vec![[0, 1, 0]], inside_out, ..Mesh::default() };
        let layer: MeshLayer = serde_json::from_str(layer).unwrap();
        warnings(&layer, &mesh).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn what_is_odd_is_told_with_a_cure() {
        let plain = r#"{"name": "m", "mesh": "m"}"#;
        let scaled = |scale: &str| format!(r#"{{"name": "m", "mesh": "m", "pose": {{"scale": {scale}}}}}"#);
        for (layer, size, inside_out, found) in [
            (plain, 1.0, false, &[][..]),
            (plain, 1.0, true, &["sides: warning", "inside out", "make sides \"both\""]),
            (r#"{"name": "m", "mesh": "m", "sides": "both"}"#, 1.0, true, &[]),
            (plain, 1e-30, false, &["pose.scale: warning", "1e-30 m large", "where it was made"]),
            (plain, 0.004, false, &["0.004 m large", "make pose.scale 200"]),
            (&scaled("200"), 0.004, false, &[]),
            (&scaled("0"), 0.004, false, &[]),
            (plain, 3e8, false, &["3e8 m large", "where it was made"]),
            (plain, 1e300, false, &["1e300 m large", "where it was made"]),
        ] {
            let told = told(layer, size, inside_out);
            assert_eq!(told.len(), found.len().min(1), "{layer} {size}: {told:?}");
            assert!(found.iter().all(|part| told[0].contains(part)), "{layer} {size}: {told:?}");
        }
    }
}
