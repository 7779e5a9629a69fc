//! A mesh as textures for the GPU: for each vertex two texels (position and u; normal and v), for each triangle one (the
//! vertices of its corners), in rows of [`WIDTH`].

use std::ops::Range;

use glam::{DMat3, DVec3, Mat4};

use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::plan::{Format, Packed, Rows, Upload};

/// Texels in a row.
pub const WIDTH: usize = 4096;

/// The number of the texture with the vertices.
pub const VERTICES: usize = 0;
/// The number of the texture with the triangles.
pub const TRIANGLES: usize = 1;

impl Upload for Mesh {
    fn pack(&self) -> Vec<Packed<'_>> {
        let vertices = lines(self.vertices.len(), |i| {
            let Vertex { position: p, normal: n, uv } = self.vertices[i];
            [[p.x, p.y, p.z, uv.x], [n.x, n.y, n.z, uv.y]].map(|texel| texel.map(|v| v as f32))
        });
        let triangles = lines(self.triangles.len(), |i| {
            let [a, b, c] = self.triangles[i];
            [[a, b, c, 0]]
        });
        vec![
            packed(vertices, self.vertices.len() * 2, Format::Rgba32Float),
            packed(triangles, self.triangles.len(), Format::Rgba32Uint),
        ]
    }
}

/// A turn and a shift as WGSL has a matrix.
pub fn matrix(turn: DMat3, shift: DVec3) -> [f32; 16] {
    let column = |v: DVec3, w: f32| v.as_vec3().extend(w);
    Mat4::from_cols(column(turn.x_axis, 0.0), column(turn.y_axis, 0.0), column(turn.z_axis, 0.0), column(shift, 1.0))
        .to_cols_array()
}

/// So many texels in rows of [`WIDTH`].
pub fn packed(rows: Rows<'_>, texels: usize, format: Format) -> Packed<'_> {
    Packed { size: (WIDTH, texels.div_ceil(WIDTH).max(1)), format, rows }
}

/// Rows of texels, `N` for each of `count` items.
pub fn lines<'a, const N: usize, T: bytemuck::Pod + Default>(
    count: usize,
    of: impl Fn(usize) -> [[T; 4]; N] + 'a,
) -> Rows<'a>
where
    [T; 4]: bytemuck::Pod,
{
    Box::new(move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
        let each = WIDTH / N;
        let mut texels: Vec<[T; 4]> = Vec::with_capacity(rows.len() * WIDTH);
        (rows.start * each..(rows.end * each).min(count)).for_each(|i| texels.extend(of(i)));
        texels.resize(rows.len() * WIDTH, [T::default(); 4]);
        take(bytemuck::cast_slice(&texels));
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rows_that_are_asked_for_come_at_once() {
        let mesh = Mesh { triangles: (0..2 * WIDTH as u32 + 5).map(|i| [i; 3]).collect(), ..Mesh::default() };
        let packed = &mesh.pack()[TRIANGLES];
        assert_eq!(packed.size, (WIDTH, 3));
        let mut all = Vec::new();
        (packed.rows)(1..3, &mut |bytes| all.push(bytes.to_vec()));
        let [bytes] = &all[..] else { panic!("taken {} times", all.len()) };
        let texels: &[[u32; 4]] = bytemuck::cast_slice(bytes);
        let first = WIDTH as u32;
        let last = 2 * first + 4;
        assert_eq!((texels.len(), texels[0]), (2 * WIDTH, [first, first, first, 0]));
        assert_eq!((texels[WIDTH + 4], texels[WIDTH + 5]), ([last, last, last, 0], [0; 4]));
    }
}
