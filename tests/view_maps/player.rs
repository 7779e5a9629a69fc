//! A player of the textures of view maps, written from "View maps" in docs/textures.md and nothing else: it finds a pixel of a
//! frame from the files alone.

use std::path::Path;

use glam::{DMat2, DQuat, DVec2, DVec3};
use plica::base::maths::{ln, pow};
use plica::base::pixels::encode;
use serde_json::Value;

/// A texture: columns, and its texels.
struct Texture(usize, Vec<[f64; 4]>);

impl Texture {
    fn read(folder: &Path, note: &Value) -> Texture {
        let image = image::open(folder.join(note["file"].as_str().unwrap())).unwrap();
        let is_float = note["file"].as_str().unwrap().ends_with(".exr");
        let texel = |texel: [f32; 4]| texel.map(f64::from);
        let texels = match is_float {
            true => image.to_rgba32f().pixels().map(|p| texel(p.0)).collect(),
            false => image.to_rgba8().pixels().map(|p| p.0.map(f64::from)).collect(),
        };
        Texture(image.width() as usize, texels)
    }

    fn at(&self, x: usize, y: usize) -> [f64; 4] {
        self.1[y * self.0 + x]
    }
}

struct Layer {
    size: DVec2,
    base: Texture,
    directions: Texture,
    turns: Texture,
}

/// A map and its mesh.
pub struct Player {
    /// The corners of triangles: places, and texture coordinates.
    triangles: Vec<[(DVec3, DVec2); 3]>,
    layers: Vec<Layer>,
    manifest: Value,
}

/// A camera: where it is, its right, down and forward by the pixel, and the middle of the frame.
pub struct Camera {
    pub place: DVec3,
    pub ways: [DVec3; 3],
    pub middle: DVec2,
}

fn vector(value: &Value) -> DVec3 {
    serde_json::from_value::<[f64; 3]>(value.clone()).unwrap().into()
}

fn light(code: f64) -> f64 {
    let c = code / 255.0;
    if c <= 0.04045 { c / 12.92 } else { pow((c + 0.055) / 1.055, 2.4) }
}

impl Player {
    /// Reads a folder that has one map.
    pub fn read(folder: &Path) -> Player {
        let manifest: Value = serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).unwrap()).unwrap();
        assert_eq!(manifest["plica_textures"], 1);
        let map = manifest["meshes"][0]["surface"].clone();
        let layer = |note: &Value| Layer {
            size: DVec2::new(note["width"].as_f64().unwrap(), note["height"].as_f64().unwrap()),
            base: Texture::read(folder, &note["base"]),
            directions: Texture::read(folder, &note["directions"]),
            turns: Texture::read(folder, &note["turns"]),
        };
        let layers = map["layers"].as_array().unwrap().iter().map(layer).collect();
        let text = std::fs::read_to_string(folder.join(map["mesh"]["file"].as_str().unwrap())).unwrap();
        Player { triangles: triangles(&text), layers, manifest: map }
    }

    /// What a pixel shows: the code of each channel; `None` where the mesh is not seen.
    pub fn pixel(&self, camera: &Camera, x: usize, y: usize) -> Option<[u8; 3]> {
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let hits = self.triangles.iter().filter_map(|triangle| {
            let (far, weights) = hit(triangle, camera, at)?;
            weights.iter().all(|weight| *weight >= 0.0).then_some((far, triangle, weights))
        });
        let (far, triangle, weights) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let point = camera.place + ray(camera, at) * far;
        let uv = |weights: [f64; 3]| -> DVec2 { triangle.iter().zip(weights).map(|((_, uv), w)| *uv * w).sum() };
        let place = |weights: [f64; 3], layer: &Layer| {
            let uv = uv(weights);
            DVec2::new(uv.x, 1.0 - uv.y) * layer.size
        };
        const STEP: f64 = 1e-4;
        let beside = |way: DVec2| {
            let weights = |at: DVec2| hit(triangle, camera, at).unwrap().1;
            let places = [at + way * STEP, at - way * STEP].map(|at| place(weights(at), &self.layers[0]));
            (places[0] - places[1]) / (2.0 * STEP)
        };
        let covered = DMat2::from_cols(beside(DVec2::X), beside(DVec2::Y)).determinant().abs();
        let depth = (-ln(covered) / ln(4.0)).clamp(0.0, (self.layers.len() - 1) as f64);
        let (mut independent, mut over, mut all) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for (layer, share) in [(depth.floor(), 1.0 - depth.fract()), (depth.floor() + 1.0, depth.fract())] {
            let Some(layer) = self.layers.get(layer as usize).filter(|_| share > 0.0) else { continue };
            let found = layer.cells(place(weights, layer));
            let sum: f64 = found.iter().map(|(.., weight)| weight).sum();
            if sum == 0.0 {
                continue;
            }
            all += share;
            for (x, y, weight) in found {
                let [r, g, b, _] = layer.base.at(x, y).map(light);
                let base = DVec3::new(r, g, b);
                let [p @ .., a] = self.direction(layer, (x, y), (camera.place - point).normalize());
                independent += base * (share * weight / sum);
                over += (DVec3::from(p) + base * (1.0 - a)) * (share * weight / sum);
            }
        }
        let base = self.base(camera);
        let shown = (independent * base + over * (1.0 - base)) / all;
        let [r, g, b, _] = encode([shown.x as f32, shown.y as f32, shown.z as f32, 1.0]);
        Some([r, g, b])
    }

    /// What a cell has in a direction.
    fn direction(&self, layer: &Layer, (x, y): (usize, usize), way: DVec3) -> [f64; 4] {
        let n = self.manifest["directions"].as_u64().unwrap() as usize;
        let turn = DQuat::from_array(layer.turns.at(x, y));
        let [along, across, normal] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn * axis);
        let flat = DVec2::new(way.dot(along), way.dot(across));
        let disc = if way.dot(normal) < 0.0 { flat.normalize() } else { flat / (1.0 + way.dot(normal)) };
        let at = ((disc + 1.0) * (n as f64 / 2.0) - 0.5).clamp(DVec2::ZERO, DVec2::splat((n - 1) as f64));
        let mut sum = [0.0; 4];
        for (right, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (i, j) = (at.x as usize + right, at.y as usize + down);
            let weight = (1.0 - (at.x - i as f64).abs()) * (1.0 - (at.y - j as f64).abs());
            if weight > 0.0 {
                let texel = layer.directions.at(x * n + i, y * n + j);
                sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        sum
    }

    /// How much of the base coat alone the camera sees.
    fn base(&self, camera: &Camera) -> f64 {
        let blend = &self.manifest["blend"];
        let (cosine, distance) = (blend["cosine"].as_f64().unwrap(), blend["distance"].as_f64().unwrap());
        let strengths = blend["points"].as_array().unwrap().iter().map(|point| {
            let turned =
                ((camera.ways[2].normalize().dot(vector(&point["direction"])) - cosine) / (1.0 - cosine)).max(0.0);
            let near = (1.0 - camera.place.distance(vector(&point["position"])) / distance).max(0.0);
            (turned * near, point["base"].as_f64().unwrap())
        });
        let (sum, bases) = strengths.fold((0.0, 0.0), |(sum, bases), (s, base)| (sum + s, bases + s * base));
        if sum > 0.0 { bases / sum * (4.0 * sum).min(1.0) } else { 0.0 }
    }
}

impl Layer {
    /// The texels that count at a place, and how much.
    fn cells(&self, at: DVec2) -> Vec<(usize, usize, f64)> {
        let at = at - 0.5;
        let (x, y) = (at.x.floor(), at.y.floor());
        let four = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(right, down)| {
            let weight = (1.0 - (at.x - x - right).abs()) * (1.0 - (at.y - y - down).abs());
            ((x + right) as usize, (y + down) as usize, weight)
        });
        four.into_iter().filter(|(x, y, _)| self.base.at(*x, *y)[3] > 0.0).collect()
    }
}

fn ray(camera: &Camera, at: DVec2) -> DVec3 {
    let at = at - camera.middle;
    camera.ways[0] * at.x + camera.ways[1] * at.y + camera.ways[2]
}

/// How far the plane of a triangle is along the ray of a place in the frame, and what its corners count there.
fn hit(triangle: &[(DVec3, DVec2); 3], camera: &Camera, at: DVec2) -> Option<(f64, [f64; 3])> {
    let [a, b, c] = triangle.map(|(place, _)| place);
    let (way, normal) = (ray(camera, at), (b - a).cross(c - a));
    if way.dot(normal) >= 0.0 {
        return None;
    }
    let far = (a - camera.place).dot(normal) / way.dot(normal);
    let point = camera.place + way * far;
    let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / normal.length_squared();
    Some((far, [weight(b, c), weight(c, a), weight(a, b)]))
}

/// The triangles of an OBJ.
fn triangles(text: &str) -> Vec<[(DVec3, DVec2); 3]> {
    let numbers = |line: &str| line.split(' ').skip(1).map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    let of = |key: &'static str| text.lines().filter(move |line| line.split(' ').next() == Some(key));
    let places: Vec<DVec3> = of("v").map(|line| DVec3::from_slice(&numbers(line))).collect();
    let uvs: Vec<DVec2> = of("vt").map(|line| DVec2::from_slice(&numbers(line))).collect();
    let corner = |corner: &str| {
        let indices: Vec<usize> = corner.split('/').map(|index| index.parse().unwrap()).collect();
        (places[indices[0] - 1], uvs[indices[1] - 1])
    };
    of("f").map(|line| line.split(' ').skip(1).map(corner).collect::<Vec<_>>().try_into().unwrap()).collect()
}
