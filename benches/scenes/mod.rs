//! The scenes of the benchmarks: anchors from a fixed sequence, 60 % of them still, jumps of up to 5 % of the width, in
//! a zone that covers the picture and folds at an ellipse.

use plica::layers::folding::model::Zone;

/// A zone that covers a picture of `size`.
pub fn zone((width, height): (usize, usize), anchors: usize, interpolation: &str) -> Zone {
    let mut random = Sequence(1);
    let points: Vec<String> = (0..anchors)
        .map(|_| {
            let at = [random.next() * width as f64, random.next() * height as f64];
            let reach = if random.next() < 0.6 { 0.0 } else { 0.1 * width as f64 };
            let jump = [(random.next() - 0.5) * reach, (random.next() - 0.5) * reach];
            format!(r#"{{"tool":"point","at":{at:?},"jump":{jump:?}}}"#)
        })
        .collect();
    let (x, y) = (width as f64 / 2.0, height as f64 / 2.0);
    let json = format!(
        r#"{{"name":"all","outline":{{"kind":"rectangle","x":0,"y":0,"width":{width},"height":{height}}},
            "motion":[{}],"interpolation":{interpolation},"position":{{"function":"sine"}},
            "fold":{{"rule":"cover","regions":[{{"kind":"ellipse","center":[{x},{y}],"radii":[{},{}]}}]}}}}"#,
        points.join(","),
        x / 3.0,
        y / 3.0
    );
    serde_json::from_str(&json).expect("the zone is written as the document wants it")
}

/// Numbers from 0 to 1 by a linear congruential generator (Knuth's MMIX constants).
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
