//! View maps over meshes made here: depths and cells are the numbers that formulas give, and what must not change does not.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::atlas::{Atlas, By};
use super::camera::Camera;
use super::cells::{Cells, NONE};
use super::coat::State;
use super::compare::compare;
use super::entries::{Entry, Reach};
use super::gauge::Gauges;
use super::id::Seen;
use super::map::{KEPT_BYTES, Map, Wanted};
use super::mix::{Part, mix};
use super::paint::Paint;
use super::view::{Extremes, Fade, View};
use crate::base::maths::{TAU, cos, sin};
use crate::base::mesh::{Mesh, Vertex};
use crate::base::picture::Picture;
use crate::base::progress::Watch;
use crate::layers::space::eye::Eye;

/// Squares of 2 m that face front, at these depths; they lie beside one another in the texture.
fn squares(at: &[f64]) -> Arc<Mesh> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let square = |(i, z): (usize, &f64)| {
        corners.map(|[x, y]| Vertex {
            position: DVec3::new(x, y, *z),
            normal: DVec3::Z,
            uv: DVec2::new(x / 2.0 + 2.0 * i as f64, y / 2.0),
        })
    };
    let triangles = (0..at.len() as u32).flat_map(|i| [[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|c| c + 4 * i)));
    Arc::new(Mesh {
        vertices: at.iter().enumerate().flat_map(square).collect(),
        triangles: triangles.collect(),
        ..Mesh::default()
    })
}

/// A ball of 1 m.
fn ball() -> Arc<Mesh> {
    let (around, down) = (24, 12);
    let vertex = |i: usize| {
        let (u, v) = ((i % (around + 1)) as f64 / around as f64, (i / (around + 1)) as f64 / down as f64);
        let (a, b) = (u * TAU, v * TAU / 2.0);
        let normal = DVec3::new(sin(b) * sin(a), cos(b), sin(b) * cos(a));
        Vertex { position: normal, normal, uv: DVec2::new(u, 1.0 - v) }
    };
    let corner = |x: usize, y: usize| (y * (around + 1) + x) as u32;
    let pair = |i: usize| {
        let (x, y) = (i % around, i / around);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, d, b], [b, d, c]]
    };
    Arc::new(Mesh {
        vertices: (0..(around + 1) * (down + 1)).map(vertex).collect(),
        triangles: (0..around * down).flat_map(pair).collect(),
        ..Mesh::default()
    })
}

fn camera(position: [f64; 3], fov: f64, size: usize) -> Camera {
    Camera::of_eye(&Eye::new([position.into(), DVec3::ZERO, DVec3::Y], fov, (size, size)), (size, size))
}

/// A picture with waves of its own.
fn waves(size: usize, phase: f64) -> Arc<Picture> {
    let wave = |x: f64| (0.5 + 0.4 * sin(x)) as f32;
    let cell = |i: usize| {
        let (x, y) = ((i % size) as f64 / size as f64, (i / size) as f64 / size as f64);
        [wave(9.0 * x + phase), wave(7.0 * y - phase), wave(5.0 * (x + y)), 1.0]
    };
    Arc::new(Picture::from_cells(size, size, (0..size * size).map(cell).collect()))
}

/// A view that looks at the origin.
pub fn view(position: [f64; 3], number: usize) -> View {
    const SIZE: usize = 40;
    let paint = Paint { picture: waves(SIZE, number as f64), mask: None, guide: None, feather_px: 0.0, gain: [1.0; 3] };
    View {
        name: number.to_string(),
        number,
        camera: camera(position, 40.0, SIZE),
        target: DVec3::ZERO,
        paint,
        base: true,
        dependent: true,
        extremes: Extremes::Auto(1.0),
        fade: Fade::default(),
        reach: Reach::default(),
        edge_px: 0.0,
    }
}

fn wanted(mesh: Arc<Mesh>, views: Vec<View>) -> Wanted {
    Wanted { mesh, by: By::Uv, first: 16, levels: Some(3), missing: [0.2; 3], views }
}

fn filled(wanted: Wanted, previous: Option<&Map>) -> Map {
    Map::new(wanted, previous, KEPT_BYTES, &Watch::NONE).unwrap()
}

fn round() -> Vec<View> {
    [[0.0, 0.0, 4.0], [3.0, 1.0, 3.0], [-2.0, 2.0, 3.0]].iter().enumerate().map(|(i, at)| view(*at, i)).collect()
}

#[test]
fn twice_the_resolution_or_half_the_distance_is_one_layer_more() {
    let mesh = squares(&[0.0]);
    let atlas = Atlas::new(&mesh, By::Uv);
    let depth = |camera: &Camera| Seen::new(&mesh, &atlas, camera, 16, 0.0).depth.unwrap();
    let far = camera([0.0, 0.0, 8.0], 10.0, 16);
    let base = depth(&far);
    // 4 square meters are half a square of the atlas; a pixel is 8 / focal meters wide.
    let pixel = 8.0 / far.focal_px.x;
    let expected = -0.5 * libm::log2(pixel * pixel * 0.5 / 4.0 * 256.0);
    assert!((base - expected).abs() < 1e-12, "{base} {expected}");
    let near = Camera { position: [0.0, 0.0, 4.0].into(), ..far };
    assert!((depth(&far.resized((32, 32))) - base - 1.0).abs() < 1e-12);
    assert!((depth(&near) - base - 1.0).abs() < 1e-12);
    let behind = camera([0.0, 0.0, -8.0], 10.0, 16);
    assert_eq!(Seen::new(&mesh, &atlas, &behind, 16, 0.0).depth, None, "backs are not seen, but hide");
}

#[test]
fn the_depth_changes_smoothly_as_a_camera_comes_nearer() {
    let mesh = ball();
    let atlas = Atlas::new(&mesh, By::Uv);
    let distances = std::iter::successors(Some(10.0), |distance| Some(0.98 * distance)).take(40);
    let seen = distances.map(|z| Seen::new(&mesh, &atlas, &camera([0.3 * z, 0.2 * z, z], 30.0, 160), 16, 0.0).depth);
    let depths: Vec<f64> = seen.map(Option::unwrap).collect();
    let most = depths.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(most <= 0.04 && depths[39] > depths[0] + 1.0, "{most} {depths:?}");
}

#[test]
fn the_surface_is_half_a_square_of_the_atlas_in_charts() {
    let two = Atlas::new(&squares(&[0.0, -1.0]), By::Uv);
    assert_eq!(two.chart, [0, 0, 1, 1]);
    assert!((two.areas.iter().sum::<f64>() - 0.5).abs() < 1e-12);
    // Each square is 0.5 wide: 8 cells of 16, and no more for the sides that they end at.
    let cells = Cells::new(&two, 16, 3);
    assert_eq!(cells.layers.iter().map(|layer| layer.len()).collect::<Vec<_>>(), [128, 512, 2048]);
    assert_eq!(cells.layers[1].find(1, 15, 15), 511);
    assert_eq!([cells.layers[1].find(1, 16, 0), cells.layers[0].find(0, -1, 3)], [NONE; 2]);
    assert_eq!(Atlas::new(&squares(&[0.0, -1.0]), By::Box).chart, [0, 0, 1, 1], "no edge in common");
    let sides = Atlas::new(&ball(), By::Box);
    assert!(sides.extents.len() >= 6);
    assert!((sides.areas.iter().sum::<f64>() - 0.5).abs() < 1e-9);
}

#[test]
fn a_lone_view_is_shown_as_it_is_from_its_own_camera() {
    let map = filled(Wanted { levels: None, ..wanted(ball(), vec![view([0.0, 1.0, 4.0], 0)]) }, None);
    let near = compare((&map, None), &Watch::NONE)[0].unwrap();
    assert!(near.psnr >= 36.0 && near.share > 0.99, "{near:?}");
    let twice = wanted(ball(), vec![view([0.0, 1.0, 4.0], 0), view([0.0, 1.0, 4.0], 1)]);
    let twice = compare((&filled(twice, None), None), &Watch::NONE)[1].unwrap();
    assert!(twice.share < 0.6, "half of what is seen there is the other's: {twice:?}");
    let report = super::report::map((&map, None));
    assert_eq!((report.charts, report.levels), (1, map.cells.layers.len()));
    let told: usize = map.origins[0].iter().flatten().sum();
    assert_eq!(report.bytes, 16 * told as u64);
    assert!(report.known.iter().zip(&report.cells).all(|(known, cells)| known < cells), "the back is not seen");
}

#[test]
fn what_is_hidden_stays_hidden() {
    let map = filled(wanted(squares(&[0.0, -1.0]), vec![view([0.0, 0.0, 4.0], 0)]), None);
    for (number, layer) in map.cells.layers.iter().enumerate() {
        for (cell, place) in layer.cells.iter().enumerate() {
            let told = !map.lists[number].of(cell as u32).is_empty();
            assert_eq!(told, place.chart == 0, "layer {number}, {place:?}");
            let state = if place.chart == 0 { State::Known } else { State::Missing };
            assert_eq!(map.coats[number].states[cell], state);
        }
    }
}

#[test]
fn views_of_other_depths_share_a_layer() {
    let entry = |depth: f32| Entry { color: [1.0; 3], mask: 1.0, facing: 1.0, depth };
    let shares = |told: &[(f32, f64)]| {
        let part = |(i, (depth, factor)): (usize, &(f32, f64))| Part::new(i, i, &entry(*depth), *factor, 3);
        let mut parts: Vec<Part> = told.iter().enumerate().map(part).collect();
        let opacity = mix(&mut parts);
        (opacity, parts.iter().map(|part| part.share).collect::<Vec<_>>())
    };
    let near = |(opacity, found): (f64, Vec<f64>), whole: f64, expected: &[f64]| {
        let far = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold((opacity - whole).abs(), f64::max);
        assert!(far < 1e-6, "{opacity} {found:?}, not {whole} {expected:?}");
    };
    near(shares(&[(2.3, 1.0), (2.9, 1.0)]), 1.0, &[0.25, 0.75]);
    near(shares(&[(0.5, 1.0)]), 1.0, &[1.0]);
    near(shares(&[(0.5, 0.4)]), 0.4, &[0.4]);
    // Half faded, it lets half of the other through.
    near(shares(&[(0.5, 1.0), (3.0, 0.5)]), 1.0, &[0.5, 0.5]);
}

#[test]
fn a_view_counts_up_to_its_limits() {
    let turned = |degrees: f64| DVec3::new(sin(degrees.to_radians()), 0.0, cos(degrees.to_radians()));
    let gauge = |views: &[View], eye: DVec3| {
        let mut gauges = Gauges::new(views);
        gauges.set(DVec3::ZERO, eye);
        let near = gauges.near().iter().find(|near| near.view == 0);
        near.map(|near| gauges.gauge(near, |_| 1.0))
    };
    let close = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?}");
    let half = (20f64.to_radians() / 2.0, libm::tan(20f64.to_radians() / 2.0)).1;
    let cone = [View { extremes: Extremes::Cone(half), ..view([0.0, 0.0, 4.0], 0) }];
    close(gauge(&cone, DVec3::Z), 0.0);
    close(gauge(&cone, turned(19.999_999)), libm::tan(19.999_999f64.to_radians() / 2.0) / half);
    assert_eq!(gauge(&cone, turned(20.001)), None);
    // At its neighbor's camera it is gone, on the other side it goes as far as its reach.
    let at = turned(10.0) * 4.0;
    let auto = [view([0.0, 0.0, 4.0], 0), view(at.to_array(), 1)];
    close(gauge(&auto, turned(10.0)), 1.0);
    close(gauge(&auto, turned(-10.0)), libm::tan(10f64.to_radians() / 2.0));
    let points = [[-30.0, 0.0], [0.0, -20.0], [30.0, 0.0], [0.0, 20.0]].map(DVec2::from);
    for back in [false, true] {
        let mut points = points.to_vec();
        if back {
            points.reverse();
        }
        let own = view([0.0, 0.0, 4.0], 0);
        let extremes = Extremes::points(&own.camera, DVec3::ZERO, &points);
        let views = [View { extremes, ..own }];
        close(
            gauge(&views, turned(29.999_999_9)),
            libm::tan(29.999_999_9f64.to_radians() / 2.0) / libm::tan(0.261_799_387_799_149_4),
        );
        assert_eq!(gauge(&views, turned(31.0)), None);
        close(gauge(&views, DVec3::Z), 0.0);
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads_nor_on_what_was_filled_before() {
    let mesh = ball();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| filled(wanted(mesh.clone(), round()), None))
    };
    let (one, two) = (with(1), with(2));
    let same =
        |a: &Map, b: &Map| (&a.lists, &a.coats, &a.reports, &a.origins) == (&b.lists, &b.coats, &b.reports, &b.origins);
    assert!(same(&one, &two));
    // An edit of one view, of another's kind, and of nothing that is told.
    let mut edited = one.wanted.clone();
    edited.views[1].paint.gain = [0.5, 1.0, 1.0];
    edited.views[2].base = false;
    let (after, anew) = (filled(edited.clone(), Some(&one)), filled(edited.clone(), None));
    assert!(same(&after, &anew) && !same(&after, &one));
    let edits: [fn(&mut Vec<View>); 5] = [
        |views| views.truncate(2),
        |views| drop(views.remove(0)),
        |views| views.push(View { base: false, ..view([1.0, -2.0, 3.0], 3) }),
        |views| views.swap(0, 2),
        |views| views[2].paint.feather_px = 9.0,
    ];
    for (number, edit) in edits.into_iter().enumerate() {
        let mut edited = edited.clone();
        edit(&mut edited.views);
        assert!(same(&filled(edited.clone(), Some(&after)), &filled(edited, None)), "edit {number}");
    }
    edited.views[0].fade.hold = 0.5;
    let faded = filled(edited, Some(&after));
    assert!(Arc::ptr_eq(&faded.lists, &after.lists) && Arc::ptr_eq(&faded.coats, &after.coats));
}

#[test]
fn a_stopped_filling_gives_nothing() {
    let watch = Watch { stopped: &|| true, done: &|_| () };
    assert!(Map::new(wanted(ball(), round()), None, KEPT_BYTES, &watch).is_none());
    let map = filled(wanted(ball(), round()), None);
    assert!(compare((&map, None), &watch).iter().all(Option::is_none));
}

#[test]
fn paint_counts_where_it_differs_from_its_guide_inside_its_mask() {
    let filled =
        |light: f32, alpha: f32| Picture::from_cells(4, 4, vec![[light * alpha, light * alpha, 0.0, alpha]; 16]);
    let mut cells = vec![[0.5, 0.5, 0.0, 1.0]; 16];
    cells[5] = [0.9, 0.5, 0.0, 1.0];
    let paint = Paint {
        picture: Arc::new(Picture::from_cells(4, 4, cells)),
        mask: Some(Arc::new(filled(1.0, 0.5))),
        guide: Some(Arc::new(filled(0.5, 1.0))),
        feather_px: 3.0,
        gain: [2.0, 1.0, 1.0],
    };
    let pixels = paint.pixels();
    // The second pixel from the border has half of what is farther than the feather, and the mask leaves half of that.
    assert_eq!(pixels[5], [1.8, 0.5, 0.0, 1.0].map(|v: f32| v * 0.25));
    assert!(pixels.iter().enumerate().all(|(i, pixel)| i == 5 || *pixel == [0.0; 4]));
}

#[test]
fn arrays_hold_what_is_seen_in_their_directions() {
    let map = filled(wanted(ball(), round()), None);
    let frames = super::frames::all(&map);
    let (layer, side) = (2, 32);
    let arrays = super::arrays::Arrays::new(&map, side, &|| false).unwrap();
    let mut mixer = super::mixer::Mixer::new(&map);
    let mut seen = 0;
    for cell in (0..map.cells.layers[layer].len()).step_by(17) {
        let frame = frames[layer][cell];
        let own = super::frames::of(&map, layer, &map.cells.layers[layer].cells[cell]).unwrap();
        assert!((own.at - frame.at).length() + (own.normal - frame.normal).length() < 1e-12);
        assert!(frame.at.dot(frame.normal) > 0.9 && frame.along.dot(frame.normal).abs() < 1e-9);
        // The middle of an element is read as it was made, to the precision of half floats.
        let at = DVec2::new(5.0 / 32.0, -5.0 / 32.0);
        let way = frame.way(at);
        assert!((way.length() - 1.0).abs() < 1e-12 && (frame.direction(way) - at).length() < 1e-12);
        mixer.look(frame.at, way);
        let exact = mixer.at(layer, cell as u32, |_, _| ());
        let read = arrays.read(layer, cell as u32, way);
        assert!(exact.iter().zip(read).all(|(a, b)| (a - b).abs() < 1e-3), "{exact:?} {read:?}");
        seen += usize::from(exact[3] > 0.1);
        assert_eq!(frame.direction(-frame.normal), DVec2::ZERO);
        assert!((frame.direction(frame.along * 0.6 - frame.normal * 0.8) - DVec2::X).length() < 1e-12, "on the rim");
    }
    assert!(seen > 10, "{seen}");
    assert!(super::arrays::Arrays::new(&map, side, &|| true).is_none());
}

#[test]
fn the_colors_of_coverage_are_named_by_the_views_that_count() {
    use crate::layers::mesh::surface::SurfaceSlot;
    let view =
        |name: &str, active: bool| serde_json::json!({ "name": name, "image": "a", "camera": {}, "active": active });
    let views = [view("a", true), view("b", false), view("c", true)];
    let own: super::model::ViewMap = serde_json::from_value(serde_json::json!({ "views": views })).unwrap();
    let named: Vec<&str> = own.pass_colors(&super::passes::COVERAGE).iter().map(|(name, _)| *name).collect();
    assert_eq!(named, ["a", "c"]);
    // HSV 0, 0.65, 0.95.
    assert_eq!(own.pass_colors(&super::passes::COVERAGE)[0].1, [242, 85, 85]);
    assert!(own.pass_colors(&super::passes::DEPENDENT).is_empty());
}

#[test]
fn a_camera_of_a_world_whose_z_is_up_is_told_as_one() {
    let mut high = (*squares(&[0.0])).clone();
    high.vertices.iter_mut().for_each(|vertex| vertex.position.y += 9.0);
    let looking = |back: DVec3, at: DVec3, up: DVec3| {
        let camera = Camera::of_eye(&Eye::new([at + back, at, up], 40.0, (40, 40)), (40, 40));
        let map = filled(wanted(Arc::new(high.clone()), vec![View { camera, ..view([0.0, 0.0, 4.0], 0) }]), None);
        let own = serde_json::json!({ "views": [{ "name": "0", "image": "a", "camera": {} }] });
        let found = super::warnings::warnings(&serde_json::from_value(own).unwrap(), &map);
        found[0].hint.clone().unwrap()
    };
    let lying = looking(DVec3::NEG_Y * 4.0, DVec3::Z * 9.0, DVec3::Z);
    assert!(lying.contains("--axes z-up"), "{lying}");
    assert!(looking(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y).contains("y up"));
}

#[test]
fn what_is_odd_is_told_once_it_is_filled() {
    let told = |mesh: Arc<Mesh>, views: Vec<View>, own: serde_json::Value| -> Vec<(String, String)> {
        let map = filled(wanted(mesh, views), None);
        let own = serde_json::from_value(own).unwrap();
        let found = super::warnings::warnings(&own, &map);
        found.into_iter().map(|problem| (problem.path, problem.message)).collect()
    };
    let own = |count: usize| {
        let view = |i: usize| serde_json::json!({ "name": i.to_string(), "image": "a", "camera": {} });
        serde_json::json!({ "views": (0..count).map(view).collect::<Vec<_>>() })
    };
    assert_eq!(told(squares(&[0.0]), vec![view([0.0, 0.0, 4.0], 0), view([1.0, 0.0, 4.0], 1)], own(2)), []);
    let lone = told(squares(&[0.0]), vec![view([0.0, 0.0, 4.0], 0)], own(1));
    assert!(lone.len() == 1 && lone[0].0 == "/views/0/extremes" && lone[0].1.contains("30 degrees"), "{lone:?}");
    let mut painted = own(2);
    painted["views"][1]["kind"] = "independent".into();
    let lone = told(squares(&[0.0]), vec![view([0.0, 0.0, 4.0], 0), view([1.0, 0.0, 4.0], 1)], painted);
    assert!(
        lone.len() == 1 && lone[0].0 == "/views/0/extremes",
        "what is seen from everywhere has no extremes: {lone:?}"
    );
    let mut beyond = view([0.0, 0.0, 4.0], 1);
    beyond.camera = beyond.camera.resized((400, 400));
    beyond.paint.picture = waves(400, 0.0);
    let found = told(squares(&[0.0]), vec![view([0.0, 0.0, -4.0], 0), beyond], own(2));
    assert!(found[0].1.starts_with("sees nothing of the mesh (it looks 0 degrees past it)"), "{found:?}");
    assert!(found[1].0 == "/views/1" && found[1].1.contains("100 % of it is finer than layer 2"), "{found:?}");
    let mut within = view([0.0, 0.0, 0.5], 0);
    within.extremes = Extremes::Cone(0.5);
    let found = told(ball(), vec![within, view([0.0, 0.0, 4.0], 1)], own(2));
    assert!(found[0] == ("/views/0/camera".into(), "it is in the mesh".into()), "{found:?}");
    let mut folded = (*squares(&[0.0])).clone();
    folded.triangles.push([0, 1, 2]);
    let found = told(Arc::new(folded), vec![view([0.0, 0.0, 4.0], 0), view([1.0, 0.0, 4.0], 1)], own(2));
    assert!(found.len() == 1 && found[0].1.contains("share their colors"), "{found:?}");
}
