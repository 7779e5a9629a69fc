//! Keys and drags that steer the window's own camera.

use kurbo::Vec2;

use super::own_view::OwnView;
use super::state::State;
use crate::layers::parts::moment::Moment;
use crate::layers::space::camera::Camera;
use crate::layers::space::eye::NEAR_M;
use crate::layers::space::fit::Ball;
use crate::render;
use crate::render::sight::Sight;

/// A key turns by this, in degrees.
const TURN_DEGREES: f64 = 5.0;
/// A drag over a logical pixel turns by this, in degrees.
const DRAG_DEGREES: f64 = 0.4;
/// A key walks by this share of what is seen, from top to bottom at the target.
const WALK: f64 = 0.07;
/// Right before a surface it walks as if this share of what the scene's camera sees were seen.
const LEAST_SEEN: f64 = 0.1;

impl State {
    /// Takes the camera that the scene's layers in space are seen by, and what is around them; without a camera there is
    /// nothing to steer.
    pub fn take_camera(&mut self, camera: Option<&Camera>, around: Option<Ball>) {
        (self.camera, self.around) = (camera.cloned(), around);
        self.own = self.own.filter(|_| camera.is_some());
    }

    /// The camera to draw with where it is not the scene's.
    pub fn own_camera(&self) -> Option<Camera> {
        self.own.map(|own| own.camera())
    }

    /// Looks at the result from there, by a view of its own, or without by the scene's camera; once it is seen again.
    pub fn look_from(&mut self, camera: Option<&Camera>) {
        let own = camera.map(|camera| OwnView::of(camera, 0.0));
        match self.sight {
            None => self.own = own.filter(|_| self.camera.is_some()),
            Some(_) => self.aside = own,
        }
    }

    /// Takes what is seen in place of the result. One looks round cameras from elsewhere than at that, and at that again from where
    /// one did.
    pub fn see(&mut self, sight: Option<Sight>) {
        match (&self.sight, &sight) {
            (None, Some(_)) => self.aside = self.own.take(),
            (Some(_), None) => self.own = self.aside.take(),
            (Some(before), Some(now)) if before.selects() != now.selects() => self.own = None,
            _ => {}
        }
        self.sight = sight;
    }

    /// Changes the window's own view, which begins as the scene's.
    fn change_view(&mut self, change: impl FnOnce(&mut OwnView)) {
        let Some(mut own) = self.looking() else { return };
        change(&mut own);
        self.own = Some(own);
    }

    /// Runs a command that steers; false if it is none.
    pub fn steer(&mut self, command: &str) -> bool {
        if command == "own-view-off" {
            self.own = None;
            return true;
        }
        if command == "own-view-all" {
            if self.around.is_some() {
                let size = (self.picture.width as usize, self.picture.height as usize);
                let (layers, t) = (self.layers.clone(), self.transport.scene_time(&self.timeline));
                self.change_view(|own| own.see(&|ways| render::reach_at(&layers, t, ways), size));
            }
            return true;
        }
        let Some((way, to)) = command.split_once('-') else { return false };
        let (right, up) = match to {
            "left" => (-1.0, 0.0),
            "right" => (1.0, 0.0),
            "up" | "forward" | "nearer" => (0.0, 1.0),
            "down" | "back" | "farther" => (0.0, -1.0),
            _ => return false,
        };
        match way {
            "orbit" => self.change_view(|own| own.orbit(right * TURN_DEGREES, up * TURN_DEGREES)),
            "walk" => {
                let least = self.camera.as_ref().map_or(0.0, |camera| OwnView::of(camera, 0.0).pixel(1.0) * LEAST_SEEN);
                self.change_view(|own| {
                    let step = own.pixel(1.0).max(least) * WALK;
                    own.walk(right * step, up * step);
                });
            }
            "dolly" => self.nearer(up),
            _ => return false,
        }
        true
    }

    /// The pointer has dragged the scene round by a distance on the screen.
    pub fn drag_round(&mut self, by: Vec2) {
        let by = by / self.scale * DRAG_DEGREES;
        self.change_view(|own| own.orbit(-by.x, by.y));
    }

    /// The pointer has dragged the scene along by a distance on the screen.
    pub fn drag_along(&mut self, by: Vec2) {
        let (zoom, height) = (self.viewport.zoom, self.picture.height);
        self.change_view(|own| {
            let by = by / zoom * own.pixel(height);
            own.pan(-by.x, by.y);
        });
    }

    /// The wheel goes nearer by steps.
    pub fn wheel_nearer(&mut self, steps: i32) {
        self.nearer(f64::from(steps));
    }

    /// Goes nearer to the target by steps, and says so where that goes through a surface or no further.
    fn nearer(&mut self, steps: f64) {
        let (before, around) = (self.looking(), self.around);
        self.change_view(|own| own.dolly(steps, around.as_ref()));
        let Some((before, now)) = before.zip(self.looking()).filter(|_| steps > 0.0) else { return };
        let went = before.distance() - now.distance();
        self.words.told = match self.ahead(&before) {
            // What stands in the bar then says more.
            _ if went <= 0.0 && self.sees_nothing => None,
            _ if went <= 0.0 => Some("as near as it goes: k walks on, 5 shows everything".to_owned()),
            Some(depth) if depth <= went + NEAR_M => {
                Some("through a surface, whose back is not shown: 3 goes back, 5 shows everything".to_owned())
            }
            _ => None,
        };
    }

    /// Where it looks from.
    fn looking(&self) -> Option<OwnView> {
        let scene = self.camera.as_ref()?;
        Some(self.own.unwrap_or_else(|| OwnView::of(scene, self.transport.scene_time(&self.timeline))))
    }

    /// How far away the surface in the middle of the picture is, in meters, seen from there.
    fn ahead(&self, from: &OwnView) -> Option<f64> {
        let (t, size_px) = (self.transport.scene_time(&self.timeline), (1, 1));
        let moment = Moment { t, size_px, eye: Some(from.camera().at(t, size_px)), left_out: 0, magnified: 1 };
        let depths = self.layers.iter().filter_map(|layer| layer.under((0, 0), &moment));
        depths.map(|under| under.depth_m).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;

    #[test]
    fn going_through_a_surface_and_no_further_is_told() {
        let mut state = State::for_tests();
        let camera = Camera { position: [0.2, 0.2, 2.0], target: [0.2, 0.2, -0.5], ..Camera::default() };
        state.take_camera(Some(&camera), None);
        state.layers = render::samples::two_squares().1.layers;
        let mut told = Vec::new();
        for _ in 0..40 {
            state.run("dolly-nearer");
            let at = state.own_camera().unwrap().position[2];
            let new = state.words.told.clone();
            told.extend(new.map(|new| (new.split([' ', ':']).next().unwrap().to_owned(), at)));
        }
        let (through, end): (Vec<_>, Vec<_>) = told.into_iter().partition(|(what, _)| what == "through");
        assert!(matches!(&through[..], [(_, at)] if (-0.25..0.01).contains(at)), "{through:?}");
        assert!(end.len() > 2 && end.iter().all(|(what, at)| what == "as" && *at < -0.4), "{end:?}");
        state.sees_nothing = true;
        state.run("dolly-nearer");
        assert_eq!(state.words.told, None, "that nothing is seen says more");
        state.run("dolly-farther");
        assert_eq!(state.words.told, None);
    }

    #[test]
    fn the_scene_is_steered_only_where_it_has_a_camera() {
        let mut state = State::for_tests();
        assert!(state.steer("orbit-left"));
        assert_eq!(state.own_camera(), None);
        state.take_camera(Some(&Camera::default()), None);
        assert!(!state.steer("orbit-sideways") && !state.steer("zoom-in"));
        assert_eq!(state.own_camera(), None);
        for command in ["orbit-left", "walk-forward", "dolly-nearer"] {
            state.steer(command);
            assert_ne!(state.own_camera(), Some(Camera::default()), "{command}");
            state.steer("own-view-off");
            assert_eq!(state.own_camera(), None);
        }
        state.drag_along(Vec2::new(20.0, 0.0));
        let moved = state.own_camera().unwrap();
        let eye = Camera::default().at(0.0, (320, 200));
        let seen = eye.project(eye.seen(DVec3::from(Camera::default().target) * 2.0 - DVec3::from(moved.target)));
        assert!((seen - eye.middle_px).distance(DVec2::new(10.0, 0.0)) < 1e-6, "under the pointer: {moved:?}");
        state.steer("own-view-off");
        let mut steps = Vec::new();
        for nearer in [0, 200] {
            for _ in 0..nearer {
                state.steer("dolly-nearer");
            }
            state.steer("walk-right");
            let before = state.own_camera().unwrap();
            state.steer("walk-right");
            let way = DVec3::from(state.own_camera().unwrap().position) - DVec3::from(before.position);
            steps.push(way.length());
        }
        assert!((0.19..0.22).contains(&steps[0]), "a twentieth of the way to the target: {steps:?}");
        assert!((steps[1] - steps[0] * LEAST_SEEN).abs() < 1e-9, "right before it still a tenth of that: {steps:?}");
        assert!(state.steer("own-view-all"), "of what is not known");
        state.take_camera(Some(&Camera::default()), Some(Ball { middle: DVec3::X, radius: 1.0 }));
        state.layers = render::samples::two_squares().1.layers;
        state.steer("own-view-all");
        let eye = state.own_camera().unwrap().at(0.0, (320, 200));
        let corners = [[-1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [1.5, 1.0, -1.0], [1.5, -1.0, -1.0]].map(DVec3::from);
        let places = corners.map(|at| (eye.project(eye.seen(at)) - eye.middle_px) / eye.middle_px);
        let widest = places.iter().map(|at| at.abs().max_element()).fold(0.0, f64::max);
        assert!((widest - 0.9).abs() < 1e-3, "as :camera fit does: {places:?}");
        let other = Camera { position: [1.0, 2.0, 3.0], ..Camera::default() };
        state.look_from(Some(&other));
        assert_eq!(state.own_camera(), Some(other.clone()), "the editor says from where");
        state.look_from(None);
        assert_eq!(state.own_camera(), None);
        state.look_from(Some(&other));
        state.take_camera(None, None);
        assert_eq!(state.own_camera(), None);
    }

    #[test]
    fn the_result_is_seen_again_from_where_it_was() {
        let mut state = State::for_tests();
        state.take_camera(Some(&Camera::default()), None);
        let from = |x: f64| Camera { position: [x, 2.0, 3.0], ..Camera::default() };
        let select = || Some(Sight::From(Box::default()));
        let painting = || Some(Sight::Painting { layer: 0, picture: 0, share: 0.5 });
        state.look_from(Some(&from(1.0)));
        for (sight, looks, own) in [
            (select(), None, None),
            // It is for the result.
            (select(), Some(2.0), None),
            (painting(), None, None),
            (None, None, Some(2.0)),
            (None, Some(3.0), Some(3.0)),
            (painting(), Some(4.0), None),
            (None, None, Some(4.0)),
        ] {
            state.see(sight);
            looks.into_iter().for_each(|x| state.look_from(Some(&from(x))));
            assert_eq!(state.own_camera(), own.map(from), "{:?}", state.sight);
        }
        state.see(select());
        state.steer("orbit-left");
        state.see(Some(Sight::From(Box::new(from(9.0)))));
        assert!(state.own_camera().is_some(), "one goes on looking round the cameras");
        state.see(painting());
        assert_eq!(state.own_camera(), None);
    }
}
