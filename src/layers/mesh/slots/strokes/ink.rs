//! Marks: how noises and tones become a drawing, many pixels at once.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::marks::{Ink, Outline, Pigment, Relief, Set};
use super::model::{Force, Ground, Side};
use super::rim::{Pixels, Rules, squares};
use super::sum::Noise;
use super::tone::{share, threshold, within};
use crate::base::color;
use crate::base::maths::{cos, sin};
use crate::base::pixels::{Rgba, decode};
use crate::base::simd::vectorised;
use crate::layers::space::raster::NONE;

/// So many pixels of a row are drawn at once.
pub const RUN: usize = 64;

/// A number for each of them.
pub type Run = [f32; RUN];

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

/// Pixels in the making.
struct Cells {
    /// The column and the row of the first.
    at: (usize, usize),
    /// Their shaded colors, straight.
    scene: [Run; 3],
    /// How much of each the layer covers.
    coverage: Run,
    /// Premultiplied by `alpha`.
    color: [Run; 3],
    alpha: Run,
    /// How much of the ground no ink has covered.
    bare: Run,
}

/// How pixels are inked.
pub struct Inked {
    /// The share of such places that is.
    pub share: Run,
    /// What the noise is below where it is.
    pub threshold: Run,
    /// How much it covers.
    pub covered: Run,
}

/// What is drawn of one mark.
type Brush<'a> = Box<dyn Fn(&mut Cells) + Sync + 'a>;

/// Marks, ready to be drawn in any pixel.
pub struct Drawing<'a> {
    sheet: &'a Sheet<'a>,
    strokes: &'a Force,
    brushes: Vec<Brush<'a>>,
    paper: [f32; 3],
}

impl<'a> Drawing<'a> {
    /// Draws these marks in order.
    pub fn new(strokes: &'a Force, marks: &'a [Set], sheet: &'a Sheet) -> Self {
        let brush = |mark: &'a Set| match mark {
            Set::Ink(ink) => sheet.ink(strokes, ink),
            Set::Pigment(pigment) => sheet.pigment(pigment),
            Set::Relief(relief) => sheet.relief(strokes, relief),
            Set::Outline(outline) => Some(sheet.outline(strokes, outline)),
        };
        Drawing { sheet, strokes, brushes: marks.iter().filter_map(brush).collect(), paper: linear(&strokes.paper) }
    }

    /// Calls `each` with the columns of a row that show the layer: with the color there, premultiplied, and how much ink
    /// there is.
    pub fn row(&self, y: usize, mut each: impl FnMut(usize, Rgba, f32)) {
        let width = self.sheet.pixels.size_px.0;
        let triangles = self.sheet.pixels.triangle[y * width..(y + 1) * width].chunks(RUN);
        for (run, triangles) in triangles.enumerate() {
            let own = |k: &usize| triangles[*k] != NONE;
            if (0..triangles.len()).any(|k| own(&k)) {
                let (colors, inks) = self.run((run * RUN, y));
                (0..triangles.len()).filter(own).for_each(|k| each(run * RUN + k, colors[k], inks[k]));
            }
        }
    }

    /// The colors of pixels from this one on, and how much ink there is.
    fn run(&self, at: (usize, usize)) -> ([Rgba; RUN], Run) {
        let mut cells = vectorised(
            #[inline(always)]
            || self.ground(at),
        );
        self.brushes.iter().for_each(|brush| brush(&mut cells));
        let (mut colors, mut inks) = ([[0.0; 4]; RUN], [0.0; RUN]);
        let Cells { color: [r, g, b], alpha, coverage, bare, .. } = &cells;
        vectorised(
            #[inline(always)]
            || {
                for k in 0..RUN {
                    colors[k] = [r[k], g[k], b[k], alpha[k]].map(|v| v * coverage[k]);
                    inks[k] = 1.0 - bare[k];
                }
            },
        );
        (colors, inks)
    }

    /// Pixels without marks.
    #[inline(always)]
    fn ground(&self, at: (usize, usize)) -> Cells {
        let shaded = self.sheet.run(self.sheet.shaded, at);
        let (mut scene, mut coverage) = ([[0.0; RUN]; 3], [0.0; RUN]);
        for (k, [r, g, b, a]) in shaded.into_iter().enumerate() {
            let often = if a > 0.0 { 1.0 / a } else { 0.0 };
            [scene[0][k], scene[1][k], scene[2][k], coverage[k]] = [r * often, g * often, b * often, a];
        }
        let (fade, mut color, mut alpha) = (self.strokes.fade as f32, [[0.0; RUN]; 3], [1.0; RUN]);
        match self.strokes.ground {
            Ground::Paper => color = self.paper.map(|paper| [paper; RUN]),
            Ground::Scene => {
                for ((color, scene), paper) in color.iter_mut().zip(&scene).zip(self.paper) {
                    (0..RUN).for_each(|k| color[k] = scene[k] + (paper - scene[k]) * fade);
                }
            }
            Ground::Clear => alpha = [0.0; RUN],
        }
        Cells { at, scene, coverage, color, alpha, bare: [1.0; RUN] }
    }
}

/// Linear light of `#rrggbb`; what is no color is black.
pub fn linear(text: &str) -> [f32; 3] {
    let [r, g, b, _] = color::parse(text).map_or([0.0; 4], decode);
    [r, g, b]
}

impl Sheet<'_> {
    /// What pixels of a row have, from this one on; beyond the frame there is nothing.
    #[inline(always)]
    fn run<T: Copy + Default>(&self, of: &[T], at: (usize, usize)) -> [T; RUN] {
        self.run_beside(of, (at.0 as isize, at.1 as isize), T::default())
    }

    /// The same, also from one on that is not in the frame: what is there is `beyond`.
    #[inline(always)]
    fn run_beside<T: Copy>(&self, of: &[T], (x, y): (isize, isize), beyond: T) -> [T; RUN] {
        let ((width, height), mut run) = (self.pixels.size_px, [beyond; RUN]);
        let inside = x.max(0)..(x + RUN as isize).min(width as isize);
        if (0..height as isize).contains(&y) && !inside.is_empty() {
            let row = &of[y as usize * width..][..width];
            let own = (inside.start - x) as usize..(inside.end - x) as usize;
            run[own].copy_from_slice(&row[inside.start as usize..inside.end as usize]);
        }
        run
    }

    /// Ink where a noise is below a threshold that follows the tone.
    fn ink<'a>(&'a self, strokes: &'a Force, ink: &'a Ink) -> Option<Brush<'a>> {
        let inking = self.inking(strokes, ink)?;
        let paint = Paint::new(&ink.color, ink.shade, strokes);
        Some(Box::new(move |cells| {
            vectorised(
                #[inline(always)]
                || cells.cover(&paint, &inking.run(self, cells.at).covered),
            );
        }))
    }

    /// How pixels from this one on are inked; `None` if the noise is not there.
    pub fn inked(&self, strokes: &Force, ink: &Ink, at: (usize, usize)) -> Option<Inked> {
        Some(self.inking(strokes, ink)?.run(self, at))
    }

    fn inking<'a>(&'a self, strokes: &Force, ink: &'a Ink) -> Option<Inking<'a>> {
        let (noise, of) = (self.noises.get(&ink.noise)?, strokes.noises.get(&ink.noise)?);
        let grain = ink.grain.as_ref().and_then(|grain| Some((&*self.noises.get(&grain.noise)?.value, grain.amount)));
        let share = grain.map_or(0.0, |(_, share)| share);
        let side = if ink.side == Side::High { -1.0 } else { 1.0 };
        Some(Inking {
            ink,
            noise: &noise.value,
            even: of.even,
            grain: grain.map(|(values, _)| values),
            mixed: [(1.0 - share * share).sqrt(), share].map(|part| (side * part) as f32),
            amount: (ink.amount * strokes.amount) as f32,
            soft: (ink.softness * PI / (of.spacing * strokes.size)) as f32,
        })
    }

    /// More or less pigment in the color.
    fn pigment<'a>(&'a self, pigment: &Pigment) -> Option<Brush<'a>> {
        let (noise, strength) = (self.noises.get(&pigment.noise)?, pigment.strength as f32);
        Some(Box::new(move |cells| {
            vectorised(
                #[inline(always)]
                || {
                    let more = self.run(&noise.value, cells.at).map(|x| strength * (2.0 * within(x / 4.0 + 0.5) - 1.0));
                    cells.change(
                        #[inline(always)]
                        |k, c| c * (1.0 - (1.0 - c) * more[k]),
                    );
                },
            );
        }))
    }

    /// Light on the noise as a relief.
    fn relief<'a>(&'a self, strokes: &Force, relief: &Relief) -> Option<Brush<'a>> {
        let (noise, of) = (self.noises.get(&relief.noise)?, strokes.noises.get(&relief.noise)?);
        let angle = relief.angle.to_radians();
        let steep = relief.strength * of.spacing * strokes.size * self.scale / TAU;
        let toward = [steep * cos(angle), -steep * sin(angle)].map(|v| v as f32);
        Some(Box::new(move |cells| {
            vectorised(
                #[inline(always)]
                || {
                    let [right, down] = self.slopes(&noise.value, cells.at);
                    cells.change(
                        #[inline(always)]
                        |k, c| {
                            let darker = right[k] * toward[0] + down[k] * toward[1];
                            c * (2.0 * within((1.0 - darker) / 2.0))
                        },
                    );
                },
            );
        }))
    }

    /// A line along rims.
    fn outline<'a>(&'a self, strokes: &'a Force, outline: &'a Outline) -> Brush<'a> {
        let paint = Paint::new(&outline.color, outline.shade, strokes);
        let covered = self.outlined(strokes, outline);
        Box::new(move |cells| {
            vectorised(
                #[inline(always)]
                || cells.cover(&paint, &covered(cells.at)),
            );
        })
    }

    /// How much a line along rims covers pixels from one on.
    pub fn outlined<'a>(&'a self, strokes: &Force, outline: &'a Outline) -> impl Fn((usize, usize)) -> Run + Sync + 'a {
        let crease = outline.creases.map(|degrees| cos(degrees.to_radians()));
        let rim = self.pixels.rim(&Rules { step_px: outline.step * self.scale, crease });
        let noise = outline.noise.as_ref().and_then(|name| self.noises.get(name)).map(|noise| &*noise.value);
        // A hard edge is the limit of a soft one.
        let soft = (outline.softness * self.scale).max(1e-9);
        let half = outline.width * strokes.size * self.scale / 2.0;
        let most = noise.map_or(0.0, |values| values.par_iter().copied().reduce(|| 0.0, f32::max));
        let reach = half * (1.0 + outline.vary * f64::from(most)) + soft / 2.0;
        let squares = squares(self.pixels.size_px, &rim, reach.ceil() as usize);
        let [half, vary, often, opacity] = [half, outline.vary, 1.0 / soft, outline.opacity].map(|v| v as f32);
        #[inline(always)]
        move |at| {
            let x = noise.map_or([0.0; RUN], |noise| self.run(noise, at));
            let mut covered = self.run(&squares, at);
            for k in 0..RUN {
                let inside = half * (1.0 + vary * x[k]) - covered[k].sqrt();
                covered[k] = opacity * within(inside * often + 0.5);
            }
            covered
        }
    }

    /// How a value grows to the right and down: the mean of the differences to the pixels of the layer on both sides.
    #[inline(always)]
    fn slopes(&self, values: &[f32], (x, y): (usize, usize)) -> [Run; 2] {
        let (own, [x, y]) = (self.run(values, (x, y)), [x as isize, y as isize]);
        [[1, 0], [0, 1]].map(
            #[inline(always)]
            |[right, down]| {
                let side = |at: (isize, isize)| {
                    let triangles = self.run_beside(self.pixels.triangle, at, NONE);
                    (self.run_beside(values, at, 0.0), triangles.map(|of| if of == NONE { 0.0 } else { 1.0 }))
                };
                let (before, is_before) = side((x - right, y - down));
                let (after, is_after) = side((x + right, y + down));
                let mut slope = [0.0; RUN];
                for k in 0..RUN {
                    let sum = is_before[k] * (own[k] - before[k]) + is_after[k] * (after[k] - own[k]);
                    slope[k] = if is_before[k] + is_after[k] > 1.0 { sum / 2.0 } else { sum };
                }
                slope
            },
        )
    }
}

/// An ink with all that tells where it goes.
struct Inking<'a> {
    ink: &'a Ink,
    noise: &'a [f32],
    /// Whether the noise is evened out.
    even: bool,
    /// The noise that is mixed into it.
    grain: Option<&'a [f32]>,
    /// What both are multiplied by; less than 0 if high values ink.
    mixed: [f32; 2],
    /// The most that is inked.
    amount: f32,
    /// How far edges reach.
    soft: f32,
}

impl Inking<'_> {
    /// How pixels from this one on are inked.
    #[inline(always)]
    fn run(&self, sheet: &Sheet, at: (usize, usize)) -> Inked {
        let Inking { ink, even, mixed, amount, soft, .. } = *self;
        let [from, to, opacity, rim] = [ink.from, ink.to, ink.opacity, 4.0 * ink.rim].map(|v| v as f32);
        let (tone, noise) = (sheet.run(sheet.tone, at), sheet.run(self.noise, at));
        let grain = self.grain.map_or([0.0; RUN], |grain| sheet.run(grain, at));
        let mut inked = Inked { share: [0.0; RUN], threshold: [0.0; RUN], covered: [0.0; RUN] };
        for k in 0..RUN {
            let share = within(amount * share(tone[k], from, to));
            let threshold = threshold(share, even);
            let below = threshold - (mixed[0] * noise[k] + mixed[1] * grain[k]);
            // Edges that are hard: infinitely far on one side, or on the other.
            let x = within((below + soft) / (2.0 * soft));
            let covered = x * x * (3.0 - 2.0 * x);
            let covered = opacity * (covered + rim * covered * (1.0 - covered));
            let covered = if covered < 1.0 { covered } else { 1.0 };
            (inked.share[k], inked.threshold[k]) = (share, threshold);
            inked.covered[k] = if share > 0.0 { covered } else { 0.0 };
        }
        inked
    }
}

impl Cells {
    #[inline(always)]
    fn cover(&mut self, paint: &Paint, covered: &Run) {
        for ((color, scene), own) in self.color.iter_mut().zip(&self.scene).zip(paint.color) {
            for k in 0..RUN {
                color[k] = color[k] * (1.0 - covered[k]) + (own + scene[k] * paint.scene) * covered[k];
            }
        }
        for ((alpha, bare), covered) in self.alpha.iter_mut().zip(&mut self.bare).zip(covered) {
            *alpha = *alpha * (1.0 - covered) + covered;
            *bare *= 1.0 - covered;
        }
    }

    /// Changes each channel of the straight colors.
    #[inline(always)]
    fn change(&mut self, change: impl Fn(usize, f32) -> f32) {
        let alpha = self.alpha;
        for color in &mut self.color {
            for k in 0..RUN {
                let straight = if alpha[k] > 0.0 { color[k] / alpha[k] } else { 0.0 };
                color[k] = change(k, straight) * alpha[k];
            }
        }
    }
}

/// What a mark is drawn with: a color in linear light, and so much of the scene's own.
pub struct Paint {
    /// See [`Paint`].
    pub color: [f32; 3],
    /// See [`Paint`].
    pub scene: f32,
}

impl Paint {
    /// The color of a mark, times a shade.
    pub fn new(color: &str, shade: f64, strokes: &Force) -> Paint {
        let shade = shade as f32;
        let color = match color {
            "scene" => return Paint { color: [0.0; 3], scene: shade },
            "ink" => &strokes.ink,
            "paper" => &strokes.paper,
            other => other,
        };
        Paint { color: linear(color).map(|v| v * shade), scene: 0.0 }
    }
}
