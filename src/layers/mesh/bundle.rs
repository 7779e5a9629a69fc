//! Meshes as files for other engines: what their surfaces have for them.

use std::any::Any;

use serde_json::{Map, Value, json};

use super::model::MeshLayer;
use super::synth::Synth;
use crate::base::error::Error;
use crate::layers::parts::bundle::{Form, Names, Sink};
use crate::layers::technique::{Bundled, Technique};

/// The names that the files of these layers may have.
pub fn names(layers: &[&dyn Technique]) -> Names {
    let own = layers.iter().filter_map(|layer| (*layer as &dyn Any).downcast_ref::<MeshLayer>());
    let own: Vec<(&str, Vec<(Form, String)>)> = own
        .map(|layer| (layer.name.as_str(), layer.surface.slot().files()))
        .filter(|(_, ends)| !ends.is_empty())
        .collect();
    Names {
        items: own.iter().map(|(name, _)| (None, (*name).to_owned())).collect(),
        bakes: !own.is_empty(),
        ends: own.into_iter().flat_map(|(_, ends)| ends).collect(),
        ..Names::default()
    }
}

/// Writes the files of these layers, and gives what the manifest says about them.
///
/// # Errors
/// Those of `to`, or what is wrong with a surface.
pub fn write(layers: &[Bundled], to: &mut dyn Sink) -> Result<Map<String, Value>, Error> {
    let mut noted = Vec::new();
    for Bundled { layer, ready } in layers {
        let Some(ready) = ready.downcast::<Synth>() else { continue };
        let surface = ready.surface.bundle(layer.name(), to)?;
        noted.extend(surface.map(|surface| json!({ "name": layer.name(), "surface": surface })));
    }
    let meshes = (!noted.is_empty()).then(|| ("meshes".to_owned(), Value::Array(noted)));
    Ok(meshes.into_iter().collect())
}
