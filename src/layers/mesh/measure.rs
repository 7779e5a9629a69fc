//! How the strokes of a mesh layer move with it, in numbers.

use std::sync::Arc;

use super::frame::Seen;
use super::model::MeshLayer;
use super::strokes::draw::main_noise;
use super::strokes::measure::{self, Frame};
use super::synth::Synth;
use crate::base::problem::Problem;
use crate::layers::parts::measures::Measures;
use crate::layers::parts::moment::Moment;
use crate::layers::ready::{Making, Ready as _};
use crate::layers::space::fit;

/// The measures of the strokes as the layer is at one time; `None` without strokes, without a camera, or once `step`, which is
/// told how many frames are drawn of how many, says that it is cancelled.
///
/// # Errors
/// If something that the layer names is not there, or no mark is made of a noise; the path is relative to the layer.
pub fn measure(
    layer: &MeshLayer,
    making: &Making,
    moment: &Moment,
    steps: u32,
    step: &mut dyn FnMut(u64, u64) -> bool,
) -> Result<Option<Measures>, Problem> {
    let synth = Synth::new(layer, making, None)?;
    let Some((ready, eye)) = synth.strokes.clone().zip(moment.eye) else { return Ok(None) };
    let Some(of) = main_noise(&ready.strokes).map(str::to_owned) else {
        return Err(Problem::error("/strokes/marks", "no mark is made of a noise: there is nothing to measure"));
    };
    let Some(middle) = fit::middle(&|ways| synth.reach(moment.t, ways)) else { return Ok(None) };
    let ways = measure::ways(&ready);
    // Given its strokes by any anchor, it shows the same surface.
    let synth = Synth { strokes: Some(Arc::new((*ready).clone())), ..synth };
    let mut done = 0;
    let mut flatness = Vec::new();
    let mut draw = |eye| {
        let moment = Moment { eye: Some(eye), ..*moment };
        let seen = Seen::new(&synth, &moment);
        let given = seen.given_alone().filter(|_| step(done, measure::frames(steps)))?;
        if done == 0 {
            flatness = ways.iter().map(|ready| measure::flatness_of(ready, &given)).collect();
        }
        done += 1;
        Some(Frame::new(&ways, &given))
    };
    let Some(mut found) = measure::moves((&eye, middle), steps, &mut draw) else { return Ok(None) };
    found.iter_mut().zip(flatness).for_each(|((_, figures), flatness)| figures.flatness = flatness);
    Ok(step(done, done).then_some(Measures { of, ways: found }))
}
