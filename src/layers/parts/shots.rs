//! Pictures with the cameras that took them, to be laid on a layer.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::marks::Mark;
use crate::base::geometry::Xy;
use crate::base::maths;
use crate::base::picture::Picture;
use crate::base::pixels::Linear;

/// How much the shape of a picture may differ from that of its camera, as a share.
const SHAPE_OFF: f64 = 0.01;

/// What is wrong with a picture of this size, in pixels, for a camera that is for another; `None` if both have the same
/// shape.
pub fn misshapen([width, height]: [u32; 2], [own_width, own_height]: [u32; 2]) -> Option<String> {
    let shape = |width: u32, height: u32| f64::from(width) / f64::from(height);
    let off = (shape(width, height) / shape(own_width, own_height) - 1.0).abs();
    (off > SHAPE_OFF).then(|| format!("the picture is {width}x{height}, its camera is for {own_width}x{own_height}"))
}

/// A pinhole camera: x right, y down, z forward, pixel centers at .5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Turns directions in the world into the camera's.
    pub turn: DMat3,
    /// Where the world's origin is for the camera, in meters.
    pub shift: DVec3,
    /// Focal lengths across and down, in pixels.
    pub focal_px: Xy,
    /// Where its axis meets the picture, in pixels; `None` is the middle.
    pub center_px: Option<Xy>,
    /// The width and height that this is for; `None` is the picture's.
    pub size_px: Option<[u32; 2]>,
}

/// Where a picture is seen from, in the coordinates of the model that it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeenFrom {
    /// By a camera that is known as a whole.
    Shot(Shot),
    /// From a place to another, in meters.
    Standing {
        /// The camera.
        position: DVec3,
        /// What it looks at.
        target: DVec3,
        /// The direction that is up in the picture; `None` is y.
        up: Option<DVec3>,
        /// Its vertical field of view in degrees; `None` is the usual one.
        fov: Option<f64>,
    },
}

/// What a view feeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Feeds {
    /// The base coat and what depends on the view: a photograph.
    #[default]
    Both,
    /// The base coat, which is seen from everywhere.
    Independent,
    /// What is seen only near its camera.
    Dependent,
}

impl Feeds {
    /// All of it.
    pub const ALL: [Feeds; 3] = [Feeds::Both, Feeds::Independent, Feeds::Dependent];

    /// The document's word for it.
    pub fn word(self) -> &'static str {
        match self {
            Feeds::Both => "both",
            Feeds::Independent => "independent",
            Feeds::Dependent => "dependent",
        }
    }
}

/// A picture to be laid on a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Laid {
    /// What it is called there; unique.
    pub name: String,
    /// The name of the picture in the scene's images.
    pub image: String,
    /// Its camera.
    pub from: SeenFrom,
    /// What it is for, in the document's word; `None` is the usual.
    pub kind: Option<String>,
    /// How far it fades towards its border, in pixels.
    pub feather_px: f64,
    /// How much of it is left out beside steps in depth, in pixels.
    pub edge_px: f64,
    /// The name of the image that it is painted over, if it is: only what differs from that counts.
    pub guide: Option<String>,
}

/// A picture that lies on a layer, by its names there and among the scene's images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lying<'a> {
    /// What it is called there.
    pub name: &'a str,
    /// The name in the scene's images.
    pub image: &'a str,
    /// The image that it is painted over, by its name there, if it is.
    pub guide: Option<&'a str>,
    /// Its camera; `None` if there is none that makes sense.
    pub from: Option<SeenFrom>,
}

/// A picture over what its camera sees of a layer.
#[derive(Clone, Debug)]
pub struct Painted {
    /// Both together, as large as the picture.
    pub picture: Arc<Picture>,
    /// The border of the part of the picture that counts, in its pixels; paths are relative to the layer.
    pub marks: Vec<Mark>,
}

/// What is put round what the camera of a picture looks at, as far away from that as the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Put {
    /// A point at which the picture is gone.
    Extreme,
    /// A place from which the picture is not seen.
    Blend,
    /// Nothing: the place is only told, as that of a point.
    Nothing,
}

/// What is seen of a layer's model from a place.
#[derive(Clone, Debug)]
pub struct Taken {
    /// What the place is called.
    pub name: &'static str,
    /// The camera, in the coordinates of the model.
    pub from: SeenFrom,
    /// The picture.
    pub picture: Linear,
}

/// How more pictures come to lie on a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Laying {
    /// What is set first, if something is: its path in the layer, and the value.
    pub first: Option<(&'static str, Value)>,
    /// The list that they are in, by its path in the layer.
    pub list: &'static str,
    /// What each is there.
    pub items: Vec<Value>,
}

impl Shot {
    /// The rows of the matrix from the world to the camera.
    pub fn rows(&self) -> [[f64; 4]; 3] {
        let turn = self.turn.transpose();
        let row = |axis: DVec3, shift: f64| [axis.x, axis.y, axis.z, shift];
        [row(turn.x_axis, self.shift.x), row(turn.y_axis, self.shift.y), row(turn.z_axis, self.shift.z)]
    }

    /// Where the camera is in the world.
    pub fn position(&self) -> DVec3 {
        -(self.turn.transpose() * self.shift)
    }

    /// The way it looks.
    pub fn forward(&self) -> DVec3 {
        self.turn.transpose().z_axis
    }

    /// The direction that is up in the picture.
    pub fn up(&self) -> DVec3 {
        -self.turn.transpose().y_axis
    }

    /// Its vertical field of view in degrees, for a picture of this height.
    pub fn fov(&self, height_px: f64) -> f64 {
        2.0 * maths::atan(0.5 * height_px / self.focal_px[1]).to_degrees()
    }

    /// The same camera over a world whose z pointed up, turned so that y does.
    pub fn from_z_up(self) -> Shot {
        let turned = DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y);
        Shot { turn: self.turn * turned.transpose(), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_view_feeds_is_called_as_in_the_document() {
        let schema = serde_json::to_value(schemars::schema_for!(Feeds)).unwrap();
        let words = schema["oneOf"].as_array().unwrap().iter().map(|one| one["const"].as_str().unwrap());
        assert_eq!(Feeds::ALL.map(Feeds::word).to_vec(), words.collect::<Vec<_>>());
    }

    #[test]
    fn a_camera_over_a_world_with_z_up_stands_where_it_did_when_that_is_turned() {
        let shot = Shot {
            turn: DMat3::from_rotation_y(0.3) * DMat3::from_rotation_x(-0.9),
            shift: DVec3::new(0.5, -0.25, 4.0),
            focal_px: [500.0, 510.0],
            center_px: None,
            size_px: None,
        };
        let turned = shot.from_z_up();
        for [x, y, z] in [[1.0, 2.0, 3.0], [-1.0, 0.5, 0.25]] {
            let seen = shot.turn * DVec3::new(x, y, z) + shot.shift;
            let again = turned.turn * DVec3::new(x, z, -y) + turned.shift;
            assert!((seen - again).length() < 1e-12);
        }
        let DVec3 { x, y, z } = shot.position();
        assert!((turned.position() - DVec3::new(x, z, -y)).length() < 1e-12);
        let [first, ..] = shot.rows();
        let seen = shot.turn * DVec3::Y + shot.shift;
        assert!((first[1] + first[3] - seen.x).abs() < 1e-12);
    }
}
