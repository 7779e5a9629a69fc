//! View maps: the GPU shows what the CPU shows.

use super::examples::ring;
use super::*;

/// A ring with pictures on it, taken from around; `extra` goes over its surface, `views` over each of its views in turn.
fn viewed(layer: Value, extra: &Value, views: &[Value]) -> Synth {
    let (scene, materials) = with_views(layer, extra, views);
    render::synth(&scene, &materials, None).unwrap()
}

pub fn with_views(layer: Value, extra: &Value, views: &[Value]) -> (Scene, Materials) {
    let view = |(i, own): (usize, &Value)| {
        let angle = i as f64 * TAU / 5.0;
        let at = [3.0 * maths::sin(angle), 1.0 + 0.4 * i as f64, 3.0 * maths::cos(angle)];
        let all = json!({"name": i.to_string(), "image": format!("p{}", i % 3), "camera": {"position": at, "fov": 50}});
        with(all, own)
    };
    let views: Vec<Value> = views.iter().enumerate().map(view).collect();
    let surface = with(json!({"kind": "view-map", "cells": 16, "levels": 3, "atlas": "box", "views": views}), extra);
    let mesh = json!({"kind": "mesh", "name": "ring", "mesh": "ring", "surface": surface});
    let scene = json!({"plica": 1, "size": [96, 72], "layers": [with(mesh, &layer)],
        "camera": {"position": [0.6, 1.5, 2.6], "target": [0, 0, 0], "fov": 50}});
    let pictures = (0..3).map(|i| (format!("p{i}"), waves(48, 48, i + 1, i == 2)));
    let materials = Materials {
        meshes: [("ring".to_owned(), Arc::new(ring()))].into(),
        pictures: pictures.collect(),
        ..Materials::default()
    };
    (serde_json::from_value(scene).unwrap(), materials)
}

#[test]
fn the_gpu_shows_view_maps_as_the_cpu_does() {
    let Some(mut gpu) = gpu() else { return };
    let (none, both) = (json!({}), vec![json!({}); 5]);
    let cone = json!({"kind": "dependent", "hold": 0.3, "extremes": {"kind": "cone", "degrees": 70}});
    let linear = with(cone.clone(), &json!({"fade": "linear", "gain": [1.5, 0.8, 0.3], "feather": 9}));
    let points = json!({"kind": "dependent",
        "extremes": {"kind": "points", "points": [[-60, 0], [0, -50], [70, 0], [0, 60]]}});
    let coat = json!({"kind": "independent"});
    let near = json!({"closer": 0.2, "extremes": {"kind": "auto", "reach": 80}});
    let far = json!({"farther": 0.3, "camera": {"position": [0.5, 1.2, 9], "fov": 12}});
    let blend = json!({"blend": {"points": [
        {"position": [0.6, 1.5, 2.6], "base": 0.8}, {"position": [4, 1, 0], "base": 0.1}]}});
    let bent = json!({"pose": {"rotate": [20, 40, 10], "scale": 1.3, "position": [0.1, -0.2, 0.3],
        "bend": {"degrees": 50, "from": -1, "to": 1}}});
    let scenes = [
        ("views up to one another", viewed(none.clone(), &none, &both)),
        ("no view", viewed(none.clone(), &json!({"missing": "#4080c0"}), &[])),
        ("one view, the rest missing", viewed(none.clone(), &none, std::slice::from_ref(&near))),
        ("cones over a coat", viewed(none.clone(), &none, &[coat.clone(), cone, linear, coat.clone()])),
        ("places over a coat", viewed(none.clone(), &none, &[points.clone(), coat, points])),
        ("near and far", viewed(none.clone(), &json!({"levels": 5}), &[near, far, json!({})])),
        ("blend points", viewed(none.clone(), &blend, &both)),
        ("arrays of directions", viewed(none.clone(), &json!({"directions": 8}), &both)),
        ("bent", viewed(bent.clone(), &none, &both)),
        ("bent, arrays of directions", viewed(bent, &json!({"directions": 6}), &both)),
        ("both sides, by texture", viewed(json!({"sides": "both"}), &json!({"atlas": "uv"}), &both)),
        ("under strokes", viewed(json!({"strokes": {"style": "painterly"}}), &none, &both)),
        (
            "arrays under strokes",
            viewed(
                json!({"strokes": {"style": "hatching", "ground": "scene", "tone": {"of": "light"}}}),
                &json!({"directions": 8}),
                &both,
            ),
        ),
    ];
    let frames = scenes.map(|(name, synth)| {
        assert_eq!(gpu.by_cpu(&synth), None, "{name}");
        let frame = gpu.frame(&synth, 0.0).unwrap();
        within(name, &frame, &cpu::frame(&synth, 0.0), 0.005);
        frame
    });
    let distinct: BTreeSet<&[[u8; 4]]> = frames.iter().map(Frame::cells).collect();
    assert_eq!(distinct.len(), frames.len(), "each shows something else");
}
