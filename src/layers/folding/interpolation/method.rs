//! The interface of a method of interpolation, and a cell of what it makes.

use super::area::{Area, Stretch};
use super::chebyshev::Nodes;

/// A pixel closer to an anchor than this, in pixels, takes that anchor's vector.
pub const AT_ANCHOR_PX: f64 = 1e-6;

/// Whether anything in a part of an area is wanted.
pub type Wanted<'a> = &'a (dyn Fn(&Area) -> bool + Sync);

/// A method, prepared for the anchors of a zone.
pub trait Method: Send + Sync {
    /// The cells that `area` touches, from left to right and down, without those that are not `wanted`; `None` once `stopped`.
    fn cells(&self, area: &Area, wanted: Wanted, stopped: &(dyn Fn() -> bool + Sync)) -> Option<Vec<Cell>>;

    /// Tells the jump vectors of the pixels that are in `area` and in `cell`, which [`Method::cells`] made, without parts
    /// that are not `wanted`.
    fn fill(&self, cell: &Cell, area: &Area, wanted: &dyn Fn(&Area) -> bool, tell: &mut dyn FnMut(Stretch));
}

/// A cell, and what the anchors add there.
#[derive(Clone, Debug)]
pub struct Cell {
    pub(super) area: Area,
    /// Sums over the far anchors, at the nodes.
    pub(super) nodes: Vec<Nodes>,
    /// Indices of the near anchors, ascending.
    pub(super) near: Vec<u32>,
    /// Bounds the error of the sums (`Kernel::doubt`).
    pub(super) doubt: f64,
}

impl Cell {
    /// The pixels in it.
    pub fn area(&self) -> &Area {
        &self.area
    }

    /// How many bytes it takes.
    pub fn bytes(&self) -> u64 {
        (size_of::<Self>() + size_of_val(&self.nodes[..]) + size_of_val(&self.near[..])) as u64
    }

    /// The side of its square.
    pub(super) fn size(&self) -> u32 {
        self.area.to[0] - self.area.from[0]
    }
}
