//! How much of each impulse is seen, for kernels that cover all of a layer (the paper's partial visibility).

use glam::DVec2;

use super::impulse::Impulse;
use super::shown::InFrame;
use crate::base::maths::{cos, sin, smoothstep};

/// Where to look: rings of this radius, in kernel radii, with so many taps, the first at an angle in degrees.
const RINGS: [(f64, u32, f64); 3] = [(0.0, 1, 0.0), (1.0 / 3.0, 4, 0.0), (2.0 / 3.0, 8, 22.5)];

/// Tells how much of each impulse is seen.
pub struct Visible<'a> {
    shown: &'a InFrame<'a>,
    reach: f64,
    /// Where to look, in kernel radii.
    taps: Vec<DVec2>,
}

impl<'a> Visible<'a> {
    /// Of kernels that reach so many of their radii in depth.
    pub fn new(shown: &'a InFrame, reach: f64) -> Visible<'a> {
        let rings = RINGS.iter().flat_map(|&(radius, count, first)| {
            (0..count).map(move |k| {
                let angle = (first + 360.0 / f64::from(count) * f64::from(k)).to_radians();
                DVec2::new(cos(angle), sin(angle)) * radius
            })
        });
        Visible { shown, reach, taps: rings.collect() }
    }

    /// How much of an impulse is seen, from 0 to 1.
    pub fn of(&self, impulse: &Impulse) -> f64 {
        let Visible { shown, reach, taps } = self;
        let (width, height) = (shown.size_px.0 as f64, shown.size_px.1 as f64);
        let scale = impulse.depth * shown.focal_px / impulse.radius_px;
        let seen = taps.iter().filter_map(|tap| {
            let pixel = (impulse.at + *tap * impulse.radius_px).floor();
            let inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < width && pixel.y < height;
            let inverse = inside.then(|| shown.inverse[pixel.y as usize * shown.size_px.0 + pixel.x as usize])?;
            if inverse <= 0.0 {
                return Some(1.0);
            }
            let plane = impulse.plane;
            let nearer = inverse - (plane.x * (pixel.x + 0.5) + plane.y * (pixel.y + 0.5) + plane.z);
            Some(1.0 - smoothstep(*reach, 2.0 * reach, nearer * scale))
        });
        let (sum, count) = seen.fold((0.0, 0.0), |(sum, count), seen| (sum + seen, count + 1.0));
        if count > 0.0 { sum / count } else { 1.0 }
    }
}
