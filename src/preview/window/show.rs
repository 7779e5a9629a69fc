//! A scene that is ready to be drawn, and the strokes of its overlay, which are made again only where something that they
//! show has changed.

use std::borrow::Cow;
use std::sync::Arc;

use kurbo::{Point, Size};

use super::canvas::Canvas;
use super::frames::Frames;
use super::own_view::OwnView;
use super::state::State;
use super::text::Letters;
use super::viewport::Viewport;
use super::{labels, marks};
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Mark, Shape, View};
use crate::layers::parts::vectors::Reach;
use crate::layers::space::camera::Camera;
use crate::render::Synth;
use crate::render::overlay::{aimed, overlay, overlays, reach};
use crate::render::passes::Asked;
use crate::scene::grips::{Grip, grips};
use crate::scene::{Document, Scene, words::item_of};

/// A scene, ready to be drawn.
pub struct Show {
    pub document: Document,
    /// As it is shown: without what is muted.
    pub scene: Arc<Scene>,
    /// As large as the picture: for the overlay.
    pub synth: Synth,
    /// As large as it is drawn.
    pub frames: Frames,
    /// Frames stay at least so many times smaller: the GPU had no room for finer ones.
    pub coarsest: usize,
    /// Marks beside those of the overlays.
    pub marks: Vec<Mark>,
}

impl Show {
    /// Whether any layer has sprites, of which some can be left out.
    pub fn has_sprites(&self) -> bool {
        self.synth.layers.iter().any(|layer| layer.has_sprites())
    }
}

/// A scene with so many births left out after each that is shown.
pub fn thinned(synth: &Synth, left_out: u32) -> Cow<'_, Synth> {
    if left_out > 0 { Cow::Owned(synth.thinned(left_out)) } else { Cow::Borrowed(synth) }
}

/// A scene as the window's own camera sees it, if there is one.
pub fn seen<'a>(synth: &'a Synth, own: Option<&Camera>) -> Cow<'a, Synth> {
    own.map_or(Cow::Borrowed(synth), |camera| Cow::Owned(synth.seen_from(camera.clone())))
}

/// What stands under a place in the picture, nearest in the topmost group of layers in space that is there at scene time
/// `t`: layer, triangle and depth.
pub fn under(scene: &Scene, synth: &Synth, t: f64, at: Point) -> Option<String> {
    let pixel = (at.x >= 0.0 && at.y >= 0.0).then_some((at.x as usize, at.y as usize))?;
    let moment = synth.moment(t);
    let (layer, found) = synth.stage.groups.iter().rev().find_map(|group| {
        let layers = group.layers().iter();
        let found = layers.filter_map(|&layer| Some((layer, synth.layers[layer].under(pixel, &moment)?)));
        found.min_by(|(_, a), (_, b)| a.depth_m.total_cmp(&b.depth_m))
    })?;
    let name = scene.layers.get(layer)?.technique().name();
    Some(format!("{name}, triangle {}, {:.2} m", found.triangle, found.depth_m))
}

/// What a JSON pointer leads to, by the names of the layer and of the item in it: `face/left
/// eye/motion/3`; `None` for the scene itself.
pub fn name(scene: &Scene, pointer: &str) -> Option<String> {
    let Some((layer, way)) = Pointer(pointer).item_of("/layers") else {
        return Some(pointer.strip_prefix('/')?.to_owned());
    };
    let of_layer = pointer.len() - way.len();
    let layer = scene.layers.get(layer)?.technique();
    let item = item_of(pointer).and_then(|item| Some((item.len(), layer.item_name(&item[of_layer..])?)));
    let rest = &pointer[item.map_or(of_layer, |(length, _)| length)..];
    Some([layer.name(), item.map_or("", |_| "/"), item.map_or("", |(_, name)| name), rest].concat())
}

/// The overlay's strokes, and what they were made for.
#[derive(Default)]
pub struct Cached {
    /// Strokes that stay as they are while the animation runs.
    pub fixed: Canvas,
    made_for: Option<(View, Basis)>,
    /// Those that change with every frame.
    pub moving: Canvas,
    moved_for: Option<(View, Basis, Option<OwnView>)>,
    /// What is dragged, as it would be.
    pub dragged: Canvas,
    /// Names and numbers, above all else of the overlay.
    pub labels: Canvas,
    /// What can be dragged of what is selected.
    pub grips: Vec<Grip>,
    /// What can be dragged of what changes with every frame.
    pub moving_grips: Vec<Grip>,
    /// See [`State::reach`].
    pub reach: Reach,
    /// The number of scenes so far.
    pub revision: u64,
}

/// Everything but the overlays that strokes depend on.
#[derive(Clone, Debug, PartialEq)]
struct Basis {
    viewport: Viewport,
    window: Size,
    scale: f64,
    grid: bool,
    revision: u64,
    /// See [`Letters::generation`].
    letters: u64,
}

impl Cached {
    /// Makes the strokes again where anything that they show has changed.
    pub fn follow(&mut self, state: &State, show: &Show, letters: &Letters) {
        let viewport = state.viewport.clone();
        let (window, scale, grid) = (state.window, state.scale, state.shows("view-grid"));
        let sight = Basis { viewport, window, scale, grid, revision: self.revision, letters: letters.generation() };
        let only = Asked::only_shown(state.pass.as_deref(), &show.scene);
        let [fixed, moving] = [state.fixed_view(), state.moving_view()].map(|view| View { only, ..view });
        self.follow_drag(state, show);
        let made_for = Some((fixed.clone(), sight.clone()));
        if self.made_for != made_for {
            self.made_for = made_for;
            self.make_fixed(state, show, &fixed, letters);
        }
        let moved_for = Some((moving.clone(), sight, state.own));
        if self.moved_for != moved_for {
            self.moved_for = moved_for;
            let synth = seen(&show.synth, state.own_camera().as_ref());
            let found = overlay(&show.scene, Some(&synth), &moving);
            self.moving_grips = found.iter().filter_map(grip).collect();
            let (viewport, area, scale) = (&state.viewport, state.area(), state.scale);
            self.moving = marks::draw(&found, viewport, area, scale);
            self.moving.strokes.extend(labels::draw(&found, viewport, area, scale, letters).strokes);
        }
    }

    fn follow_drag(&mut self, state: &State, show: &Show) {
        self.dragged = Canvas::default();
        let Some((pointer, at)) = &state.dragged else { return };
        let synth = seen(&show.synth, state.own_camera().as_ref());
        let time = state.transport.scene_time(&state.timeline);
        let found = aimed(&show.scene, &synth, time, (pointer, *at));
        self.dragged = marks::draw(&found, &state.viewport, state.area(), state.scale);
    }

    fn make_fixed(&mut self, state: &State, show: &Show, view: &View, letters: &Letters) {
        let mut found = overlay(&show.scene, Some(&show.synth), view);
        found.extend(show.marks.iter().cloned());
        self.grips = view.selection.as_deref().map_or_else(Vec::new, |at| grips(&show.document, at));
        self.fixed = Canvas::default();
        if state.shows("view-grid") {
            marks::grid(&mut self.fixed, state.picture, &state.viewport, state.area());
        }
        self.fixed.strokes.extend(marks::draw(&found, &state.viewport, state.area(), state.scale).strokes);
        self.labels = labels::draw(&found, &state.viewport, state.area(), state.scale, letters);
        let legends = overlays().any(|overlay| overlay.legend.is_some() && state.shows(overlay.name));
        self.reach = if legends { reach(&show.synth, &view.vectors) } else { Reach::default() };
    }
}

/// What a mark lets the mouse drag, and where that is.
fn grip(mark: &Mark) -> Option<Grip> {
    let Shape::Dot(at) = mark.shape else { return None };
    mark.look.is_grip.then(|| Grip { pointer: mark.pointer(), at, from: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_triangle_under_the_pointer_is_told() {
        let (scene, synth) = crate::render::samples::two_squares();
        for (x, told) in
            [(25.0, Some("near, triangle 1, 4.00 m")), (52.5, Some("far, triangle 0, 5.00 m")), (5.0, None)]
        {
            assert_eq!(under(&scene, &synth, 0.0, Point::new(x, 20.0)).as_deref(), told, "{x}");
        }
        assert_eq!(under(&scene, &synth, 0.0, Point::new(-1.0, 20.0)), None);
        let only = Asked::only_shown(Some("depth:far"), &scene).unwrap();
        let [all, far] =
            [&synth, &synth.only(only)].map(|synth| under(&scene, synth, 0.0, Point::new(40.0, 20.0)).unwrap());
        assert!(all.starts_with("near, triangle") && far.starts_with("far, triangle"), "{all} {far}");
    }

    #[test]
    fn what_is_selected_has_names() {
        let scene = serde_json::from_str(
            r#"{ "plica": 1, "images": {"a": {"path": "a.png"}}, "layers": [{ "kind": "picture", "name": "face", "image": "a",
              "zones": [{ "name": "left eye", "outline": {"kind": "rectangle", "x": 1, "y": 1, "width": 6, "height": 4}}]}]}"#,
        )
        .unwrap();
        for (pointer, expected) in [
            ("", None),
            ("/timeline", Some("timeline")),
            ("/layers/0", Some("face")),
            ("/layers/0/image", Some("face/image")),
            ("/layers/0/zones/0/motion/3", Some("face/left eye/motion/3")),
            ("/layers/0/zones/7", Some("face/zones/7")),
            ("/layers/7", None),
        ] {
            assert_eq!(name(&scene, pointer).as_deref(), expected, "{pointer}");
        }
    }
}
