//! What every technique answers, by an example of each.

use super::view_maps::with_views;
use super::*;

/// Three quarters of a ring about the z axis, of radius 1 and thickness 0.35; its inside is seen at the ends.
pub fn ring() -> Mesh {
    let (around, across) = (24, 12);
    let vertex = |i: usize| {
        let (u, v) = ((i % (around + 1)) as f64 / around as f64, (i / (around + 1)) as f64 / across as f64);
        let (a, b) = (u * TAU, v * TAU);
        let normal = DVec3::new(maths::cos(b) * maths::cos(a), maths::cos(b) * maths::sin(a), maths::sin(b));
        let middle = DVec3::new(maths::cos(a), maths::sin(a), 0.0);
        Vertex { position: middle + normal * 0.35, normal, uv: DVec2::new(u * 3.0, v) }
    };
    let corner = |x: usize, y: usize| (y * (around + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % around, i / around);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    Mesh {
        vertices: (0..(around + 1) * (across + 1)).map(vertex).collect(),
        triangles: (0..around * across).filter(|i| i % around < around * 3 / 4).flat_map(pair).collect(),
        ..Mesh::default()
    }
}

/// The example of each technique, with pictures of 96 x 64 for the images that it names.
fn examples() -> Vec<(&'static str, Scene, Materials)> {
    let example = |kind: &&'static Kind| {
        let scene: Scene = serde_json::from_str(kind.example).unwrap();
        let mut materials = Materials::default();
        let uses = scene.layers.iter().flat_map(|layer| layer.technique().uses());
        for (seed, Use { of, what, .. }) in uses.enumerate() {
            match of {
                Of::Name(List::Layers | List::Shapes, _) => {}
                Of::Name(List::Meshes, name) => drop(materials.meshes.insert(name.to_owned(), Arc::new(ring()))),
                Of::Name(List::Clips, name) => {
                    let frames = (0..5).map(|frame| waves(96, 64, seed + 7 * frame, true)).collect();
                    drop(materials.clips.insert(name.to_owned(), Arc::new(Clip { fps: 12.5, frames })));
                }
                Of::Name(List::Images, name) => {
                    let picture = waves(96, 64, seed + 1, what != What::Picture || seed > 0);
                    drop(materials.pictures.insert(name.to_owned(), picture));
                }
                Of::Path(path) => {
                    let vector = |i: usize| [(i % 96) as f32 / 12.0, (i / 96) as f32 / -9.0];
                    let field = Grid::from_cells(96, 64, (0..96 * 64).map(vector).collect());
                    drop(materials.fields.insert(path.to_owned(), Arc::new(field)));
                }
            }
        }
        (kind.name, scene, materials)
    };
    KINDS.iter().map(example).collect()
}

/// The examples, and one of a view map with strokes, for what only these have.
pub fn examples_of_all() -> Vec<(&'static str, Scene, Materials)> {
    let strokes = json!({"strokes": {"style": "hatching"}});
    let (scene, materials) = with_views(strokes, &json!({}), &vec![json!({}); 3]);
    examples().into_iter().chain([("mesh", scene, materials)]).collect()
}

#[test]
fn every_surface_is_in_an_example() {
    let scenes = examples_of_all().into_iter().map(|(_, scene, _)| serde_json::to_value(scene).unwrap());
    let layers: Vec<Value> = scenes.flat_map(|scene| scene["layers"].as_array().unwrap().clone()).collect();
    let found = layers.iter().filter_map(|layer| Some(layer["surface"]["kind"].as_str()?.to_owned())).collect();
    assert_eq!(variants::<Surface>("kind"), found);
}

#[test]
fn every_overlay_draws_something_over_an_example_of_its_technique() {
    let (mut something, mut all) = (BTreeSet::new(), BTreeSet::new());
    for (kind, scene, materials) in examples_of_all() {
        let synth = render::synth(&scene, &materials, None).unwrap();
        // From elsewhere, so that the scene's camera is seen too.
        let elsewhere = Camera { position: [2.5, -2.0, 2.5], target: [0.0; 3], ..Camera::default() };
        let synth = synth.seen_from(elsewhere);
        let overlays =
            KINDS.iter().filter(|row| row.name == kind).flat_map(|row| row.overlays.iter().copied().flatten());
        // Labels are texts at the marks of others.
        for overlay in overlays.filter(|overlay| overlay.name != "view-labels") {
            let view = View { spacing_px: 8.0, cell_px: 2.0, times: vec![0.4], ..View::of(&[overlay.name]) };
            all.insert((kind, overlay.name));
            if !render::overlay::overlay(&scene, Some(&synth), &view).is_empty() {
                something.insert((kind, overlay.name));
            }
        }
        let all_off = View { times: vec![0.4], ..View::default() };
        assert!(render::overlay::overlay(&scene, Some(&synth), &all_off).is_empty(), "{kind}");
    }
    let nothing: Vec<_> = all.difference(&something).collect();
    assert!(nothing.is_empty(), "nothing is drawn: {nothing:?}");
}

#[test]
fn every_technique_with_textures_bundles_its_example() {
    let mut bundled = BTreeSet::new();
    for (kind, scene, materials) in examples_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let place = Guard::new(false).folder(&folder.path().join("textures"), &|_| true, BTreeSet::new()).unwrap();
        let synth = render::synth(&scene, &materials, None).unwrap();
        let written = textures::write(&scene, &synth, Depth::Float.into(), &place, &mut |_, _| Ok(())).unwrap();
        if written.names.iter().any(|name| name != "manifest.json") {
            bundled.insert(kind);
        }
        for name in &written.names {
            assert!(folder.path().join("textures").join(name).metadata().unwrap().len() > 0, "{kind}: {name}");
        }
    }
    let expected = KINDS.iter().filter(|row| row.bundle.is_some()).map(|row| row.name).collect();
    assert_eq!(bundled, expected);
}

#[test]
fn every_technique_answers_everything() {
    let mut gpu = gpu();
    let mut probed = BTreeSet::new();
    for (kind, scene, materials) in examples_of_all() {
        // At the edges of strokes single precision may decide otherwise.
        let most = if scene.layers.iter().any(|layer| layer.technique().sketched() != [""; 0]) { 0.005 } else { 0.001 };
        assert!(scene.layers.iter().any(|layer| layer.technique().kind().name == kind));
        let problems: Vec<_> = scene.layers.iter().map(|layer| layer.technique()).collect();
        let problems = problems.iter().flat_map(|layer| layer.problems(&layer.check(None)));
        assert_eq!(problems.collect::<Vec<_>>(), [], "{kind}");
        let synth = render::synth(&scene, &materials, None).unwrap();
        let making = Making::plain(scene.timeline.wrap, &materials);
        let making = Making { duration: scene.timeline.duration, ..making };
        for (layer, ready) in scene.layers.iter().zip(&synth.layers) {
            let probe = |ready| layer.technique().probe(&making, ready, (40, 28), &synth.moment(0.5)).unwrap();
            let told = probe(None);
            assert_eq!(probe(Some(&**ready)), told, "{kind}: what is made already says the same");
            assert!(told.as_ref().is_none_or(|told| !told.entries.is_empty()), "{kind}: a probe that says nothing");
            probed.extend(told.map(|_| layer.technique().kind().name));
        }
        let again = render::synth(&scene, &materials, Some(&synth)).unwrap();
        let samples = render::samples(&scene, &materials, 2).unwrap();
        let small = reduced(&synth, 4);
        let still = synth.unmoved();
        let bands = Bands::new(&scene, &materials, 1).unwrap();
        for time in [0.13, 0.77] {
            let frame = cpu::frame(&synth, time);
            assert_eq!(cpu::frame(&again, time), frame, "{kind} at {time}: made from the one before");
            assert_eq!(bands.frame(time, &|_| ()).unwrap(), frame, "{kind} at {time}: in bands");
            let rows: Vec<usize> = (0..synth.size.1).step_by(7).collect();
            let columns: Vec<usize> = (3..synth.size.0).step_by(5).collect();
            let some = cpu::lattice(&synth, time, &columns, &rows);
            let at = |(i, j): (usize, usize)| encode(*some.get(i, j)) == *frame.get(columns[i], rows[j]);
            let places = (0..rows.len()).flat_map(|j| (0..columns.len()).map(move |i| (i, j)));
            assert!(places.into_iter().all(at), "{kind} at {time}: some columns");
            assert_eq!(cpu::frame(&still, time), cpu::frame(&still, 0.0), "{kind} at {time}: still");
            let (_, share) = difference(&cpu::frames(&samples, time), &frame);
            assert!(share < 0.5, "{kind} at {time}: {share} differ between samples and the middle of each pixel");
            assert_eq!(cpu::frame(&small, time).width(), synth.size.0.div_ceil(4));
            if let Some(gpu) = &mut gpu {
                for (name, synth) in [("whole", &synth), ("reduced", &small), ("still", &still)] {
                    let by_gpu = gpu.frame(synth, time).unwrap();
                    within(&format!("{kind}, {name} at {time}"), &by_gpu, &cpu::frame(synth, time), most);
                }
                let mean = cpu::finish(&gpu.mean(&samples, time).unwrap());
                within(&format!("{kind}, samples at {time}"), &mean, &cpu::frames(&samples, time), most);
            }
        }
    }
    let silent: Vec<_> = KINDS.iter().map(|kind| kind.name).filter(|name| !probed.contains(name)).collect();
    assert_eq!(silent, [""; 0], "these say nothing of any pixel");
}
