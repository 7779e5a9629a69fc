//! What a view map is made from, as pictures of numbers.

use super::super::Reader;
use super::map::Map;
use super::ready::Looked;
use super::sample;
use crate::layers::parts::pass::{Holds, Pass};

/// The base coat.
pub const INDEPENDENT: Pass =
    Pass { name: "independent", help: "the base coat of view maps: what is seen from everywhere", holds: Holds::Light };
/// What depends on the direction.
pub const DEPENDENT: Pass = Pass {
    name: "dependent",
    help: "what of view maps is seen near the cameras of their views, times its opacity",
    holds: Holds::Light,
};
/// Who tells what.
pub const COVERAGE: Pass = Pass {
    name: "coverage",
    help: "how opaque that is, how much of the base coat is known, the number of the view that counts most",
    holds: Holds::Share,
};

/// The least opacity at which a view counts.
const LEAST_OPACITY: f64 = 1e-6;

/// What tells what a pass has at one place after the other; `None` for passes that are not of view maps.
pub fn reader<'a>(looked: &'a Looked, map: &'a Map, pass: &Pass) -> Option<Reader<'a>> {
    let (mut spots, mut reader) = (looked.spots(), sample::Reader::new(map));
    let left = 1.0 - looked.base();
    let mut shares = vec![0.0; map.wanted.views.len()];
    match pass.name {
        name if name == INDEPENDENT.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            let [r, g, b] = reader.at(&spot, |_, _| ()).independent.map(|light| light as f32);
            [r, g, b, 1.0]
        })),
        name if name == DEPENDENT.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            let sample = reader.at(&spot, |_, _| ());
            let [r, g, b] = sample.dependent.map(|light| (left * light) as f32);
            [r, g, b, (left * sample.opacity) as f32]
        })),
        name if name == COVERAGE.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            shares.fill(0.0);
            let sample = reader.at(&spot, |view, share| shares[view] += share);
            let first = |best: usize, view: usize| if shares[view] > shares[best] { view } else { best };
            let most = (0..shares.len()).reduce(first).filter(|_| sample.opacity > LEAST_OPACITY);
            let number = most.map_or(0, |view| map.wanted.views[view].number + 1);
            [(left * sample.opacity) as f32, sample.known as f32, number as f32, 1.0]
        })),
        _ => None,
    }
}
