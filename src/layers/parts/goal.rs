//! Where an item of a layer goes: the end of the line that begins at it, say.

use glam::DVec3;

use super::derived::Derived;

/// Where an item goes.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The place; `None` if it comes to none.
    pub at: Option<DVec3>,
    /// The height of the level plane in which such places lie, in meters.
    pub level: f64,
    /// The columns that tell of it.
    pub told: &'static [Derived],
}
