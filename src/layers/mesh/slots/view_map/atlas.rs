//! The surface of a mesh laid flat: its charts, and where each triangle is in the atlas. All charts have the same density,
//! and all of the surface is half a unit square.

use glam::{DVec2, DVec3};

use crate::base::mesh::Mesh;

/// How charts are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// By texture coordinates.
    Uv,
    /// By the side of a box that triangles are turned to.
    Box,
}

/// A mesh laid flat.
#[derive(Clone, Debug, Default)]
pub struct Atlas {
    /// The chart of each triangle.
    pub chart: Vec<u32>,
    /// Where the corners of each triangle are in its chart.
    pub corners: Vec<[DVec2; 3]>,
    /// The area of each triangle there.
    pub areas: Vec<f64>,
    /// The greatest coordinates of each chart; the least are 0.
    pub extents: Vec<DVec2>,
    /// How many times larger each chart is there than as its coordinates were.
    pub scales: Vec<f64>,
}

impl Atlas {
    /// Lays a mesh flat.
    pub fn new(mesh: &Mesh, by: By) -> Atlas {
        let sides: Vec<u8> = (0..mesh.triangles.len()).map(|triangle| side(mesh, triangle, by)).collect();
        let chart = charts(mesh, &sides, by);
        let count = chart.iter().max().map_or(0, |last| *last as usize + 1);
        let flat = mesh.triangles.iter().zip(&sides).map(|(corners, side)| {
            corners.map(|corner| {
                let vertex = &mesh.vertices[corner as usize];
                match by {
                    By::Uv => DVec2::new(vertex.uv.x, -vertex.uv.y),
                    By::Box => seen_from(*side, vertex.position),
                }
            })
        });
        let mut corners: Vec<[DVec2; 3]> = flat.collect();
        let mut least = vec![DVec2::INFINITY; count];
        let (mut in_atlas, mut in_space, mut all) = (vec![0.0; count], vec![0.0; count], 0.0);
        for (triangle, own) in corners.iter().enumerate() {
            let chart = chart[triangle] as usize;
            least[chart] = own.iter().fold(least[chart], |least, corner| least.min(*corner));
            let area = normal(mesh, triangle).length() / 2.0;
            in_atlas[chart] += area_of(own);
            in_space[chart] += area;
            all += area;
        }
        let k = (0.5 / all).sqrt();
        let scale = |(flat, area): (&f64, &f64)| if *flat > 0.0 { k * (area / flat).sqrt() } else { 1.0 };
        let scales: Vec<f64> = in_atlas.iter().zip(&in_space).map(scale).collect();
        let mut extents = vec![DVec2::ZERO; count];
        for (own, chart) in corners.iter_mut().zip(&chart) {
            let chart = *chart as usize;
            *own = own.map(|corner| (corner - least[chart]) * scales[chart]);
            extents[chart] = own.iter().fold(extents[chart], |most, corner| most.max(*corner));
        }
        Atlas { chart, areas: corners.iter().map(area_of).collect(), corners, extents, scales }
    }

    /// Where a place of a triangle is in its chart.
    #[inline]
    pub fn at(&self, triangle: usize, weights: [f64; 3]) -> DVec2 {
        mixed(&self.corners[triangle], weights)
    }
}

/// The mean of corners with these weights.
#[inline]
pub fn mixed([a, b, c]: &[DVec2; 3], weights: [f64; 3]) -> DVec2 {
    *a * weights[0] + *b * weights[1] + *c * weights[2]
}

fn area_of([a, b, c]: &[DVec2; 3]) -> f64 {
    (*b - *a).perp_dot(*c - *a).abs() / 2.0
}

/// Twice the area of a triangle as a vector outward.
pub fn normal(mesh: &Mesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.triangles[triangle].map(|corner| mesh.vertices[corner as usize].position);
    (b - a).cross(c - a)
}

/// What a triangle must have in common with its neighbors to be of one chart.
fn side(mesh: &Mesh, triangle: usize, by: By) -> u8 {
    if by == By::Uv {
        let [a, b, c] = mesh.triangles[triangle].map(|corner| mesh.vertices[corner as usize].uv);
        return u8::from((b - a).perp_dot(c - a) > 0.0);
    }
    let normal = normal(mesh, triangle);
    let along = [normal.x, -normal.x, normal.y, -normal.y, normal.z, -normal.z];
    (1..6).fold(0, |best, side| if along[side] > along[best] { side } else { best }) as u8
}

/// A point as it is seen on a side of a box, from outside: right, then down.
fn seen_from(side: u8, p: DVec3) -> DVec2 {
    match side {
        0 => DVec2::new(-p.z, -p.y),
        1 => DVec2::new(p.z, -p.y),
        2 => DVec2::new(p.x, p.z),
        3 => DVec2::new(p.x, -p.z),
        4 => DVec2::new(p.x, -p.y),
        _ => DVec2::new(-p.x, -p.y),
    }
}

/// The chart of each triangle, by the first triangle of each.
fn charts(mesh: &Mesh, sides: &[u8], by: By) -> Vec<u32> {
    let places = same(mesh, by);
    let mut edges: Vec<([u32; 2], u8, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, (corners, side)) in mesh.triangles.iter().zip(sides).enumerate() {
        let ends = corners.map(|corner| places[corner as usize]);
        for k in 0..3 {
            let (a, b) = (ends[k], ends[(k + 1) % 3]);
            edges.push(([a.min(b), a.max(b)], *side, triangle as u32));
        }
    }
    edges.sort_unstable();
    let mut parents: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    for pair in edges.windows(2).filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1)) {
        let (a, b) = (root(&mut parents, pair[0].2), root(&mut parents, pair[1].2));
        // The first triangle stands for all.
        parents[a.max(b) as usize] = a.min(b);
    }
    let mut next = 0;
    let mut chart = vec![0; parents.len()];
    for triangle in 0..parents.len() {
        let first = root(&mut parents, triangle as u32) as usize;
        if first == triangle {
            chart[triangle] = next;
            next += 1;
        } else {
            chart[triangle] = chart[first];
        }
    }
    chart
}

fn root(parents: &mut [u32], mut of: u32) -> u32 {
    while parents[of as usize] != of {
        let above = parents[parents[of as usize] as usize];
        parents[of as usize] = above;
        of = above;
    }
    of
}

/// A number for each vertex that is the same for vertices at the same place; of `uv` charts, also in the texture.
fn same(mesh: &Mesh, by: By) -> Vec<u32> {
    // Adding 0 makes one number of 0 and -0.
    let key = |vertex: u32| {
        let vertex = &mesh.vertices[vertex as usize];
        let [x, y, z] = vertex.position.to_array();
        let [u, v] = if by == By::Uv { vertex.uv.to_array() } else { [0.0; 2] };
        [x, y, z, u, v].map(|number| (number + 0.0).to_bits())
    };
    let mut order: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    order.sort_by_cached_key(|vertex| key(*vertex));
    let mut numbers = vec![0; order.len()];
    for pair in order.windows(2) {
        let more = u32::from(key(pair[0]) != key(pair[1]));
        numbers[pair[1] as usize] = numbers[pair[0] as usize] + more;
    }
    numbers
}
