//! The checks of a picture layer beyond its shape. Paths are relative to the layer.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use kurbo::{Point, Rect, Vec2};

use super::anchor::Anchor;
use super::interpolation::Interpolation;
use super::position::{Pieces, Position};
use super::{counts, needs, outline::Outline};
use super::{model::PictureLayer, model::Zone};
use crate::base::crossings::{emptiness, self_crossing};
use crate::base::geometry::FLATNESS_PX;
use crate::base::problem::{Kind, Problem, quoted};
use crate::layers::check as rules;
use crate::layers::parts::materials::{Materials, Of, Use, What};
use crate::layers::technique::Checked;

/// In zones with more anchors than this, coincident anchors are not looked for.
const MAX_COMPARED: f64 = 20_000.0;

/// Anchors closer to each other than this are at the same place (docs/folding.md, section 4).
const SAME_PX: f64 = 1e-6;

/// Anchors are nearly on one line if their spread across it is less than this share of their spread along it.
const NEARLY_STRAIGHT: f64 = 0.05;

/// Values of s beyond this are a mistake.
const MOST_S: f64 = 1e15;

/// At most this many coincident pairs per zone are reported.
const MAX_PAIRS: usize = 3;

/// Checks the layer on its own: the names of its zones, then each zone, unless it is the same as in the layer `before`.
pub fn check(layer: &PictureLayer, before: Option<(&PictureLayer, &Checked)>) -> Checked {
    let names = layer.zones.iter().enumerate();
    let names = rules::names(names.map(|(i, zone)| (format!("/zones/{i}/name"), zone.name.as_str())));
    let known = |i: usize, zone: &Zone| {
        let (before, checked) = before?;
        let alike = |&j: &usize| before.zones.get(j) == Some(zone);
        let at = Some(i).filter(alike).or_else(|| (0..before.zones.len()).find(alike))?;
        checked.0.get(at + 1).cloned()
    };
    let zones = layer.zones.iter().enumerate();
    let zones = zones.map(|(i, zone)| known(i, zone).unwrap_or_else(|| check_zone(zone).into()));
    Checked(std::iter::once(names.into()).chain(zones).collect())
}

/// Every problem that a check has found, its path relative to the layer.
pub fn problems(checked: &Checked) -> Vec<Problem> {
    let mut all = Vec::new();
    for (i, part) in checked.0.iter().enumerate() {
        match i.checked_sub(1) {
            None => all.extend(part.iter().cloned()),
            Some(zone) => all.extend(part.iter().map(|problem| problem.clone().under(&format!("/zones/{zone}")))),
        }
    }
    all
}

/// Problems that only show with the pictures and fields: an outline outside its picture, a mask or a field of another
/// size, a mask without alpha.
pub fn check_materials(layer: &PictureLayer, materials: &Materials) -> Vec<Problem> {
    let Some(own) = materials.pictures.get(&layer.image) else { return Vec::new() };
    let (width, height) = (own.width(), own.height());
    let picture = Rect::new(0.0, 0.0, width as f64, height as f64);
    let mut problems = Vec::new();
    for (i, zone) in layer.zones.iter().enumerate() {
        if !zone.outline.polygon().bounds().overlaps(picture) {
            let message =
                format!("the outline lies outside the picture ({width} x {height} px), so the zone shows nothing");
            problems.push(Problem::warning(format!("/zones/{i}/outline"), message));
        }
        for (j, tool) in zone.motion.iter().enumerate() {
            let Some(path) = tool.facts().file else { continue };
            let size = materials.fields.get(path).map(|field| (field.width(), field.height()));
            if let Some((w, h)) = size.filter(|&size| size != (width, height)) {
                let message = format!("the field is {w} x {h} px, the picture {width} x {height}");
                let hint = "a vector is for the pixel at its own place; beyond the field its edge goes on";
                problems.push(Problem::warning(format!("/zones/{i}/motion/{j}/path"), message).hint(hint));
            }
        }
    }
    for Use { at: path, of, what } in needs::uses(layer) {
        let (What::Mask { .. }, Of::Name(_, name)) = (what, of) else { continue };
        let Some(mask) = materials.pictures.get(name) else { continue };
        let (w, h) = (mask.width(), mask.height());
        if (w, h) != (width, height) {
            let message = format!("the mask {} is {w} x {h} px, the picture {width} x {height}", quoted(name));
            problems.push(Problem::error(path, message).hint("a mask is a copy of the picture, of its size"));
        } else if !mask.channels().have_alpha() {
            let message = format!("the mask {} has no alpha: its brightness is taken for it", quoted(name));
            problems.push(Problem::warning(path, message).hint("paint it black where pixels keep their own color"));
        }
    }
    problems
}

fn check_zone(zone: &Zone) -> Vec<Problem> {
    let mut problems = outline(&zone.outline, "/outline");
    let regions = zone.fold.iter().flat_map(|fold| fold.regions()).enumerate();
    problems.extend(regions.flat_map(|(i, region)| outline(region, &format!("/fold/regions/{i}"))));
    problems.extend(zone.interpolation.check().map(|problem| problem.under("/interpolation")));
    if zone.fold.as_ref().is_some_and(|fold| fold.mask().is_some()) && zone.sampler.is_some() {
        let hint = "remove either the fold or the sampler";
        problems.push(Problem::error("/fold", "a mask and a sampler image do not go together").hint(hint));
    }
    if zone.is_still() {
        let problem = Problem::warning("/motion", "nothing moves: no tool gives a jump vector").hint("add a point");
        problems.push(Problem { kind: Kind::Still, ..problem });
    }
    problems.extend(motion(zone));
    if problems.is_empty() {
        problems.extend(anchors_of(zone));
    }
    let position = position(&zone.position);
    let known = position.is_empty();
    problems.extend(position.into_iter().map(|problem| problem.under("/position")));
    problems.extend(clock(zone).filter(|_| known));
    problems
}

/// A problem if numbers that are finite by themselves give a time or an s that is not.
fn clock(zone: &Zone) -> Option<Problem> {
    let Zone { speed, shift, .. } = zone;
    if !(speed * (shift.abs() + 1.0)).is_finite() {
        let message = format!("{speed:?} passes at a shift of {shift:?} timelines give no finite time");
        return Some(Problem::error("/shift", message).hint("make the shift or the speed smaller"));
    }
    // NaN is not within bounds either.
    let within = |tau: f64| (-MOST_S..=MOST_S).contains(&zone.position.eval(tau));
    let tau = telling(&zone.position).into_iter().find(|&tau| !within(tau))?;
    let message = format!("at τ = {tau} the function leads out of all bounds");
    Some(Problem::error("/position", message).hint(format!("keep s between -{MOST_S:e} and {MOST_S:e}")))
}

/// An error if an outline encloses nothing, a warning if it crosses itself.
fn outline(outline: &Outline, path: &str) -> Vec<Problem> {
    // A shape that is not there is told as such.
    if matches!(outline, Outline::Shapes { nodes, .. } if nodes.is_empty()) {
        return Vec::new();
    }
    let polygon = outline.polygon();
    let drawn = outline.is_drawn();
    if let Some(what) = emptiness(&polygon) {
        let what = if drawn { what } else { "has no area: it is too narrow" };
        return vec![Problem::error(path, format!("the outline {what}"))];
    }
    let slack = if outline.is_curved() { FLATNESS_PX } else { 0.0 };
    let crossing = if drawn { self_crossing(&polygon, slack) } else { None };
    let message = |Point { x, y }| format!("the outline crosses itself near ({x:.1}, {y:.1})");
    let hint = "what it encloses twice is outside (even-odd)";
    crossing.map(|place| Problem::warning(path, message(place)).hint(hint)).into_iter().collect()
}

/// Warnings about anchors at the same place, of which only the first counts, and about anchors that make a thin plate
/// overshoot.
fn anchors_of(zone: &Zone) -> Vec<Problem> {
    if counts::all_anchors(zone) > MAX_COMPARED {
        return Vec::new();
    }
    let anchors = zone.anchors();
    let mut problems: Vec<Problem> = nearly_straight(zone, &anchors).into_iter().collect();
    let cell = |at: Point| ((at.x / SAME_PX).round() as i64, (at.y / SAME_PX).round() as i64);
    let mut first = HashMap::new();
    let mut pairs = Vec::new();
    for (j, anchor) in anchors.iter().enumerate() {
        match first.entry(cell(anchor.at)) {
            Entry::Occupied(taken) => pairs.push((*taken.get(), j)),
            Entry::Vacant(free) => drop(free.insert(j)),
        }
    }
    let named = pairs.iter().take(MAX_PAIRS).map(|&(i, j)| {
        let (first, second) = (&anchors[i], &anchors[j]);
        let Point { x, y } = first.at;
        let message = format!(
            "anchors {i} (of tool {}) and {j} (of tool {}) are at the same place, ({x}, {y})",
            first.tool, second.tool
        );
        Problem::warning(format!("/motion/{}", second.tool), message).hint("at that place only the first counts")
    });
    problems.extend(named);
    problems
}

/// A thin plate through anchors that are nearly on one line overshoots far beside it; if they are exactly on one line,
/// shepard is used instead.
fn nearly_straight(zone: &Zone, anchors: &[Anchor]) -> Option<Problem> {
    let plate = matches!(zone.interpolation, Interpolation::ThinPlate { .. });
    let (along, across) = spread(anchors).filter(|(along, across)| plate && across < &(along * NEARLY_STRAIGHT))?;
    let last = anchors.len() - 1;
    let message = format!(
        "the thin plate's anchors 0 to {last} are nearly on one line: they spread {along:.1} px along it and {across:.1} px \
         across, and jump vectors beside it become far longer than those of the anchors"
    );
    let hint = "add anchors beside the line (a still border, say), or use another interpolation";
    Some(Problem::warning("/interpolation", message).hint(hint))
}

/// The spread of anchors along the line that fits them best, and across it: standard deviations in pixels.
fn spread(anchors: &[Anchor]) -> Option<(f64, f64)> {
    let count = anchors.len() as f64;
    let center = anchors.iter().fold(Vec2::ZERO, |sum, anchor| sum + anchor.at.to_vec2()) / count;
    let [xx, xy, yy] = anchors
        .iter()
        .map(|anchor| anchor.at.to_vec2() - center)
        .fold([0.0; 3], |[xx, xy, yy], d| [xx + d.x * d.x / count, xy + d.x * d.y / count, yy + d.y * d.y / count]);
    let (middle, half) = ((xx + yy) / 2.0, Vec2::new((xx - yy) / 2.0, xy).hypot2().sqrt());
    (anchors.len() > 2).then(|| ((middle + half).sqrt(), (middle - half).max(0.0).sqrt()))
}

/// Checks of fields in a tool that depend on each other.
fn motion(zone: &Zone) -> Vec<Problem> {
    let tools = zone.motion.iter().enumerate();
    tools.flat_map(|(i, tool)| tool.check().into_iter().map(move |each| each.under(&format!("/motion/{i}")))).collect()
}

/// Local times at which to look for values out of bounds.
fn telling(position: &Position) -> Vec<f64> {
    const EVEN: u32 = 16;
    let mut taus: Vec<f64> = (0..=EVEN).map(|i| f64::from(i) / f64::from(EVEN)).collect();
    let inner: Vec<f64> = match position.pieces() {
        Pieces::Whole => Vec::new(),
        Pieces::Points(points, _) => points.iter().map(|point| point[0]).collect(),
        Pieces::Segments(segments) => segments.iter().map(|segment| segment.until).collect(),
    };
    taus.extend(inner.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
    taus.extend(inner);
    taus
}

/// Checks of numbers in a position function that depend on each other.
fn position(position: &Position) -> Vec<Problem> {
    if let Some(problem) = position.check() {
        return vec![problem];
    }
    match position.pieces() {
        Pieces::Whole => Vec::new(),
        Pieces::Points(points, _) => {
            rules::ascending("τ", points.iter().map(|point| point[0]), |i| format!("/points/{i}/0"))
        }
        Pieces::Segments(segments) => {
            let path = |i| format!("/segments/{i}/until");
            let untils = segments.iter().map(|segment| segment.until);
            let mut problems = rules::ascending("the ends of segments", untils, path);
            if let Some(last) = segments.last().filter(|last| last.until != 1.0) {
                let message = format!("the last segment ends at {}, not at 1", last.until);
                problems.push(Problem::error(path(segments.len() - 1), message).hint("set it to 1"));
            }
            for (i, segment) in segments.iter().enumerate() {
                let prefix = format!("/segments/{i}/ease");
                let ease = match segment.ease.pieces() {
                    Pieces::Segments(_) => {
                        vec![Problem::error("", "an ease cannot itself be piecewise").hint("split the segment instead")]
                    }
                    Pieces::Whole | Pieces::Points(..) => self::position(&segment.ease),
                };
                problems.extend(ease.into_iter().map(|problem| problem.under(&prefix)));
            }
            problems
        }
    }
}
