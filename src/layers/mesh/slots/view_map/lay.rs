//! Pictures that lie on the surface, and laying more of them there.

use glam::{DMat3, DVec3};
use serde_json::{Map, Value, json};

use super::model::{View, ViewCamera, ViewMap};
use crate::base::number;
use crate::layers::parts::shots::{Laid, Laying, Lying, SeenFrom, Shot};

/// The pictures that lie there.
pub fn lying(map: &ViewMap) -> Vec<Lying<'_>> {
    fn lying(view: &View) -> Lying<'_> {
        let guide = view.changed.as_deref();
        Lying { name: &view.name, image: &view.image, guide, from: seen_from(&view.camera) }
    }
    map.views.iter().map(lying).collect()
}

fn seen_from(camera: &ViewCamera) -> Option<SeenFrom> {
    let ViewCamera { position, target, up, fov, matrix, focal, center, size } = camera;
    if let Some(position) = position {
        let target = DVec3::from(target.unwrap_or_default());
        return Some(SeenFrom::Standing { position: (*position).into(), target, up: up.map(DVec3::from), fov: *fov });
    }
    let rows = (*matrix)?.map(|[x, y, z, shift]| (DVec3::new(x, y, z), shift));
    let turn = DMat3::from_cols(rows[0].0, rows[1].0, rows[2].0).transpose();
    let shift = DVec3::from(rows.map(|(_, shift)| shift));
    Some(SeenFrom::Shot(Shot { turn, shift, focal_px: (*focal)?, center_px: *center, size_px: *size }))
}

/// More of them; on a surface of another kind, `first` is what makes it one that can have them.
pub fn laying(pictures: &[Laid], first: Option<(&'static str, Value)>, list: &'static str) -> Laying {
    Laying { first, list, items: pictures.iter().map(view).collect() }
}

/// A view map without views, for these pictures. Texture coordinates are made for textures, and may be uneven or cover
/// themselves; whoever adds a view to a mesh that has one should not have to think of that.
pub fn empty(pictures: &[Laid]) -> Value {
    let is_added = |laid: &Laid| matches!(laid.from, SeenFrom::Standing { .. });
    match pictures.iter().any(is_added) {
        true => json!({ "kind": "view-map", "atlas": "box" }),
        false => json!({ "kind": "view-map" }),
    }
}

/// A picture as a view in the document.
fn view(laid: &Laid) -> Value {
    let mut view =
        Map::from_iter([("name".to_owned(), laid.name.clone().into()), ("image".into(), laid.image.clone().into())]);
    if let Some(kind) = &laid.kind {
        view.insert("kind".into(), kind.clone().into());
    }
    let camera = match &laid.from {
        SeenFrom::Shot(shot) => matrix(shot),
        SeenFrom::Standing { position, target, up, fov } => {
            let mut camera = json!({ "position": place(*position), "target": place(*target) });
            up.iter().for_each(|up| camera["up"] = place(*up).into_iter().collect());
            fov.iter().for_each(|fov| camera["fov"] = number::json(*fov));
            camera
        }
    };
    view.insert("camera".into(), camera);
    if let Some(guide) = &laid.guide {
        view.insert("extremes".into(), json!({ "kind": "cone", "degrees": 45 }));
        view.insert("hold".into(), json!(0.5));
        view.insert("changed".into(), guide.clone().into());
    }
    for (key, px) in [("feather", laid.feather_px), ("edge", laid.edge_px)].into_iter().filter(|(_, px)| *px > 0.0) {
        view.insert(key.into(), number::json(px));
    }
    view.into()
}

fn place(at: DVec3) -> [Value; 3] {
    at.to_array().map(number::json)
}

fn matrix(shot: &Shot) -> Value {
    let mut camera = json!({
        "matrix": shot.rows().map(|row| row.map(number::json)),
        "focal": shot.focal_px.map(number::json),
    });
    shot.center_px.iter().for_each(|center| camera["center"] = center.map(number::json).into_iter().collect());
    shot.size_px.iter().for_each(|size| camera["size"] = json!(size));
    camera
}
