//! What every method must do, and the values of each, checked against its formula.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use kurbo::{Point, Vec2};

use super::method::AT_ANCHOR_PX;
use super::*;
use crate::base::budget::Budget;
use crate::base::maths;
use crate::layers::tests::variants;

const METHODS: [&str; 9] = [
    r#"{"method":"shepard"}"#,
    r#"{"method":"shepard","power":1}"#,
    r#"{"method":"shepard","power":3.5}"#,
    r#"{"method":"shepard","power":100}"#,
    r#"{"method":"modified-shepard","radius":40}"#,
    r#"{"method":"modified-shepard-random","radius":40,"ring":25,"seed":7}"#,
    r#"{"method":"thin-plate"}"#,
    r#"{"method":"thin-plate","smoothing":50}"#,
    r#"{"method":"rigid"}"#,
];

const CENTER: Vec2 = Vec2::new(0.5, 0.5);

fn interpolator(json: &str, anchors: &[Anchor], size: [u32; 2], place: Vec2) -> Interpolator {
    let interpolation = serde_json::from_str(json).unwrap();
    Interpolator::new(&interpolation, anchors, size, place, &Materials::default()).unwrap()
}

/// The jump vectors of an area, row by row.
fn jumps(interpolator: &Interpolator, area: Area) -> Vec<Vec2> {
    let width = (area.to[0] - area.from[0]) as usize;
    let mut found = vec![Vec2::new(f64::NAN, f64::NAN); area.count() as usize];
    for cell in interpolator.cells(&area, &|_| true, &|| false).unwrap() {
        interpolator.fill(&cell, &area, &|_| true, &mut |Stretch { pixel: [x, y], x: xs, y: ys }| {
            let first = (y - area.from[1]) as usize * width + (x - area.from[0]) as usize;
            let told = found[first..].iter_mut().zip(xs.iter().zip(ys.iter()));
            told.for_each(|(found, (x, y))| *found = Vec2::new(*x, *y));
        });
    }
    found
}

fn at(json: &str, anchors: &[[f64; 4]], (x, y): (u32, u32)) -> Vec2 {
    let interpolator = interpolator(json, &make(anchors), [100, 100], CENTER);
    jumps(&interpolator, Area { from: [x, y], to: [x + 1, y + 1] })[0]
}

fn make(anchors: &[[f64; 4]]) -> Vec<Anchor> {
    let anchor = |&[x, y, u, v]: &[f64; 4]| Anchor { at: Point::new(x, y), jump: Vec2::new(u, v), tool: 0 };
    anchors.iter().map(anchor).collect()
}

#[track_caller]
fn assert_near(found: Vec2, expected: (f64, f64), tolerance: f64) {
    assert!((found - Vec2::from(expected)).hypot2().sqrt() <= tolerance, "{found:?}, not {expected:?}");
}

#[test]
fn every_method_of_the_schema_is_looked_at() {
    for method in variants::<Interpolation>("method") {
        let listed = METHODS.iter().any(|json| json.contains(&format!(r#""method":"{method}""#)));
        assert!(listed, "METHODS has no {method}");
    }
}

#[test]
fn every_method_reproduces_a_constant() {
    let anchors = [[3.0, 4.0, 2.0, -1.0], [20.0, 7.0, 2.0, -1.0], [9.0, 31.0, 2.0, -1.0]];
    for method in METHODS {
        assert_near(at(method, &anchors, (10, 10)), (2.0, -1.0), 1e-9);
    }
}

#[test]
fn every_method_is_exact_at_its_anchors() {
    let anchors = [[3.5, 4.5, 2.0, -1.0], [20.5, 7.5, -5.0, 3.0], [9.5, 31.5, 0.0, 8.0], [30.5, 30.5, 1.0, 1.0]];
    for method in METHODS.iter().filter(|method| !method.contains("smoothing")) {
        assert_near(at(method, &anchors, (20, 7)), (-5.0, 3.0), 1e-6);
    }
    // smoothing gives up the exactness it is asked to give up
    assert!((at(METHODS[7], &anchors, (20, 7)) - Vec2::new(-5.0, 3.0)).hypot2() > 1e-6);
}

#[test]
fn no_method_makes_nan_of_odd_anchors() {
    let odd: [&[[f64; 4]]; 6] = [
        &[],
        &[[5.5, 5.5, 1.0, 2.0]],
        &[[5.5, 5.5, 1.0, 2.0], [5.5, 5.5, 3.0, 4.0]],
        &[[1.5, 1.5, 1.0, 2.0], [5.5, 5.5, 3.0, 4.0], [9.5, 9.5, 0.0, 0.0]],
        &[[5.5 + 1e-8, 5.5, 1.0, 2.0], [80.0, 5.5, 3.0, 4.0], [5.5, 90.0, 3.0, 4.0]],
        &[[5.5, 5.5, 0.0, 0.0], [900.0, 5.5, 1e6, 4.0], [5.5, 9000.0, 3.0, -1e6]],
    ];
    for method in METHODS {
        for anchors in odd {
            for x in 0..20 {
                let found = at(method, anchors, (x, 5));
                assert!(found.is_finite(), "{method} {anchors:?} {x}: {found:?}");
            }
        }
    }
    assert_eq!(at(METHODS[0], odd[2], (5, 5)), Vec2::new(1.0, 2.0), "the first of two at one place");
}

#[test]
fn values_follow_the_formulae() {
    let two = [[0.5, 0.5, 10.0, 0.0], [3.5, 0.5, 0.0, 10.0]];
    assert_near(at(METHODS[0], &two, (1, 0)), (8.0, 2.0), 1e-12);
    assert_near(at(METHODS[1], &two, (1, 0)), (20.0 / 3.0, 10.0 / 3.0), 1e-12);
    let near: f64 = (40.0 - 1.0) / (40.0 * 1.0);
    let far: f64 = (40.0 - 2.0) / (40.0 * 2.0);
    let share = near * near / (near * near + far * far);
    assert_near(at(METHODS[4], &two, (1, 0)), (10.0 * share, 10.0 - 10.0 * share), 1e-12);
    assert_near(at(METHODS[4], &two, (90, 0)), (0.0, 0.0), 0.0);
    assert_near(at(METHODS[6], &two, (1, 0)), (8.0, 2.0), 1e-12); // fewer than three anchors: shepard
}

#[test]
fn thin_plate_reproduces_an_affine_map_and_rigid_a_rotation() {
    let affine = |x: f64, y: f64| [x, y, 0.5 * x - y + 3.0, 0.25 * y];
    let anchors = [affine(1.0, 2.0), affine(30.0, 4.0), affine(9.0, 25.0), affine(28.0, 31.0)];
    assert_near(at(METHODS[6], &anchors, (12, 8)), (0.5 * 12.5 - 8.5 + 3.0, 0.25 * 8.5), 1e-9);
    let quarter = |x: f64, y: f64| [x, y, -y - x, x - y];
    let anchors = [quarter(1.0, 2.0), quarter(30.0, 4.0), quarter(9.0, 25.0)];
    assert_near(at(METHODS[8], &anchors, (12, 8)), (-8.5 - 12.5, 12.5 - 8.5), 1e-9);
}

/// Anchors on a picture of 96 x 80: all over it, in a heap of a hundredth of a pixel, on a line, and around it.
fn nasty(kind: usize, count: usize, reach: f64) -> Vec<Anchor> {
    let anchor = |i: usize| {
        let part = |step: f64| (i as f64 * step).fract();
        let (a, b) = (part(0.754_877_666), part(0.569_840_291));
        let at = match kind {
            0 => Point::new(96.0 * a, 80.0 * b),
            1 if !i.is_multiple_of(8) => Point::new(30.2 + a / 100.0, 40.3 + b / 100.0),
            2 => Point::new(96.0 * a, 80.0 * a),
            _ => Point::new(96.0 * (8.0 * a - 4.0), 80.0 * (8.0 * b - 4.0)),
        };
        let jump = if i % 5 < 3 { Vec2::ZERO } else { Vec2::new(part(0.31) - 0.5, part(0.47) - 0.5) * (2.0 * reach) };
        Anchor { at, jump, tool: 0 }
    };
    (0..count).map(anchor).collect()
}

/// Those that are compared with exact sums. Up to 100 px weights are made in single precision.
const NASTY: [(usize, usize, f64); 7] = [
    (0, 400, 50.0),
    (0, 2000, 100.0),
    (1, 200, 50.0),
    (1, 200, 100.0),
    (2, 200, 100.0),
    (2, 200, 1000.0),
    (3, 400, 1000.0),
];

/// The jump vector at a place by the formula of the documentation, term by term.
fn exact(interpolation: &Interpolation, anchors: &[Anchor], pixel: [u32; 2], q: Point) -> Vec2 {
    let distance = |anchor: &Anchor| (anchor.at - q).hypot2().sqrt();
    if let Some(there) = anchors.iter().find(|anchor| distance(anchor) < AT_ANCHOR_PX) {
        return there.jump;
    }
    if *interpolation == (Interpolation::Rigid {}) {
        return exact_rigid(anchors, q);
    }
    let nearest = anchors.iter().map(distance).fold(f64::INFINITY, f64::min);
    let reaching = |d: f64, radius: f64| maths::powi((radius - d).max(0.0) / (radius * d), 2);
    let (mut total, mut sum) = (0.0, Vec2::ZERO);
    for (index, anchor) in anchors.iter().enumerate() {
        let d = distance(anchor);
        let w = match *interpolation {
            Interpolation::Shepard { power } => maths::pow(nearest / d, power),
            Interpolation::ModifiedShepard { radius } => reaching(d, radius),
            Interpolation::ModifiedShepardRandom { radius, ring, seed } => {
                let hash = inverse_distance::pcg3d(
                    pixel[0],
                    pixel[1],
                    (index as u32).wrapping_add(seed.wrapping_mul(0x9E37_79B9)),
                );
                if d > radius - ring && hash[0] >> 31 == 0 { 0.0 } else { reaching(d, radius) }
            }
            Interpolation::ThinPlate { .. } | Interpolation::Rigid {} => unreachable!("not a weighted mean"),
        };
        total += w;
        sum += anchor.jump * w;
    }
    if total > 0.0 { sum / total } else { Vec2::ZERO }
}

/// As [`exact`]: from the weighted centers p* and q*, and the sum of w conj(p - p*) (p + u - q*).
fn exact_rigid(anchors: &[Anchor], q: Point) -> Vec2 {
    let weights: Vec<f64> = anchors.iter().map(|anchor| 1.0 / (anchor.at - q).hypot2()).collect();
    let total: f64 = weights.iter().sum();
    let mean = |of: &dyn Fn(&Anchor) -> Vec2| {
        anchors.iter().zip(&weights).fold(Vec2::ZERO, |sum, (anchor, w)| sum + of(anchor) * (w / total))
    };
    let (from, to) = (mean(&|anchor| anchor.at - q), mean(&|anchor| anchor.at - q + anchor.jump));
    let turn = mean(&|anchor| {
        let (p, r) = (anchor.at - q - from, anchor.at - q + anchor.jump - to);
        Vec2::new(p.dot(r), p.cross(r))
    });
    let turn = turn / turn.hypot2().sqrt();
    to - Vec2::new(turn.x * from.x - turn.y * from.y, turn.y * from.x + turn.x * from.y)
}

#[test]
fn sums_by_cells_are_the_sums() {
    let [width, height] = [96, 80];
    for json in [
        METHODS[0],
        METHODS[1],
        METHODS[2],
        METHODS[3],
        METHODS[4],
        METHODS[5],
        METHODS[8],
        r#"{"method":"shepard","power":0.01}"#,
        r#"{"method":"modified-shepard","radius":300}"#,
        r#"{"method":"modified-shepard-random","radius":120,"ring":20}"#,
    ] {
        let interpolation = serde_json::from_str(json).unwrap();
        for (kind, count, reach) in NASTY {
            let (anchors, place) = (nasty(kind, count, reach), Vec2::new(0.25, 0.75));
            // Rows that have the heap and leaves of several cells.
            let rows = Area { from: [0, 30], to: [width, 42] };
            let found = jumps(&interpolator(json, &anchors, [width, height], place), rows);
            for [x, y] in (0..40).map(|i| [i * 37 % width, 30 + i * 29 % 12]).chain([[30, 39], [30, 40]]) {
                let q = Point::new(f64::from(x), f64::from(y)) + place;
                let exact = exact(&interpolation, &anchors, [x, y], q);
                let error = (found[((y - 30) * width + x) as usize] - exact).hypot2().sqrt();
                assert!(error <= kernel::TOLERANCE_PX, "{json}, anchors {kind}, pixel {x}, {y}: {error} px");
            }
        }
    }
}

#[test]
fn weights_in_single_precision_tell_anchors_in_a_heap_apart() {
    // The pixel lies in the middle of 175 anchors, each a few thousandths of a pixel from it.
    let (anchors, place, pixel) = (nasty(1, 200, 100.0), Vec2::new(0.205, 0.305), [30, 40]);
    let found = jumps(&interpolator(METHODS[0], &anchors, [96, 80], place), Area { from: pixel, to: [31, 41] })[0];
    let exact = exact(&Interpolation::default(), &anchors, pixel, Point::new(30.0, 40.0) + place);
    let error = (found - exact).hypot2().sqrt();
    assert!(error <= kernel::TOLERANCE_PX, "{found:?}, not {exact:?}");
    assert!(error > 1e-12, "in double precision");
}

#[test]
fn a_thin_plate_by_cells_passes_its_anchors() {
    let mut anchors = nasty(0, 120, 200.0);
    anchors.iter_mut().for_each(|anchor| anchor.at = (anchor.at.floor().to_vec2() + CENTER).to_point());
    let distinct = thin_plate::distinct(&anchors);
    let rows = Area { from: [0, 20], to: [96, 32] };
    let found = jumps(&interpolator(METHODS[6], &anchors, [96, 80], CENTER), rows);
    let seen = distinct.iter().filter(|anchor| (20.0..32.0).contains(&anchor.at.y));
    for anchor in seen {
        let error = found[(anchor.at.y as usize - 20) * 96 + anchor.at.x as usize] - anchor.jump;
        assert!(error.hypot2().sqrt() <= kernel::TOLERANCE_PX, "{anchor:?}: {error:?}");
    }
}

#[test]
fn a_pixel_is_the_same_in_any_part() {
    let anchors = nasty(0, 60, 10.0);
    for method in METHODS {
        let interpolator = interpolator(method, &anchors, [96, 80], Vec2::new(0.25, 0.75));
        let whole = jumps(&interpolator, Area { from: [0, 0], to: [96, 80] });
        for from in [[3, 9], [70, 40], [31, 66]] {
            let part = jumps(&interpolator, Area { from, to: from.map(|from| from + 14) });
            for (k, found) in part.into_iter().enumerate() {
                let (x, y) = (from[0] as usize + k % 14, from[1] as usize + k / 14);
                assert_eq!(found, whole[y * 96 + x], "{method} {x} {y}");
            }
        }
    }
}

#[test]
fn the_hash_is_that_of_the_paper() {
    // Computed from the published definition with arbitrary-precision integers.
    assert_eq!(inverse_distance::pcg3d(0, 0, 0), [2611992518, 2833812075, 1058359340]);
    assert_eq!(inverse_distance::pcg3d(1, 2, 3), [4204755366, 1223881804, 1500469937]);
}

#[test]
fn a_thin_plate_takes_no_more_memory_than_there_is_and_ends_when_asked_to() {
    let anchors: Vec<[f64; 4]> = (0..100).map(f64::from).map(|i| [i * 7.3 % 61.0, i * 3.7 % 23.0, i, -i]).collect();
    let solve = |materials: &Materials| {
        Interpolator::new(&serde_json::from_str(METHODS[6]).unwrap(), &make(&anchors), [61, 23], CENTER, materials)
            .map(drop)
    };
    let budget = |most| Materials { budget: Budget::new(most), ..Materials::default() };
    let needed = thin_plate::bytes(100);
    assert!(needed >= 100 * 100 * 8);
    let materials = budget(needed);
    solve(&materials).unwrap();
    assert_eq!(materials.budget.taken(), 0, "given back");
    let refused = solve(&budget(needed - 1)).unwrap_err();
    assert_eq!(refused.path, "/interpolation");
    assert!(refused.message.contains("of memory") && refused.hint.unwrap().contains("--limit memory"));
    let stop = Some(Arc::new(AtomicBool::new(true)));
    assert_eq!(solve(&Materials { stop, ..Materials::default() }).unwrap_err().message, "stopped");
}

#[test]
fn a_thin_plate_has_the_same_bits_everywhere() {
    let anchors: Vec<[f64; 4]> =
        (0..70).map(f64::from).map(|i| [i * 7.3 % 61.0, i * 3.7 % 23.0, i % 5.0, -i % 3.0]).collect();
    let found = at(METHODS[6], &anchors, (20, 7));
    assert_eq!((found.x.to_bits(), found.y.to_bits()), (4609792142237502559, 4599545483544191484), "{found:?}");
}
