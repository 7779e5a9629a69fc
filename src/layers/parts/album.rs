//! The pictures that sprites show, for other programs and for editing by hand.

use serde_json::Value;

use crate::base::pixels::Linear;

/// All pictures of a layer's sprites.
#[derive(Clone, Debug)]
pub struct Album {
    /// Pictures, each with the name of its file without an ending.
    pub pictures: Vec<(String, Linear)>,
    /// What they are, in JSON; a picture is named under "file".
    pub listing: Value,
    /// What to set in the layer so that the automatic choice can be changed by hand: JSON pointers relative to it, and
    /// values; nothing if there is no such choice.
    pub taken: Vec<(String, Value)>,
}
