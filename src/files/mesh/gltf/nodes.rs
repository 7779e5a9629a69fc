//! The nodes of a scene, and where they are.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, DVec4};

use super::document::Node;
use super::source::Source;
use crate::base::error::{Error, Result};
use crate::base::problem::quoted;

/// A matrix of this precision moves points in space: single precision is rounded to less.
const ROUNDED: f64 = 1e-6;

/// A rotation whose length is this near to 1 is written in few digits.
const FEW_DIGITS: f64 = 0.01;

/// A node of the default scene.
pub(super) struct Placed<'a> {
    index: usize,
    pub(super) node: &'a Node,
    /// From its own coordinates to those of the scene.
    pub(super) transform: DAffine3,
}

impl Placed<'_> {
    /// It in words.
    pub(super) fn called(&self) -> String {
        called(self.index, self.node)
    }

    /// What of it the file says twice, in words.
    pub(super) fn doubled(&self) -> Option<String> {
        let Node { matrix, translation, rotation, scale, .. } = self.node;
        let is_doubled = matrix.is_some() && (translation.is_some() || rotation.is_some() || scale.is_some());
        is_doubled.then(|| {
            format!("{} has a matrix, beside which its translation, rotation and scale are not applied", self.called())
        })
    }

    /// What of it is not as it is to be, and is applied all the same, in words.
    pub(super) fn stretched(&self) -> Option<String> {
        let length = DQuat::from_array(self.node.rotation.filter(|_| self.node.matrix.is_none())?).length();
        let is_stretched = (length - 1.0).abs() > FEW_DIGITS;
        is_stretched.then(|| {
            format!("{}: its rotation is of length {length:.3}, and is taken as if that were 1", self.called())
        })
    }

    /// Whether nothing that it shows has an area: all areas are zero where all cofactors are.
    fn is_gone(&self) -> bool {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = self.transform.matrix3;
        [x.cross(y), y.cross(z), z.cross(x)].iter().all(|area| *area == DVec3::ZERO)
    }

    fn is_flat(&self) -> bool {
        self.transform.matrix3.determinant() == 0.0
    }
}

/// The nodes of the default scene, each before its children.
pub(super) fn nodes<'a>(source: &'a Source) -> Result<Vec<Placed<'a>>> {
    let all = &source.document.nodes;
    let mut ahead: Vec<(usize, DAffine3)> = Vec::new();
    let queue = |nodes: &[usize], transform, ahead: &mut Vec<_>| {
        ahead.extend(nodes.iter().rev().map(|&node| (node, transform)));
    };
    queue(&roots(source)?, DAffine3::IDENTITY, &mut ahead);
    let mut seen = vec![false; all.len()];
    let mut found = Vec::new();
    while let Some((index, transform)) = ahead.pop() {
        let node = source.get(all, index, "node")?;
        // A tree: neither a circle nor a node in two places, which could multiply without end.
        if std::mem::replace(&mut seen[index], true) {
            return Err(source.wrong(format!("node {index} is in the scene twice")));
        }
        let transform = transform * own_transform(source, index, node)?;
        found.push(Placed { index, node, transform });
        queue(&node.children, transform, &mut ahead);
    }
    Ok(found)
}

/// What is said of nodes that leave nothing of the meshes that they show, or no thickness.
///
/// # Errors
/// They leave nothing of any.
pub(super) fn flattened(source: &Source, nodes: &[Placed]) -> Result<Option<String>> {
    let shown = || nodes.iter().filter(|placed| placed.node.mesh.is_some());
    let told = |placed: &Placed, how: &str| format!("{} is {how}, itself or by one that it is in", placed.called());
    match shown().find(|placed| placed.is_gone()) {
        Some(gone) if shown().all(Placed::is_gone) => {
            let what = told(gone, "scaled to nothing");
            Err(Error::at(source.with.place, what).cure("mend its scale, and export it again"))
        }
        Some(gone) => Ok(Some(told(gone, "scaled to nothing"))),
        None => Ok(shown().find(|placed| placed.is_flat()).map(|flat| told(flat, "made flat"))),
    }
}

/// The nodes that the default scene begins with: of a file without scenes those that are nobody's children.
fn roots(source: &Source) -> Result<Vec<usize>> {
    let document = &source.document;
    if document.scenes.is_empty() && document.scene.is_none() {
        let mut child = vec![false; document.nodes.len()];
        for &node in document.nodes.iter().flat_map(|node| &node.children) {
            source.get(&document.nodes, node, "node")?;
            child[node] = true;
        }
        return Ok((0..child.len()).filter(|&node| !child[node]).collect());
    }
    Ok(source.get(&document.scenes, document.scene.unwrap_or(0), "scene")?.nodes.clone())
}

/// A node in words: its number, and its name where it has one.
fn called(index: usize, node: &Node) -> String {
    let name = node.name.as_ref().map(|name| format!(" {}", quoted(name)));
    format!("node {index}{}", name.unwrap_or_default())
}

fn own_transform(source: &Source, index: usize, node: &Node) -> Result<DAffine3> {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(matrix);
        let last = matrix.row(3);
        if !last.abs_diff_eq(DVec4::W, ROUNDED) {
            let what =
                format!("{}: the last row of its matrix is {last}, and is to be [0, 0, 0, 1]", called(index, node));
            return Err(source
                .wrong(what)
                .cure("write translation, rotation and scale in its place, or export it again"));
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    if rotation.length_squared() == 0.0 {
        let what = format!("{}: the rotation [0, 0, 0, 0] is none", called(index, node));
        return Err(source.wrong(what).cure("write [0, 0, 0, 1], which turns nothing, or export it again"));
    }
    Ok(DAffine3::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, DVec3::from_array),
        rotation.normalize(),
        node.translation.map_or(DVec3::ZERO, DVec3::from_array),
    ))
}
