//! What a view map is made from, as pictures of numbers.

use super::looked::Looked;
use crate::base::pixels::linear_from_srgb;
use crate::layers::mesh::surface::Reader;
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
    holds: Holds::Codes(&COLORS),
};
/// The same to look at: each view in a color of its own.
pub const COLORS: Pass = Pass { name: "coverage-colors", help: "which views are seen, by colors", holds: Holds::Light };

/// The least opacity at which a view counts.
const LEAST_OPACITY: f64 = 1e-6;

/// What tells what a pass has at one place after the other; `None` for passes that are not of view maps.
pub fn reader<'a>(looked: &'a Looked, pass: &Pass) -> Option<Reader<'a>> {
    let map = looked.map();
    let (mut spots, mut reader) = (looked.spots(), looked.sampler());
    let left = 1.0 - looked.base();
    let mut shares = vec![0.0; map.wanted.views.len()];
    match pass.name {
        name if name == INDEPENDENT.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            let [r, g, b] = reader.at(&spot, None).independent.map(|light| light as f32);
            [r, g, b, 1.0]
        })),
        name if name == DEPENDENT.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            let sample = reader.at(&spot, None);
            let [r, g, b] = sample.dependent.map(|light| (left * light) as f32);
            [r, g, b, (left * sample.opacity) as f32]
        })),
        name if name == COVERAGE.name => Some(Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            shares.fill(0.0);
            let sample = reader.at(&spot, Some(&mut |view, share| shares[view] += share));
            let first = |best: usize, view: usize| if shares[view] > shares[best] { view } else { best };
            let most = (0..shares.len()).reduce(first).filter(|_| sample.opacity > LEAST_OPACITY);
            let number = most.map_or(0, |view| map.wanted.views[view].number + 1);
            [(left * sample.opacity) as f32, sample.known as f32, number as f32, 1.0]
        })),
        name if name == COLORS.name => {
            let colors: Vec<[f64; 3]> = map.wanted.views.iter().map(|view| color(view.number + 1)).collect();
            Some(Box::new(move |place| {
                let Some(spot) = spots(place) else { return [0.0; 4] };
                let mut sum = [0.0; 3];
                reader.everyone(&spot, |view, share| {
                    sum.iter_mut().zip(colors[view]).for_each(|(sum, light)| *sum += share * light);
                });
                let [r, g, b] = sum.map(|light| light as f32);
                [r, g, b, 1.0]
            }))
        }
        _ => None,
    }
}

/// The color of the view with this number: linear light.
pub fn color(number: usize) -> [f64; 3] {
    const STEP: f64 = 0.618_034;
    const SATURATION: f64 = 0.65;
    const VALUE: f64 = 0.95;
    let turn = STEP * (number as f64 - 1.0);
    let sixths = (turn - turn.floor()) * 6.0;
    // How far each channel is from the one that is full.
    let channel = |at: f64| {
        let away = (sixths - at).abs();
        let full = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        linear_from_srgb(VALUE * (1.0 - SATURATION * (1.0 - full)))
    };
    [channel(0.0), channel(2.0), channel(4.0)]
}
