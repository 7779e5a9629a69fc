//! What every method must do, and the values of each, checked against its formula.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use kurbo::{Point, Vec2};

use super::*;
use crate::base::budget::Budget;
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

fn at(json: &str, anchors: &[[f64; 4]], pixel: (u32, u32)) -> Vec2 {
    let interpolator =
        Interpolator::new(&serde_json::from_str(json).unwrap(), make(anchors), &Materials::default()).unwrap();
    let run = Run { pixel, place: Vec2::new(0.5, 0.5), len: 1 };
    let mut out = Jumps::default();
    interpolator.run(&run, &mut out);
    Vec2::new(out.x[0], out.y[0])
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

#[test]
fn a_run_is_its_pixels() {
    let anchors: Vec<[f64; 4]> = (0..40).map(f64::from).map(|i| [i * 7.3 % 61.0, i * 3.7 % 23.0, i, -i]).collect();
    for method in METHODS {
        let interpolator =
            Interpolator::new(&serde_json::from_str(method).unwrap(), make(&anchors), &Materials::default()).unwrap();
        let mut out = Jumps::default();
        interpolator.run(&Run { pixel: (3, 9), place: Vec2::new(0.25, 0.75), len: 50 }, &mut out);
        for k in 0..50u32 {
            let mut one = Jumps::default();
            interpolator.run(&Run { pixel: (3 + k, 9), place: Vec2::new(0.25, 0.75), len: 1 }, &mut one);
            assert_eq!((out.x[k as usize], out.y[k as usize]), (one.x[0], one.y[0]), "{method} {k}");
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
        Interpolator::new(&serde_json::from_str(METHODS[6]).unwrap(), make(&anchors), materials).map(drop)
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
    assert_eq!((found.x.to_bits(), found.y.to_bits()), (4609792142237502732, 4599545483544193280), "{found:?}");
}
