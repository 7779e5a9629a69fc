//! glTF 2.0, `.glb` and `.gltf`: the triangles of the default scene, moved as its nodes say. Everything is checked here
//! as it is used, so that no file, however wrong, leads further than to a message.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::base::budget::Share;
use crate::base::error::{Error, Result};
use crate::base::mesh::builder::{Builder, Corner, Counts};
use crate::base::mesh::normals::unit;
use crate::base::text::{counted, there_are};
use crate::files::limits::within;

mod accessor;
mod document;
mod looks;
mod nodes;
mod pictures;
mod source;

pub(super) use looks::looks;
pub(super) use pictures::{embedded, named, parts};
pub(super) use source::With;

use document::{Material, Primitive, TextureInfo};
use nodes::Placed;
use source::Source;

/// The lists and the triangles of a file, what in it is not supported, and the file of its picture, relative to its own.
pub(super) fn read(bytes: &[u8], with: With) -> Result<(Builder, Vec<String>, Option<String>)> {
    let With { place, limits, budget, .. } = with;
    let source = Source::of(bytes, with)?;
    let nodes = nodes::nodes(&source)?;
    let meshes: BTreeSet<usize> = nodes.iter().filter_map(|placed| placed.node.mesh).collect();
    let shapes = meshes.into_iter().map(|mesh| Ok((mesh, Shape::of(&source, mesh)?)));
    let shapes = shapes.collect::<Result<BTreeMap<usize, Shape>>>()?;
    // Many nodes may show a mesh of many parts: they are counted before anything is made for each.
    let shown = || nodes.iter().filter_map(|placed| Some((shapes.get(&placed.node.mesh?)?, placed)));
    let counts = shown().fold(Counts::default(), |sum, (shape, _)| sum.and(shape.counts));
    within(place, "has", "triangles", "triangles", counts.triangles, limits.triangles)?;
    if counts.triangles == 0 {
        return Err(match shapes.values().any(|shape| shape.others) {
            true => Error::at(place, "has only points and lines, which are not drawn").cure("export it with its faces"),
            false => Error::at(place, "has no triangles").cure("name a mesh with faces"),
        });
    }
    let flattened = nodes::flattened(&source, &nodes)?;
    let mut builder = Builder::new(counts, place, budget)?;
    for (shape, placed) in shown() {
        shape.pieces.iter().try_for_each(|piece| piece.put(&source, &placed.transform, &mut builder))?;
    }
    let skinned = nodes.iter().any(|Placed { node, .. }| node.mesh.is_some() && node.skin.is_some());
    let mut pieces = shapes.values().flat_map(|shape| &shape.pieces);
    let colored = pieces.any(|piece| piece.primitive.attributes.color_0.is_some());
    let notes = [
        (shapes.values().any(|shape| shape.others), "its points and lines are not drawn"),
        (
            shapes.values().any(|shape| shape.moved),
            "a texture of it is moved, or laid by other coordinates than the first, which is not applied",
        ),
        (
            skinned || shapes.values().any(|shape| shape.posed),
            "its bones and morph targets are not applied: it is shown as it is stored",
        ),
        (colored, "the colors of its vertices are not shown"),
    ];
    let notes = notes.into_iter().filter(|(told, _)| *told).map(|(_, note)| note.to_owned());
    let cut = shown().find_map(|(shape, placed)| Some(format!("{}: {}", placed.called(), shape.cut.as_ref()?)));
    let (doubled, stretched) = (nodes.iter().find_map(Placed::doubled), nodes.iter().find_map(Placed::stretched));
    let of_nodes = [flattened, doubled, stretched, cut].into_iter().flatten();
    let notes = of_nodes.chain(notes).collect();
    Ok((builder, notes, pictures::first_file(&source)))
}

/// How corners make triangles.
#[derive(Clone, Copy, Debug)]
enum Mode {
    List,
    Strip,
    Fan,
}

impl Mode {
    /// The corners of a triangle, as places among all corners.
    fn triangle(self, at: usize) -> [usize; 3] {
        match self {
            Mode::List => [3 * at, 3 * at + 1, 3 * at + 2],
            // Every other one would face away.
            Mode::Strip => [at, at + 1 + at % 2, at + 2 - at % 2],
            Mode::Fan => [at + 1, at + 2, 0],
        }
    }

    fn triangles(self, corners: u64) -> u64 {
        match self {
            Mode::List => corners / 3,
            Mode::Strip | Mode::Fan => corners.saturating_sub(2),
        }
    }
}

/// A mesh, wherever nodes show it.
#[derive(Default)]
struct Shape<'a> {
    pieces: Vec<Piece<'a>>,
    /// How much the pieces are, together.
    counts: Counts,
    /// What is said of corners that make no whole triangle.
    cut: Option<String>,
    /// Whether it has points or lines.
    others: bool,
    /// Whether a texture is laid otherwise than it is read.
    moved: bool,
    /// Whether it has morph targets.
    posed: bool,
}

/// Triangles of a mesh.
struct Piece<'a> {
    primitive: &'a Primitive,
    /// The accessor of its positions.
    positions: usize,
    mode: Mode,
    count: u64,
    corners: u64,
}

impl<'a> Shape<'a> {
    /// The mesh with this index. What its accessors count is there.
    fn of(source: &'a Source, mesh: usize) -> Result<Shape<'a>> {
        let mut shape = Shape::default();
        for primitive in &source.get(&source.document.meshes, mesh, "mesh")?.primitives {
            shape.posed |= !primitive.targets.is_empty();
            let Some(positions) = primitive.attributes.position else { continue };
            let mode = match primitive.mode {
                None | Some(4) => Mode::List,
                Some(5) => Mode::Strip,
                Some(6) => Mode::Fan,
                Some(0..=3) => {
                    shape.others = true;
                    continue;
                }
                Some(none) => {
                    return Err(source.wrong(format!("mesh {mesh} has a primitive of mode {none}: there are 0 to 6")));
                }
            };
            let material = primitive.material.and_then(|material| source.document.materials.get(material));
            shape.moved |= material.and_then(Material::base_color).is_some_and(TextureInfo::is_moved);
            let piece = Piece::of(source, primitive, positions, mode)?;
            shape.cut = shape.cut.take().or_else(|| piece.cut(mesh));
            // The limit on triangles bounds only what has some, and each node takes the time for all pieces.
            if piece.counts().triangles > 0 {
                shape.counts = shape.counts.and(piece.counts());
                shape.pieces.push(piece);
            }
        }
        Ok(shape)
    }
}

impl<'a> Piece<'a> {
    fn of(source: &Source, primitive: &'a Primitive, positions: usize, mode: Mode) -> Result<Piece<'a>> {
        let count = source.stored::<3>(positions)?.count;
        let same = |accessor: usize, found: u64| match found == count {
            true => Ok(()),
            false => Err(source.wrong(format!(
                "accessor {accessor} has {} for {}",
                counted(found, "element"),
                counted(count, "position")
            ))),
        };
        if let Some(normals) = primitive.attributes.normal {
            same(normals, source.stored::<3>(normals)?.count)?;
        }
        if let Some(uvs) = primitive.attributes.texcoord_0 {
            same(uvs, source.stored::<2>(uvs)?.count)?;
        }
        let indices = primitive.indices.map(|indices| source.stored_indices(indices)).transpose()?;
        let corners = indices.map_or(count, |indices| indices.count);
        Ok(Piece { primitive, positions, mode, count, corners })
    }

    /// What is said if corners are left over once they are triangles.
    fn cut(&self, mesh: usize) -> Option<String> {
        let over = if matches!(self.mode, Mode::List) { self.corners % 3 } else { 0 };
        let corners = counted(self.corners, "corner");
        (over > 0).then(|| format!("mesh {mesh} lists triangles by {corners}: the last {over} make none"))
    }

    fn counts(&self) -> Counts {
        let Piece { primitive, count, .. } = self;
        let listed = |accessor: Option<usize>| accessor.map_or(0, |_| *count);
        let triangles = self.mode.triangles(self.corners);
        Counts {
            positions: *count,
            normals: listed(primitive.attributes.normal),
            uvs: listed(primitive.attributes.texcoord_0),
            // A vertex for each position: two where some of its faces have a normal that is zero elsewhere.
            corners: triangles.saturating_mul(3).min(count.saturating_mul(2)),
            triangles,
        }
    }

    /// Adds the lists and the triangles to a mesh.
    fn put(&self, source: &Source, transform: &DAffine3, builder: &mut Builder) -> Result<()> {
        let from = [builder.positions.len(), builder.normals.len(), builder.uvs.len()].map(|length| length as u32);
        self.put_positions(source, transform, builder)?;
        let has_normals = self.put_normals(source, transform, builder)?;
        let has_uvs = self.put_uvs(source, builder)?;
        let (corners, _share) = self.corners(source)?;
        let corner = |at: usize| {
            let index = corners.get(at).copied().unwrap_or(at as u32);
            Corner {
                position: from[0] + index,
                normal: has_normals.then_some(from[1] + index),
                uv: has_uvs.then_some(from[2] + index),
            }
        };
        let mirrored = transform.matrix3.determinant() < 0.0;
        for at in 0..self.mode.triangles(self.corners) as usize {
            let [a, b, c] = self.mode.triangle(at).map(corner);
            builder.polygon(&if mirrored { [a, c, b] } else { [a, b, c] });
        }
        Ok(())
    }

    /// The indices of positions, corner by corner; empty if the corners are the positions in order.
    fn corners(&self, source: &Source) -> Result<(Vec<u32>, Share)> {
        let Some(indices) = self.primitive.indices else { return Ok(Default::default()) };
        let With { place, budget, .. } = source.with;
        let share = budget.take(self.corners.saturating_mul(size_of::<u32>() as u64), place)?;
        let mut corners = vec![0; self.corners as usize];
        source.numbers(indices, |at, [index]| corners[at] = index as u32)?;
        match corners.iter().find(|&&index| u64::from(index) >= self.count) {
            Some(index) => {
                let what = format!("accessor {indices}: there is no vertex {index}: {}", there_are(self.count));
                Err(source.wrong(what))
            }
            None => Ok((corners, share)),
        }
    }

    fn put_positions(&self, source: &Source, transform: &DAffine3, builder: &mut Builder) -> Result<()> {
        let from = builder.positions.len();
        builder.positions.resize(from + self.count as usize, DVec3::ZERO);
        let positions = &mut builder.positions[from..];
        source.numbers(self.positions, |at, position| positions[at] = DVec3::from_array(position))?;
        for position in positions.iter_mut() {
            *position = transform.transform_point3(*position);
        }
        match positions.iter().all(|position| position.is_finite()) {
            true => Ok(()),
            false => Err(source.wrong(format!("accessor {}: its node moves it out of all bounds", self.positions))),
        }
    }

    /// Whether there are any. Normals turn by the inverse transpose, which the cofactors are but for a factor.
    fn put_normals(&self, source: &Source, transform: &DAffine3, builder: &mut Builder) -> Result<bool> {
        let Some(accessor) = self.primitive.attributes.normal else { return Ok(false) };
        let from = builder.normals.len();
        builder.normals.resize(from + self.count as usize, DVec3::ZERO);
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = transform.matrix3;
        let sign = if transform.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        let turn = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign;
        let normals = &mut builder.normals[from..];
        source.numbers(accessor, |at, normal| normals[at] = unit(turn * unit(DVec3::from_array(normal))))?;
        Ok(true)
    }

    /// Whether there are any; v goes up, in the file it goes down.
    fn put_uvs(&self, source: &Source, builder: &mut Builder) -> Result<bool> {
        let Some(accessor) = self.primitive.attributes.texcoord_0 else { return Ok(false) };
        let from = builder.uvs.len();
        builder.uvs.resize(from + self.count as usize, DVec2::new(0.0, 1.0));
        let uvs = &mut builder.uvs[from..];
        source.numbers(accessor, |at, [u, v]| uvs[at] = DVec2::new(u, 1.0 - v))?;
        Ok(true)
    }
}
