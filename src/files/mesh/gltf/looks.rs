//! What the materials of a model say of its looks, as far as a layer can have it: a layer has one surface for all triangles.

use super::document::{Material, Primitive};
use super::pictures::{base_color, primitives};
use super::source::{Source, With};
use crate::base::error::Result;
use crate::base::problem::quoted;
use crate::files::mesh::looks::Looks;

/// The looks of the first material that has a picture, or else of the first one.
pub(in crate::files::mesh) fn looks(bytes: &[u8], with: With) -> Result<Looks> {
    let source = &Source::of(bytes, with)?;
    let mut used: Vec<Option<usize>> = Vec::new();
    for Primitive { material, .. } in primitives(source)?.into_iter().filter(|primitive| primitive.has_faces()) {
        if !used.contains(material) {
            used.push(*material);
        }
    }
    let materials = || used.iter().filter_map(|own| source.document.materials.get((*own)?));
    let textured = used.iter().position(|own| matches!(base_color(source, *own), Ok(Some(_))));
    let shown = used.get(textured.unwrap_or(0)).copied().flatten();
    let name = |own: &Option<usize>| {
        let Some(index) = *own else { return "that of parts without one".to_owned() };
        let name = source.document.materials.get(index).and_then(|material| material.name.as_deref());
        name.map_or_else(|| index.to_string(), quoted)
    };
    Ok(Looks {
        color: shown.and_then(|shown| source.document.materials.get(shown)).map(Material::color),
        both_sides: materials().any(|material| material.double_sided),
        left_out: used.iter().filter(|own| **own != shown).map(name).collect(),
    })
}
