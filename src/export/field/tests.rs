//! Plots and tables of a field that is known in every pixel.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::*;
use crate::layers::parts::marks::Legend;
use crate::layers::parts::materials::Materials;
use crate::render;

fn scene() -> (Scene, Synth) {
    let scene: Scene = serde_json::from_str(
        r#"{ "plica": 1, "images": { "a": { "path": "a.png" } }, "layers": [{ "kind": "picture", "name": "l", "image": "a",
          "zones": [{ "name": "z", "outline": { "kind": "rectangle", "x": 10, "y": 12, "width": 20, "height": 8 },
            "fold": { "rule": "cover", "regions": [{ "kind": "ellipse", "center": [20, 16], "radii": [5, 2] }] },
            "motion": [{ "tool": "translate", "by": [3, -4] }, { "tool": "point", "at": [20, 16] }] }] }] }"#,
    )
    .unwrap();
    let picture = std::sync::Arc::new(crate::base::picture::Picture::filled(60, 40, [0.2, 0.4, 0.1, 1.0]));
    let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
    let synth = render::synth(&scene, &materials, None).unwrap();
    (scene, synth)
}

#[test]
fn the_table_has_every_pixel_of_the_lattice() {
    let (_, synth) = scene();
    let text = csv(&arrows(&synth, 1));
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines.len(), 1 + 20 * 8);
    assert_eq!(lines[..2], ["x,y,dx,dy,length,degrees", "10.5,12.5,3,-4,5.000000,-53.1301"]);
    let sparse = arrows(&synth, 4);
    assert_eq!(sparse.len(), 5 * 2);
    assert!(sparse.iter().all(|a| a.at.x % 4.0 == 2.5 && a.at.y % 4.0 == 2.5));
}

#[test]
fn the_svg_is_well_formed() {
    let (scene, synth) = scene();
    for picture in [true, false] {
        let text = svg(&plot(&scene, &synth, &PlotLook { no_picture: !picture, ..PlotLook::default() })).unwrap();
        assert_eq!(text.matches("<image").count(), usize::from(picture));
        let encoded = text.split_once("image/png;base64,").map(|(_, rest)| rest.split('"').next().unwrap());
        let within = encoded.map(|text| image::load_from_memory(&STANDARD.decode(text).unwrap()).unwrap());
        // The zone with two pixels around it.
        assert_eq!(within.map(|image| [image.width(), image.height()]), picture.then_some([24, 12]));
        let mut open = Vec::new();
        for tag in text.split('<').skip(1) {
            let (tag, rest) = tag.split_once('>').unwrap();
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
            match tag.strip_prefix('/') {
                Some(name) => assert_eq!(open.pop(), Some(name.to_owned())),
                None if tag.ends_with('/') => {}
                None => open.push(tag.split_whitespace().next().unwrap().to_owned()),
            }
            assert!(open.last().is_some_and(|t| t == "title") || rest.trim().is_empty());
        }
        assert!(open.is_empty() && !text.contains("NaN") && !text.contains("inf"));
    }
}

#[test]
fn the_png_shows_arrows_and_picture() {
    let (scene, synth) = scene();
    let plot = plot(&scene, &synth, &PlotLook { step: Some(2), ..PlotLook::default() });
    let image = image::load_from_memory(&png(&plot).unwrap()).unwrap().to_rgba8();
    assert_eq!((f64::from(image.width()), f64::from(image.height())), (plot.width.ceil(), plot.height.ceil()));
    let colors: std::collections::HashSet<_> = image.pixels().map(|p| p.0).collect();
    assert!(colors.len() > 50, "{} colors", colors.len());
    assert!(plot.marks.iter().all(|m| m.points.iter().all(|p| p.is_finite())));
}

#[test]
fn a_plot_shows_what_is_asked_for_and_colors_what_they_are_to_tell() {
    let (scene, synth) = scene();
    let count = |show: &[&str], look: &str, no_legend: bool| {
        let named = |overlay: &&Overlay| overlay.legend.is_some_and(|legend| show.contains(&legend.word()));
        let overlays = overlays_of_fields().filter(named).map(|overlay| overlay.name).collect();
        let mut vectors = VectorLook::default();
        vectors.set(look).unwrap();
        let look = PlotLook { step: Some(4), overlays, vectors, no_legend, ..PlotLook::default() };
        let plot = plot(&scene, &synth, &look);
        let colors: std::collections::BTreeSet<_> = plot.marks.iter().map(|mark| mark.color).collect();
        (plot.marks.len(), colors, plot.height)
    };
    let arrows = count(&["arrows"], "", true);
    assert_eq!(count(&[], "", true), arrows, "arrows, unless it is told what");
    // Ten arrows of a line and a head, or a dot; as many squares as pixels.
    assert_eq!(count(&["colors"], "", true).0 - arrows.0, 20 * 8 - 2 * 10);
    let (streamlines, both) = (count(&["streamlines"], "", true), count(&["arrows", "streamlines"], "", true));
    let colors = count(&["colors"], "", true);
    assert_eq!(arrows.0 + streamlines.0 - both.0, colors.0 - 20 * 8, "beside the field all have the same");
    let [full, faint] = ["color=length", "color=length longest=1000"].map(|look| count(&["colors"], look, true).1);
    assert_ne!(full, faint);
    for look in ["", "color=curl", "equal=on"] {
        let (with, without) = (count(&["arrows"], look, false), count(&["arrows"], look, true));
        assert!(with.0 > without.0 && with.2 > without.2, "{look}: {with:?} {without:?}");
    }
}

#[test]
fn cells_of_color_meet_whatever_the_spacing() {
    let (scene, synth) = scene();
    let overlays: Vec<_> = overlays_of_fields().filter(|overlay| overlay.legend == Some(Legend::Colors)).collect();
    for step in [4, 5, 9, 10] {
        let overlays = overlays.iter().map(|overlay| overlay.name).collect();
        let look = PlotLook { step: Some(step), overlays, no_legend: true, ..PlotLook::default() };
        let squares = |mark: &PlotMark| (mark.points.len() == 4 && mark.stroke.is_none()).then(|| mark.points[0].x);
        let plot = plot(&scene, &synth, &look);
        let sides: Vec<f64> = plot.marks.iter().filter_map(squares).take(6).collect();
        let side = sides[1] - sides[0];
        let cell = plot.marks.iter().find(|mark| squares(mark) == Some(sides[0])).unwrap();
        assert_eq!(cell.points[1].x - cell.points[0].x, side, "{step}");
        assert!(sides.windows(2).all(|pair| pair[1] - pair[0] == side), "{step}: {sides:?}");
    }
}

#[test]
fn nothing_reaches_out_of_the_picture() {
    let (scene, synth) = scene();
    let mut json = serde_json::to_value(&scene).unwrap();
    json["layers"][0]["zones"][0]["outline"] =
        serde_json::json!({ "kind": "rectangle", "x": -99, "y": -99, "width": 150, "height": 115 });
    let scene = serde_json::from_value(json).unwrap();
    let image = image::load_from_memory(
        &png(&plot(&scene, &synth, &PlotLook { no_picture: true, ..PlotLook::default() })).unwrap(),
    )
    .unwrap()
    .to_rgba8();
    assert!((0..image.width()).all(|x| image.get_pixel(x, 5).0 == [255; 4]));
    assert!((0..image.height()).all(|y| image.get_pixel(5, y).0 == [255; 4]));
}
