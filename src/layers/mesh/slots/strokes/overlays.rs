//! What explains the strokes of a mesh: the impulses of a noise, which way they run, and where outlines are drawn.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use kurbo::Point;

use super::draw::{main_noise, sheet_of};
use super::impulse::Impulse;
use super::marks::{Outline, Set};
use super::noise::Scene;
use super::rim::Rules;
use super::synth::Ready;
use crate::base::maths::{TAU, cos, sin};
use crate::base::pointer::Pointer;
use crate::layers::mesh::drawing::Given;
use crate::layers::parts::marks::{Dot, Look, Mark, Overlay, Shape, View, When};
use crate::layers::space::raster::NONE;

const IMPULSES: &str = "view-impulses";
const DIRECTIONS: &str = "view-directions";
const RIMS: &str = "view-rims";

/// Every overlay.
pub static OVERLAYS: &[Overlay] = &[
    Overlay::new(
        IMPULSES,
        "I",
        "Impulses of a noise of strokes, the stronger the more they count, and kernels",
        When::EveryFrame,
    ),
    Overlay::new(DIRECTIONS, "K", "Which way strokes run", When::EveryFrame),
    Overlay::new(RIMS, "O", "Pixels at which outlines of strokes are drawn", When::EveryFrame),
];

/// An impulse.
static IMPULSE: Look = Look::new("impulse", 35, [255, 90, 60, 255], 0.0).dots(Dot::Disc, 1.3);
/// What the kernel of an impulse reaches.
static KERNEL: Look = Look::new("kernel", 34, [255, 90, 60, 110], 1.0).dashed(3.0, 3.0);
/// The way of a stroke.
static DIRECTION: Look = Look::new("stroke", 36, [40, 110, 240, 255], 1.4);
/// A pixel at a rim.
static RIM: Look = Look::new("rim", 33, [20, 170, 90, 190], 0.0).dots(Dot::Square, 1.0).stroke("▒");

/// Every look, from bottom to top.
pub static LOOKS: &[&Look] = &[&RIM, &KERNEL, &IMPULSE, &DIRECTION];

/// At most so many impulses are drawn, and so many of their kernels; of more, every n-th.
const MOST: usize = 20_000;
const MOST_KERNELS: usize = 150;
/// The corners of a circle.
const CORNERS: usize = 24;

/// What is to be shown of strokes, if something is.
pub fn is_shown(view: &View) -> bool {
    OVERLAYS.iter().any(|overlay| view.shows(overlay.name))
}

/// The marks over a frame: of the noise that is selected, or of that of the first mark.
pub fn marks(ready: &Ready, given: &Given, view: &View) -> Vec<Mark> {
    let scene = Scene::new(ready, given);
    let mut marks = if view.shows(RIMS) { rims(&scene) } else { Vec::new() };
    if !view.shows(IMPULSES) && !view.shows(DIRECTIONS) {
        return marks;
    }
    let Some(name) = noise(ready, view) else { return marks };
    let of_noise = scene.impulses(&ready.strokes.noises[name]).unwrap_or_default();
    let seen: Vec<Impulse> = of_noise.into_iter().filter(|impulse| is_seen(given, impulse)).collect();
    let path = Pointer("/strokes/noises").join(name);
    if view.shows(IMPULSES) {
        marks.extend(dots(&seen, &path));
    }
    if view.shows(DIRECTIONS) {
        marks.extend(ways(&seen, &path, view.spacing_px));
    }
    marks
}

/// The noise that is selected; otherwise that of the first mark that has one.
fn noise<'a>(ready: &'a Ready, view: &View) -> Option<&'a str> {
    let selected = view.selection.as_deref().and_then(|path| Pointer(path).below("/strokes/noises"));
    let selected = selected.and_then(|below| Pointer(below).tokens().next());
    let noises = &ready.strokes.noises;
    let selected = selected.and_then(|name| noises.keys().find(|known| **known == name));
    selected.map(String::as_str).or_else(|| main_noise(&ready.strokes))
}

/// Whether a pixel near an impulse, as far as its strokes are apart, shows the layer at its depth or nearer.
fn is_seen(given: &Given, impulse: &Impulse) -> bool {
    let (width, height) = given.size_px;
    let at = impulse.at.floor();
    if impulse.factor <= 0.0 || at.min_element() < 0.0 || at.x >= width as f64 || at.y >= height as f64 {
        return false;
    }
    let i = at.y as usize * width + at.x as usize;
    // Impulses of the frame have no depth of their own.
    let deep = impulse.plane == DVec3::ZERO || given.inverse[i] * impulse.depth < 1.0 + NEAR;
    given.triangle[i] != NONE && deep
}

/// How much nearer than an impulse the surface before it may be, as a share.
const NEAR: f64 = 0.02;

fn point(at: DVec2) -> Point {
    Point::new(at.x, at.y)
}

fn dots(seen: &[Impulse], path: &str) -> Vec<Mark> {
    let step = seen.len().div_ceil(MOST).max(1);
    let dot = |impulse: &Impulse| Mark {
        strength: impulse.factor.clamp(0.15, 1.0) as f32,
        ..Mark::new(&IMPULSE, path, Shape::Dot(point(impulse.at)))
    };
    let circle = |impulse: &Impulse| {
        let corner = |i: usize| {
            let angle = TAU * i as f64 / CORNERS as f64;
            point(impulse.at + impulse.radius_px * DVec2::new(cos(angle), sin(angle)))
        };
        Mark::new(&KERNEL, path, Shape::Line { points: (0..CORNERS).map(corner).collect(), closed: true })
    };
    let kernels = seen.iter().step_by(seen.len().div_ceil(MOST_KERNELS).max(1)).map(circle);
    let mut marks: Vec<Mark> = kernels.chain(seen.iter().step_by(step).map(dot)).collect();
    if let Some(first) = seen.first().filter(|_| step > 1) {
        marks.push(Mark::new(&IMPULSE, path, Shape::Label(point(first.at), format!("1 of {step} impulses"))));
    }
    marks
}

/// A dash along the stroke of one impulse in each square of this side.
fn ways(seen: &[Impulse], path: &str, side_px: f64) -> Vec<Mark> {
    let mut taken = BTreeSet::new();
    let mut dash = |impulse: &Impulse| {
        let square = (impulse.at / side_px.max(1.0)).floor();
        let half = DVec2::new(cos(impulse.angle), sin(impulse.angle)) * 0.35 * side_px.max(4.0);
        let points = vec![point(impulse.at - half), point(impulse.at + half)];
        let is_first = taken.insert((square.x as i64, square.y as i64));
        is_first.then(|| Mark::new(&DIRECTION, path, Shape::Line { points, closed: false }))
    };
    seen.iter().filter_map(&mut dash).collect()
}

/// The pixels at a rim of any outline.
fn rims(scene: &Scene) -> Vec<Mark> {
    let sets = scene.ready.strokes.marks.iter().filter_map(Set::of);
    let outlines: Vec<Outline> =
        sets.filter_map(|set| if let Set::Outline(outline) = set { Some(outline) } else { None }).collect();
    let rules = |outline: &Outline| Rules {
        step_px: outline.step * scene.scale,
        crease: outline.creases.map(|degrees| cos(degrees.to_radians())),
    };
    let (given, width) = (scene.given, scene.given.size_px.0.max(1));
    let all = sheet_of(scene, (&given.shaded, &given.light), &Default::default(), |sheet| {
        outlines.iter().map(|outline| sheet.pixels.rim(&rules(outline))).collect::<Vec<_>>()
    });
    let is_rim = |i: &usize| all.iter().any(|rim| rim[*i]);
    let cell = |i: usize| {
        let at = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        Mark::new(&RIM, "/strokes/marks", Shape::Cell(at, 1.0))
    };
    (0..given.triangle.len()).filter(is_rim).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn impulse(x: f64, y: f64, factor: f64, angle: f64) -> Impulse {
        Impulse {
            of: [0; 3],
            at: DVec2::new(x, y),
            depth: 1.0,
            factor,
            phase: 0.0,
            angle,
            sure: 1.0,
            radius_px: 6.0,
            spacing_px: 3.0,
            plane: DVec3::ZERO,
        }
    }

    #[test]
    fn an_impulse_is_a_dot_as_strong_as_it_counts_in_the_circle_of_its_kernel() {
        let marks = dots(&[impulse(10.0, 20.0, 0.5, 0.0), impulse(30.0, 20.0, 0.0, 0.0)], "/strokes/noises/a");
        let [circle, _, dot, faint] = &marks[..] else { panic!("{marks:?}") };
        assert_eq!((dot.shape.clone(), dot.strength), (Shape::Dot(Point::new(10.0, 20.0)), 0.5));
        assert_eq!((faint.strength, &*faint.path), (0.15, "/strokes/noises/a"));
        let Shape::Line { points, closed: true } = &circle.shape else { panic!("{circle:?}") };
        assert!(points.iter().all(|corner| (corner.distance(Point::new(10.0, 20.0)) - 6.0).abs() < 1e-9));
    }

    #[test]
    fn too_many_impulses_are_thinned_and_a_label_says_so() {
        let many = vec![impulse(1.0, 1.0, 1.0, 0.0); 2 * MOST + 1];
        let marks = dots(&many, "");
        let count = |is: fn(&Shape) -> bool| marks.iter().filter(|mark| is(&mark.shape)).count();
        assert!(count(|shape| matches!(shape, Shape::Dot(_))) <= MOST);
        assert!(count(|shape| matches!(shape, Shape::Line { .. })) <= MOST_KERNELS);
        assert!(marks.iter().any(|mark| matches!(&mark.shape, Shape::Label(_, told) if told == "1 of 3 impulses")));
    }

    #[test]
    fn one_dash_in_each_square_runs_as_its_stroke() {
        let right = impulse(3.0, 3.0, 1.0, 0.0);
        let down = impulse(13.0, 3.0, 1.0, TAU / 4.0);
        let marks = ways(&[right, impulse(4.0, 4.0, 1.0, 1.0), down], "", 10.0);
        let along = |mark: &Mark| match &mark.shape {
            Shape::Line { points, .. } => points[1] - points[0],
            _ => kurbo::Vec2::ZERO,
        };
        let found: Vec<_> = marks.iter().map(along).collect();
        assert!(found.len() == 2 && found[0].y.abs() < 1e-9 && found[1].x.abs() < 1e-9, "{found:?}");
        assert!((found[0].x - 7.0).abs() < 1e-9 && (found[1].y - 7.0).abs() < 1e-9, "{found:?}");
    }
}
