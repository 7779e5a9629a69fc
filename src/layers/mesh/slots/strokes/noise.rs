//! One noise of a layer in one frame: from its description to its value at every pixel.

use std::sync::OnceLock;

use glam::{DMat3, DVec2, DVec3};

use super::aim::{Aim, Follows, Grows};
use super::bins::Binning;
use super::impulse::{Impulse, Recipe, Weight, impulses};
use super::model::{Along, Anchor, By, Direction, Noise as Wanted, Trim as Ends, Vary};
use super::shown::InFrame;
use super::sum::{Noise, Trim, covers, sum};
use super::surface::Surface;
use super::synth::{Codes, Ready, SMOOTH, is_set};
use super::visible::Visible;
use super::{even, flat, grid};
use crate::layers::mesh::drawing::Given;

/// A layer in one frame.
pub struct Scene<'a> {
    /// Its strokes.
    pub ready: &'a Ready,
    /// What the layer hands out.
    pub given: &'a Given<'a>,
    /// Its triangles in camera coordinates.
    pub surface: Surface<'a>,
    /// What pixels show.
    pub shown: InFrame<'a>,
    /// Where the light goes, in camera coordinates.
    pub light: DVec3,
    /// How many times larger all is drawn than the document says.
    pub scale: f64,
    /// The number of the drawing.
    drawing: u32,
    /// The tensors of each of the curvatures, once they are needed.
    tensors: Vec<OnceLock<Tensors>>,
}

/// The tensors of a mesh, turned at each vertex, and half its size.
type Tensors = (Vec<DMat3>, f64);

impl<'a> Scene<'a> {
    /// The layer in the frame.
    pub fn new(ready: &'a Ready, given: &'a Given<'a>) -> Self {
        let eye = given.eye;
        let seen = given.world.iter().map(|(at, normal)| (eye.seen(*at), eye.turn * *normal)).collect();
        let (mesh, pieces, size_px) = (given.mesh, &*ready.pieces, given.size_px);
        let stop = ready.stop.as_deref();
        let surface = Surface { mesh, pieces, seen, placed: given.placed, both: given.both, eye, size_px, stop };
        let (inverse, triangle) = (&*given.inverse, &*given.triangle);
        let shown = InFrame::new((size_px, eye.focal_px), inverse, triangle, stop);
        let drawing = (given.t * ready.duration * ready.strokes.redraw + 1e-9).floor() as u32;
        let (light, scale) = (eye.turn * -given.toward, ready.scale * given.magnified);
        let tensors = vec![OnceLock::new(); ready.curvatures.len()];
        Scene { ready, given, surface, shown, light, scale, drawing, tensors }
    }

    /// The spacing of a noise, in pixels.
    pub fn spacing_px(&self, noise: &Wanted) -> f64 {
        noise.spacing * self.ready.strokes.size * self.scale
    }

    /// One of its noises, without shares of its variance.
    pub fn noise(&self, wanted: &Wanted) -> Noise {
        self.made(wanted, Noise::of_values(self.given.triangle.len()))
    }

    /// The same with them.
    pub fn noise_with_shares(&self, wanted: &Wanted) -> Noise {
        self.made(wanted, Noise::with_shares(self.given.triangle.len()))
    }

    /// The impulses of one of its noises that reach a pixel; `None` for a texture, which has none in the frame.
    pub fn reaching(&self, wanted: &Wanted, (x, y): (usize, usize)) -> Option<Vec<Impulse>> {
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let trim = self.trim(wanted);
        let reaches = |impulse: &Impulse| {
            let away = (impulse.at - at).abs();
            away.max_element() < impulse.radius_px && covers(&self.shown, trim, impulse, (x, y)) > 0.0
        };
        Some(self.impulses(wanted)?.into_iter().filter(reaches).collect())
    }

    /// All impulses of one of its noises; `None` for a texture, which has none in the frame.
    pub fn impulses(&self, wanted: &Wanted) -> Option<Vec<Impulse>> {
        let lumps = self.aimed(wanted, |anchor, aim| self.lumps(wanted, (anchor, aim), (Vec::new, std::mem::take)));
        Some(lumps?.concat())
    }

    /// What a noise is fixed to: its own anchor, otherwise that of the strokes.
    pub fn anchor(&self, wanted: &Wanted) -> Anchor {
        wanted.anchor.unwrap_or(self.ready.strokes.anchor)
    }

    /// Where the strokes of a noise run.
    pub fn direction<'b>(&'b self, wanted: &'b Wanted) -> &'b Direction {
        wanted.direction.as_ref().unwrap_or(&self.ready.strokes.direction)
    }

    /// What makes strokes of a noise larger or finer.
    pub fn vary<'b>(&'b self, wanted: &'b Wanted) -> Option<&'b Vary> {
        let vary = wanted.vary.as_ref().or(self.ready.strokes.vary.as_ref());
        vary.filter(|_| self.anchor(wanted) == Anchor::Surface)
    }

    /// What the kernels of a noise cover.
    pub fn trim(&self, wanted: &Wanted) -> Trim {
        match wanted.trim {
            _ if self.anchor(wanted) == Anchor::Screen => Trim::Object,
            Ends::Depth => Trim::Depth(wanted.reach),
            Ends::Triangle => Trim::Triangle,
            Ends::Object => Trim::Object,
        }
    }

    /// How many pixels of the frame a meter is, for strokes that are a texture.
    pub fn px_per_m(&self) -> f64 {
        self.ready.px_per_m * self.scale
    }

    /// Makes something of the anchor of a noise and how its impulses run.
    fn aimed<R>(&self, wanted: &Wanted, make: impl FnOnce(Anchor, &Aim) -> R) -> R {
        let (direction, anchor, vary) = (self.direction(wanted), self.anchor(wanted), self.vary(wanted));
        let none = Tensors::default();
        let tensors = |smooth: f64, is: bool| is.then(|| self.tensors(smooth)).flatten().unwrap_or(&none);
        let own = tensors(direction.smooth, direction.along == Along::Curvature);
        let of_vary = tensors(SMOOTH, vary.is_some_and(|vary| vary.by == By::Curvature));
        let axis = |triangle: u32| self.axis(direction, triangle);
        let flow = |uv: DVec2| self.image(&direction.image).map_or(DVec2::ZERO, |codes| flow(codes, uv));
        let bright = |vary: &Vary, uv: DVec2| self.image(&vary.image).map_or(0.0, |codes| brightness(codes, uv));
        let brightness = |uv: DVec2| vary.map_or(0.0, |vary| bright(vary, uv));
        let along = match direction.along {
            Along::Screen => Follows::Screen,
            Along::Curvature => Follows::Curvature(&own.0, own.1),
            Along::Light => Follows::Light(self.light),
            Along::Axis => Follows::Axis(&axis),
            Along::Outline => Follows::Outline,
            Along::Image => Follows::Image(&flow),
        };
        let by = |vary: &Vary| {
            let by = match vary.by {
                By::Light => Grows::Light(self.light),
                By::Curvature => Grows::Curvature(&of_vary.0, of_vary.1),
                By::Facing => Grows::Facing,
                By::Image => Grows::Image(&brightness),
            };
            (by, [vary.low, vary.high])
        };
        let turn = (direction.turn + wanted.turn).to_radians();
        let aim = Aim::new(along, direction.angle.to_radians(), turn, vary.map(by));
        make(anchor, &aim)
    }

    /// What the impulses of a noise are made by.
    pub fn recipe(&self, wanted: &Wanted) -> Recipe {
        let spacing_px = self.spacing_px(wanted);
        Recipe {
            key: Recipe::key(self.ready.strokes.seed, self.drawing, wanted.seed),
            spacing_px,
            radius_px: spacing_px * wanted.regularity,
            overlap: wanted.overlap,
            spread: wanted.spread.to_radians(),
        }
    }

    /// What `done` makes of the lumps of impulses of a noise, in order; `None` for a texture, which has none in the frame.
    fn lumps<L: Extend<Impulse>, R: Send>(
        &self,
        wanted: &Wanted,
        (anchor, aim): (Anchor, &Aim),
        (lump, done): (impl Fn() -> L + Sync + Send, impl Fn(&mut L) -> R + Sync + Send),
    ) -> Option<Vec<R>> {
        let recipe = self.recipe(wanted);
        match anchor {
            Anchor::Surface => {
                let visible = Visible::new(&self.shown, wanted.reach);
                let visible = |impulse: &Impulse| visible.of(impulse);
                let visible: Option<Weight> = (self.trim(wanted) == Trim::Object).then_some(&visible);
                Some(impulses(&self.surface, &recipe, aim, visible, (lump, done)))
            }
            Anchor::Screen => {
                let mut lump = lump();
                lump.extend(grid::impulses(self.shown.size_px, &recipe, aim.drawn));
                Some(vec![done(&mut lump)])
            }
            Anchor::Texture => None,
        }
    }

    /// A noise, with what `empty` has room for.
    fn made(&self, wanted: &Wanted, empty: Noise) -> Noise {
        let (shown, mut noise) = (&self.shown, empty);
        if is_set(shown.stop) {
            return noise;
        }
        self.aimed(wanted, |anchor, aim| {
            let binning = (|| Binning::new(shown.size_px, shown.focal_px), Binning::sorted);
            match self.lumps(wanted, (anchor, aim), binning) {
                Some(lumps) => {
                    sum(shown, &lumps, (wanted.overlap, wanted.regularity), self.trim(wanted), &mut noise);
                }
                None => {
                    let recipe = self.recipe(wanted);
                    noise = flat::sum(&self.surface, shown, &recipe, aim, self.px_per_m(), wanted.reach);
                }
            }
        });
        if wanted.even {
            even::even(shown.size_px, shown.triangle, self.spacing_px(wanted), &mut noise);
        }
        noise
    }

    /// The tensors of the mesh, smoothed so far, as they are turned; made once in a frame.
    fn tensors(&self, smooth: f64) -> Option<&Tensors> {
        let known = self.ready.curvatures.iter().zip(&self.tensors);
        let ((_, curvature), tensors) = known.into_iter().find(|((known, _), _)| *known == smooth)?;
        Some(tensors.get_or_init(|| {
            let turned = curvature.tensors.iter().zip(&self.given.mesh.vertices).map(|(tensor, vertex)| {
                let turn = self.given.eye.turn * self.given.placed.turn_at(vertex.position);
                turn * *tensor * turn.transpose()
            });
            (turned.collect(), curvature.half_m)
        }))
    }

    /// The axis of a direction as it is turned at the first corner of a triangle.
    fn axis(&self, direction: &Direction, triangle: u32) -> DVec3 {
        self.surface.turn_at(triangle) * DVec3::from(direction.axis).normalize_or_zero()
    }

    fn image(&self, name: &str) -> Option<&Codes> {
        self.ready.images.get(name).map(|codes| &**codes)
    }
}

/// The vector of a flow map, to the right and up.
fn flow(codes: &Codes, uv: DVec2) -> DVec2 {
    let (width, height) = (codes.width(), codes.height());
    let (x, y) = (uv.x * width as f64 - 0.5, (1.0 - uv.y) * height as f64 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (across, down) = (x - left, y - top);
    let at = |x: f64, y: f64| {
        let [r, g, _] = *codes.get(x.rem_euclid(width as f64) as usize, y.rem_euclid(height as f64) as usize);
        DVec2::new(f64::from(r), f64::from(g))
    };
    let above = at(left, top).lerp(at(left + 1.0, top), across);
    let below = at(left, top + 1.0).lerp(at(left + 1.0, top + 1.0), across);
    (above.lerp(below, down) - 128.0) / 127.0
}

/// The brightness of the pixel of an image at texture coordinates, from 0 to 1.
fn brightness(codes: &Codes, uv: DVec2) -> f64 {
    let (width, height) = (codes.width() as f64, codes.height() as f64);
    let x = (uv.x * width).floor().rem_euclid(width) as usize;
    let y = ((1.0 - uv.y) * height).floor().rem_euclid(height) as usize;
    let [r, g, b] = codes.get(x, y).map(f64::from);
    (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0
}
