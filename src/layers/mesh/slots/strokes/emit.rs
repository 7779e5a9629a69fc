//! The impulses of a noise, made by the GPU: what `emit.wgsl` reads, and the steps that run it. Pieces, curvatures and images
//! are uploaded once; in a frame only numbers are.

use std::sync::Arc;

use bytemuck::bytes_of;
use glam::{DVec2, DVec3};

use super::aim::half_way;
use super::curvature::Curvature;
use super::grid;
use super::model::{Along, Anchor, By, Noise as Wanted};
use super::noise::Scene;
use super::pieces::{Piece, Pieces};
use super::synth::{Codes, SMOOTH};
use crate::layers::parts::plan::{Bind, Compute, Format, Groups, Packed, Routine, Rows, Scratch, Upload};
use crate::layers::parts::twin::{Twin, twin};
use crate::layers::space::upload::{VERTICES, lines, matrix, packed};

/// Threads of a group, which are the pieces of a block.
const WIDE: usize = 256;

const SOURCE: &[&str] = &[include_str!("../../posed.wgsl"), include_str!("aim.wgsl"), include_str!("emit.wgsl")];

static COUNT: Routine = Routine { name: "mesh/strokes/emit.wgsl", source: SOURCE, entry: "count" };
static SCAN: Routine = Routine { name: "mesh/strokes/emit.wgsl", source: SOURCE, entry: "scan" };
static EMIT: Routine = Routine { name: "mesh/strokes/emit.wgsl", source: SOURCE, entry: "emit" };

/// One of each shader.
pub static ROUTINES: &[&Routine] = &[&COUNT];

/// `Recipe` in aim.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Recipe {
    turn: [f32; 16],
    light: [f32; 3],
    overlap: f32,
    axis: [f32; 3],
    spread: f32,
    size: [f32; 2],
    middle: [f32; 2],
    angle: [f32; 2],
    drawn: [f32; 2],
    unsure: [f32; 2],
    turned: [f32; 2],
    low: f32,
    high: f32,
    half: f32,
    focal: f32,
    radius: f32,
    spacing: f32,
    reach: f32,
    px_per_m: f32,
    key: u32,
    count: u32,
    down: u32,
    padding: u32,
}

/// What shaders read.
pub const TWIN: Twin = twin!(Recipe: turn, light, overlap, axis, spread, size, middle, angle, drawn, unsure, turned, low,
    high, half, focal, radius, spacing, reach, px_per_m, key, count, down);

/// Where a plan has what impulses are made of and what becomes of them: the numbers of its scratch.
pub struct Places {
    /// How many impulses there are before each piece of a block.
    pub pieces: usize,
    /// The same before each block.
    pub blocks: usize,
    /// The impulses.
    pub made: usize,
    /// How many there are.
    pub tally: usize,
}

/// What a plan needs for the impulses of these noises, in the order of [`Places`].
pub fn scratch<'a>(scene: &Scene, noises: impl Iterator<Item = &'a Wanted>) -> [Scratch; 4] {
    let count = noises.map(|wanted| cells(scene, wanted)[0]).max().unwrap_or(0);
    let bytes = |count: usize| Scratch::Bytes((count * size_of::<u32>()) as u64);
    [bytes(count), bytes(count.div_ceil(WIDE) + 1), Scratch::Growing, Scratch::Tally]
}

/// The steps that make the impulses of a noise, of a mesh that is bound by `posed`.
pub fn steps(scene: &Scene, wanted: &Wanted, posed: &dyn Fn() -> Vec<Bind>, places: &Places) -> [Compute; 3] {
    let recipe = Recipe::of(scene, wanted);
    let constants = constants(scene, wanted);
    let compute = |routine, groups| {
        let mut binds = posed();
        binds.extend(read(scene, wanted, posed));
        binds.insert(3, Bind::Bytes(bytes_of(&recipe).to_vec()));
        binds.extend([places.pieces, places.blocks, places.made].map(Bind::Written));
        Compute { routine, constants: constants.clone(), binds, groups }
    };
    let mut scan = compute(&SCAN, Groups::Count(1));
    scan.binds.push(Bind::Written(places.tally));
    let blocks = recipe.count.div_ceil(WIDE as u32);
    [compute(&COUNT, Groups::Count(blocks)), scan, compute(&EMIT, Groups::Found(places.tally))]
}

/// How many pieces or cells a noise has, and how many of these are in a column.
fn cells(scene: &Scene, wanted: &Wanted) -> [usize; 2] {
    match scene.anchor(wanted) {
        Anchor::Screen => {
            let [across, down] = grid::cells(scene.given.size_px, scene.recipe(wanted).radius_px).map(|to| to.count());
            [across * down, down]
        }
        Anchor::Surface | Anchor::Texture => [scene.ready.pieces.count(), 1],
    }
}

/// The values of the overrides in the shaders.
fn constants(scene: &Scene, wanted: &Wanted) -> Vec<(&'static str, f64)> {
    let along = match scene.direction(wanted).along {
        Along::Screen => 0.0,
        Along::Curvature => 1.0,
        Along::Light => 2.0,
        Along::Axis => 3.0,
        Along::Outline => 4.0,
        Along::Image => 5.0,
    };
    let by = scene.vary(wanted).map_or(0.0, |vary| match vary.by {
        By::Curvature => 1.0,
        By::Light => 2.0,
        By::Image => 5.0,
        By::Facing => 6.0,
    });
    let anchor = match scene.anchor(wanted) {
        Anchor::Surface => 0.0,
        Anchor::Screen => 1.0,
        Anchor::Texture => 2.0,
    };
    vec![("along", along), ("by", by), ("anchor", anchor)]
}

/// What is read besides the mesh and the recipe. Something has to stand where nothing is read.
fn read(scene: &Scene, wanted: &Wanted, posed: &dyn Fn() -> Vec<Bind>) -> Vec<Bind> {
    let (ready, direction, vary) = (scene.ready, scene.direction(wanted), scene.vary(wanted));
    let tensors = |smooth: f64, is: bool| {
        let found = is.then(|| ready.curvature(smooth)).flatten();
        found.map(|curvature| curvature as Arc<dyn Upload>)
    };
    let image = |name: Option<&str>| ready.images.get(name?).map(|codes| codes.clone() as Arc<dyn Upload>);
    let by = |by: By| vary.filter(|vary| vary.by == by);
    let all = [
        Some(ready.pieces.clone() as Arc<dyn Upload>),
        tensors(direction.smooth, direction.along == Along::Curvature),
        tensors(SMOOTH, by(By::Curvature).is_some()),
        image(Some(&*direction.image).filter(|_| direction.along == Along::Image)),
        image(by(By::Image).map(|vary| &*vary.image)),
    ];
    let bind = |of: Option<Arc<dyn Upload>>| match of {
        Some(of) => Bind::Upload(of, 0),
        None => posed().swap_remove(1 + VERTICES),
    };
    all.map(bind).into()
}

impl Recipe {
    fn of(scene: &Scene, wanted: &Wanted) -> Recipe {
        let (recipe, eye, direction) = (scene.recipe(wanted), &scene.given.eye, scene.direction(wanted));
        let turn = (direction.turn + wanted.turn).to_radians();
        let drawn = -(direction.angle.to_radians() + turn);
        let vary = scene.vary(wanted).map_or([1.0; 2], |vary| [vary.low, vary.high]);
        let [count, down] = cells(scene, wanted).map(|count| count as u32);
        let circle = |angle: f64| DVec2::from_angle(angle).as_vec2().to_array();
        let (width, height) = scene.given.size_px;
        Recipe {
            turn: matrix(eye.turn, DVec3::ZERO),
            light: scene.light.as_vec3().to_array(),
            overlap: recipe.overlap as f32,
            axis: DVec3::from(direction.axis).normalize_or_zero().as_vec3().to_array(),
            spread: recipe.spread as f32,
            size: [width as f32, height as f32],
            middle: eye.middle_px.as_vec2().to_array(),
            angle: circle(direction.angle.to_radians()),
            drawn: circle(half_way(drawn)),
            unsure: circle(2.0 * drawn),
            turned: circle(turn),
            low: vary[0] as f32,
            high: vary[1] as f32,
            half: scene.ready.curvatures.first().map_or(0.0, |(_, curvature)| curvature.half_m) as f32,
            focal: eye.focal_px as f32,
            radius: recipe.radius_px as f32,
            spacing: recipe.spacing_px as f32,
            reach: wanted.reach as f32,
            px_per_m: scene.px_per_m() as f32,
            key: recipe.key,
            count,
            down,
            padding: 0,
        }
    }
}

impl Upload for Pieces {
    /// One texture: for each piece its triangle and its number there, and its corners as weights of the first two of those of
    /// the triangle.
    fn pack(&self) -> Vec<Packed<'_>> {
        let mut all = Vec::with_capacity(self.count());
        self.of(0..self.triangles(), |piece| all.push(texels(piece)));
        let count = all.len();
        vec![packed(lines(count, move |i| all[i]), 2 * count, Format::Rgba32Uint)]
    }
}

fn texels(piece: &Piece) -> [[u32; 4]; 2] {
    let [a, b, c] = piece.corners.map(|weights| [weights.x, weights.y].map(|v| (v as f32).to_bits()));
    [[piece.triangle, piece.number, a[0], a[1]], [b[0], b[1], c[0], c[1]]]
}

impl Upload for Curvature {
    /// One texture: for each vertex two texels, xx, xy, xz, yy and yz, zz.
    fn pack(&self) -> Vec<Packed<'_>> {
        let texels = lines(self.tensors.len(), |i| {
            let [xx, xy, xz, _, yy, yz, _, _, zz] = self.tensors[i].to_cols_array().map(|v| v as f32);
            [[xx, xy, xz, yy], [yz, zz, 0.0, 0.0]]
        });
        vec![packed(texels, 2 * self.tensors.len(), Format::Rgba32Float)]
    }
}

impl Upload for Codes {
    /// One texture, pixel by pixel.
    fn pack(&self) -> Vec<Packed<'_>> {
        let rows: Rows = Box::new(|rows, take| {
            let cells = &self.cells()[rows.start * self.width()..rows.end * self.width()];
            let texels: Vec<[f32; 4]> = cells.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
            take(bytemuck::cast_slice(&texels));
        });
        vec![Packed { size: (self.width(), self.height()), format: Format::Rgba32Float, rows }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::mesh::{Mesh, Vertex};

    #[test]
    fn pieces_are_packed_with_what_the_shader_takes_for_them() {
        let corner = |[x, y]: [f64; 2]| Vertex { position: DVec3::new(x, y, 0.0), ..Vertex::default() };
        let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.01, 0.0], [0.0, 0.01]].map(corner).to_vec();
        let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 3, 4]], ..Mesh::default() };
        let pieces = Pieces::new(&mesh);
        let mut all = Vec::new();
        pieces.of(0..2, |piece| all.push(*piece));
        assert_eq!((all.len(), pieces.triangles()), (pieces.count(), 2));
        let mut bytes: Vec<u8> = Vec::new();
        (pieces.pack()[0].rows)(0..1, &mut |row| bytes.extend(row));
        let texels: &[[u32; 4]] = bytemuck::cast_slice(&bytes);
        for (piece, texels) in all.iter().zip(texels.chunks(2)) {
            assert_eq!(texels[0][..2], [piece.triangle, piece.number]);
            // As emit.wgsl has it.
            assert_eq!(piece.share, 1.0 / f64::from(1_u32 << piece.number.ilog2()));
            for (k, weights) in piece.corners.iter().enumerate() {
                let at = |i: usize| f64::from(f32::from_bits(texels[(2 + i) / 4][(2 + i) % 4]));
                let (x, y) = (at(2 * k), at(2 * k + 1));
                assert_eq!(DVec3::new(x, y, 1.0 - x - y), *weights, "halves of halves are exact");
            }
        }
    }
}
