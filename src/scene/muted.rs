//! A scene without some of its layers and zones, for looking at the others.

use super::Scene;
use crate::base::pointer::Pointer;

impl Scene {
    /// The thing at `pointer` or around it that can be left out by itself: a zone, else its layer. `None` outside of layers.
    pub fn mutable(&self, pointer: &str) -> Option<String> {
        let (index, _) = Pointer(pointer).item_of("/layers")?;
        let layer = self.layers.get(index)?;
        let start = format!("/layers/{index}");
        let inner = Pointer(pointer).upward().find(|at| at.strip_prefix(&start).is_some_and(|way| layer.can_mute(way)));
        Some(inner.map_or(start, str::to_owned))
    }

    /// The scene as if the things at these pointers were not there: all others keep their places, and its frames the size that
    /// they have.
    #[must_use]
    pub fn without(&self, muted: &[String], (width, height): (usize, usize)) -> Scene {
        let layers = self.layers.iter().enumerate().map(|(i, layer)| {
            let own = muted.iter().filter_map(|pointer| Pointer(pointer).item_of("/layers"));
            let paths: Vec<&str> = own.filter(|(index, _)| *index == i).map(|(_, way)| way).collect();
            layer.without(&paths)
        });
        let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        Scene { layers: layers.collect(), size: Some([side(width), side(height)]), ..self.clone() }
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
}
