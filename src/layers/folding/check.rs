//! What can be wrong in a picture layer beyond its shape. Paths are relative to the layer.

use super::{
    fold::Fold, interpolation::Interpolation, model::PictureLayer, model::Zone, position::Position, tools::Tool,
};
use crate::base::problem::{Problem, quoted};
use crate::layers::{Sizes, check as rules};

/// Every problem of the layer by itself.
pub fn check(layer: &PictureLayer) -> Vec<Problem> {
    let zones = || layer.zones.iter().enumerate();
    let mut problems = rules::names(zones().map(|(i, zone)| (format!("/zones/{i}/name"), zone.name.as_str())));
    for (i, zone) in zones() {
        let prefix = format!("/zones/{i}");
        problems.extend(check_zone(zone).into_iter().map(|problem| problem.under(&prefix)));
    }
    problems
}

/// The images that the layer names, each with its pointer.
pub fn images(layer: &PictureLayer) -> Vec<(String, &str)> {
    let mut images = vec![("/image".to_owned(), layer.image.as_str())];
    for (i, zone) in layer.zones.iter().enumerate() {
        if let Some(Fold::Mask { image }) = &zone.fold {
            images.push((format!("/zones/{i}/fold/image"), image));
        }
        if let Some(sampler) = &zone.sampler {
            images.push((format!("/zones/{i}/sampler/image"), &sampler.image));
        }
    }
    images
}

/// What the sizes of pictures say: an outline outside its picture, a mask of another size.
pub fn check_images(layer: &PictureLayer, sizes: &Sizes) -> Vec<Problem> {
    let Some(&(width, height)) = sizes.get(&layer.image) else { return Vec::new() };
    let picture = kurbo::Rect::new(0.0, 0.0, width as f64, height as f64);
    let mut problems = Vec::new();
    for (i, zone) in layer.zones.iter().enumerate() {
        let bounds = zone.outline.polygon().bounds();
        if !bounds.overlaps(picture) {
            let message =
                format!("the outline lies outside the picture ({width} x {height} px), so the zone shows nothing");
            problems.push(Problem::warning(format!("/zones/{i}/outline"), message));
        }
        let Some(Fold::Mask { image }) = &zone.fold else { continue };
        if let Some((w, h)) = sizes.get(image).filter(|&&size| size != (width, height)) {
            let message = format!("the mask {} is {w} x {h} px, the picture {width} x {height}", quoted(image));
            let hint = "a mask is a copy of the picture, of its size";
            problems.push(Problem::error(format!("/zones/{i}/fold/image"), message).hint(hint));
        }
    }
    problems
}

fn check_zone(zone: &Zone) -> Vec<Problem> {
    let mut problems = Vec::new();
    if let Interpolation::ModifiedShepardRandom { radius, ring, .. } = zone.interpolation
        && ring > radius
    {
        let message = format!("the ring of {ring} px is wider than the radius of {radius} px");
        problems.push(Problem::error("/interpolation/ring", message).hint("at most the radius"));
    }
    if matches!(zone.fold, Some(Fold::Mask { .. })) && zone.sampler.is_some() {
        let hint = "take away either the fold or the sampler";
        problems.push(Problem::error("/fold", "a mask and a sampler image do not go together").hint(hint));
    }
    if zone.motion.iter().all(|tool| matches!(tool, Tool::StillBorder { .. })) {
        problems.push(Problem::warning("/motion", "nothing moves: no tool gives a jump vector").hint("add a point"));
    }
    problems.extend(motion(zone));
    problems.extend(position(&zone.position).into_iter().map(|problem| problem.under("/position")));
    problems
}

/// Tools whose fields hang together.
fn motion(zone: &Zone) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (i, tool) in zone.motion.iter().enumerate() {
        match tool {
            Tool::Curve { jumps, .. } => {
                let path = |j| format!("/motion/{i}/jumps/{j}/along");
                problems.extend(rules::ascending("places along a curve", jumps.iter().map(|jump| jump.along), path));
            }
            Tool::Field { path, .. } => problems.extend(rules::file_path(path, &format!("/motion/{i}/path"))),
            _ => {}
        }
    }
    problems
}

/// Numbers of a position function that hang together.
fn position(position: &Position) -> Vec<Problem> {
    match position {
        Position::Exponential { rate } | Position::ExponentialInverse { rate } if *rate == 0.0 => {
            vec![Problem::error("/rate", "a rate of 0 has no curve").hint("the nearest is the function linear")]
        }
        Position::Keyframes { points, .. } => {
            rules::ascending("τ", points.iter().map(|point| point[0]), |i| format!("/points/{i}/0"))
        }
        Position::Piecewise { segments } => {
            let path = |i| format!("/segments/{i}/until");
            let untils = segments.iter().map(|segment| segment.until);
            let mut problems = rules::ascending("the ends of segments", untils, path);
            if let Some(last) = segments.last().filter(|last| last.until != 1.0) {
                let message = format!("the last segment ends at {}, not at 1", last.until);
                problems.push(Problem::error(path(segments.len() - 1), message).hint("set it to 1"));
            }
            for (i, segment) in segments.iter().enumerate() {
                let prefix = format!("/segments/{i}/ease");
                let ease = match &*segment.ease {
                    Position::Piecewise { .. } => {
                        vec![Problem::error("", "an ease cannot itself be piecewise").hint("split the segment instead")]
                    }
                    ease => self::position(ease),
                };
                problems.extend(ease.into_iter().map(|problem| problem.under(&prefix)));
            }
            problems
        }
        _ => Vec::new(),
    }
}
