//! A smaller synthesis for a preview, for pictures that are too large for the GPU.

use super::Synth;
use crate::base::reduce::Reduced;

/// The synthesis of a scene whose frames are `factor` times smaller on each side.
pub fn reduced(synth: &Synth, factor: usize) -> Synth {
    let mut pictures = Reduced::new(factor);
    let layers = synth.layers.iter().map(|layer| layer.reduced(&mut pictures)).collect();
    let size = (synth.size.0.div_ceil(factor), synth.size.1.div_ceil(factor));
    Synth { size, layers, ..synth.clone() }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::maths;
    use crate::base::picture::Picture;
    use crate::base::pixels::Rgba;
    use crate::base::reduce::means;
    use crate::layers::parts::materials::Materials;
    use crate::render::{cpu, synth};

    #[test]
    fn a_reduced_frame_looks_like_the_frame_reduced() {
        let cell = |i: usize| {
            let wave = |x: usize| (0.5 + 0.5 * maths::sin(x as f64 / 23.0)) as f32;
            [wave(i % 200), wave(i / 200), 0.4, 1.0]
        };
        let picture = Arc::new(Picture::from_cells(200, 160, (0..200 * 160).map(cell).collect()));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let scene = serde_json::from_str(
            r#"{"plica": 1, "layers": [{"kind": "picture", "name": "l", "image": "a", "zones": [{"name": "z",
              "outline": {"kind": "ellipse", "center": [101, 79], "radii": [70, 60]},
              "motion": [{"tool": "point", "at": [90, 70], "jump": [24, 12]}, {"tool": "still-border", "spacing": 10}],
              "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 110, "y": 60, "width": 30, "height": 40}]}}]}]}"#,
        )
        .unwrap();
        let large = synth(&scene, &materials, None).unwrap();
        let (small, expected) =
            (cpu::linear(&reduced(&large, 4), 0.6), means(&cpu::linear(&large, 0.6).into(), 4).to_linear());
        assert_eq!((small.width(), small.height()), (50, 40));
        let far = |(a, b): (&Rgba, &Rgba)| (0..4).any(|c| (a[c] - b[c]).abs() > 0.05);
        let count = small.cells().iter().zip(expected.cells()).filter(|&p| far(p)).count();
        assert!(count < 60, "{count} of 2000 differ");
    }
}
