//! How long the synthesis of a zone takes, by method and number of anchors: the baseline for later work.
//! `cargo bench --bench synthesis`

mod scenes;

use divan::Bencher;
use plica::layers::folding::field::{Inputs, Made};
use plica::layers::parts::materials::Materials;
use plica::layers::parts::moment::CENTER;

fn main() {
    divan::main();
}

/// Anchors on a picture of 1920 x 1080 pixels.
#[divan::bench(args = [62, 94, 1000, 10000], sample_count = 5)]
fn shepard_1920x1080(bencher: Bencher, anchors: usize) {
    synthesis(bencher, (1920, 1080), anchors, r#"{"method":"shepard"}"#);
}

#[divan::bench(args = [94, 1000, 10000], sample_count = 5)]
fn shepard_of_power_3_5_1920x1080(bencher: Bencher, anchors: usize) {
    synthesis(bencher, (1920, 1080), anchors, r#"{"method":"shepard","power":3.5}"#);
}

/// The radius that contains 32 anchors on average.
fn radius(anchors: usize) -> f64 {
    (32.0 * 1920.0 * 1080.0 / (std::f64::consts::PI * anchors as f64)).sqrt()
}

#[divan::bench(args = [94], sample_count = 5)]
fn modified_shepard_random_1920x1080(bencher: Bencher, anchors: usize) {
    let (radius, ring) = (radius(anchors), radius(anchors) / 5.0);
    let method = format!(r#"{{"method":"modified-shepard-random","radius":{radius},"ring":{ring}}}"#);
    synthesis(bencher, (1920, 1080), anchors, &method);
}

#[divan::bench(args = [62, 94, 1000, 10000], sample_count = 5)]
fn modified_shepard_1920x1080(bencher: Bencher, anchors: usize) {
    let radius = radius(anchors);
    synthesis(bencher, (1920, 1080), anchors, &format!(r#"{{"method":"modified-shepard","radius":{radius}}}"#));
}

#[divan::bench(args = [62, 94, 1000], sample_count = 3)]
fn thin_plate_1920x1080(bencher: Bencher, anchors: usize) {
    synthesis(bencher, (1920, 1080), anchors, r#"{"method":"thin-plate"}"#);
}

#[divan::bench(args = [62, 94], sample_count = 3)]
fn rigid_1920x1080(bencher: Bencher, anchors: usize) {
    synthesis(bencher, (1920, 1080), anchors, r#"{"method":"rigid"}"#);
}

/// The zone whose change must be visible within 50 ms of a key press.
#[divan::bench(args = ["shepard", "modified-shepard"], sample_count = 20)]
fn edit_512x512_with_94_anchors_and_a_fold(bencher: Bencher, method: &str) {
    let more = if method == "shepard" { "" } else { r#","radius":170"# };
    synthesis(bencher, (512, 512), 94, &format!(r#"{{"method":"{method}"{more}}}"#));
}

fn synthesis(bencher: Bencher, size: (usize, usize), anchors: usize, interpolation: &str) {
    let zone = scenes::zone(size, anchors, interpolation);
    let inputs = Inputs::new(&zone, size, CENTER);
    bencher.bench(|| Made::new(&inputs, None, &Materials::default()));
}
