//! The pictures of the demo scenes, by the file they are committed as.

use kit::Canvas;

mod beach;
mod cat;
mod chest;
mod eye;
mod kit;
mod noise;
mod road;
mod skin;
mod wound;

/// The file, relative to the project's root, and the function that draws it.
pub const PICTURES: &[(&str, fn() -> Canvas)] = &[
    ("profiles/blink/eye.png", eye::eye),
    ("profiles/blink/lashes.png", eye::lashes),
    ("profiles/waves/beach.png", beach::beach),
    ("profiles/wound/arm.png", wound::wound),
    ("profiles/pecs/chest.png", chest::chest),
    ("profiles/car/road.png", road::road),
    ("profiles/car/car.png", road::car),
    ("profiles/car/light.png", road::light),
    ("profiles/cat/cat.png", cat::cat),
    ("tests/photos/flesh.png", wound::flesh_for_hand),
];
