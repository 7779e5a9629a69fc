//! How what is drawn on a mesh layer moves with it, in numbers.

use super::drawing::{Given, Looking};
use super::frame::MeshAt;
use super::model::MeshLayer;
use super::synth::Synth;
use crate::base::problem::Problem;
use crate::layers::parts::measures::Measures;
use crate::layers::parts::moment::Moment;
use crate::layers::ready::{Making, Ready as _};
use crate::layers::space::eye::Eye;
use crate::layers::space::fit;

/// The measures of the strokes as the layer is at one time; `None` without strokes, without a camera, or once `step`, which is
/// told how many frames are drawn of how many, says that it is cancelled.
///
/// # Errors
/// If something that the layer names is not there, or there is nothing to measure; the path is relative to the layer.
pub fn measure(
    layer: &MeshLayer,
    making: &Making,
    moment: &Moment,
    steps: u32,
    step: &mut dyn FnMut(u64, u64) -> bool,
) -> Result<Option<Measures>, Problem> {
    let synth = Synth::new(layer, making, None)?;
    let Some((strokes, eye)) = synth.strokes.as_deref().zip(moment.eye) else { return Ok(None) };
    let middle = fit::middle(&|ways| synth.reach(moment.t, ways));
    let mut see = |eye: Eye, make: &mut dyn FnMut(&Given)| {
        let moment = Moment { eye: Some(eye), ..*moment };
        MeshAt::new(&synth, &moment).given_alone().iter().for_each(make);
    };
    let looking = Looking { eye, middle, steps, see: &mut see, step };
    strokes.measure(looking).map_err(|problem| problem.under("/strokes"))
}
