//! The nodes of a scene, and where they are.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, DVec4};

use super::document::Node;
use super::source::Source;
use crate::base::error::{Error, Result};
use crate::base::problem::quoted;

/// A matrix of this precision moves points in space: single precision is rounded to less.
const ROUNDED: f64 = 1e-6;

/// The nodes of the default scene, each before its children, and where they are.
pub(super) fn nodes<'a>(source: &'a Source) -> Result<Vec<(&'a Node, DAffine3)>> {
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
        found.push((node, transform));
        queue(&node.children, transform, &mut ahead);
    }
    Ok(found)
}

/// What is said of nodes that leave nothing of the meshes that they show.
///
/// # Errors
/// They are all of them.
pub(super) fn flattened(source: &Source, nodes: &[(&Node, DAffine3)]) -> Result<Option<String>> {
    let mut shown = nodes.iter().filter(|(node, _)| node.mesh.is_some()).peekable();
    // All areas are zero where all cofactors are.
    let is_gone = |(_, DAffine3 { matrix3: DMat3 { x_axis: x, y_axis: y, z_axis: z }, .. }): &&(&Node, DAffine3)| {
        [x.cross(*y), y.cross(*z), z.cross(*x)].iter().all(|area| *area == DVec3::ZERO)
    };
    let all = shown.clone().all(|one| is_gone(&one));
    let Some((node, _)) = shown.find(is_gone) else { return Ok(None) };
    let index = source.document.nodes.iter().position(|other| std::ptr::eq(other, *node)).unwrap_or_default();
    let what = format!("{} is scaled to nothing, itself or by one that it is in", called(index, node));
    match all {
        true => Err(Error::at(source.with.place, what).cure("mend its scale, and export it again")),
        false => Ok(Some(what)),
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
