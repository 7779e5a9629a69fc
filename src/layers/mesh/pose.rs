//! Where a mesh is at one time: bent, scaled, turned, moved, in this order.

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::geometry::Xyz;
use crate::base::maths::{self, TAU};
use crate::base::problem::Problem;

/// Where a mesh is, and how it moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Pose {
    /// Where the origin of the mesh is.
    #[schemars(extend("unit" = "m"))]
    pub position: Xyz,
    /// Turns about the world's x, then y, then z; counter-clockwise as seen from the end of the axis.
    #[schemars(extend("unit" = "degrees"))]
    pub rotate: Xyz,
    /// How many times larger it is.
    #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "1"))]
    pub scale: f64,
    /// How far it turns about the world's y in one timeline, counter-clockwise as seen from above.
    #[schemars(extend("unit" = "degrees"))]
    pub spin: f64,
    /// How it leans to one side: nothing up to `from` on its axis, by all `degrees` from `to` on, more and more between. For a
    /// tree that sways, set degrees=20, to=(its height) and swing=1.
    pub bend: Bend,
}

/// A turn about the z through the model's origin that grows along an axis of the model: to the left, where the degrees are
/// positive and the axis is y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Bend {
    /// How far it leans from `to` on; counter-clockwise as seen from the front, so that a positive turn leans to the left.
    #[schemars(extend("unit" = "degrees"))]
    pub degrees: f64,
    /// The axis of the model along which the turn grows: y for what stands.
    pub axis: Axis,
    /// Where on the axis the turn begins, before the scale of the pose.
    #[schemars(extend("unit" = "m"))]
    pub from: f64,
    /// Where on the axis it has reached all degrees: the height of what stands, before the scale of the pose.
    #[schemars(extend("unit" = "m"))]
    pub to: f64,
    /// How many times it swings to both sides in one timeline; with 0 it stands still, bent.
    #[schemars(extend("unit" = "cycles"))]
    pub swing: f64,
}

/// An axis of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// From left to right.
    X,
    /// From below to above.
    #[default]
    Y,
    /// From back to front.
    Z,
}

impl Default for Pose {
    fn default() -> Self {
        Pose { position: [0.0; 3], rotate: [0.0; 3], scale: 1.0, spin: 0.0, bend: Bend::default() }
    }
}

impl Default for Bend {
    fn default() -> Self {
        Bend { degrees: 0.0, axis: Axis::Y, from: 0.0, to: 1.0, swing: 0.0 }
    }
}

impl Pose {
    /// The checks beyond shape.
    pub fn check(&self) -> Vec<Problem> {
        let level = self.bend.from == self.bend.to;
        let problem = || {
            Problem::error("/pose/bend/to", "the bend ends where it begins").hint("give it a length: from 0 to 1, say")
        };
        level.then(problem).into_iter().collect()
    }

    /// The pose at scene time `t`.
    pub fn at(&self, t: f64) -> Placed {
        let [x, y, z] = self.rotate.map(f64::to_radians);
        let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        let swing = if self.bend.swing == 0.0 { 1.0 } else { maths::sin(TAU * self.bend.swing * t) };
        let bend = &self.bend;
        Placed {
            turn: DMat3::from_rotation_y((self.spin * t).to_radians()) * turn,
            scale: self.scale,
            position: DVec3::from(self.position),
            bend_radians: bend.degrees.to_radians() * swing,
            along: match bend.axis {
                Axis::X => DVec3::X,
                Axis::Y => DVec3::Y,
                Axis::Z => DVec3::Z,
            },
            from: bend.from,
            length: bend.to - bend.from,
        }
    }
}

/// A pose at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The turn of the whole, from the model to the world.
    pub turn: DMat3,
    /// How many times larger.
    pub scale: f64,
    /// Where the origin is.
    pub position: DVec3,
    /// The whole bend.
    pub bend_radians: f64,
    /// The axis along which the bend grows.
    pub along: DVec3,
    /// Where it begins.
    pub from: f64,
    /// How long it grows; may be negative.
    pub length: f64,
}

impl Placed {
    /// A point of the model and its normal, in the world.
    pub fn point(&self, model: DVec3, normal: DVec3) -> (DVec3, DVec3) {
        let (bent, normal) = if self.bend_radians == 0.0 {
            (model, normal)
        } else {
            let bend = self.bend_at(model);
            (bend * model, bend * normal)
        };
        (self.turn * (bent * self.scale) + self.position, self.turn * normal)
    }

    /// How the model is turned at one of its points, to the world.
    pub fn turn_at(&self, model: DVec3) -> DMat3 {
        if self.bend_radians == 0.0 { self.turn } else { self.turn * self.bend_at(model) }
    }

    fn bend_at(&self, model: DVec3) -> DMat3 {
        let share = ((model.dot(self.along) - self.from) / self.length).clamp(0.0, 1.0);
        DMat3::from_rotation_z(self.bend_radians * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(json: &str, t: f64, model: [f64; 3]) -> [DVec3; 2] {
        let pose: Pose = serde_json::from_str(json).unwrap();
        let (point, normal) = pose.at(t).point(DVec3::from(model), DVec3::X);
        [point, normal]
    }

    #[test]
    fn a_pose_bends_then_scales_then_turns_then_moves() {
        for (json, t, model, point, normal) in [
            ("{}", 0.3, [1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [1.0, 0.0, 0.0]),
            (r#"{"position": [1, 0, 0], "scale": 2}"#, 0.0, [1.0, 2.0, 3.0], [3.0, 4.0, 6.0], [1.0, 0.0, 0.0]),
            // About x first: y goes to z, and that, about y, to x.
            (r#"{"rotate": [90, 90, 0]}"#, 0.0, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
            (r#"{"spin": 360}"#, 0.25, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
            (r#"{"bend": {"degrees": 90}}"#, 0.0, [0.0, 2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            (r#"{"bend": {"degrees": 90}}"#, 0.0, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            (r#"{"bend": {"degrees": 90, "swing": 1}}"#, 0.75, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
            (
                r#"{"bend": {"degrees": 180, "axis": "x", "from": 1, "to": 3}}"#,
                0.0,
                [2.0, 0.0, 0.0],
                [0.0, 2.0, 0.0],
                [0.0, 1.0, 0.0],
            ),
        ] {
            let found = placed(json, t, model);
            let far = (found[0] - DVec3::from(point)).length().max((found[1] - DVec3::from(normal)).length());
            assert!(far < 1e-12, "{json} at {t}: {found:?}");
        }
    }

    #[test]
    fn a_bend_of_no_length_is_refused() {
        let pose: Pose = serde_json::from_str(r#"{"bend": {"from": 2, "to": 2}}"#).unwrap();
        assert_eq!(pose.check()[0].path, "/pose/bend/to");
        assert_eq!(Pose::default().check(), []);
    }
}
