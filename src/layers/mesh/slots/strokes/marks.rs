//! Marks with everything set: what each kind of them does, and with which numbers.

use serde::Serialize;

use super::model::{Does, Grain, Mark, Side};

/// A mark with everything set.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Set {
    /// Ink where the noise is below a threshold that follows the tone.
    Ink(Ink),
    /// More or less pigment.
    Pigment(Pigment),
    /// Light on a relief.
    Relief(Relief),
    /// A line along rims.
    Outline(Outline),
}

/// Ink where a noise is below a threshold that follows the tone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ink {
    /// The noise.
    pub noise: String,
    /// Its color, and what that is multiplied by.
    pub color: String,
    /// See `color`.
    pub shade: f64,
    /// How much it covers at most.
    pub opacity: f64,
    /// The tones between which it goes from nothing to most.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// The share that is inked at most.
    pub amount: f64,
    /// How wide its edges are, in pixels.
    pub softness: f64,
    /// A finer noise that is mixed in.
    pub grain: Option<Grain>,
    /// How much darker edges are.
    pub rim: f64,
    /// Which values ink.
    pub side: Side,
}

/// More or less pigment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pigment {
    /// The noise.
    pub noise: String,
    /// How strong it is.
    pub strength: f64,
}

/// Light on a relief.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Relief {
    /// The noise.
    pub noise: String,
    /// How strong it is.
    pub strength: f64,
    /// Where it is lit from, in degrees.
    pub angle: f64,
}

/// A line along rims.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// How wide it is, in pixels.
    pub width: f64,
    /// Its color, and what that is multiplied by.
    pub color: String,
    /// See `color`.
    pub shade: f64,
    /// How much it covers.
    pub opacity: f64,
    /// How wide its edges are, in pixels.
    pub softness: f64,
    /// The noise that changes its width.
    pub noise: Option<String>,
    /// How much.
    pub vary: f64,
    /// The angle from which on creases have one, in degrees.
    pub creases: Option<f64>,
    /// The step in depth from which on there is one within the layer, in pixels.
    pub step: f64,
}

impl Set {
    /// What is not written has its default; `None` if the mark has no kind.
    pub fn of(mark: &Mark) -> Option<Set> {
        let color = || mark.color.clone().unwrap_or_else(|| "ink".into());
        let noise = || mark.noise.clone().unwrap_or_default();
        let (shade, opacity) = (mark.shade.unwrap_or(1.0), mark.opacity.unwrap_or(1.0));
        let softness = mark.softness.unwrap_or(1.0);
        Some(match mark.kind? {
            Does::Ink => Set::Ink(Ink {
                noise: noise(),
                color: color(),
                shade,
                opacity,
                from: mark.from.unwrap_or(1.0),
                to: mark.to.unwrap_or(0.0),
                amount: mark.amount.unwrap_or(1.0),
                softness,
                grain: mark.grain.clone(),
                rim: mark.rim.unwrap_or(0.0),
                side: mark.side.unwrap_or_default(),
            }),
            Does::Pigment => Set::Pigment(Pigment { noise: noise(), strength: mark.strength.unwrap_or(0.5) }),
            Does::Relief => {
                let (strength, angle) = (mark.strength.unwrap_or(0.3), mark.angle.unwrap_or(135.0));
                Set::Relief(Relief { noise: noise(), strength, angle })
            }
            Does::Outline => Set::Outline(Outline {
                width: mark.width.unwrap_or(1.5),
                color: color(),
                shade,
                opacity,
                softness,
                noise: mark.noise.clone(),
                vary: mark.vary.unwrap_or(0.0),
                creases: mark.creases,
                step: mark.step.unwrap_or(4.0),
            }),
        })
    }

    /// Its noise, if it has one, and the field with the name of that.
    pub fn noises(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let (own, grain) = match self {
            Set::Ink(ink) => (Some(&*ink.noise), ink.grain.as_ref().map(|grain| &*grain.noise)),
            Set::Pigment(pigment) => (Some(&*pigment.noise), None),
            Set::Relief(relief) => (Some(&*relief.noise), None),
            Set::Outline(outline) => (outline.noise.as_deref(), None),
        };
        own.map(|name| ("/noise", name)).into_iter().chain(grain.map(|name| ("/grain/noise", name)))
    }
}
