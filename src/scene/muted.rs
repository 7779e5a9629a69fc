//! A scene without some of its layers and zones, for looking at the others, and for exports without them.

use serde_json::json;

use super::{Document, Edit, Scene};
use crate::base::pointer::Pointer;
use crate::layers::{KINDS, Layer};

impl Scene {
    /// The thing at `pointer` or around it that can be left out by itself: a zone, else its layer. `None` outside of layers.
    pub fn mutable(&self, pointer: &str) -> Option<String> {
        let (index, _) = Pointer(pointer).item_of("/layers")?;
        let layer = self.layers.get(index)?;
        let start = format!("/layers/{index}");
        let inner = Pointer(pointer)
            .upward()
            .find(|at| Pointer(at).below(&start).is_some_and(|way| layer.technique().can_mute(way)));
        Some(inner.map_or(start, str::to_owned))
    }

    /// The scene as if the things at these pointers were not there: all others keep their places, and its frames the size that
    /// they have.
    #[must_use]
    pub fn without(&self, muted: &[String], (width, height): (usize, usize)) -> Scene {
        let layers = self.layers.iter().enumerate().map(|(i, layer)| {
            let own = muted.iter().filter_map(|pointer| Pointer(pointer).item_of("/layers"));
            let paths: Vec<&str> = own.filter(|(index, _)| *index == i).map(|(_, way)| way).collect();
            if paths.contains(&"") { blank(layer) } else { layer.without(&paths) }
        });
        let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        Scene { layers: layers.collect(), size: Some([side(width), side(height)]), ..self.clone() }
    }
}

/// A layer that shows nothing in place of another.
fn blank(layer: &Layer) -> Layer {
    let made = KINDS.iter().find_map(|kind| kind.blank).map(|blank| blank(layer.technique().name()));
    made.and_then(|made| serde_json::from_value(made).ok()).unwrap_or_else(|| layer.clone())
}

impl Document {
    /// The document from which the things at these pointers are taken away, with frames of this size; if it cannot be without one of
    /// them, as others need it, as [`Scene::without`].
    #[must_use]
    pub fn without(&self, muted: &[String], size: (usize, usize)) -> Document {
        // The last of a list first, so that the others keep their places until then.
        let mut last_first: Vec<&String> = muted.iter().collect();
        last_first.sort_by_key(|pointer| {
            std::cmp::Reverse(Pointer(pointer).tokens().map(|token| (token.len(), token)).collect::<Vec<_>>())
        });
        let of_size = Edit::set(self, "/size", json!([size.0, size.1]));
        let edits = std::iter::once(of_size).chain(last_first.into_iter().map(|pointer| Edit::remove(pointer)));
        self.apply(&Edit::all(edits)).unwrap_or_else(|_| {
            let shown = serde_json::to_value(self.scene().without(muted, size)).map(Document::from_json);
            shown.ok().and_then(Result::ok).unwrap_or_else(|| self.clone())
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Document;

    const SCENE: &str = r##"{ "plica": 1, "images": { "a": { "path": "a.png" } }, "layers": [
        { "kind": "picture", "name": "face", "image": "a", "zones": [
            { "name": "left", "outline": { "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 },
              "motion": [{ "tool": "translate", "by": [1, 0] }] },
            { "name": "right", "outline": { "kind": "rectangle", "x": 9, "y": 0, "width": 9, "height": 9 } }] },
        { "kind": "fill", "name": "ground", "color": "#102030" }] }"##;

    #[test]
    fn what_is_left_out_is_a_zone_or_a_layer_in_its_place() {
        let document = Document::parse(SCENE).unwrap();
        let scene = document.scene();
        for (pointer, expected) in [
            ("/layers/0/zones/1/outline/x", Some("/layers/0/zones/1")),
            ("/layers/0/zones", Some("/layers/0")),
            ("/layers/0/image", Some("/layers/0")),
            ("/layers/1/color", Some("/layers/1")),
            ("/timeline/fps", None),
            ("/layers/7", None),
        ] {
            assert_eq!(scene.mutable(pointer).as_deref(), expected, "{pointer}");
        }
        let without = |muted: &[&str]| {
            let muted: Vec<String> = muted.iter().map(|one| (*one).to_owned()).collect();
            let shown = scene.without(&muted, (20, 10));
            let json = serde_json::to_value(&shown).unwrap();
            // It is a scene like others.
            Document::from_json(json.clone()).unwrap();
            json
        };
        let shown = without(&["/layers/0/zones/0"]);
        assert_eq!(shown["layers"][0]["zones"][0]["motion"], serde_json::json!([]));
        assert_eq!(shown["layers"][0]["zones"][1]["outline"]["x"], 9.0);
        assert_eq!(shown["size"], serde_json::json!([20, 10]));
        let shown = without(&["/layers/0"]);
        assert_eq!((&shown["layers"][0]["kind"], &shown["layers"][0]["name"]), (&"fill".into(), &"face".into()));
        assert_eq!(shown["layers"][1]["color"], "#102030");
    }

    #[test]
    fn exports_are_without_what_is_muted_or_have_something_clear_where_others_need_it() {
        let document = Document::parse(SCENE).unwrap();
        let without = |muted: &[&str]| {
            let muted: Vec<String> = muted.iter().map(|one| (*one).to_owned()).collect();
            document.without(&muted, (20, 10)).json().clone()
        };
        let left = without(&["/layers/0/zones/0", "/layers/1"]);
        assert_eq!((left["layers"].as_array().unwrap().len(), &left["size"]), (1, &serde_json::json!([20, 10])));
        assert_eq!(left["layers"][0]["zones"][0]["name"], "right");
        assert_eq!(left["layers"][0]["zones"][1], serde_json::Value::Null);
        // A mesh shows the layer: something clear is there in its place.
        let shown = r##"{ "plica": 1, "size": [8, 6], "camera": { "position": [0, 0, 3] }, "meshes": { "m": { "path": "m.obj" } },
            "layers": [{ "kind": "fill", "name": "sky", "color": "#102030" },
                { "kind": "mesh", "name": "m", "mesh": "m", "surface": { "kind": "layer", "layer": "sky" } }] }"##;
        let shown = Document::parse(shown).unwrap().without(&["/layers/0".into()], (8, 6));
        assert_eq!(shown.json()["layers"][0]["color"], "#00000000", "{}", shown.json());
    }
}
