//! A scene, loaded and synthesised, and what is true of every demo: outside the zones the picture keeps still, and no
//! seam opens where a zone ends.

use std::path::Path;

use kurbo::Point;
use plica::base::geometry::Polygon;
use plica::base::pixels::Frame;
use plica::files;
use plica::layers::Layer;
use plica::layers::folding::{self, model::PictureLayer};
use plica::layers::parts::materials::Materials;
use plica::render;
use plica::scene::Document;

/// A scene ready to be shown.
pub struct Show {
    pub document: Document,
    pub materials: Materials,
    pub synth: render::Synth,
}

impl Show {
    pub fn open(scene: &Path) -> Show {
        let options = files::Options::default();
        let document = files::scene::open(scene, &options).unwrap();
        assert!(document.warnings().is_empty(), "{}: {:?}", scene.display(), document.warnings());
        let loaded = files::materials::load(scene, document.scene(), &options, &mut Default::default());
        let (materials, problems) = loaded.unwrap();
        assert!(problems.is_empty(), "{}: {problems:?}", scene.display());
        let synth = render::synth(document.scene(), &materials, None).unwrap();
        Show { document, materials, synth }
    }

    pub fn frame(&self, time: f64) -> Frame {
        render::cpu::frame(&self.synth, time)
    }

    /// Its only layer.
    pub fn layer(&self) -> &PictureLayer {
        let Layer::Picture(layer) = &self.document.scene().layers[0] else { panic!("no picture") };
        layer
    }

    /// The layer's own picture, as a frame.
    pub fn still(&self) -> Frame {
        render::cpu::finish(&self.materials.pictures[&self.layer().image].to_linear())
    }

    /// For every pixel, how many zones contain it.
    pub fn zones(&self) -> Vec<u32> {
        let (width, height) = self.synth.size;
        let layer = self.synth.layers[0].downcast::<folding::synth::Synth>().unwrap();
        let mut count = vec![0; width * height];
        for field in layer.zones.iter().map(|zone| &zone.field) {
            for y in 0..field.inside.height() {
                for x in 0..field.inside.width() {
                    count[(field.y0 + y) * width + field.x0 + x] += u32::from(*field.inside.get(x, y));
                }
            }
        }
        count
    }
}

/// The largest difference of two colors in any channel, in 8-bit steps.
pub fn step(a: [u8; 4], b: [u8; 4]) -> u8 {
    (0..4).map(|i| a[i].abs_diff(b[i])).max().unwrap()
}

pub fn at(frame: &Frame, x: usize, y: usize) -> [u8; 4] {
    *frame.get(x, y)
}

/// A time at which the scene has moved far, and two others.
pub const TIMES: [f64; 3] = [0.1, 0.5, 0.75];

pub fn still_outside(name: &str, show: &Show) {
    let (still, zones) = (show.still(), show.zones());
    let mut moves = false;
    for time in TIMES {
        let frame = show.frame(time);
        let changed = (0..zones.len()).filter(|&i| frame.cells()[i] != still.cells()[i]);
        let (inside, outside): (Vec<usize>, Vec<usize>) = changed.partition(|&i| zones[i] > 0);
        assert!(outside.is_empty(), "{name}: {} pixels outside every zone change at {time}", outside.len());
        moves |= !inside.is_empty();
    }
    assert!(moves, "{name}: nothing moves");
}

/// Checks that across a zone's outline, neighboring pixels of a moved picture differ no more than those of the still
/// picture within a few pixels. Where a zone deliberately ends at a visible edge (the lower lid, a sign in front of the
/// car), one thing covers another, and nothing is checked.
pub fn no_seam(name: &str, show: &Show) {
    let (seams, still) = (seams(show), show.still());
    for time in (0..8).map(|k| f64::from(k) / 8.0) {
        let frame = show.frame(time);
        for &((x, y), (u, v)) in &seams {
            let excess = step(at(&frame, x, y), at(&frame, u, v)).saturating_sub(roughness(&still, x, y));
            assert!(excess <= 12, "{name}: a seam of {excess} at ({x}, {y}) at time {time}");
        }
    }
}

type Pixel = (usize, usize);

/// Neighboring pixels that a zone's outline separates, except where one thing covers another on purpose.
fn seams(show: &Show) -> Vec<(Pixel, Pixel)> {
    let (width, height) = show.synth.size;
    let zones = show.zones();
    let covers = covering(show);
    let below = (0..height - 1).flat_map(|y| (0..width).map(move |x| ((x, y), (x, y + 1))));
    let beside = (0..height).flat_map(|y| (0..width - 1).map(move |x| ((x, y), (x + 1, y))));
    let index = |(x, y): Pixel| y * width + x;
    let parted = below.chain(beside).filter(|&(a, b)| zones[index(a)] != zones[index(b)]);
    parted.filter(|&(a, b)| !covers(a) && !covers(b)).collect()
}

/// Whether a pixel is near a fold region's edge or in a zone with its own sampler image: there one thing covers
/// another.
fn covering(show: &Show) -> impl Fn(Pixel) -> bool {
    let mut areas: Vec<Polygon> = Vec::new();
    for zone in &show.layer().zones {
        let regions = zone.fold.iter().flat_map(|fold| fold.regions());
        match zone.sampler {
            Some(_) => areas.push(zone.outline.polygon()),
            None => areas.extend(regions.map(|region| region.polygon())),
        }
    }
    move |(x, y)| {
        let q = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        areas.iter().any(|area| area.contains(q) || area.distance(q) < 4.0)
    }
}

/// The largest step between neighbors within 3 pixels.
fn roughness(frame: &Frame, x: usize, y: usize) -> u8 {
    let rows = y.saturating_sub(3)..=(y + 3).min(frame.height() - 2);
    let columns = x.saturating_sub(3)..=(x + 3).min(frame.width() - 2);
    let steps = rows.flat_map(|v| columns.clone().map(move |u| (u, v)));
    steps
        .map(|(u, v)| step(at(frame, u, v), at(frame, u + 1, v)).max(step(at(frame, u, v), at(frame, u, v + 1))))
        .max()
        .unwrap()
}
