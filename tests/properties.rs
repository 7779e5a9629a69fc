//! Properties that hold for any input, for parts where examples are not enough: membership in regions, palettes, merges
//! and the atlas.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::f64::consts::TAU;
use std::sync::Arc;

use kurbo::Point;
use plica::base::geometry::Polygon;
use plica::base::maths;
use plica::base::picture::Picture;
use plica::base::pixels::Beyond;
use plica::base::quantise::{Histogram, Nearest};
use plica::layers::folding::atlas::{Area, Atlas, Need};
use plica::scene::merge::{Side, merge};
use proptest::collection::vec;
use proptest::prelude::*;
use serde_json::{Map, Value, json};

/// The winding number of the sides around `q`, by the sum of the angles that they subtend.
fn turns(vertices: &[Point], q: Point) -> i64 {
    let angle = |i: usize| {
        let (a, b) = (vertices[i] - q, vertices[(i + 1) % vertices.len()] - q);
        maths::atan2(a.cross(b), a.dot(b))
    };
    ((0..vertices.len()).map(angle).sum::<f64>() / TAU).round() as i64
}

/// A miniature scene: named items, numbers and lists without names.
fn versions() -> impl Strategy<Value = (Value, Value, Value)> {
    let values = || vec(0..4i32, 7);
    (values(), vec(0..3usize, 7), values()).prop_map(|(base, sides, new)| {
        let scene = |values: &dyn Fn(usize) -> i32| {
            let zones: Vec<Value> =
                (0..4).map(|i| json!({ "name": format!("zone {i}"), "speed": values(i), "at": [i, 7] })).collect();
            json!({ "title": values(4), "zones": zones, "timeline": { "fps": values(5), "duration": values(6) } })
        };
        // Who changes the value with that number: nobody, one side, or the other.
        let side = |own: usize| scene(&|i| if sides[i] == own { new[i] } else { base[i] });
        (scene(&|i| base[i]), side(1), side(2))
    })
}

/// Objects with any subset of a few keys.
fn objects() -> impl Strategy<Value = Value> {
    proptest::collection::btree_map("[a-d]", 0..3i32, 0..4).prop_map(|found| {
        Value::Object(found.into_iter().map(|(key, value)| (key, value.into())).collect::<Map<_, _>>())
    })
}

fn palette_error(palette: &[[u8; 3]], colors: &[[u8; 3]]) -> f64 {
    let nearest = Nearest::new(&palette.iter().map(|color| color.map(f64::from)).collect::<Vec<_>>());
    colors.iter().map(|color| nearest.error(color.map(f64::from))).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn inside_is_an_odd_number_of_turns(
        vertices in vec((0.0..60.0f64, 0.0..60.0f64), 3..40),
        places in vec((-5.0..65.0f64, -5.0..65.0f64), 20),
    ) {
        let vertices: Vec<Point> = vertices.into_iter().map(Point::from).collect();
        let polygon = Polygon::new(vertices.clone());
        for q in places.into_iter().map(Point::from).filter(|&q| polygon.distance(q) > 1e-6) {
            prop_assert_eq!(polygon.contains(q), turns(&vertices, q) % 2 != 0, "{}", q);
        }
    }

    #[test]
    fn what_does_not_meet_merges_alike_from_both_sides((base, mine, theirs) in versions()) {
        let one = merge(Some(&base), &mine, &theirs, Side::Mine);
        let other = merge(Some(&base), &theirs, &mine, Side::Theirs);
        prop_assert!(one.conflicts.is_empty(), "{:?}", one.conflicts);
        prop_assert_eq!(&one.json, &other.json);
        // Nothing is lost: each side finds its own changes again.
        for (changed, unchanged) in [(&mine, &theirs), (&theirs, &mine)] {
            for (i, zone) in changed["zones"].as_array().unwrap().iter().enumerate() {
                if zone != &base["zones"][i] {
                    prop_assert_eq!(&one.json["zones"][i], zone);
                } else {
                    prop_assert_eq!(&one.json["zones"][i], &unchanged["zones"][i]);
                }
            }
        }
    }

    #[test]
    fn either_side_wins_whole(base in objects(), mine in objects(), theirs in objects()) {
        let one = merge(Some(&base), &mine, &theirs, Side::Mine);
        let other = merge(Some(&base), &theirs, &mine, Side::Theirs);
        prop_assert_eq!(&one.json, &other.json, "mine wins, whichever side it stands on");
        let places = |conflicts: &[plica::scene::merge::Conflict]| -> Vec<String> {
            let mut places: Vec<String> = conflicts.iter().map(|conflict| conflict.pointer.clone()).collect();
            places.sort();
            places
        };
        prop_assert_eq!(places(&one.conflicts), places(&other.conflicts));
        prop_assert_eq!(merge(Some(&base), &mine, &mine, Side::Mine).json, mine.clone());
        prop_assert_eq!(merge(Some(&base), &mine, &base, Side::Theirs).json, mine);
    }

    #[test]
    fn pieces_of_the_atlas_never_overlap(areas in vec((0..3usize, 0..20i64, 0..20i64, 1..20i64, 1..20i64), 1..24)) {
        let picture = Arc::new(Picture::from_cells(40, 40, vec![[0.5; 4]; 1600]));
        let need = |&(image, x0, y0, width, height): &(usize, i64, i64, i64, i64)| Need {
            image: image.to_string(),
            picture: picture.clone(),
            beyond: Beyond::Clamp,
            area: Area { x0, y0, x1: x0 + width, y1: y0 + height },
        };
        let (atlas, piece_of) = Atlas::new(areas.iter().map(need).collect());
        let gutter = usize::from(atlas.pieces.len() > 1);
        let mut taken = vec![false; atlas.colors.width() * atlas.colors.height()];
        for piece in &atlas.pieces {
            let (width, height) = (piece.need.area.width() as usize, piece.need.area.height() as usize);
            for y in piece.y - gutter..piece.y + height + gutter {
                for x in piece.x - gutter..piece.x + width + gutter {
                    let cell = &mut taken[y * atlas.colors.width() + x];
                    prop_assert!(!*cell, "texel {}, {} twice", x, y);
                    *cell = true;
                }
            }
        }
        for (&(image, x0, y0, width, height), piece) in areas.iter().zip(piece_of) {
            let need = &atlas.pieces[piece].need;
            prop_assert_eq!(&need.image, &image.to_string());
            let holds = need.area.x0 <= x0 && need.area.y0 <= y0 && need.area.x1 >= x0 + width && need.area.y1 >= y0 + height;
            prop_assert!(holds, "{:?} does not hold its need", need.area);
        }
    }
}

proptest! {
    // k-means is slow without optimisation.
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_palette_is_no_worse_than_one_spread_evenly(
        colors in vec(any::<[u8; 3]>(), 1..60),
        spread in 2..9u8,
    ) {
        let colors: Vec<[u8; 3]> = colors.into_iter().map(|color| color.map(|code| code / spread + 30)).collect();
        // Three steps along each axis of their bounding box.
        let least: [u8; 3] = std::array::from_fn(|axis| colors.iter().map(|color| color[axis]).min().unwrap());
        let most: [u8; 3] = std::array::from_fn(|axis| colors.iter().map(|color| color[axis]).max().unwrap());
        let step = |axis: usize, step: u8| least[axis] + (most[axis] - least[axis]) / 6 * (2 * step + 1);
        let even: Vec<[u8; 3]> = (0..27u8).map(|i| [step(0, i / 9), step(1, i / 3 % 3), step(2, i % 3)]).collect();
        let palette = Histogram::of(colors.iter().copied()).palette(even.len());
        prop_assert!(!palette.is_empty() && palette.len() <= even.len());
        prop_assert!(palette_error(&palette, &colors) <= palette_error(&even, &colors) + colors.len() as f64);
    }
}
