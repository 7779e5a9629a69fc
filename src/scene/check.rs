//! Everything that can be said about a scene before it is synthesised: shape first (the schema), then names, references
//! and what each technique says about its own layers. Facts about pictures come in as values.

use serde::Deserialize;
use serde_json::Value;

use super::{Scene, pointer, shape};
use crate::base::problem::{Problem, Severity, nearest, quoted};
use crate::layers::{Sizes, check as rules};

/// A scene plays at most so many frames.
const MAX_FRAMES: f64 = 100_000.0;

/// Every problem of `json`: of shape, and, where the shape is right, of names, ranges and references. The scene comes
/// with the warnings; errors come without it.
pub fn read(json: &Value) -> Result<(Scene, Vec<Problem>), Vec<Problem>> {
    let problems = shape::check(json);
    if !problems.is_empty() {
        return Err(problems);
    }
    // The walk above says the same as the types and more; where they ever differ the types have the last word.
    let scene = Scene::deserialize(json).map_err(|e| vec![Problem::error("", e.to_string())])?;
    let problems = check(&scene);
    if problems.iter().any(|problem| problem.severity == Severity::Error) {
        Err(problems)
    } else {
        Ok((scene, problems))
    }
}

/// Every problem of a scene whose shape is right.
pub fn check(scene: &Scene) -> Vec<Problem> {
    let mut problems = Vec::new();
    timeline(scene, &mut problems);
    for (name, image) in &scene.images {
        let path = pointer::join("/images", name);
        problems.extend(rules::plain_text(name, &path));
        problems.extend(rules::file_path(&image.path, &format!("{path}/path")));
    }
    let layers = scene.layers.iter().enumerate();
    problems.extend(rules::names(layers.map(|(i, layer)| (format!("/layers/{i}/name"), layer.name()))));
    for (i, layer) in scene.layers.iter().enumerate() {
        let prefix = format!("/layers/{i}");
        problems.extend(layer.check().into_iter().map(|problem| problem.under(&prefix)));
        for (path, image) in layer.images() {
            if !scene.images.contains_key(image) {
                let message = format!("there is no image {}", quoted(image));
                let hint = match nearest(image, scene.images.keys().map(String::as_str)) {
                    Some(hint) => hint,
                    None => "add it to the scene's images".into(),
                };
                problems.push(Problem::error(format!("{prefix}{path}"), message).hint(hint));
            }
        }
    }
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    problems
}

/// What the sizes of the pictures say about a scene: outlines outside their picture, masks of another size. Pictures of
/// unknown size are left out.
pub fn check_images(scene: &Scene, sizes: &Sizes) -> Vec<Problem> {
    let layers = scene.layers.iter().enumerate();
    layers
        .flat_map(|(i, layer)| layer.check_images(sizes).into_iter().map(move |p| p.under(&format!("/layers/{i}"))))
        .collect()
}

fn timeline(scene: &Scene, problems: &mut Vec<Problem>) {
    let frames = scene.timeline.duration * scene.timeline.fps;
    if frames > MAX_FRAMES {
        let message = format!("{frames:.0} frames are too many: at most {MAX_FRAMES}");
        problems.push(Problem::error("/timeline", message).hint("a shorter duration, or fewer frames a second"));
    }
}
