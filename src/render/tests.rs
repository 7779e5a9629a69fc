//! A camera inside a room, with things that the near plane cuts, against a plain caster of rays that shares no code with the
//! rasteriser: for each pixel every triangle is tried.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use serde_json::json;

use super::passes::Asked;
use crate::base::maths::{cos, sin};
use crate::base::mesh::{Mesh, Vertex};
use crate::layers::parts::materials::Materials;
use crate::scene::Document;

const SIZE: (usize, usize) = (96, 64);
const NEAR_M: f64 = 0.01;

/// A mesh of triangles with corners of their own, whose normals lean as only a curved surface's do.
fn mesh(triangles: Vec<[DVec3; 3]>) -> Mesh {
    let lean = |at: DVec3| 0.3 * DVec3::new(sin(3.0 * at.y), cos(2.0 * at.z), sin(2.5 * at.x));
    let corner = |flat: DVec3| {
        move |position: DVec3| Vertex { position, normal: (flat + lean(position)).normalize(), ..Vertex::default() }
    };
    let vertices = triangles.iter().flat_map(|&[a, b, c]| [a, b, c].map(corner((b - a).cross(c - a).normalize())));
    let vertices: Vec<Vertex> = vertices.collect();
    let triangles = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { vertices, triangles, ..Mesh::default() }
}

/// A parallelogram in so many times so many pieces; its front is where a, b and c run counter-clockwise.
fn sheet(a: DVec3, b: DVec3, c: DVec3, pieces: usize) -> Vec<[DVec3; 3]> {
    let at = |x: usize, y: usize| a + (b - a) * (x as f64 / pieces as f64) + (c - a) * (y as f64 / pieces as f64);
    let pair = |i: usize| {
        let (x, y) = (i % pieces, i / pieces);
        [[at(x, y), at(x + 1, y), at(x, y + 1)], [at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]]
    };
    (0..pieces * pieces).flat_map(pair).collect()
}

/// Walls, floor and ceiling, seen from within.
fn room() -> Mesh {
    let p = DVec3::new;
    let walls = [
        [p(-2.0, 0.0, -3.0), p(2.0, 0.0, -3.0), p(-2.0, 2.5, -3.0)],
        [p(2.0, 0.0, 3.0), p(-2.0, 0.0, 3.0), p(2.0, 2.5, 3.0)],
        [p(-2.0, 0.0, 3.0), p(-2.0, 0.0, -3.0), p(-2.0, 2.5, 3.0)],
        [p(2.0, 0.0, -3.0), p(2.0, 0.0, 3.0), p(2.0, 2.5, -3.0)],
        [p(-2.0, 0.0, 3.0), p(2.0, 0.0, 3.0), p(-2.0, 0.0, -3.0)],
        [p(-2.0, 2.5, -3.0), p(2.0, 2.5, -3.0), p(-2.0, 2.5, 3.0)],
    ];
    mesh(walls.into_iter().flat_map(|[a, b, c]| sheet(a, b, c, 3)).collect())
}

/// What stands right before a camera at (0, 1.2, 0): a table top 5 mm below it that goes on behind it, a board through the near
/// plane, and one that is all nearer than that.
fn things() -> Mesh {
    let p = DVec3::new;
    let table = sheet(p(-0.3, 1.195, 0.4), p(0.5, 1.195, 0.4), p(-0.3, 1.195, -1.5), 2);
    let board = sheet(p(0.002, 1.199, -0.004), p(0.9, 1.35, -0.9), p(0.0, 1.205, -0.003), 1);
    let too_near = sheet(p(-0.01, 1.19, -0.009), p(0.0, 1.19, -0.009), p(-0.01, 1.21, -0.009), 1);
    mesh([table, board, too_near].concat())
}

/// What a ray shows: depth, normal, layer from 1 and triangle from 1.
type Hit = Option<(f64, DVec3, usize, usize)>;

/// The nearest of all triangles along a ray that gains one meter of depth with each of its lengths (Möller and Trumbore).
fn cast(meshes: &[(Mesh, bool)], from: DVec3, along: DVec3) -> Hit {
    let mut nearest: Hit = None;
    for (layer, (mesh, both)) in meshes.iter().enumerate() {
        for (number, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
            let (e, f) = (b.position - a.position, c.position - a.position);
            let across = along.cross(f);
            let area = e.dot(across);
            let to = from - a.position;
            let (v, w) = (to.dot(across) / area, along.dot(to.cross(e)) / area);
            let depth = f.dot(to.cross(e)) / area;
            let hit = v >= 0.0 && w >= 0.0 && v + w <= 1.0 && depth >= NEAR_M && (*both || area > 0.0);
            if hit && nearest.is_none_or(|(other, ..)| depth < other) {
                let normal = (a.normal * (1.0 - v - w) + b.normal * v + c.normal * w).normalize();
                nearest = Some((depth, if area > 0.0 { normal } else { -normal }, layer + 1, number + 1));
            }
        }
    }
    nearest
}

#[test]
fn a_camera_inside_a_room_sees_what_rays_meet_also_where_the_near_plane_cuts() {
    let meshes = [(room(), false), (things(), true)];
    let known =
        ["room", "things"].into_iter().zip(&meshes).map(|(name, (mesh, _))| (name.to_owned(), Arc::new(mesh.clone())));
    let materials = Materials { meshes: known.collect::<BTreeMap<_, _>>(), ..Materials::default() };
    let (mut hidden, mut cut, mut differ) = (0, 0, 0);
    for target in [[0.0, 1.2, -1.0], [1.0, 1.1, -0.6], [-0.8, 0.6, -1.0], [0.3, 1.9, 1.0]] {
        let scene = json!({
            "plica": 1, "size": [SIZE.0, SIZE.1],
            "camera": { "position": [0, 1.2, 0], "target": target, "fov": 60 },
            "meshes": { "room": { "path": "room.obj" }, "things": { "path": "things.obj" } },
            "layers": [
                { "kind": "mesh", "name": "room", "mesh": "room" },
                { "kind": "mesh", "name": "things", "mesh": "things", "sides": "both" },
            ],
        });
        let document = Document::parse(&scene.to_string()).unwrap();
        let synth = super::synth(document.scene(), &materials, None).unwrap();
        let pass = |name| Asked::parse(name, document.scene()).unwrap().picture(&synth, 0.0);
        let [depth, normal, object, uv] = ["depth", "normal", "object", "uv"].map(pass);
        let from = DVec3::new(0.0, 1.2, 0.0);
        let ahead = (DVec3::from(target) - from).normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        let up = right.cross(ahead);
        // The tangent of half of 60 degrees is that of 1 to the root of 3.
        let focal = SIZE.1 as f64 / 2.0 * 3.0_f64.sqrt();
        for i in 0..SIZE.0 * SIZE.1 {
            let (x, y) = ((i % SIZE.0) as f64 + 0.5, (i / SIZE.0) as f64 + 0.5);
            let along = ahead + right * ((x - SIZE.0 as f64 / 2.0) / focal) + up * ((SIZE.1 as f64 / 2.0 - y) / focal);
            let (far, turned, layer, triangle) = cast(&meshes, from, along).expect("a room is closed");
            cut += usize::from(layer == 2);
            hidden += usize::from(far < 0.02);
            let found = [f64::from(object.cells()[i][0]), f64::from(uv.cells()[i][2])];
            if found != [layer as f64, triangle as f64] {
                differ += 1;
                continue;
            }
            let [nx, ny, nz, _] = normal.cells()[i].map(f64::from);
            let at = format!("{target:?} at {x}, {y}, layer {layer}");
            assert!((f64::from(depth.cells()[i][0]) - far).abs() < 1e-4 * far, "{at}: {:?} {far}", depth.cells()[i]);
            assert!((DVec3::new(nx, ny, nz) - turned).length() < 0.01, "{at}: {:?} {turned}", normal.cells()[i]);
        }
    }
    let all = 4 * SIZE.0 * SIZE.1;
    assert!(differ * 500 <= all, "{differ} of {all} pixels show something else");
    assert!(cut > all / 10 && hidden > 20, "{cut} pixels of things, {hidden} right behind the near plane");
}
