//! The camera of a scene, as in the document. The doc comments become the help texts of forms and schema.

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::eye::Eye;
use crate::base::geometry::Xyz;
use crate::base::number;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::base::text::short;
use crate::layers::check;
use crate::layers::keyframes;
use crate::layers::parts::repeat::{EVERYWHERE, Snap, turned};
use crate::layers::starts::{Starts, halfway};

/// Where the scene is seen from. It looks from its position to its target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// Where it is: right, up, to the front.
    #[schemars(extend("unit" = "m"))]
    pub position: Xyz,
    /// What it looks at.
    #[schemars(extend("unit" = "m"))]
    pub target: Xyz,
    /// The direction that is up in the picture.
    #[schemars(extend("unit" = "1"))]
    pub up: Xyz,
    /// Its vertical field of view.
    #[schemars(range(min = 0.01, max = 179.0), extend("unit" = "degrees"))]
    pub fov: f64,
    /// Where it is at other times, ascending: each names what it replaces.
    pub keys: Vec<Key>,
    /// What happens between two keys.
    pub between: Between,
    /// How far it is carried round its target in one timeline, counter-clockwise as seen from above.
    #[schemars(extend("unit" = "degrees"))]
    pub turn: f64,
}

/// What a camera is at one time; what is not given is as the other keys have it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Key {
    /// The scene time.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub at: f64,
    /// Where it is then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "m"))]
    pub position: Option<Xyz>,
    /// What it looks at then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "m"))]
    pub target: Option<Xyz>,
    /// Its vertical field of view then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 179.0), extend("unit" = "degrees"))]
    pub fov: Option<f64>,
}

/// What happens between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Between {
    /// At a constant rate.
    Linear,
    /// Smoothly, without passing beyond a key (monotone cubic of Fritsch and Carlson); each coordinate by itself.
    #[default]
    Smooth,
}

/// How new keys begin: half way between their neighbors, like the one before.
pub static STARTS: Starts = Starts { ascending, item, ..Starts::PLAIN };

fn ascending(_variant: &str, list: &str) -> Option<&'static str> {
    (list == "keys").then_some("/at")
}

fn item(_variant: &str, list: &str, items: &[Value], index: usize) -> Option<(usize, Value)> {
    halfway(items, index, "/at").filter(|_| list == "keys")
}

impl Default for Camera {
    fn default() -> Self {
        Camera {
            position: [0.0, 1.2, 4.0],
            target: [0.0, 0.8, 0.0],
            up: [0.0, 1.0, 0.0],
            fov: 40.0,
            keys: Vec::new(),
            between: Between::Smooth,
            turn: 0.0,
        }
    }
}

impl Camera {
    /// The camera at scene time `t`, for frames of this width and height.
    pub fn at(&self, t: f64, size: (usize, usize)) -> Eye {
        let (from_to_up, fov) = self.view(t);
        Eye::new(from_to_up, fov, size)
    }

    /// Position, target and up at scene time `t`, and the field of view in degrees.
    pub fn view(&self, t: f64) -> ([DVec3; 3], f64) {
        let target = DVec3::from(self.components(t, self.target, |key| key.target));
        let position = DVec3::from(self.components(t, self.position, |key| key.position));
        let [fov] = self.components(t, [self.fov], |key| key.fov.map(|fov| [fov]));
        let up = DVec3::from(self.up);
        let turn = up
            .try_normalize()
            .map_or(DMat3::IDENTITY, |axis| DMat3::from_axis_angle(axis, (self.turn * t).to_radians()));
        let position = if self.turn == 0.0 { position } else { target + turn * (position - target) };
        ([position, target, up], fov)
    }

    /// Whether it changes while the time runs.
    pub fn moves(&self) -> bool {
        self.turn != 0.0 || self.keys.iter().any(|key| self.view(key.at) != self.view(0.0))
    }

    /// What jumps where a timeline that repeats starts over.
    pub fn snaps(&self) -> Vec<Snap> {
        let unturned = Camera { turn: 0.0, ..self.clone() };
        let [begin, end] = [0.0, 1.0].map(|t| unturned.view(t));
        let keys = (begin != end).then(|| Snap {
            path: "/keys".into(),
            bounds: EVERYWHERE,
            time: 1.0,
            what: "it ends elsewhere than it begins".into(),
            cure: "give it a key at 1 like that at 0, or let the timeline be once or ping-pong".into(),
            needs_time_alone: false,
        });
        turned("/turn", self.turn).into_iter().chain(keys).collect()
    }

    /// What stands for a field of a key that does not name it: what the other keys say at its time.
    pub fn automatic(&self, path: &str) -> Option<Value> {
        let (index, field) = Pointer(path).item_of("/keys")?;
        let at = self.keys.get(index)?.at;
        let place = |at: Xyz| at.map(number::json).into_iter().collect();
        match field {
            "/position" => Some(place(self.components(at, self.position, |key| key.position))),
            "/target" => Some(place(self.components(at, self.target, |key| key.target))),
            "/fov" => Some(number::json(self.components(at, [self.fov], |key| key.fov.map(|fov| [fov]))[0])),
            _ => None,
        }
    }

    /// Whether keys say this field at every time, so that its own value is not seen.
    pub fn is_ruled(&self, field: &str) -> bool {
        self.keys.iter().any(|key| match field {
            "position" => key.position.is_some(),
            "target" => key.target.is_some(),
            "fov" => key.fov.is_some(),
            _ => false,
        })
    }

    /// How many pixels of a frame of this size a meter at its target is, at the beginning.
    pub fn px_per_m(&self, size: (usize, usize)) -> f64 {
        let ([position, target, _], _) = self.view(0.0);
        self.at(0.0, size).focal_px / (target - position).length()
    }

    /// The camera that stays where this one begins.
    pub fn unmoved(&self) -> Camera {
        let ([position, target, _], fov) = self.view(0.0);
        Camera { position: position.into(), target: target.into(), up: self.up, fov, ..Camera::default() }
    }

    /// What the keys say about one field at `t`, each number for itself; `own` if no key names it.
    fn components<const N: usize>(&self, t: f64, own: [f64; N], of: impl Fn(&Key) -> Option<[f64; N]>) -> [f64; N] {
        let between = match self.between {
            Between::Linear => keyframes::Between::Linear,
            Between::Smooth => keyframes::Between::Smooth,
        };
        let keys: Vec<(f64, [f64; N])> = self.keys.iter().filter_map(|key| Some((key.at, of(key)?))).collect();
        if keys.is_empty() {
            return own;
        }
        std::array::from_fn(|i| {
            let points: Vec<[f64; 2]> = keys.iter().map(|(at, value)| [*at, value[i]]).collect();
            keyframes::value(&points, between, t)
        })
    }

    /// The checks beyond shape, for frames at these times.
    pub fn check(&self, frames: impl Iterator<Item = f64>) -> Vec<Problem> {
        let at = |i: usize| format!("/keys/{i}/at");
        let mut problems = check::ascending("times of keys", self.keys.iter().map(|key| key.at), at);
        if !problems.is_empty() {
            return problems;
        }
        let empty = |key: &Key| key.position.is_none() && key.target.is_none() && key.fov.is_none();
        let empty = self.keys.iter().enumerate().filter(|(_, key)| empty(key));
        problems.extend(empty.map(|(i, _)| {
            let problem = Problem::warning(format!("/keys/{i}"), "the key names nothing, so nothing moves by it");
            problem.hint("give it a position, a target or fov, or delete it")
        }));
        let has_up = DVec3::from(self.up).length() > 0.0;
        if self.keys.is_empty() || !has_up {
            let wrong = view_problem(self.view(0.0).0);
            let path = if has_up { "/position" } else { "/up" };
            problems.extend(wrong.map(|(what, cure)| Problem::error(path, what).hint(cure)));
            return problems;
        }
        let mut times = self.keys.iter().map(|key| key.at).chain(frames);
        let wrong = times.find_map(|t| Some((t, view_problem(self.view(t).0)?)));
        problems.extend(wrong.map(|(t, (what, cure))| {
            let after = self.keys.partition_point(|key| key.at <= t);
            let path = format!("/keys/{}", after.saturating_sub(1));
            Problem::error(path, format!("{what} at t {}", short(t, 3))).hint(cure)
        }));
        problems
    }
}

/// What is wrong with a view, and its cure.
fn view_problem([position, target, up]: [DVec3; 3]) -> Option<(&'static str, &'static str)> {
    if up.length() == 0.0 {
        return Some(("the camera has no direction that is up", "make up [0, 1, 0]"));
    }
    let Some(along) = (target - position).try_normalize() else {
        return Some(("the camera stands where it looks", "move its position or its target"));
    };
    let level = along.cross(up.normalize()).length() < 1e-9;
    level.then_some(("the camera looks along its up", "move its position or its target, or turn up"))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn camera(json: &str) -> Camera {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn each_field_follows_its_own_keys() {
        let camera = camera(
            r#"{"fov": 30, "between": "linear", "keys": [{"at": 0.2, "position": [0, 1, 4]}, {"at": 0.4, "fov": 50},
                {"at": 0.6, "position": [2, 3, 4]}]}"#,
        );
        for (t, position, fov) in
            [(0.0, [0.0, 1.0, 4.0], 50.0), (0.4, [1.0, 2.0, 4.0], 50.0), (1.0, [2.0, 3.0, 4.0], 50.0)]
        {
            let ([found, target, _], found_fov) = camera.view(t);
            assert!((found - DVec3::from(position)).length() < 1e-12, "{t}: {found}");
            assert_eq!((target, found_fov), (DVec3::new(0.0, 0.8, 0.0), fov), "{t}");
        }
    }

    #[test]
    fn what_a_key_does_not_name_is_what_the_others_say() {
        let camera = camera(
            r#"{"target": [0, 1, 0], "between": "linear", "keys": [{"at": 0, "position": [0, 1, 4]}, {"at": 0.5, "fov": 20},
                {"at": 1, "position": [2, 1, 4]}]}"#,
        );
        for (path, expected) in
            [("/keys/1/position", json!([1, 1, 4])), ("/keys/1/target", json!([0, 1, 0])), ("/keys/0/fov", json!(20))]
        {
            assert_eq!(camera.automatic(path), Some(expected), "{path}");
        }
        assert_eq!((camera.automatic("/keys/3/fov"), camera.automatic("/fov")), (None, None));
    }

    #[test]
    fn a_turn_goes_counter_clockwise_seen_from_above() {
        let camera = camera(r#"{"position": [0, 2, 4], "target": [0, 0, 0], "turn": 180}"#);
        let ([position, ..], _) = camera.view(0.5);
        assert!((position - DVec3::new(4.0, 2.0, 0.0)).length() < 1e-12, "{position}");
        assert_eq!(camera.view(0.0).0[0], DVec3::new(0.0, 2.0, 4.0));
    }

    #[test]
    fn a_key_that_names_nothing_is_told() {
        let problems = camera(r#"{"keys": [{"at": 0, "fov": 30}, {"at": 0.5}]}"#).check([0.0].into_iter());
        let paths: Vec<_> = problems.iter().map(|problem| problem.path.as_str()).collect();
        assert_eq!(paths, ["/keys/1"], "{problems:?}");
    }

    #[test]
    fn a_view_that_is_none_is_told_with_its_place() {
        for (json, path, what) in [
            (r#"{"position": [1, 2, 3], "target": [1, 2, 3]}"#, "/position", "the camera stands where it looks"),
            (r#"{"position": [0, 2, 0], "target": [0, 0, 0]}"#, "/position", "the camera looks along its up"),
            (r#"{"up": [0, 0, 0]}"#, "/up", "the camera has no direction that is up"),
            (r#"{"up": [0, 0, 0], "keys": [{"at": 0, "fov": 30}]}"#, "/up", "the camera has no direction that is up"),
            (
                r#"{"keys": [{"at": 0, "position": [1, 0, 0]}, {"at": 1, "position": [0, 0.8, 0]}]}"#,
                "/keys/1",
                "the camera stands where it looks",
            ),
            (
                r#"{"target": [0, 0, 0], "keys": [{"at": 0, "position": [0, 0, 3]}, {"at": 1, "position": [0, 0, -3]}]}"#,
                "/keys/0",
                "the camera stands where it looks at t 0.5",
            ),
            (r#"{"keys": [{"at": 0.5}, {"at": 0.5}]}"#, "/keys/1/at", ""),
        ] {
            let problems = camera(json).check([0.25, 0.5].into_iter());
            assert_eq!(problems.len(), 1, "{json}: {problems:?}");
            assert_eq!(problems[0].path, path, "{json}");
            assert!(problems[0].message.starts_with(what), "{:?}", problems[0]);
        }
        assert_eq!(Camera::default().check(std::iter::empty()), []);
    }
}
