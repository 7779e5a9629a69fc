//! Strokes: their impulses are made by the device.

use super::examples::ring;
use super::*;

/// A ring that is drawn with strokes, one behind it that is not, and one in front.
pub fn drawn(strokes: &Value, surface: &Value) -> Synth {
    let placed = |name: &str, at: [f64; 3], scale: f64, extra: &Value| {
        let pose = json!({"position": at, "scale": scale, "rotate": [55, 10, 0]});
        with(json!({"kind": "mesh", "name": name, "mesh": "ring", "sides": "both", "pose": pose}), extra)
    };
    let scene = json!({"plica": 1, "size": [64, 48], "background": "#f6f1e6",
        "camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "meshes": {"ring": {"path": "ring.obj"}},
        "layers": [
            placed("behind", [0.6, 0.3, -1.0], 1.2, &json!({})),
            placed("drawn", [0.0, 0.0, 0.0], 1.0, &json!({"strokes": strokes, "surface": surface})),
            placed("before", [-0.9, 0.2, 0.8], 0.4, &json!({}))]});
    let scene = serde_json::from_value(scene).unwrap();
    let materials = Materials { meshes: [("ring".to_owned(), Arc::new(ring()))].into(), ..materials() };
    render::synth(&scene, &materials, None).unwrap()
}

/// Every style, and everything that a noise or a mark can be beside what styles make of them. There half of all is inked with
/// hard edges, so that one pixel in a hundred changes where the noise does by a fortieth of its standard deviation.
pub fn all_strokes() -> Vec<Value> {
    let noise = |noise: Value| {
        let own = with(json!({"spacing": 7.5, "regularity": 2}), &noise);
        let mark = json!({"name": "m", "kind": "ink", "noise": "a", "from": 2, "to": 1, "amount": 0.5, "softness": 0});
        json!({"style": "none", "noises": {"a": own}, "marks": [mark]})
    };
    let along = |along: &str| noise(json!({"direction": {"along": along, "image": "other", "turn": 20}}));
    let by = |by: &str| noise(json!({"vary": {"by": by, "image": "other", "low": 0.7, "high": 1.6}}));
    let anchor = |anchor: &str| noise(json!({"anchor": anchor}));
    let trim = |trim: &str, reach: f64| noise(json!({"trim": trim, "reach": reach}));
    let hatching = |more: Value| with(json!({"style": "hatching"}), &more);
    let styles = KINDS.iter().filter_map(|kind| kind.styles).flat_map(|styles| styles.list);
    let styles = styles.map(|style| json!({"style": style.name}));
    let others = [
        noise(json!({})),
        anchor("screen"),
        anchor("texture"),
        noise(json!({"anchor": "texture", "direction": {"along": "curvature"}})),
        along("curvature"),
        along("light"),
        along("axis"),
        along("outline"),
        along("image"),
        by("light"),
        by("curvature"),
        by("facing"),
        by("image"),
        trim("object", 0.5),
        trim("triangle", 0.5),
        trim("depth", 0.05),
        noise(json!({"overlap": 64, "spread": 90})),
        hatching(json!({"ground": "clear", "tone": {"of": "light", "gamma": 2}, "size": 0.6, "amount": 1.5})),
        hatching(json!({"redraw": 9, "marks": [{"name": "contour", "creases": 15, "step": 1, "width": 3}]})),
        hatching(json!({"marks": [{"name": "r", "kind": "relief", "noise": "a"}, {"name": "light", "side": "high"}]})),
    ];
    styles.chain(others).collect()
}

#[test]
fn the_gpu_draws_strokes_as_the_cpu_does() {
    let Some(mut gpu) = gpu() else { return };
    let (plain, pictured) =
        (json!({"kind": "plain", "color": "#c8b8a0c0"}), json!({"kind": "texture", "image": "own"}));
    let mut frames = BTreeSet::new();
    let strokes = all_strokes();
    let all = Value::from(strokes.clone()).to_string();
    for word in [words::<Along>(), words::<By>(), words::<Anchor>(), words::<Trim>()].concat() {
        // What is by default need not be written.
        let known = all.contains(&format!("\"{word}\"")) || ["surface", "screen"].contains(&word.as_str());
        assert!(known, "no strokes with {word}");
    }
    for (i, own) in strokes.iter().enumerate() {
        let synth = drawn(own, if i % 2 == 0 { &pictured } else { &plain });
        assert_eq!(gpu.by_cpu(&synth), None, "{own}");
        let (by_gpu, by_cpu) = (gpu.frame(&synth, 0.3).unwrap(), cpu::frame(&synth, 0.3));
        within(&own.to_string(), &by_gpu, &by_cpu, 0.005);
        frames.insert(by_gpu.cells().to_vec());
    }
    assert_eq!(frames.len(), strokes.len(), "each shows something else");
}

#[test]
fn samples_of_strokes_are_drawn_in_one_frame_and_left_to_the_cpu_beside_pictures() {
    let Some(mut gpu) = gpu() else { return };
    let mesh =
        |name: &str, extra: Value| with(json!({"kind": "mesh", "name": name, "mesh": "ring", "sides": "both"}), &extra);
    let drawn = mesh("drawn", json!({"strokes": {"style": "hatching"}, "pose": {"rotate": [55, 10, 0]}}));
    let behind = mesh("behind", json!({"pose": {"position": [0.6, 0.3, -1.0]}}));
    let materials = Materials { meshes: [("ring".to_owned(), Arc::new(ring()))].into(), ..materials() };
    for (layers, left) in [([behind, drawn.clone()], false), ([layer("a", "own", &[]), drawn], true)] {
        let scene = json!({"plica": 1, "size": [64, 48], "camera": {"position": [0, 0, 4], "target": [0, 0, 0]}, "layers": layers});
        let samples = render::samples(&serde_json::from_value(scene).unwrap(), &materials, 2).unwrap();
        assert_eq!(gpu.samples_by_cpu(&samples).is_some(), left);
        let (by_gpu, by_cpu) = (cpu::finish(&gpu.mean(&samples, 0.3).unwrap()), cpu::frames(&samples, 0.3));
        within("samples", &by_gpu, &by_cpu, 0.005);
    }
}

#[test]
fn a_gpu_that_cannot_compute_leaves_strokes_to_the_cpu_and_says_so() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::GL;
    let Ok(mut gpu) = Gpu::open(wgpu::Instance::new(descriptor), None) else { return };
    let synth = drawn(&json!({"style": "hatching"}), &json!({"kind": "plain", "color": "#c8b8a0"}));
    let (frame, by_cpu) = (gpu.frame(&synth, 0.3).unwrap(), cpu::frame(&synth, 0.3));
    match gpu.by_cpu(&synth) {
        None => drop(within("OpenGL", &frame, &by_cpu, 0.005)),
        Some(why) => assert_eq!((&frame, why), (&by_cpu, format!("{} cannot compute strokes", gpu.device().name()))),
    }
}

/// A plane of so many squares on each side, so often before itself: the last is what is seen.
fn sheets(side: usize, count: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for sheet in 0..count {
        let first = mesh.vertices.len() as u32;
        for i in 0..(side + 1) * (side + 1) {
            let at = DVec2::new((i % (side + 1)) as f64, (i / (side + 1)) as f64) / side as f64;
            let position = DVec3::new(2.0 * at.x - 1.0, 2.0 * at.y - 1.0, 0.01 * sheet as f64);
            mesh.vertices.push(Vertex { position, normal: DVec3::Z, uv: at });
        }
        let row = side as u32 + 1;
        let corners = (0..side * side).map(|i| first + (i / side) as u32 * row + (i % side) as u32);
        mesh.triangles.extend(corners.flat_map(|a| [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]));
    }
    mesh
}

#[test]
fn the_gpu_makes_impulses_of_many_pieces_and_more_of_them_than_there_was_room_for() {
    let Some(mut gpu) = gpu() else { return };
    let mark = json!({"name": "m", "kind": "ink", "noise": "a", "from": 2, "to": 1, "amount": 0.5, "softness": 0});
    // More than 256 blocks of pieces; more impulses than there is room for at first.
    for (mesh, size, spacing) in [(sheets(190, 1), [48, 36], 6.0), (sheets(4, 12), [128, 96], 2.0)] {
        let noise = json!({"spacing": spacing, "overlap": 8, "regularity": 1, "direction": {"along": "axis"}});
        let scene = json!({"plica": 1, "size": size, "camera": {"position": [0.3, 0.2, 3], "target": [0, 0, 0], "fov": 30},
            "layers": [{"kind": "mesh", "name": "m", "mesh": "m",
                "strokes": {"style": "none", "noises": {"a": noise}, "marks": [mark.clone()]}}]});
        let materials = Materials { meshes: [("m".to_owned(), Arc::new(mesh))].into(), ..Materials::default() };
        let synth = render::synth(&serde_json::from_value(scene).unwrap(), &materials, None).unwrap();
        assert_eq!(gpu.by_cpu(&synth), None);
        let frame = gpu.frame(&synth, 0.0).unwrap();
        within(&format!("{size:?}"), &frame, &cpu::frame(&synth, 0.0), 0.005);
        let inked = frame.cells().iter().filter(|[r, _, _, a]| *r < 128 && *a > 0).count();
        assert!((0.3..0.6).contains(&(inked as f64 / frame.cells().len() as f64)), "{inked}");
    }
}
