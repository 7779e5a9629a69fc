//! A layer that is ready for rendering at any time: what every technique makes from its part of the document.

use std::any::Any;
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use super::parts::marks::{Mark, View};
use super::parts::materials::Materials;
use super::parts::moment::{Columns, Moment};
use super::parts::passes::Plan;
use super::parts::readout::VectorField;
use crate::base::pixels::Rgba;
use crate::base::problem::Problem;
use crate::base::reduce::Reduced;

/// A layer ready for rendering at any time: pure, shared, no handles.
pub trait Ready: Any + Debug + Send + Sync {
    /// The layer at one time, on the CPU: the reference. Called once per frame.
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a>;

    /// The layer at one time, for the GPU: looks the same as [`Ready::at`].
    fn plan(&self, moment: &Moment) -> Plan;

    /// The same layer with nothing that moves.
    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready>;

    /// The layer of a frame that is [`Reduced::by`] times smaller on each side.
    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready>;

    /// The vectors that its pixels have, from below to above.
    fn fields(&self) -> Vec<VectorField<'_>> {
        Vec::new()
    }

    /// The largest side of any picture that a frame reads, in pixels.
    fn largest_texture(&self) -> usize;

    /// What the view shows of the vectors of pixels, in any order; paths are relative to the layer.
    fn marks(&self, _view: &View) -> Vec<Mark> {
        Vec::new()
    }

    /// Gives a fully transparent pixel (column, row) of a finished frame the color that the layer has there, if it has
    /// one, since straight alpha can keep it.
    fn keep_clear_color(&self, _pixel: (usize, usize), _code: &mut [u8; 4]) {}
}

impl dyn Ready {
    /// The layer as its technique's own type, for that technique.
    pub fn downcast<T: Ready>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// One layer at one time.
pub trait Still: Sync {
    /// Writes row `y` of the frame to `out`, one cell per column, all transparent before: linear light, premultiplied
    /// by alpha. Rows are computed on all cores; a cell does not depend on which columns are wanted.
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]);
}

/// A layer whose parts can be prepared without the rest, for a single pixel or a band of a large picture.
pub trait Prepared: Send + Sync {
    /// The layer, ready for rendering these columns and rows of the frame; no others may be asked for.
    ///
    /// # Errors
    /// If there is not enough memory or it is cancelled; the problem's path is relative to the layer.
    fn part(&self, columns: Range<usize>, rows: Range<usize>, materials: &Materials)
    -> Result<Arc<dyn Ready>, Problem>;
}

/// A layer whose parts cost what the whole does: each is the whole.
pub struct Whole(pub Arc<dyn Ready>);

impl Prepared for Whole {
    fn part(&self, _: Range<usize>, _: Range<usize>, _: &Materials) -> Result<Arc<dyn Ready>, Problem> {
        Ok(self.0.clone())
    }
}
