//! A mesh as textures for the GPU: for each vertex two texels (position and u; normal and v), for each triangle one (the
//! vertices of its corners), in rows of [`WIDTH`].

use std::ops::Range;

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

fn packed(rows: Rows<'_>, texels: usize, format: Format) -> Packed<'_> {
    Packed { size: (WIDTH, texels.div_ceil(WIDTH).max(1)), format, rows }
}

/// Rows of texels, `N` for each of `count` items.
fn lines<'a, const N: usize, T: bytemuck::Pod + Default>(
    count: usize,
    of: impl Fn(usize) -> [[T; 4]; N] + 'a,
) -> Rows<'a>
where
    [T; 4]: bytemuck::Pod,
{
    Box::new(move |rows: Range<usize>, take: &mut dyn FnMut(&[u8])| {
        let each = WIDTH / N;
        let mut line: Vec<[T; 4]> = Vec::with_capacity(WIDTH);
        for row in rows {
            line.clear();
            (row * each..((row + 1) * each).min(count)).for_each(|i| line.extend(of(i)));
            line.resize(WIDTH, [T::default(); 4]);
            take(bytemuck::cast_slice(&line));
        }
    })
}
