//! How flat strokes are, and how they move with the surface, for each anchor: the camera is moved in small steps, and
//! drawings of a gray surface of one tone are compared along the true motion of its points.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::draw::{grey, main_noise};
use super::model::ANCHORS;
use super::noise::Scene;
use super::synth::Ready;
use crate::base::maths::{TAU, cos, pow, sin};
use crate::base::problem::Problem;
use crate::base::statistics::{Sums, correlation, median, percentile};
use crate::layers::mesh::drawing::{Given, Looking};
use crate::layers::parts::measures::{Figures, Measures, Moved};
use crate::layers::space::eye::Eye;
use crate::layers::space::raster::NONE;

/// How the camera moves.
const MOVES: [&str; 3] = ["pan", "turn", "zoom"];
/// A step of a pan, in pixels.
const PAN_PX: f64 = 4.0;
/// What a step of a zoom divides the distance by.
const ZOOM: f64 = 1.02;
/// A point that comes nearer to the border of the frame than this is not compared, in pixels.
const BORDER_PX: f64 = 2.0;
/// A point is hidden where the depth differs by more than this share.
const HIDDEN: f64 = 0.02;
/// The side of the windows in which slides are sought, in pixels; each begins half a side after the one before.
const WINDOW: usize = 32;
/// How far slides are sought, in pixels.
const FARTHEST: isize = 6;
/// The side of the windows in which frequencies are measured: in spacings, and the least in pixels.
const FLAT: (f64, f64) = (6.0, 24.0);
/// The fewest windows of which flatness is told.
const FEWEST: usize = 4;

/// The measures of strokes.
///
/// # Errors
/// If no mark is made of a noise; the path is relative to the strokes.
pub fn measure(ready: &Ready, looking: Looking) -> Result<Option<Measures>, Problem> {
    let Looking { eye, middle, steps, see, step } = looking;
    let Some(of) = main_noise(&ready.strokes).map(str::to_owned) else {
        return Err(Problem::error("/marks", "no mark is made of a noise: there is nothing to measure"));
    };
    let Some(middle) = middle else { return Ok(None) };
    let ways = ways(ready);
    let mut done = 0;
    let mut flatness = Vec::new();
    let mut draw = |eye| {
        let mut frame = None;
        see(eye, &mut |given| {
            if !step(done, frames(steps)) {
                return;
            }
            if done == 0 {
                flatness = ways.iter().map(|ready| flatness_of(ready, given)).collect();
            }
            done += 1;
            frame = Some(Frame::new(&ways, given));
        });
        frame
    };
    let Some(mut found) = moves((&eye, middle), steps, &mut draw) else { return Ok(None) };
    found.iter_mut().zip(flatness).for_each(|((_, figures), flatness)| figures.flatness = flatness);
    Ok(step(done, done).then_some(Measures { of, ways: found }))
}

/// Strokes by each anchor.
fn ways(ready: &Ready) -> Vec<Ready> {
    ANCHORS.map(|(anchor, _)| Ready { strokes: ready.strokes.anchored(anchor), ..ready.clone() }).to_vec()
}

/// How many frames a measure of so many steps draws.
fn frames(steps: u32) -> u64 {
    1 + MOVES.len() as u64 * u64::from(steps)
}

/// What the camera sees, and a drawing of it by each anchor.
pub struct Frame {
    eye: Eye,
    size_px: (usize, usize),
    inverse: Vec<f64>,
    own: Vec<bool>,
    drawings: Vec<Vec<f32>>,
}

impl Frame {
    /// Draws it.
    pub fn new(ways: &[Ready], given: &Given) -> Frame {
        Frame::of(given, ways.iter().map(|ready| grey(ready, given)).collect())
    }

    /// With these drawings.
    pub fn of(given: &Given, drawings: Vec<Vec<f32>>) -> Frame {
        let own = given.triangle.iter().map(|triangle| *triangle != NONE).collect();
        Frame { eye: given.eye, size_px: given.size_px, inverse: given.inverse.clone(), own, drawings }
    }

    /// What each pixel shows of a drawing, and what is drawn there in the frame `to`, where it is seen again.
    pub fn pairs(&self, to: &Frame, way: usize) -> Vec<(f32, f32)> {
        let read = |place: Option<DVec2>| place.map(|place| read(&to.drawings[way], to.size_px, place));
        let again = self.motion(to).into_iter().map(read);
        self.drawings[way].iter().zip(again).filter_map(|(own, again)| Some((*own, again?))).collect()
    }

    /// Where in the frame `to` what each pixel shows is seen again.
    fn motion(&self, to: &Frame) -> Vec<Option<DVec2>> {
        let (width, height) = self.size_px;
        let land = |i: usize| {
            let at = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let seen = to.eye.seen(self.eye.ray_in_world(at).at_depth(1.0 / self.inverse[i]));
            let place = (seen.z < 0.0).then(|| to.eye.project(seen))?;
            let inside = |v: f64, side: usize| v >= BORDER_PX && v <= side as f64 - BORDER_PX;
            if !inside(place.x, width) || !inside(place.y, height) {
                return None;
            }
            let (x, y) = (place.x as usize, place.y as usize);
            let mut around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| y * width + x));
            let depth = 1.0 / to.inverse[y * width + x];
            let is_there = around.all(|i| to.own[i]) && (depth + seen.z).abs() <= HIDDEN * depth;
            is_there.then_some(place)
        };
        (0..width * height).into_par_iter().map(|i| self.own[i].then(|| land(i)).flatten()).collect()
    }
}

/// The camera after so many steps of a move about the middle of the layer.
fn moved(eye: &Eye, middle: DVec3, name: &str, steps: u32) -> Eye {
    let k = f64::from(steps);
    let back = eye.turn.transpose();
    let away = eye.position - middle;
    match name {
        "pan" => {
            let depth = -eye.seen(middle).z;
            Eye { position: eye.position - back * DVec3::X * (k * PAN_PX * depth / eye.focal_px), ..*eye }
        }
        "turn" => {
            let (axis, angle) = (back * DVec3::Y, k.to_radians());
            let turned =
                |v: DVec3| v * cos(angle) + axis.cross(v) * sin(angle) + axis * axis.dot(v) * (1.0 - cos(angle));
            let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|own| turned(back * own));
            let turn = DMat3::from_cols(axes[0], axes[1], axes[2]).transpose();
            Eye { position: middle + turned(away), turn, ..*eye }
        }
        _ => Eye { position: middle + away / pow(ZOOM, k), ..*eye },
    }
}

/// Measures the moves of each anchor. `draw` makes the frame that a camera sees, or `None` if it is cancelled.
fn moves(
    (eye, middle): (&Eye, DVec3),
    steps: u32,
    draw: &mut dyn FnMut(Eye) -> Option<Frame>,
) -> Option<Vec<(&'static str, Figures)>> {
    let mut found = ANCHORS.map(|(_, name)| (name, Figures::default())).to_vec();
    let first = draw(*eye)?;
    for name in MOVES {
        let mut all = vec![Compared::default(); ANCHORS.len()];
        let mut before: Option<Frame> = None;
        for k in 1..=steps {
            let after = draw(moved(eye, middle, name, k))?;
            let from = before.as_ref().unwrap_or(&first);
            let motion = from.motion(&after);
            let drawings = from.drawings.iter().zip(&after.drawings);
            all.iter_mut().zip(drawings).for_each(|(all, drawings)| all.take(drawings, &motion, from.size_px));
            before = Some(after);
        }
        for ((_, figures), compared) in found.iter_mut().zip(&mut all) {
            figures.moves.push((name, compared.figures()));
        }
    }
    Some(found)
}

/// What was found in all steps of a move.
#[derive(Clone, Debug, Default)]
struct Compared {
    coherences: Vec<f64>,
    slides_px: Vec<f64>,
    continuities: Vec<f64>,
}

impl Compared {
    /// Compares a drawing with the next.
    fn take(&mut self, (own, next): (&Vec<f32>, &Vec<f32>), motion: &[Option<DVec2>], size_px: (usize, usize)) {
        let (width, height) = size_px;
        let again: Vec<f32> =
            motion.par_iter().map(|place| place.map_or(f32::NAN, |place| read(next, size_px, place))).collect();
        let pairs = own.iter().copied().zip(again.iter().copied()).filter(|(_, again)| !again.is_nan());
        self.coherences.extend(correlation(pairs));
        let corners: Vec<(usize, usize)> = corners((width, height), WINDOW, WINDOW / 2).collect();
        let found = corners.into_par_iter().filter_map(|corner| slide(own, &again, size_px, corner));
        let found: Vec<(f64, f64)> = found.collect();
        self.slides_px.extend(found.iter().map(|(length, _)| length));
        self.continuities.extend(found.iter().map(|(_, best)| best));
    }

    fn figures(&mut self) -> Moved {
        let count = self.coherences.len() as f64;
        Moved {
            coherence: (count > 0.0).then(|| self.coherences.iter().sum::<f64>() / count),
            slide: median(&mut self.slides_px),
            continuity: median(&mut self.continuities),
        }
    }
}

/// The corners of square windows of a frame.
fn corners((width, height): (usize, usize), side: usize, apart: usize) -> impl Iterator<Item = (usize, usize)> {
    let starts = move |length: usize| (0..(length + 1).saturating_sub(side)).step_by(apart.max(1));
    starts(height).flat_map(move |y| starts(width).map(move |x| (x, y)))
}

/// In a window, how far what is seen again correlates best elsewhere, in pixels, and how well.
fn slide(own: &[f32], again: &[f32], (width, height): (usize, usize), (x, y): (usize, usize)) -> Option<(f64, f64)> {
    let pixels = (y..y + WINDOW).flat_map(|y| (x..x + WINDOW).map(move |x| (x, y)));
    let seen: Vec<(usize, usize)> = pixels.filter(|(x, y)| !again[y * width + x].is_nan()).collect();
    let all = WINDOW * WINDOW;
    if 4 * seen.len() < 3 * all {
        return None;
    }
    let at = |across: isize, down: isize| {
        let mut sums = Sums::default();
        for &(x, y) in &seen {
            let (Some(to_x), Some(to_y)) = (x.checked_add_signed(across), y.checked_add_signed(down)) else { continue };
            if to_x < width && to_y < height && !again[to_y * width + to_x].is_nan() {
                sums.add(own[y * width + x], again[to_y * width + to_x]);
            }
        }
        if 2 * sums.count < all { None } else { sums.correlation() }
    };
    const SIDE: usize = 2 * FARTHEST as usize + 1;
    let shift = |i: usize| (i % SIDE) as isize - FARTHEST;
    let found: Vec<Option<f64>> = (0..SIDE * SIDE).map(|i| at(shift(i), shift(i / SIDE))).collect();
    let ranked = found.iter().enumerate().filter_map(|(i, found)| Some((i, (*found)?)));
    let (best, value) = ranked.max_by(|(i, a), (j, b)| a.total_cmp(b).then(j.cmp(i)))?;
    let (column, row) = (best % SIDE, best / SIDE);
    // The top of a parabola through the peak and its neighbors.
    let top = |before: Option<f64>, after: Option<f64>| {
        let (before, after) = before.zip(after)?;
        let bend = before - 2.0 * value + after;
        (bend < 0.0).then(|| ((before - after) / (2.0 * bend)).clamp(-0.5, 0.5))
    };
    let beside = |i: Option<usize>| i.and_then(|i| found[i]);
    let inner = |k: usize| k > 0 && k + 1 < SIDE;
    let across = inner(column).then(|| top(beside(best.checked_sub(1)), beside(Some(best + 1)))).flatten();
    let down = inner(row).then(|| top(beside(best.checked_sub(SIDE)), beside(Some(best + SIDE)))).flatten();
    let away = |k: isize, more: Option<f64>| k as f64 + more.unwrap_or(0.0);
    Some((DVec2::new(away(shift(best), across), away(shift(row), down)).length(), value))
}

/// A drawing between its pixels: Catmull-Rom, at a place at least two pixels inside.
fn read(drawing: &[f32], (width, height): (usize, usize), place: DVec2) -> f32 {
    let at = place - 0.5;
    let (left, top) = (at.x.floor(), at.y.floor());
    let weights = |t: f64| {
        [
            ((2.0 - t) * t - 1.0) * t / 2.0,
            ((3.0 * t - 5.0) * t * t + 2.0) / 2.0,
            ((4.0 - 3.0 * t) * t + 1.0) * t / 2.0,
            (t - 1.0) * t * t / 2.0,
        ]
    };
    let (across, down) = (weights(at.x - left), weights(at.y - top));
    let cell = |x: f64, y: f64| {
        let within = |v: f64, side: usize| v.clamp(0.0, (side - 1) as f64) as usize;
        f64::from(drawing[within(y, height) * width + within(x, width)])
    };
    let row = |y: f64| (0..4).map(|k| across[k] * cell(left + k as f64 - 1.0, y)).sum::<f64>();
    (0..4).map(|k| down[k] * row(top + k as f64 - 1.0)).sum::<f64>() as f32
}

/// The flatness of the main noise.
pub fn flatness_of(ready: &Ready, given: &Given) -> Option<f64> {
    let wanted = ready.strokes.noises.get(main_noise(&ready.strokes)?)?;
    let scene = Scene::new(ready, given);
    let own: Vec<bool> = given.triangle.iter().map(|triangle| *triangle != NONE).collect();
    flatness(&scene.noise(wanted).value, &own, given.size_px, scene.spacing_px(wanted))
}

/// How equal the frequency of a noise is over the layer: the lowest over the highest, but for a tenth of each.
fn flatness(noise: &[f32], own: &[bool], size_px: (usize, usize), spacing_px: f64) -> Option<f64> {
    let width = size_px.0;
    let side = (FLAT.0 * spacing_px).max(FLAT.1).round() as usize;
    let corners: Vec<(usize, usize)> = corners(size_px, side, side / 2).collect();
    let frequency = |(x, y): (usize, usize)| {
        let pixels = (y..y + side).flat_map(|y| (x..x + side).map(move |x| y * width + x));
        let seen: Vec<usize> = pixels.filter(|i| own[*i]).collect();
        if 10 * seen.len() < 9 * side * side {
            return None;
        }
        let values = seen.iter().map(|i| f64::from(noise[*i]));
        let mean = values.clone().sum::<f64>() / seen.len() as f64;
        let variance = values.map(|value| (value - mean) * (value - mean)).sum::<f64>() / seen.len() as f64;
        let slope = |i: usize, step: usize| {
            let (before, after) = (i.checked_sub(step)?, i + step);
            let inside = after < own.len() && own[before] && own[after];
            inside.then(|| f64::from(noise[after] - noise[before]) / 2.0)
        };
        let squares = seen.iter().filter_map(|i| slope(*i, 1).zip(slope(*i, width)));
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), (x, y)| (sum + x * x + y * y, count + 1.0));
        (variance > 0.0 && count > 0.0).then(|| (sum / count / variance).sqrt() / TAU)
    };
    let mut found: Vec<f64> = corners.into_par_iter().filter_map(frequency).collect();
    if found.len() < FEWEST {
        return None;
    }
    let (low, high) = (percentile(&mut found, 0.1)?, percentile(&mut found, 0.9)?);
    (high > 0.0).then(|| low / high)
}
