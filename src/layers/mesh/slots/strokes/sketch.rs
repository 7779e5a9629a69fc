//! Small drawings of noises and of what inks.

use super::aim::{Aim, Follows};
use super::bins::Binning;
use super::even::even;
use super::force::Strokes;
use super::grid;
use super::impulse::Recipe;
use super::marks::{Ink, Set};
use super::model::{Force, Noise};
use super::passes;
use super::shown::InFrame;
use super::sum::{Noise as Summed, Trim, sum};
use super::tone::share;
use crate::base::pixels::Grid;
use crate::base::pointer::Pointer;
use crate::layers::parts::sketch::{Curve, Patch, Sketch};

/// What there are drawings of.
pub const OF: &[&str] = &["noise", "mark of ink"];

/// How many standard deviations of a noise are from black to white.
const CONTRAST: f32 = 5.0;

/// The drawing of what is at `path`, relative to the strokes: a noise, or a mark of ink.
pub fn sketch(strokes: &Strokes, path: &str) -> Option<Sketch> {
    let tokens: Vec<String> = Pointer(path).tokens().take(2).collect();
    let [list, item] = &tokens[..] else { return None };
    if list == "noises" {
        let noise = strokes.noises.get(item)?;
        return Some(Sketch::Patch(patch(strokes, noise)));
    }
    let name = strokes.value(&(Pointer("/marks").join(item) + "/name")).filter(|_| list == "marks")?;
    match strokes.marks.iter().find(|mark| name == mark.name.as_str()).and_then(Set::of)? {
        Set::Ink(ink) => Some(Sketch::Curve(curve(strokes, &ink))),
        Set::Pigment(_) | Set::Relief(_) | Set::Outline(_) => None,
    }
}

/// The share that ink covers at a tone.
fn curve(strokes: &Force, Ink { amount, from, to, .. }: &Ink) -> Curve {
    let (amount, from, to) = (amount * strokes.amount, *from, *to);
    let value = move |tone: f64| (amount * f64::from(share(tone as f32, from as f32, to as f32))).clamp(0.0, 1.0);
    Curve { axes: ["tone", "inked"], value: Box::new(value), over: &passes::TONE }
}

/// A noise on a surface that faces the eye.
fn patch(strokes: &Force, noise: &Noise) -> Patch {
    let spacing_px = noise.spacing * strokes.size;
    let direction = noise.direction.as_ref().unwrap_or(&strokes.direction);
    let turn = (direction.turn + noise.turn).to_radians();
    let angle = Aim::new(Follows::Screen, direction.angle.to_radians(), turn, None).drawn;
    let (key, spread) = (Recipe::key(strokes.seed, 0, noise.seed), noise.spread.to_radians());
    let (regularity, overlap, is_even) = (noise.regularity, noise.overlap, noise.even);
    let make = move |size: (usize, usize), px: f64| {
        let spacing_px = spacing_px / px;
        let recipe = Recipe { key, spacing_px, radius_px: spacing_px * regularity, overlap, spread };
        let count = size.0 * size.1;
        let (inverse, triangle) = (vec![1.0; count], vec![0; count]);
        let shown = InFrame::new((size, 1.0), &inverse, &triangle, None);
        let mut kernels = Binning::new(size, shown.focal_px);
        kernels.extend(grid::impulses(size, &recipe, angle));
        let mut found = Summed::of_values(count);
        sum(&shown, &[kernels.sorted()], (overlap, regularity), Trim::Object, &mut found);
        if is_even {
            even(size, &triangle, spacing_px, &mut found);
        }
        let light = found.value.into_iter().map(|x| (0.5 + x / CONTRAST).clamp(0.0, 1.0));
        Grid::from_cells(size.0, size.1, light.collect())
    };
    Patch { lengths_px: vec![("spacing", spacing_px), ("radius", spacing_px * noise.regularity)], make: Box::new(make) }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn strokes() -> Strokes {
        serde_json::from_value(json!({
            "style": "hatching",
            "noises": {"mine": {"spacing": 8, "regularity": 2, "overlap": 64, "spread": 0, "direction": {"along": "screen", "angle": 0}}},
            "marks": [{"name": "half", "kind": "ink", "noise": "mine", "from": 0.8, "to": 0.2, "amount": 0.5}, {"name": "line", "kind": "outline"}]
        }))
        .unwrap()
    }

    #[test]
    fn noises_and_ink_have_drawings() {
        let strokes = strokes();
        let drawn = |path: &str| match sketch(&strokes, path) {
            Some(Sketch::Patch(_)) => "patch",
            Some(Sketch::Curve(_)) => "curve",
            None => "nothing",
        };
        let named = |index: usize| strokes.written["marks"][index]["name"].clone();
        assert_eq!((named(0), named(1)), (json!("half"), json!("line")));
        for (path, expected) in [
            ("/noises/mine", "patch"),
            ("/noises/mine/direction/angle", "patch"),
            ("/noises/none", "nothing"),
            ("/marks/0", "curve"),
            ("/marks/0/grain", "curve"),
            ("/marks/1", "nothing"),
            ("/marks/9", "nothing"),
            ("/tone", "nothing"),
            ("", "nothing"),
        ] {
            assert_eq!(drawn(path), expected, "{path}");
        }
    }

    #[test]
    fn a_curve_is_the_inked_share() {
        let Some(Sketch::Curve(curve)) = sketch(&strokes(), "/marks/0") else { panic!("a curve") };
        let amount = strokes().amount;
        for (tone, expected) in [(0.0, 0.5), (0.2, 0.5), (0.5, 0.25), (0.8, 0.0), (1.0, 0.0)] {
            assert!(((curve.value)(tone) - expected * amount).abs() < 1e-6, "{tone}");
        }
    }

    #[test]
    fn a_patch_has_its_strokes_and_its_spacing() {
        let Some(Sketch::Patch(patch)) = sketch(&strokes(), "/noises/mine") else { panic!("a patch") };
        assert_eq!(patch.lengths_px, [("spacing", 8.0 * strokes().size), ("radius", 16.0 * strokes().size)]);
        // Strokes run across: the noise changes down, about twice as often where pixels are twice as wide.
        let changes = |px: f64| {
            let grid = (patch.make)((64, 64), px);
            let light = |x: usize, y: usize| *grid.get(x, y) > 0.5;
            let all = |(right, down): (usize, usize)| {
                let next = |x: usize, y: usize| light((x + right).min(63), (y + down).min(63));
                (0..64 * 64).filter(|i| light(i % 64, i / 64) != next(i % 64, i / 64)).count()
            };
            [all((1, 0)), all((0, 1))]
        };
        let ([across, down], [_, finer]) = (changes(1.0), changes(2.0));
        assert!(down > 3 * across && (1.6..2.4).contains(&(finer as f64 / down as f64)), "{across} {down} {finer}");
    }
}
