//! Moves the picture's cursor to something near it: a point, a line, a whole number, an even angle.

use kurbo::{Point, Vec2};

use super::command::{Call, Command, Done, command};
use crate::base::maths;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Shape, View};
use crate::render::overlay;
use crate::tui::document::{places, tree};
use crate::tui::events::Effect;
use crate::tui::layout::picture;
use crate::tui::state::{State, place};
use crate::tui::text::numbers::short;

pub const COMMANDS: &[Command] = &[command(
    "snap",
    "point|line|whole|angle",
    "Move the picture's cursor to the nearest point or line, to whole numbers, or to a multiple of 15° about the selected point",
    snap,
)];

/// Angles that are snapped to.
const STEP: f64 = 15.0;

fn snap(state: &mut State, call: &Call) -> Done {
    let here = state.picture.cursor;
    let to = match call.text {
        "point" => nearest(here, points(state).into_iter()).ok_or("there is no point in this layer")?,
        "line" => nearest(here, lines(state).into_iter().map(|(a, b)| closest(here, a, b)))
            .ok_or("there is no line in this layer")?,
        "whole" => here.round(),
        _ => {
            let about = place::selected(state).ok_or("angles are those about the selected point: select one (w, b)")?;
            turned(here, about)
        }
    };
    state.picture.step(to - here);
    picture::settle(state);
    state.ask(Effect::Show);
    let at = state.picture.cursor;
    state.say(format!("at {}, {}", short(at.x), short(at.y)));
    Ok(())
}

fn nearest(here: Point, all: impl Iterator<Item = Point>) -> Option<Point> {
    all.min_by(|a, b| a.distance_squared(here).total_cmp(&b.distance_squared(here)))
}

/// All places of the layer that is shown, and of the shapes of the scene, but for the selected one.
fn points(state: &State) -> Vec<Point> {
    let layer = format!("/layers/{}", tree::layer_of(&state.cursor.node).unwrap_or(0));
    let own = state.focused();
    let all = places::list(state.document()).into_iter().map(|listed| listed.pointer);
    let may_be = |at: Pointer| (at.is_within(&layer) || at.is_within("/shapes")) && !at.is_within(&own);
    let all = all.filter(|at| may_be(Pointer(at)));
    all.filter_map(|at| place::of(state.document(), &at)).collect()
}

/// The straight pieces of all lines of the layer that is shown.
fn lines(state: &State) -> Vec<(Point, Point)> {
    let layer = tree::layer_of(&state.cursor.node).unwrap_or(0);
    let Some(layer) = state.document().scene().layers.get(layer) else { return Vec::new() };
    let names: Vec<&'static str> = overlay::overlays().map(|overlay| overlay.name).collect();
    let marks = layer.technique().marks(&View::of(&names));
    let of = |shape| match shape {
        Shape::Line { mut points, closed } => {
            points.extend(closed.then(|| points.first().copied()).flatten());
            points.windows(2).map(|ends| (ends[0], ends[1])).collect::<Vec<_>>()
        }
        Shape::Fill(_) | Shape::Cell(..) | Shape::Dot(_) | Shape::Arrow(..) | Shape::Label(..) => Vec::new(),
    };
    marks.into_iter().flat_map(|mark| of(mark.shape)).collect()
}

/// The point between two that is nearest.
fn closest(here: Point, a: Point, b: Point) -> Point {
    let way = b - a;
    let along = if way == Vec2::ZERO { 0.0 } else { ((here - a).dot(way) / way.hypot2()).clamp(0.0, 1.0) };
    a + way * along
}

/// The point as far from another in the nearest even direction.
fn turned(here: Point, about: Point) -> Point {
    let way = here - about;
    let degrees = (maths::atan2(way.y, way.x).to_degrees() / STEP).round() * STEP;
    let (sin, cos) = (maths::sin(degrees.to_radians()), maths::cos(degrees.to_radians()));
    about + Vec2::new(cos, sin) * way.hypot()
}
