//! The pictures of the demo scenes, by the file they are committed as.

use kit::Canvas;

mod beach;
mod cat;
mod chest;
mod eye;
mod fire;
mod fish;
mod kit;
pub mod noise;
mod road;
mod skin;
mod vase;
mod water;
mod wound;

/// A clip: the files of its frames, relative to the project's root, with `%04d` for their number; how many there are; and the
/// function that draws one.
pub const CLIPS: &[(&str, usize, fn(usize) -> Canvas)] =
    &[("profiles/falls/water-%04d.png", 20, water::frame), ("profiles/fire/fire-%04d.png", 20, fire::frame)];

/// A file of a clip.
pub fn frame_file(pattern: &str, number: usize) -> String {
    pattern.replace("%04d", &format!("{number:04}"))
}

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
    ("profiles/vase/clay.png", vase::clay),
    ("profiles/vase/mouth.png", vase::mouth),
    ("profiles/vase/flowers.png", vase::flowers),
    ("profiles/vase/dots.png", vase::dots),
    ("profiles/fish/left.png", fish::left),
    ("profiles/fish/right.png", fish::right),
    ("profiles/fish/scales.png", fish::scales),
    ("profiles/fish/shine.png", fish::shine),
    ("tests/photos/flesh.png", wound::flesh_for_hand),
];
