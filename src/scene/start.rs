//! A new scene: a layer for each picture, mesh and clip, made by the techniques that can start from one, and a camera that
//! sees all meshes.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use serde_json::{Map, Value, json};

use super::build::{unique_name, write};
use super::check::Rules;
use super::edit::Edit;
use super::{Document, FRAME, VERSION};
use crate::base::geometry::farther;
use crate::base::mesh::Mesh;
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::layers::KINDS;
use crate::layers::parts::materials::{List, Materials};
use crate::layers::parts::moment::Space;
use crate::layers::space::camera::Camera;
use crate::layers::space::fit::{fit, short};
use crate::layers::starts::NewLayer;
use crate::layers::technique::Kind;

/// Where a new camera sees meshes from.
const BACK: DVec3 = DVec3::new(0.0, 0.3, 1.0);

/// What a layer of a mesh takes over from its file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Looks<'a> {
    /// The picture on its surface, by name and path.
    pub picture: Option<(&'a str, &'a str)>,
    /// The color of its surface, where there is no picture.
    pub color: Option<&'a str>,
    /// Whether both sides of its triangles are meant to be seen.
    pub both_sides: bool,
}

/// What is known of a clip.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Width and height of its frames.
    pub size_px: (usize, usize),
    /// How many there are.
    pub frames: usize,
    /// Whether all of them are alike.
    pub is_still: bool,
}

/// A scene in the making, or what comes into one that is there.
#[derive(Debug, Default)]
pub struct Start {
    /// The lists of the scene, by name.
    lists: Map<String, Value>,
    layers: Vec<Value>,
    /// Names of the layers that are there already.
    taken: Vec<String>,
    frame: Option<(usize, usize)>,
    /// What is to be seen.
    meshes: BTreeMap<String, Arc<Mesh>>,
    /// Whether a layer is in space.
    in_space: bool,
    /// What the only layer is seen best on.
    ground: Option<&'static str>,
    /// See [`Start::fitted`].
    fitted: Option<String>,
}

impl Start {
    /// Begins with what is in a scene.
    pub fn within(document: &Document) -> Start {
        let list = |list: &List| Some((list.words().0.to_owned(), document.json().get(list.words().0)?.clone()));
        let scene = document.scene();
        Start {
            lists: List::NAMED.iter().filter_map(list).collect(),
            taken: scene.layers.iter().map(|layer| layer.technique().name().to_owned()).collect(),
            frame: scene.size.map(|[width, height]| (width as usize, height as usize)),
            ..Start::default()
        }
    }

    /// The edit that brings what was added into the scene that this began with, over its layers, and a camera if it needs one
    /// and there is none; and where the first new entry of a list and the first new layer are then.
    pub fn edit(self, document: &Document) -> (Edit, Vec<String>) {
        let (json, mut edits, mut places) = (document.json(), Vec::new(), Vec::new());
        if self.in_space && document.scene().camera.is_none() {
            edits.push(write(document, "/camera", camera(&self.meshes, self.frame.unwrap_or(FRAME))));
        }
        let written = |list: &str| json.get(list).and_then(Value::as_object);
        for (list, all) in &self.lists {
            let is_new = |name: &&String| written(list).is_none_or(|there| !there.contains_key(*name));
            let Some(name) = all.as_object().into_iter().flat_map(Map::keys).find(is_new) else { continue };
            places.push(Pointer(&format!("/{list}")).join(name));
            edits.push(write(document, &format!("/{list}"), all.clone()));
        }
        let count = json.get("layers").and_then(Value::as_array).map_or(0, Vec::len);
        places.extend((!self.layers.is_empty()).then(|| Pointer("/layers").join(count)));
        edits.extend(self.layers.into_iter().map(|layer| Edit::insert(document, "/layers", count, layer)));
        (Edit::all(edits), places)
    }

    /// The same without the layers.
    pub fn without_layers(self) -> Start {
        Start { layers: Vec::new(), in_space: false, ..self }
    }

    /// Adds a picture of this width and height, in a file, with a layer that shows it. If another image has its name
    /// already, it gets a similar one.
    pub fn picture(mut self, name: &str, path: &str, size_px: (usize, usize)) -> Start {
        let image = self.image(name, path);
        self.frame.get_or_insert(size_px);
        self.layer(List::Images, &NewLayer { name: &image, size_px, ..NewLayer::default() });
        self
    }

    /// Adds a mesh in a file, with a layer that shows it, which looks like that. What is known of it the camera will see.
    pub fn mesh(mut self, name: &str, path: &str, known: Option<Mesh>, looks: Looks) -> Start {
        let Looks { picture, color, both_sides } = looks;
        let mesh = self.put(List::Meshes, name, json!({ "path": path }));
        let image = picture.map(|(name, path)| self.image(name, path));
        self.meshes.extend(known.map(|known| (mesh.clone(), Arc::new(known))));
        let shown = NewLayer { name: &mesh, image: image.as_deref(), color, both_sides, ..NewLayer::default() };
        self.layer(List::Meshes, &shown);
        self
    }

    /// Adds a clip whose frames are numbered from `first`, with a layer that shows it, which fits what is known of it.
    pub fn clip(mut self, name: &str, path: &str, first: u64, known: Option<Known>) -> Start {
        let mut clip = json!({ "path": path });
        if first > 0 {
            clip["first"] = first.into();
        }
        let clip = self.put(List::Clips, name, clip);
        let plain = NewLayer { name: &clip, ..NewLayer::default() };
        let fitted =
            |Known { size_px, frames, is_still }| NewLayer { size_px, frames: Some(frames), is_still, ..plain };
        let shown = known.map_or(plain, fitted);
        self.layer(List::Clips, &shown);
        self
    }

    /// What is known of the meshes, by the names that they have in it.
    pub fn known(&self) -> Materials {
        Materials { meshes: self.meshes.clone(), ..Materials::default() }
    }

    /// What the last layer has that one of something whose size is not known would not have, as JSON.
    pub fn fitted(&self) -> Option<&str> {
        self.fitted.as_deref()
    }

    /// The scene.
    ///
    /// # Errors
    /// If its content is not a valid scene: for example, it names an impossible path.
    pub fn document(self) -> Result<Document, Vec<Problem>> {
        self.document_under(Rules::default())
    }

    /// The scene under other rules.
    ///
    /// # Errors
    /// As [`Start::document`].
    pub fn document_under(mut self, rules: Rules) -> Result<Document, Vec<Problem>> {
        let mut scene = Map::from_iter([("plica".to_owned(), VERSION.into())]);
        scene.extend(self.ground.map(|ground| ("background".to_owned(), ground.into())));
        if self.in_space {
            scene.insert("camera".into(), camera(&self.meshes, self.frame.unwrap_or(FRAME)));
        }
        scene.extend(List::NAMED.iter().filter_map(|list| self.lists.remove_entry(list.words().0)));
        scene.insert("layers".into(), self.layers.into());
        Document::from_json_under(scene.into(), rules)
    }

    fn image(&mut self, name: &str, path: &str) -> String {
        let images = self.lists.get(List::Images.words().0).and_then(Value::as_object);
        let known = images.and_then(|images| images.iter().find(|(_, image)| image["path"] == path));
        let known = known.map(|(name, _)| name.clone());
        known.unwrap_or_else(|| self.put(List::Images, name, json!({ "path": path })))
    }

    /// Adds an entry to a list of the scene, and gives the name that it has there.
    fn put(&mut self, list: List, name: &str, entry: Value) -> String {
        let list = self.lists.entry(list.words().0).or_insert_with(|| json!({}));
        let name = unique_name(name, |name| list.get(name).is_some());
        list[&name] = entry;
        name
    }

    /// Adds a layer of the first technique that makes one of what is in this list.
    fn layer(&mut self, list: List, shown: &NewLayer) {
        let makes = |kind: &&&Kind| kind.template.is_some_and(|template| template.of == list);
        let Some((kind, template)) = KINDS.iter().find(makes).and_then(|kind| Some((kind, kind.template?))) else {
            return;
        };
        let mut layer = (template.layer)(shown);
        let plain = (template.layer)(&NewLayer { size_px: (0, 0), frames: None, is_still: false, ..*shown });
        let fields = layer.as_object().into_iter().flatten().filter(|(name, value)| plain.get(name) != Some(*value));
        let fields: Map<String, Value> = fields.map(|(name, value)| (name.clone(), value.clone())).collect();
        self.fitted = (!fields.is_empty()).then(|| Value::Object(fields).to_string());
        self.ground = template.ground.filter(|_| self.layers.is_empty());
        let name = unique_name(shown.name, |name| {
            self.taken.iter().any(|taken| taken == name) || self.layers.iter().any(|other| other["name"] == name)
        });
        layer["name"] = name.into();
        self.layers.push(layer);
        self.in_space |= kind.space == Space::World;
    }
}

/// A camera that sees all of these meshes, in short numbers.
fn camera(meshes: &BTreeMap<String, Arc<Mesh>>, frame: (usize, usize)) -> Value {
    let reach = |ways: &[DVec3]| meshes.values().filter_map(|mesh| mesh.reach(ways)).reduce(farther);
    let fitted = fit(&reach, [BACK, DVec3::Y], Camera::default().fov, frame);
    let Some(fitted) = fitted else { return json!({}) };
    let [position, target] = short(fitted).map(|point| point.to_array().map(number::json));
    json!({ "position": position, "target": target })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::mesh::Vertex;
    use crate::layers::space::eye::Eye;

    #[test]
    fn the_camera_sees_all_meshes_in_short_numbers() {
        for (scale, size) in [(1.0, (400, 400)), (0.1, (90, 400)), (1e5, (1280, 720))] {
            let bounds = [[-1.0, 0.0, -2.0], [1.0, 3.0, 0.5], [4.0, 0.1, 0.3]].map(|at| DVec3::from(at) * scale);
            let pair = |at: DVec3| {
                let vertices = [at, at + scale].map(|position| Vertex { position, ..Vertex::default() }).to_vec();
                Mesh { vertices, ..Mesh::default() }
            };
            let meshes = bounds.map(pair);
            let start = Start::default().picture("cat", "cat.png", size);
            let start = meshes
                .iter()
                .fold(start, |start, mesh| start.mesh("box", "box.obj", Some(mesh.clone()), Looks::default()));
            let document = start.document().unwrap();
            let eye = document.scene().camera.as_ref().unwrap().at(0.0, size);
            let Eye { middle_px, .. } = eye;
            let corners = meshes.iter().flat_map(|mesh| &mesh.vertices).map(|vertex| vertex.position);
            let reach = corners.map(|corner| {
                let from_middle = (eye.project(eye.seen(corner)) - middle_px) / middle_px;
                from_middle.abs().max_element()
            });
            let reach = reach.fold(0.0, f64::max);
            assert!((0.899..0.901).contains(&reach), "{scale}: {reach}");
            let text = document.to_text();
            let camera = text.lines().find(|line| line.contains("\"camera\"")).unwrap();
            assert!(camera.len() < 100, "{camera}");
        }
    }

    fn of<'a>(name: &'a str, path: &'a str) -> Looks<'a> {
        Looks { picture: Some((name, path)), ..Looks::default() }
    }

    #[test]
    fn names_are_unique_in_each_list() {
        let start = Start::default().picture("cat", "cat.png", (8, 6)).mesh("cat", "cat.obj", None, of("cat", "a.png"));
        let document = start.mesh("cat", "b/cat.obj", None, of("skin", "cat.png")).document().unwrap();
        let json = document.json();
        assert_eq!(json["images"], json!({ "cat": { "path": "cat.png" }, "cat 2": { "path": "a.png" } }));
        assert_eq!(json["meshes"], json!({ "cat": { "path": "cat.obj" }, "cat 2": { "path": "b/cat.obj" } }));
        let layers = json["layers"].as_array().unwrap();
        let names: Vec<_> = layers.iter().map(|layer| layer["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["cat", "cat 2", "cat 3"]);
        assert_eq!(layers[2]["surface"], json!({ "kind": "texture", "image": "cat" }));
        assert_eq!(json["camera"], json!({}));
    }

    #[test]
    fn a_clip_gets_a_layer_in_space_and_a_camera() {
        let document = Start::default().clip("falls", "falls/%04d.jpg", 3, None).document().unwrap();
        let expected = json!({
            "plica": 1,
            "background": "#15191c",
            "camera": {},
            "clips": { "falls": { "path": "falls/%04d.jpg", "first": 3 } },
            "layers": [{ "kind": "waterfall", "name": "falls", "clip": "falls" }]
        });
        assert_eq!(document.json(), &expected);
        let document = Start::default().picture("cat", "cat.png", (8, 6)).document().unwrap();
        assert_eq!(document.json().get("camera"), None);
        let both = Start::default().picture("cat", "cat.png", (8, 6)).clip("falls", "falls/%04d.jpg", 3, None);
        assert_eq!(both.document().unwrap().json().get("background"), None, "the picture is behind it");
    }
}
