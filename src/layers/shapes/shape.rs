//! Paths of the scene that outlines and curves share, by name (docs/folding.md, section 7).

use std::ops::Deref;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Value, json};

use super::node::Node;

/// A path that outlines and curves may be made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// The nodes from one end to the other, at least two.
    #[schemars(length(min = 2))]
    pub nodes: Vec<Node>,
}

/// A shape of these nodes, all as they are written.
pub fn written(nodes: Vec<Value>) -> Value {
    json!({ "nodes": nodes })
}

/// A part, as it is written.
pub fn part(shape: &str, reverse: bool) -> Value {
    if reverse { json!({ "shape": shape, "reverse": true }) } else { json!({ "shape": shape }) }
}

/// A shape as a part of an outline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Name of the shape, one of the scene's shapes.
    #[schemars(extend("reference" = "shapes"))]
    pub shape: String,
    /// Whether it is followed from its end to its beginning.
    #[serde(default, skip_serializing_if = "is_false")]
    #[schemars(extend("default" = false))]
    pub reverse: bool,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// The nodes of a curve: its own, or those of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    /// The name of the shape, one of the scene's shapes.
    pub shape: Option<String>,
    nodes: Vec<Node>,
}

impl Nodes {
    /// Those of a shape, once it is looked up.
    pub fn look_up(&mut self, find: impl Fn(&str) -> Vec<Node>) {
        if let Some(name) = &self.shape {
            self.nodes = find(name);
        }
    }
}

impl Deref for Nodes {
    type Target = [Node];

    fn deref(&self) -> &[Node] {
        &self.nodes
    }
}

/// Nodes as they are written.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Own(Vec<Node>),
    Shared(String),
}

impl<'de> Deserialize<'de> for Nodes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match Written::deserialize(deserializer)? {
            Written::Own(nodes) => Nodes { shape: None, nodes },
            Written::Shared(name) => Nodes { shape: Some(name), nodes: Vec::new() },
        })
    }
}

impl Serialize for Nodes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.shape {
            Some(name) => name.serialize(serializer),
            None => self.nodes.serialize(serializer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_names_a_shape_is_written_as_it_was() {
        for json in [json!("lid"), json!([{ "at": [0.0, 0.0] }, { "at": [1.0, 0.0], "in": [1.0, 2.0] }])] {
            let nodes: Nodes = serde_json::from_value(json.clone()).unwrap();
            assert_eq!(serde_json::to_value(&nodes).unwrap(), json);
        }
        assert!(serde_json::from_value::<Nodes>(Value::Bool(true)).is_err());
    }
}
