//! What can be wrong with strokes: on their own, and with the mesh and the images that they name. Paths are relative to
//! the strokes.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::Value;

use super::force::Strokes;
use super::marks::Set;
use super::model::{Along, Anchor, By, Direction, Ground, Mark, Noise, Vary};
use crate::base::color;
use crate::base::pointer::Pointer;
use crate::base::problem::{Problem, nearest, quoted};
use crate::layers::check as rules;

/// The least and the greatest radius of a wave, in pixels.
const RADII_PX: [f64; 2] = [1.0, 1000.0];
/// The most noises.
const MOST_NOISES: usize = 32;
/// The most waves of one noise in a frame.
const MOST_WAVES: f64 = (1 << 24) as f64;
/// So many waves there are for each that is wanted, since they come one by one.
const COMING: f64 = 1.63;

/// The checks beyond shape.
pub fn problems(strokes: &Strokes) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (path, text) in [("/ink", &strokes.ink), ("/paper", &strokes.paper)] {
        problems.extend((!is_color(text)).then(|| no_color(path, text, "as #20304a")));
    }
    let tone = &strokes.tone;
    if tone.dark >= tone.light {
        let message = format!("dark is not below light ({} and {})", tone.dark, tone.light);
        problems.push(Problem::error("/tone/dark", message).hint("make it smaller"));
    }
    if strokes.noises.len() > MOST_NOISES {
        let message = format!("there are {} noises ({MOST_NOISES} at most)", strokes.noises.len());
        problems.push(Problem::error("/noises", message).hint("remove some"));
    }
    problems.extend(of_direction(&strokes.direction, "/direction"));
    problems.extend(strokes.vary.iter().flat_map(|vary| of_vary(vary, "/vary")));
    for (name, noise) in &strokes.noises {
        let path = Pointer("/noises").join(name);
        problems.extend(radius(strokes, noise, &path));
        problems.extend(noise.direction.iter().flat_map(|own| of_direction(own, &format!("{path}/direction"))));
        problems.extend(noise.vary.iter().flat_map(|own| of_vary(own, &format!("{path}/vary"))));
    }
    let written = strokes.written.get("marks").and_then(Value::as_array).into_iter().flatten();
    let names = written.enumerate().filter_map(|(i, mark)| Some((format!("/marks/{i}/name"), mark["name"].as_str()?)));
    problems.extend(rules::names(names));
    problems.extend(nothing_left_out(strokes));
    problems.extend(strokes.marks.iter().flat_map(|mark| of_mark(strokes, mark)));
    problems.extend(unused(strokes));
    problems.extend(nothing(strokes));
    problems
}

/// Warnings for noises that are written and that no mark is made of.
fn unused(strokes: &Strokes) -> Vec<Problem> {
    let sets: Vec<Set> = strokes.marks.iter().filter_map(Set::of).collect();
    let used: Vec<&str> = sets.iter().flat_map(Set::noises).map(|(_, name)| name).collect();
    let written = strokes.written.get("noises").and_then(Value::as_object).into_iter().flatten();
    let unused = written.filter(|(name, noise)| !noise.is_null() && !used.contains(&name.as_str()));
    let problem = |name: &String| {
        let message = format!("no mark is made of the noise {}", quoted(name));
        Problem::warning(Pointer("/noises").join(name), message).hint("name it as the noise of a mark, or remove it")
    };
    unused.map(|(name, _)| problem(name)).collect()
}

fn is_color(text: &str) -> bool {
    text.len() == 7 && color::parse(text).is_some()
}

fn no_color(path: &str, text: &str, hint: &str) -> Problem {
    Problem::error(path, format!("{} is no color", quoted(text))).hint(hint)
}

fn of_direction(direction: &Direction, path: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    if direction.along == Along::Axis && DVec3::from(direction.axis).try_normalize().is_none() {
        let problem = Problem::error(format!("{path}/axis"), "the axis has no direction");
        problems.push(problem.hint("make it [0, 1, 0] for strokes that run up and down"));
    }
    if direction.along == Along::Image && direction.image.is_empty() {
        let problem = Problem::error(format!("{path}/image"), "strokes along an image name none");
        problems.push(problem.hint("name an image of the scene; along curvature needs none"));
    }
    problems
}

fn of_vary(vary: &Vary, path: &str) -> Vec<Problem> {
    let missing = vary.by == By::Image && vary.image.is_empty();
    let problem = || {
        let problem = Problem::error(format!("{path}/image"), "strokes that vary by an image name none");
        problem.hint("name an image of the scene; by curvature needs none")
    };
    missing.then(problem).into_iter().collect()
}

/// The factors of sizes of a noise.
fn factors(strokes: &Strokes, noise: &Noise) -> [f64; 2] {
    let vary = noise.vary.as_ref().or(strokes.vary.as_ref());
    let vary = vary.filter(|_| noise.anchor.unwrap_or(strokes.anchor) == Anchor::Surface);
    vary.map_or([1.0; 2], |vary| [vary.low.min(vary.high), vary.low.max(vary.high)])
}

fn radius(strokes: &Strokes, noise: &Noise, path: &str) -> Option<Problem> {
    let each = noise.regularity * strokes.size;
    let [low, high] = factors(strokes, noise);
    let near = if noise.spacing * each * low < RADII_PX[0] {
        (noise.spacing * each * low, RADII_PX[0] / each / low)
    } else if noise.spacing * each * high > RADII_PX[1] {
        (noise.spacing * each * high, RADII_PX[1] / each / high)
    } else {
        return None;
    };
    let message = format!(
        "spacing {} times regularity {} times size {} gives waves of radius {:.3} px ({} to {} px are drawn)",
        noise.spacing, noise.regularity, strokes.size, near.0, RADII_PX[0], RADII_PX[1],
    );
    Some(Problem::error(format!("{path}/spacing"), message).hint(format!("the nearest spacing is {:.4}", near.1)))
}

fn of_mark(strokes: &Strokes, mark: &Mark) -> Vec<Problem> {
    let path = strokes.place_of(&mark.name);
    let within = |field: &str| if path == "/marks" { path.clone() } else { format!("{path}{field}") };
    let name = quoted(&mark.name);
    let Some(set) = Set::of(mark) else {
        let problem = Problem::error(within(""), format!("the mark {name} has no kind, and the style has no {name}"));
        return vec![problem.hint("give it a kind: ink, pigment, relief or outline")];
    };
    let mut problems = Vec::new();
    for (field, noise) in set.noises().filter(|(_, noise)| !strokes.noises.contains_key(*noise)) {
        let message = match noise {
            "" => format!("the mark {name} names no noise"),
            noise => format!("the mark {name} is made of the noise {}, which is not there", quoted(noise)),
        };
        let known = nearest(noise, strokes.noises.keys().map(String::as_str)).unwrap_or("add it to noises".into());
        let taken_out = strokes.written.get("noises").and_then(|own| own.get(noise)).is_some_and(Value::is_null);
        let (at, known) = match taken_out {
            true => (Pointer("/noises").join(noise), format!("{known}: give the mark one of them, or \"off\": true")),
            false => (within(field), known),
        };
        problems.push(Problem::error(at, message).hint(known));
    }
    if let Set::Ink(super::marks::Ink { color, .. }) | Set::Outline(super::marks::Outline { color, .. }) = &set
        && !["ink", "paper", "scene"].contains(&color.as_str())
        && !is_color(color)
    {
        problems.push(no_color(&within("/color"), color, "ink, paper, scene, or as #20304a"));
    }
    if let Set::Pigment(pigment) = &set
        && pigment.strength > 1.0
    {
        let message = format!("{} is too large: the strength of pigment is 0 to 1", pigment.strength);
        problems.push(Problem::error(within("/strength"), message));
    }
    problems
}

/// Warnings for marks that are to be left out and are not there.
fn nothing_left_out(strokes: &Strokes) -> Vec<Problem> {
    let table = strokes.style.table();
    let of = |table: &Value| table["marks"].as_array().cloned().unwrap_or_default();
    let (written, styles) = (of(&strokes.written), of(&table));
    let known = || styles.iter().filter_map(|mark| mark["name"].as_str());
    let off = written.iter().enumerate().filter(|(_, mark)| mark["off"] == true);
    let named = off.filter_map(|(i, mark)| Some((i, mark["name"].as_str()?)));
    let unknown = named.filter(|(_, name)| !known().any(|own| own == *name));
    let problem = |(i, name): (usize, &str)| {
        let message = format!("the style has no mark {} that could be left out", quoted(name));
        let problem = Problem::warning(format!("/marks/{i}/name"), message);
        problem.hint(nearest(name, known()).unwrap_or_else(|| "remove it".into()))
    };
    unknown.filter(|(i, _)| written[*i].get("kind").is_none()).map(problem).collect()
}

/// A warning if nothing will show.
fn nothing(strokes: &Strokes) -> Option<Problem> {
    let inks = |mark: &Mark| matches!(Set::of(mark), Some(Set::Ink(_) | Set::Outline(_)));
    let what = if strokes.marks.is_empty() {
        "there are no marks"
    } else if strokes.ground == Ground::Clear && !strokes.marks.iter().any(inks) {
        "the ground is clear, and no mark is ink or an outline"
    } else {
        return None;
    };
    Some(Problem::warning("/marks", format!("nothing will show: {what}")))
}

/// What names an image, with where, and whether it is a direction.
pub fn images(strokes: &Strokes) -> Vec<(String, &str)> {
    let direction =
        |path: String, direction: &'_ Direction| (direction.along == Along::Image).then_some(path + "/direction/image");
    let vary = |path: String, vary: &'_ Vary| (vary.by == By::Image).then_some(path + "/vary/image");
    let mut all = Vec::new();
    let own = [(String::new(), Some(&strokes.direction), strokes.vary.as_ref())].into_iter();
    let noises = strokes.noises.iter();
    let noises =
        noises.map(|(name, noise)| (Pointer("/noises").join(name), noise.direction.as_ref(), noise.vary.as_ref()));
    for (path, along, by) in own.chain(noises) {
        all.extend(along.and_then(|along| Some((direction(path.clone(), along)?, along.image.as_str()))));
        all.extend(by.and_then(|by| Some((vary(path, by)?, by.image.as_str()))));
    }
    all.retain(|(_, image)| !image.is_empty());
    all
}

/// The problem with images on a mesh without texture coordinates at a triangle.
pub fn without_uv(strokes: &Strokes, mesh: &str, triangle: usize) -> Option<Problem> {
    let (path, image) = images(strokes).into_iter().next()?;
    let message = format!(
        "the image {} needs texture coordinates, and the mesh \"{mesh}\" has none at triangle {triangle} (from 0)",
        quoted(image)
    );
    Some(Problem::error(path, message).hint("unwrap the mesh; curvature needs none"))
}

/// The problem with noises that have too many waves in a frame of this size, or, as a texture, on a surface of this area
/// in pixels.
pub fn too_many(strokes: &Strokes, (width, height): (usize, usize), surface_px: f64) -> Option<Problem> {
    strokes.noises.iter().find_map(|(name, noise)| {
        let radius = noise.spacing * noise.regularity * strokes.size;
        let [low, high] = factors(strokes, noise).map(|factor| radius * factor);
        let area = match noise.anchor.unwrap_or(strokes.anchor) {
            Anchor::Texture => surface_px,
            Anchor::Surface | Anchor::Screen => (width as f64 + 2.0 * high) * (height as f64 + 2.0 * high),
        };
        let count = COMING * noise.overlap / (PI * low * low) * area;
        (count > MOST_WAVES).then(|| {
            let message = format!("the noise {} has {count:.0} waves in a frame, at most {MOST_WAVES}", quoted(name));
            Problem::error(Pointer("/noises").join(name), message).hint("raise spacing or lower overlap")
        })
    })
}
