//! Marks: how noises and tones become a drawing, pixel by pixel.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::marks::{Ink, Outline, Relief, Set};
use super::model::{Force, Ground, Side};
use super::rim::{Pixels, Rules, distances};
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

/// Draws the marks in order: the color of every pixel of the frame, premultiplied, and how much ink there is.
pub fn draw<'a>(strokes: &'a Force, marks: &'a [Set], sheet: &'a Sheet) -> (Vec<Rgba>, Vec<f32>) {
    let brush = |mark: &'a Set| match mark {
        Set::Ink(ink) => sheet.ink(strokes, ink),
        Set::Pigment(pigment) => sheet.pigment(&pigment.noise, pigment.strength),
        Set::Relief(relief) => sheet.relief(strokes, relief),
        Set::Outline(outline) => Some(sheet.outline(strokes, outline)),
    };
    let brushes: Vec<Brush> = marks.iter().filter_map(brush).collect();
    let paper = linear(&strokes.paper);
    let pixel = |i: usize| {
        if sheet.pixels.triangle[i] == NONE {
            return ([0.0; 4], 0.0);
        }
        let [r, g, b, coverage] = sheet.shaded[i].map(f64::from);
        let scene = if coverage > 0.0 { DVec3::new(r, g, b) / coverage } else { DVec3::ZERO };
        let (color, alpha) = match strokes.ground {
            Ground::Paper => (paper, 1.0),
            Ground::Scene => (scene.lerp(paper, strokes.fade), 1.0),
            Ground::Clear => (DVec3::ZERO, 0.0),
        };
        let mut cell = Cell { i, scene, color, alpha, bare: 1.0 };
        brushes.iter().for_each(|brush| brush(&mut cell));
        let [r, g, b] = (cell.color * coverage).to_array().map(|v| v as f32);
        ([r, g, b, (cell.alpha * coverage) as f32], (1.0 - cell.bare) as f32)
    };
    (0..sheet.shaded.len()).into_par_iter().map(pixel).unzip()
}

/// Linear light of `#rrggbb`; what is no color is black.
pub fn linear(text: &str) -> DVec3 {
    let [r, g, b, _] = color::parse(text).map_or([0.0; 4], decode).map(f64::from);
    DVec3::new(r, g, b)
}

impl Sheet<'_> {
    /// Ink where a noise is below a threshold that follows the tone.
    fn ink<'a>(&'a self, strokes: &'a Force, ink: &'a Ink) -> Option<Brush<'a>> {
        let of = self.noises.get(&ink.noise).and(strokes.noises.get(&ink.noise))?;
        let thresholds = Thresholds::new(of.even);
        let paint = Paint::new(&ink.color, ink.shade, strokes);
        Some(Box::new(move |cell| {
            let threshold = |share: f64, x: f64, soft: f64| thresholds.serving(share, x, soft);
            let inked = self.inked_by(strokes, ink, cell.i, threshold);
            if let Some(inked) = inked.filter(|inked| inked.share > 0.0) {
                cell.cover(&paint, inked.covered);
            }
        }))
    }

    /// How a pixel is inked; `None` if the noise is not there.
    pub fn inked(&self, strokes: &Force, ink: &Ink, i: usize) -> Option<Inked> {
        let even = strokes.noises.get(&ink.noise)?.even;
        self.inked_by(strokes, ink, i, |share, _, _| threshold(share, even))
    }

    /// The same, by thresholds of a share, the noise, and how far edges reach.
    fn inked_by(
        &self,
        strokes: &Force,
        ink: &Ink,
        i: usize,
        threshold: impl Fn(f64, f64, f64) -> f64,
    ) -> Option<Inked> {
        let (noise, of) = (self.noises.get(&ink.noise)?, strokes.noises.get(&ink.noise)?);
        let tone = f64::from(self.tone[i]);
        let inked = (ink.amount * strokes.amount * share(tone, ink.from, ink.to)).clamp(0.0, 1.0);
        if inked == 0.0 {
            return Some(Inked::default());
        }
        let mut x = f64::from(noise.value[i]);
        let grain = ink.grain.as_ref().and_then(|grain| Some((self.noises.get(&grain.noise)?, grain.amount)));
        if let Some((grain, amount)) = grain {
            x = (1.0 - amount * amount).sqrt() * x + amount * f64::from(grain.value[i]);
        }
        let x = if ink.side == Side::High { -x } else { x };
        let soft = ink.softness * PI / (of.spacing * strokes.size);
        let threshold = threshold(inked, x, soft);
        let below = x - threshold;
        let covered = match soft > 0.0 {
            true => 1.0 - smoothstep(-soft, soft, below),
            false => f64::from(u8::from(below < 0.0)),
        };
        let covered = (ink.opacity * (covered + 4.0 * ink.rim * covered * (1.0 - covered))).min(1.0);
        Some(Inked { share: inked, threshold, covered })
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
        let away = distances(self.pixels.size_px, &rim);
        let noise = outline.noise.as_ref().and_then(|name| self.noises.get(name));
        // A hard edge is the limit of a soft one.
        let soft = (outline.softness * self.scale).max(1e-9);
        let half = outline.width * strokes.size * self.scale / 2.0;
        move |i| {
            let x = noise.map_or(0.0, |noise| f64::from(noise.value[i]));
            let inside = half * (1.0 + outline.vary * x) - away[i];
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

impl Cell {
    fn cover(&mut self, paint: &Paint, covered: f64) {
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
