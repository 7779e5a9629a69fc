//! A layer once it is ready to be shown at any time: what every technique makes of its part of the document.

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

/// A layer ready to be shown at any time: pure, shared, no handles.
pub trait Ready: Any + Debug + Send + Sync {
    /// The layer at one time, on the CPU: the reference. Asked once a frame.
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a>;

    /// The layer at one time, for the GPU: shows what [`Ready::at`] shows.
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

    /// Gives a fully transparent pixel (column, row) of a finished frame the color that the layer has there, if it has one:
    /// straight alpha keeps it.
    fn keep_clear_color(&self, _pixel: (usize, usize), _code: &mut [u8; 4]) {}
}

impl dyn Ready {
    /// The layer as what its technique made, for that technique.
    pub fn downcast<T: Ready>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// One layer at one time.
pub trait Still: Sync {
    /// Writes row `y` of the frame to `out`, one cell a column, all of them clear before: linear light, premultiplied by
    /// alpha. Rows are asked for on all cores; what one holds does not depend on which columns are wanted.
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]);
}

/// A layer of which parts can be made ready, each without the rest: what one pixel costs, or a band of a large picture.
pub trait Prepared: Send + Sync {
    /// These columns and rows of the frame, ready to be shown; what is beyond them is not asked for.
    ///
    /// # Errors
    /// There is not enough memory, or nobody wants it any more; the problem's path is relative to the layer.
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
