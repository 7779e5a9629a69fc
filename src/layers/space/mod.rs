//! What techniques in space share: where a scene is seen from, and which triangle a pixel shows. Right-handed, y up,
//! in meters, seconds and degrees; the camera looks along its -z, and the depth of a point is its distance along that.

pub mod camera;
pub mod eye;
pub mod fit;
pub mod hidden;
pub mod marks;
pub mod raster;
pub mod upload;
