//! Everything that can be checked in a scene before it is synthesised: shape first (the schema), then names, references
//! and what each technique checks in its own layers. Facts about pictures are passed in as values.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::{Map, Value};

use super::{Scene, VERSION, references, shape, sight};
use crate::base::budget::Budget;
use crate::base::change::Change;
use crate::base::pointer::Pointer;
use crate::base::problem::{Kind, Problem, Severity};
use crate::layers::parts::materials::{List, Materials, Of};
use crate::layers::parts::moment::Space;
use crate::layers::space::camera::Camera;
use crate::layers::technique::{Checked, Technique};
use crate::layers::{KINDS, Layer, check as rules};

/// At most about so many frames are looked at for what the camera sees.
const MOST_VIEWS: u64 = 2000;

/// Bytes that a pixel of a frame takes: light, and what is written.
const FRAME_BYTES: u64 = 20;

/// What a scene is allowed to ask for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Whether paths may leave the scene's folder.
    pub allow_outside: bool,
    /// The most that the scene may have of each kind of thing that techniques count; kinds not listed have no limit.
    pub counted: BTreeMap<&'static str, u64>,
    /// The most frames in its timeline.
    pub frames: u64,
    /// Bytes of memory for the document, and for whatever one place in it asks for.
    pub memory: u64,
}

impl Rules {
    /// No limits, for a document that has been checked before.
    pub const NONE: Rules = Rules { allow_outside: true, counted: BTreeMap::new(), frames: u64::MAX, memory: u64::MAX };
}

impl Default for Rules {
    fn default() -> Self {
        let counted = KINDS.iter().flat_map(|kind| kind.counted).map(|row| (row.name, row.most)).collect();
        Rules { allow_outside: false, counted, frames: 100_000, memory: 4 << 30 }
    }
}

/// What JSON means, after it has passed every check.
#[derive(Clone, Debug)]
pub struct Read {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its warnings.
    pub warnings: Arc<[Problem]>,
    /// What was found in each layer on its own.
    layers: Arc<[Checked]>,
}

/// The scene that `json` means, with its warnings.
///
/// # Errors
/// Every problem: of shape, or, if the shape is right, of names, ranges and references.
pub fn read(json: &Value, rules: &Rules) -> Result<Read, Vec<Problem>> {
    let problems = shape::check(json);
    if !problems.is_empty() {
        return Err(problems);
    }
    // The check above covers what the types demand, and more; if they ever differ, the types decide.
    let scene = Scene::deserialize(json).map_err(|e| vec![Problem::error("", e.to_string())])?;
    check(scene.resolved(), None, rules)
}

/// A scene with nothing but the files that `json` lists, as far as that is right and within the rules.
pub fn files(json: &Value, rules: &Rules) -> Option<Scene> {
    let listed = [List::Images, List::Meshes, List::Clips].map(|list| list.words().0);
    let listed = listed.into_iter().filter_map(|list| Some((list.to_owned(), json.get(list)?.clone())));
    let mut bare: Map<String, Value> = listed.collect();
    bare.insert("plica".into(), VERSION.into());
    for problem in shape::check(&Value::Object(bare.clone())) {
        let mut tokens = Pointer(&problem.path).tokens();
        let (Some(list), entry) = (tokens.next(), tokens.next()) else { continue };
        match (bare.get_mut(&*list).and_then(Value::as_object_mut), entry) {
            (Some(entries), Some(entry)) => drop(entries.remove(&*entry)),
            _ => drop(bare.remove(&*list)),
        }
    }
    let mut scene = Scene::deserialize(Value::Object(bare)).ok()?;
    scene.clips.retain(|_, clip| clip.count.is_none_or(|count| u64::from(count) <= rules.frames));
    Some(scene)
}

/// Like [`read`], if `change` is how `json` differs from what `before` was read from: only that is looked at. JSON that
/// does not pass is read as a whole, so that the problems are the same as from [`read`].
pub fn reread(json: &Value, change: &Change, before: &Read, rules: &Rules) -> Result<Read, Vec<Problem>> {
    let fits = shape::still_fits(json, change);
    match if fits { before.scene.reread(json, change) } else { None } {
        Some(scene) => check(scene.resolved(), Some(before), rules),
        None => read(json, rules),
    }
}

impl Scene {
    /// The same with the shapes looked up that its layers name.
    fn resolved(mut self) -> Scene {
        let Scene { shapes, layers, .. } = &mut self;
        layers.iter_mut().for_each(|layer| layer.resolve(shapes));
        self
    }

    fn reread(&self, json: &Value, change: &Change) -> Option<Scene> {
        let bare = json.as_object()?.iter().filter(|(name, _)| *name != "layers");
        let bare = Scene::deserialize(Value::Object(bare.map(|(k, v)| (k.clone(), v.clone())).collect())).ok()?;
        let layers = match change.field("layers") {
            Change::Same => self.layers.clone(),
            Change::Items(items) if items.ahead + items.between.len() + items.behind == self.layers.len() => {
                let mut layers = self.layers.clone();
                for (i, change) in items.each().filter(|(_, change)| **change != Change::Same) {
                    let layer = layers.get_mut(i)?;
                    *layer = layer.reread(json.get("layers")?.get(i)?, change)?;
                }
                layers
            }
            _ => return None,
        };
        Some(Scene { layers, ..bare })
    }
}

/// Checks a scene whose shape is right; in layers, only what is new since `before`.
fn check(scene: Scene, before: Option<&Read>, rules: &Rules) -> Result<Read, Vec<Problem>> {
    let before =
        |i: usize| before.and_then(|before| Some((before.scene.layers.get(i)?.technique(), before.layers.get(i)?)));
    // A scene that asks for too much is not checked further.
    let over = counts(&scene, rules);
    let layers = scene.layers.iter().enumerate().filter(|_| over.is_empty());
    let layers: Vec<Checked> = layers.map(|(i, layer)| layer.technique().check(before(i))).collect();
    let warnings = problems(&scene, over, &layers, rules);
    if warnings.iter().any(|problem| problem.severity == Severity::Error) {
        return Err(warnings);
    }
    Ok(Read { scene: Arc::new(scene), warnings: warnings.into(), layers: layers.into() })
}

/// Every problem of a scene whose shape is right, errors first.
fn problems(scene: &Scene, over: Vec<Problem>, layers: &[Checked], rules: &Rules) -> Vec<Problem> {
    let mut problems = over;
    for (i, (layer, checked)) in scene.layers.iter().zip(layers).enumerate() {
        problems.extend(
            layer.technique().problems(checked).into_iter().map(|problem| problem.under(&format!("/layers/{i}"))),
        );
    }
    for list in List::NAMED {
        let at = |name: &str| Pointer(&format!("/{}", list.words().0)).join(name);
        problems.extend(scene.names(list).into_iter().filter_map(|name| rules::plain_text(name, &at(name))));
    }
    problems.extend(view(scene));
    if scene.layers.is_empty() {
        let problem = Problem::warning("/layers", "a scene without layers has nothing to show");
        problems.push(problem.hint("add a layer"));
    }
    problems.extend(names(scene));
    problems.extend(paths(scene, rules));
    problems.extend(references::problems(scene));
    let is_still = |problem: &Problem| problem.kind == Kind::Still;
    if problems.iter().any(is_still) && moves(scene) {
        problems.retain(|problem| !is_still(problem));
    }
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    problems
}

/// Whether something in the scene changes while the time runs, as far as the document tells.
pub fn moves(scene: &Scene) -> bool {
    let turns = scene.camera.as_ref().is_some_and(Camera::moves);
    let in_space = |layer: &Layer| layer.technique().kind().space == Space::World;
    scene.layers.iter().any(|layer| layer.technique().moves() || turns && in_space(layer))
}

/// The problems with which a scene can be open and edited, but not shown. Some show only with the pictures and fields:
/// outlines outside their picture, masks and fields of another size; those that could not be loaded are skipped.
pub fn check_materials(scene: &Scene, materials: &Materials) -> Vec<Problem> {
    let mut problems = below_layers(scene, |layer| layer.check_materials(materials));
    problems.extend(sight::problems(scene, materials));
    problems
}

fn below_layers(scene: &Scene, check: impl Fn(&dyn Technique) -> Vec<Problem>) -> Vec<Problem> {
    let layers = scene.layers.iter().enumerate();
    let below = layers.map(|(i, layer)| (format!("/layers/{i}"), check(layer.technique())));
    below.flat_map(|(prefix, problems)| problems.into_iter().map(move |problem| problem.under(&prefix))).collect()
}

/// For each kind of thing, the first place where the scene asks for more than is allowed.
fn counts(scene: &Scene, rules: &Rules) -> Vec<Problem> {
    let mut sums: BTreeMap<&str, (u64, f64, Option<String>)> =
        rules.counted.iter().map(|(what, most)| (*what, (*most, 0.0, None))).collect();
    for (i, layer) in scene.layers.iter().enumerate() {
        layer.technique().counts(&mut |count| {
            if let Some((most, sum, over)) = sums.get_mut(count.what) {
                *sum += count.count;
                if *sum > *most as f64 && over.is_none() {
                    *over = Some(format!("/layers/{i}{}", (count.path)()));
                }
            }
        });
    }
    let over = sums.into_iter().filter_map(|(what, (most, _, over))| Some(too_many(over?, what, most)));
    let mut problems: Vec<Problem> = over.collect();
    let budget = Budget::new(rules.memory);
    for (i, layer) in scene.layers.iter().enumerate() {
        let memory = layer.technique().memory().into_iter();
        let short = memory.filter_map(|(path, bytes)| Some((path, budget.try_take(bytes).err()?)));
        problems.extend(short.map(|(path, short)| short.problem(format!("/layers/{i}{path}"))));
    }
    if let Some([width, height]) = scene.size {
        let frame = u64::from(width) * u64::from(height) * FRAME_BYTES;
        problems.extend(budget.try_take(frame).err().map(|short| short.problem("/size".to_owned())));
    }
    if scene.timeline.frames() > rules.frames {
        problems.push(too_long("/timeline".into(), scene.timeline.frames(), rules.frames));
    }
    let counted = scene.clips.iter().filter_map(|(name, clip)| Some((name, u64::from(clip.count?))));
    let long = counted.filter(|(_, count)| *count > rules.frames);
    problems.extend(long.map(|(name, count)| too_long(Pointer("/clips").join(name) + "/count", count, rules.frames)));
    problems
}

fn too_long(path: String, frames: u64, most: u64) -> Problem {
    let message = format!("that is {frames} frames, and at most {most} are allowed");
    Problem::error(path, message).hint(format!("make it shorter, or give --limit frames={frames}"))
}

fn too_many(path: String, what: &str, most: u64) -> Problem {
    let message = format!("makes more than {most} {what} in one scene");
    Problem::error(path, message).hint(format!("make fewer, or give --limit {what}=N"))
}

/// Problems with what all layers are seen in: the background, the camera.
fn view(scene: &Scene) -> Vec<Problem> {
    let mut problems: Vec<Problem> = rules::color(&scene.background, "/background").into_iter().collect();
    let frames = scene.timeline.frames();
    let step = frames.div_ceil(MOST_VIEWS).max(1) as usize;
    let times = (0..frames).step_by(step).map(|k| scene.timeline.time_of(k));
    let camera = scene.camera.iter().flat_map(|camera| camera.check(times.clone()));
    problems.extend(camera.map(|problem| problem.under("/camera")));
    problems
}

fn names(scene: &Scene) -> Vec<Problem> {
    let layers = scene.layers.iter().enumerate();
    rules::names(layers.map(|(i, layer)| (format!("/layers/{i}/name"), layer.technique().name())))
}

/// Problems with paths of files, judged by the text alone.
fn paths(scene: &Scene, rules: &Rules) -> Vec<Problem> {
    let path = |list: &str, name: &str| Pointer(&format!("/{list}")).join(name) + "/path";
    let images = scene.images.iter().map(|(name, image)| (path("images", name), &*image.path));
    let meshes = scene.meshes.iter().map(|(name, mesh)| (path("meshes", name), &*mesh.path));
    let files = scene.uses().filter_map(|used| match used.of {
        Of::Path(file) => Some((used.at, file)),
        Of::Name(..) => None,
    });
    let clips = scene.clips.iter().map(|(name, clip)| (path("clips", name), &*clip.path));
    let patterns = scene
        .clips
        .iter()
        .filter_map(|(name, clip)| clip.frames().err().map(|problem| problem.under(&Pointer("/clips").join(name))));
    images
        .chain(meshes)
        .chain(clips)
        .chain(files)
        .filter_map(|(path, file)| rules::file_path(file, &path, rules.allow_outside))
        .chain(patterns)
        .collect()
}
