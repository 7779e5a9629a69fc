//! The mesh of a map as an OBJ whose texture coordinates lead to its cells.

use std::collections::HashMap;
use std::fmt::Write;

use super::layout::Layout;
use crate::base::mesh::Mesh;
use crate::layers::mesh::slots::view_map::map::Map;

/// The text.
pub fn text(map: &Map, layout: &Layout) -> String {
    let Mesh { vertices, triangles, .. } = &*map.wanted.mesh;
    let mut text = String::from("# made by plica synth: texture coordinates lead to cells, as manifest.json tells\n");
    for vertex in vertices {
        let ([x, y, z], [i, j, k]) = (vertex.position.to_array(), vertex.normal.to_array());
        let _ = writeln!(text, "v {x} {y} {z}\nvn {i} {j} {k}");
    }
    let (width, height) = layout.size(0);
    let (mut known, mut faces) = (HashMap::new(), String::new());
    for (triangle, corners) in triangles.iter().enumerate() {
        let chart = map.atlas.chart[triangle];
        let (left, top) = layout.places[chart as usize];
        faces.push('f');
        for (corner, at) in corners.iter().zip(map.atlas.corners[triangle]) {
            let next = known.len() + 1;
            let number = *known.entry((*corner, chart)).or_insert(next);
            if number == next {
                let at = at * f64::from(map.wanted.first);
                let (u, v) = ((left as f64 + at.x) / width as f64, 1.0 - (top as f64 + at.y) / height as f64);
                let _ = writeln!(text, "vt {u} {v}");
            }
            let _ = write!(faces, " {0}/{number}/{0}", corner + 1);
        }
        faces.push('\n');
    }
    text + &faces
}
