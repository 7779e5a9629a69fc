//! Marks: how noises and tones become a drawing, pixel by pixel.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::marks::{Ink, Outline, Relief, Set};
use super::model::{Force, Ground, Side};
use super::rim::{Pixels, Rules, squares};
use super::sum::Noise;
use super::tone::{Thresholds, share, threshold};
use crate::base::color;
use crate::base::maths::{cos, sin, smoothstep};
use crate::base::pixels::{Rgba, decode};
use crate::layers::space::raster::NONE;

/// What a drawing is made from: one of each for every pixel of the frame.
pub struct Sheet<'a> {
    /// What the frame shows.
    pub pixels: &'a Pixels<'a>,
    /// The shaded color of the layer: linear, premultiplied.
    pub shaded: &'a [Rgba],
    /// 0 is dark, 1 is light.
    pub tone: &'a [f32],
    /// The noises by their names.
    pub noises: &'a BTreeMap<String, Noise>,
    /// How many times larger all lengths are than in the document.
    pub scale: f64,
}

/// A pixel in the making.
struct Cell {
    /// The pixel.
    i: usize,
    /// Its shaded color, straight.
    scene: DVec3,
    /// Premultiplied by `alpha`.
    color: DVec3,
    alpha: f64,
    /// How much of the ground no ink has covered.
    bare: f64,
}

/// How a pixel is inked.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inked {
    /// The share of such places that is.
    pub share: f64,
    /// What the noise is below where it is.
    pub threshold: f64,
    /// How much it covers.
    pub covered: f64,
}

/// What is drawn of one mark.
type Brush<'a> = Box<dyn Fn(&mut Cell) + Sync + 'a>;

/// Marks, ready to be drawn in any pixel.
pub struct Drawing<'a> {
    sheet: &'a Sheet<'a>,
    strokes: &'a Force,
    brushes: Vec<Brush<'a>>,
    paper: DVec3,
}

impl<'a> Drawing<'a> {
    /// Draws these marks in order.
    pub fn new(strokes: &'a Force, marks: &'a [Set], sheet: &'a Sheet) -> Self {
        let brush = |mark: &'a Set| match mark {
            Set::Ink(ink) => sheet.ink(strokes, ink),
            Set::Pigment(pigment) => sheet.pigment(&pigment.noise, pigment.strength),
            Set::Relief(relief) => sheet.relief(strokes, relief),
            Set::Outline(outline) => Some(sheet.outline(strokes, outline)),
        };
        Drawing { sheet, strokes, brushes: marks.iter().filter_map(brush).collect(), paper: linear(&strokes.paper) }
    }

    /// The color of a pixel that shows the layer, premultiplied, and how much ink there is.
    pub fn pixel(&self, i: usize) -> (Rgba, f32) {
        let [r, g, b, coverage] = self.sheet.shaded[i].map(f64::from);
        let scene = if coverage > 0.0 { DVec3::new(r, g, b) / coverage } else { DVec3::ZERO };
        let (color, alpha) = match self.strokes.ground {
            Ground::Paper => (self.paper, 1.0),
            Ground::Scene => (scene.lerp(self.paper, self.strokes.fade), 1.0),
            Ground::Clear => (DVec3::ZERO, 0.0),
        };
        let mut cell = Cell { i, scene, color, alpha, bare: 1.0 };
        self.brushes.iter().for_each(|brush| brush(&mut cell));
        let [r, g, b] = (cell.color * coverage).to_array().map(|v| v as f32);
        ([r, g, b, (cell.alpha * coverage) as f32], (1.0 - cell.bare) as f32)
    }
}

/// Linear light of `#rrggbb`; what is no color is black.
pub fn linear(text: &str) -> DVec3 {
    let [r, g, b, _] = color::parse(text).map_or([0.0; 4], decode).map(f64::from);
    DVec3::new(r, g, b)
}

impl Sheet<'_> {
    /// Ink where a noise is below a threshold that follows the tone.
    fn ink<'a>(&'a self, strokes: &'a Force, ink: &'a Ink) -> Option<Brush<'a>> {
        let inking = self.inking(strokes, ink)?;
        let thresholds = Thresholds::new(inking.even);
        let paint = Paint::new(&ink.color, ink.shade, strokes);
        Some(Box::new(move |cell| {
            let inked = inking.at(cell.i, |share, x| thresholds.serving(share, x, inking.soft));
            cell.cover(&paint, inked.covered);
        }))
    }

    /// How a pixel is inked; `None` if the noise is not there.
    pub fn inked(&self, strokes: &Force, ink: &Ink, i: usize) -> Option<Inked> {
        let inking = self.inking(strokes, ink)?;
        Some(inking.at(i, |share, _| threshold(share, inking.even)))
    }

    fn inking<'a>(&'a self, strokes: &Force, ink: &'a Ink) -> Option<Inking<'a>> {
        let (noise, of) = (self.noises.get(&ink.noise)?, strokes.noises.get(&ink.noise)?);
        let grain = ink.grain.as_ref().and_then(|grain| Some((&*self.noises.get(&grain.noise)?.value, grain.amount)));
        Some(Inking {
            ink,
            tone: self.tone,
            noise: &noise.value,
            even: of.even,
            grain,
            amount: ink.amount * strokes.amount,
            soft: ink.softness * PI / (of.spacing * strokes.size),
        })
    }

    /// More or less pigment in the color.
    fn pigment<'a>(&'a self, noise: &str, strength: f64) -> Option<Brush<'a>> {
        let noise = self.noises.get(noise)?;
        Some(Box::new(move |cell| {
            let more = strength * (f64::from(noise.value[cell.i]) / 2.0).clamp(-1.0, 1.0);
            cell.change(|c| c * (1.0 - (1.0 - c) * more));
        }))
    }

    /// Light on the noise as a relief.
    fn relief<'a>(&'a self, strokes: &Force, relief: &Relief) -> Option<Brush<'a>> {
        let (noise, of) = (self.noises.get(&relief.noise)?, strokes.noises.get(&relief.noise)?);
        let angle = relief.angle.to_radians();
        let toward = (cos(angle), -sin(angle));
        let steep = relief.strength * of.spacing * strokes.size * self.scale / TAU;
        Some(Box::new(move |cell| {
            let (right, down) = self.slope(&noise.value, cell.i);
            let light = (1.0 - steep * (right * toward.0 + down * toward.1)).clamp(0.0, 2.0);
            cell.change(|c| c * light);
        }))
    }

    /// A line along rims.
    fn outline<'a>(&'a self, strokes: &'a Force, outline: &'a Outline) -> Brush<'a> {
        let paint = Paint::new(&outline.color, outline.shade, strokes);
        let covered = self.outlined(strokes, outline);
        Box::new(move |cell| cell.cover(&paint, covered(cell.i)))
    }

    /// How much a line along rims covers each pixel.
    pub fn outlined<'a>(&'a self, strokes: &Force, outline: &'a Outline) -> impl Fn(usize) -> f64 + Sync + 'a {
        let crease = outline.creases.map(|degrees| cos(degrees.to_radians()));
        let rim = self.pixels.rim(&Rules { step_px: outline.step * self.scale, crease });
        let noise = outline.noise.as_ref().and_then(|name| self.noises.get(name)).map(|noise| &*noise.value);
        // A hard edge is the limit of a soft one.
        let soft = (outline.softness * self.scale).max(1e-9);
        let half = outline.width * strokes.size * self.scale / 2.0;
        let most = noise.map_or(0.0, |values| values.par_iter().copied().reduce(|| 0.0, f32::max));
        let reach = half * (1.0 + outline.vary * f64::from(most)) + soft / 2.0;
        let squares = squares(self.pixels.size_px, &rim, reach.ceil() as usize);
        move |i| {
            let x = noise.map_or(0.0, |noise| f64::from(noise[i]));
            let inside = half * (1.0 + outline.vary * x) - f64::from(squares[i]).sqrt();
            outline.opacity * (inside / soft + 0.5).clamp(0.0, 1.0)
        }
    }

    /// How a value grows to the right and down: the mean of the differences to the pixels of the layer on both sides.
    fn slope(&self, values: &[f32], i: usize) -> (f64, f64) {
        let (width, height) = self.pixels.size_px;
        let (x, y) = (i % width, i / width);
        let own = |i: usize| self.pixels.triangle[i] != NONE;
        let mean = |before: Option<usize>, after: Option<usize>| {
            let before = before.filter(|i| own(*i)).map(|before| f64::from(values[i] - values[before]));
            let after = after.filter(|i| own(*i)).map(|after| f64::from(values[after] - values[i]));
            match (before, after) {
                (Some(before), Some(after)) => (before + after) / 2.0,
                (one, other) => one.or(other).unwrap_or(0.0),
            }
        };
        let right = mean((x > 0).then(|| i - 1), (x + 1 < width).then(|| i + 1));
        let down = mean((y > 0).then(|| i - width), (y + 1 < height).then(|| i + width));
        (right, down)
    }
}

/// An ink with all that tells where it goes.
struct Inking<'a> {
    ink: &'a Ink,
    tone: &'a [f32],
    noise: &'a [f32],
    /// Whether the noise is evened out.
    even: bool,
    /// The noise that is mixed into it, and how much.
    grain: Option<(&'a [f32], f64)>,
    /// The most that is inked.
    amount: f64,
    /// How far edges reach.
    soft: f64,
}

impl Inking<'_> {
    /// How a pixel is inked, by thresholds of a share and the noise.
    fn at(&self, i: usize, threshold: impl Fn(f64, f64) -> f64) -> Inked {
        let (ink, soft) = (self.ink, self.soft);
        let inked = (self.amount * share(f64::from(self.tone[i]), ink.from, ink.to)).clamp(0.0, 1.0);
        if inked == 0.0 {
            return Inked::default();
        }
        let mut x = f64::from(self.noise[i]);
        if let Some((grain, amount)) = self.grain {
            x = (1.0 - amount * amount).sqrt() * x + amount * f64::from(grain[i]);
        }
        let x = if ink.side == Side::High { -x } else { x };
        let threshold = threshold(inked, x);
        let below = x - threshold;
        let covered = match soft > 0.0 {
            true => 1.0 - smoothstep(-soft, soft, below),
            false => f64::from(u8::from(below < 0.0)),
        };
        let covered = (ink.opacity * (covered + 4.0 * ink.rim * covered * (1.0 - covered))).min(1.0);
        Inked { share: inked, threshold, covered }
    }
}

impl Cell {
    fn cover(&mut self, paint: &Paint, covered: f64) {
        if covered == 0.0 {
            return;
        }
        let color = match paint {
            Paint::Scene(shade) => self.scene * *shade,
            Paint::Color(color) => *color,
        };
        self.color = self.color * (1.0 - covered) + color * covered;
        self.alpha = self.alpha * (1.0 - covered) + covered;
        self.bare *= 1.0 - covered;
    }

    /// Changes each channel of the straight color.
    fn change(&mut self, change: impl Fn(f64) -> f64) {
        if self.alpha > 0.0 {
            self.color = DVec3::from_array((self.color / self.alpha).to_array().map(change)) * self.alpha;
        }
    }
}

/// What a mark is drawn with: a color, or the scene's own times a shade.
pub enum Paint {
    /// The scene's own, times this.
    Scene(f64),
    /// This, in linear light.
    Color(DVec3),
}

impl Paint {
    /// The color of a mark, times a shade.
    pub fn new(color: &str, shade: f64, strokes: &Force) -> Paint {
        match color {
            "scene" => Paint::Scene(shade),
            "ink" => Paint::Color(linear(&strokes.ink) * shade),
            "paper" => Paint::Color(linear(&strokes.paper) * shade),
            other => Paint::Color(linear(other) * shade),
        }
    }
}
