//! A smaller synthesis for a preview, where a picture is larger than the GPU can hold. Folds, jumps and outlines are those
//! of the pixel in the middle of each block, scaled; the picture is the mean of the block.

use std::sync::Arc;

use super::{LayerSynth, Synth};
use crate::base::picture::Picture;
use crate::base::pixels::{Grid, Rgba};
use crate::layers::folding::field::{Field, Folds, Ragged};
use crate::layers::folding::synth::ZoneSynth;

/// The synthesis of a scene whose pictures are `factor` times smaller on each side.
pub fn reduced(synth: &Synth, factor: usize) -> Synth {
    let mut pictures = Pictures { factor, made: Vec::new() };
    let layer = |LayerSynth::Picture(layer): &LayerSynth| {
        let zones = layer.zones.iter().filter_map(|z| zone(z, &mut pictures)).collect();
        let picture = pictures.reduced(&layer.picture);
        LayerSynth::Picture(crate::layers::folding::synth::Synth { picture, zones })
    };
    let layers = synth.layers.iter().map(layer).collect();
    Synth { size: (synth.size.0.div_ceil(factor), synth.size.1.div_ceil(factor)), layers }
}

/// Pictures made smaller, each once.
struct Pictures {
    factor: usize,
    made: Vec<(Arc<Picture>, Arc<Picture>)>,
}

impl Pictures {
    fn reduced(&mut self, picture: &Arc<Picture>) -> Arc<Picture> {
        if let Some((_, made)) = self.made.iter().find(|(large, _)| Arc::ptr_eq(large, picture)) {
            return made.clone();
        }
        let made = Arc::new(means(picture, self.factor));
        self.made.push((picture.clone(), made.clone()));
        made
    }
}

/// The mean of every block of `factor` x `factor` pixels.
fn means(picture: &Picture, factor: usize) -> Picture {
    let (width, height) = (picture.width().div_ceil(factor), picture.height().div_ceil(factor));
    let block = |i: usize| {
        let (x, y) = (i % width * factor, i / width * factor);
        let (x1, y1) = ((x + factor).min(picture.width()), (y + factor).min(picture.height()));
        let mut sum: Rgba = [0.0; 4];
        let mut colors = vec![[0.0; 4]; x1 - x];
        for row in y..y1 {
            picture.row(x, row, &mut colors);
            for color in &colors {
                sum = std::array::from_fn(|c| sum[c] + color[c]);
            }
        }
        sum.map(|s| s / ((x1 - x) * (y1 - y)) as f32)
    };
    Picture::from_cells(width, height, (0..width * height).map(block).collect())
}

/// `None` if no block has its middle in the zone's box.
fn zone(zone: &ZoneSynth, pictures: &mut Pictures) -> Option<ZoneSynth> {
    let factor = pictures.factor;
    let mut small = zone.clone();
    small.field = Arc::new(field(&zone.field, factor)?);
    small.source.picture = pictures.reduced(&zone.source.picture);
    small.source.offset = zone.source.offset / factor as f64;
    Some(small)
}

fn field(field: &Field, factor: usize) -> Option<Field> {
    // Block b stands for the pixel b * factor + factor / 2.
    let first = |from: usize| (from + factor - 1 - factor / 2) / factor;
    let blocks = |from: usize, n: usize| first(from)..first(from + n);
    let columns = blocks(field.x0, field.inside.width());
    let rows = blocks(field.y0, field.inside.height());
    if columns.is_empty() || rows.is_empty() {
        return None;
    }
    let middle = |b: usize, from: usize| b * factor + factor / 2 - from;
    let kept: Vec<usize> = rows
        .clone()
        .flat_map(|y| columns.clone().map(move |x| (x, y)))
        .map(|(x, y)| middle(y, field.y0) * field.inside.width() + middle(x, field.x0))
        .collect();
    let (width, height) = (columns.len(), rows.len());
    let jump = |i: &usize| field.jumps.cells()[*i].map(|c| c / factor as f32);
    Some(Field {
        x0: columns.start,
        y0: rows.start,
        inside: Grid::from_cells(width, height, kept.iter().map(|&i| field.inside.cells()[i]).collect()),
        jumps: Grid::from_cells(width, height, kept.iter().map(jump).collect()),
        folds: field.folds.as_ref().map(|folds| Folds {
            rule: folds.rule,
            inside: Grid::from_cells(width, height, kept.iter().map(|&i| folds.inside.cells()[i]).collect()),
            ahead: some_of(&folds.ahead, &kept),
            behind: some_of(&folds.behind, &kept),
        }),
    })
}

fn some_of(ragged: &Ragged, kept: &[usize]) -> Ragged {
    let mut some = Ragged { starts: vec![0], values: Vec::new() };
    for &i in kept {
        some.values.extend_from_slice(ragged.of(i));
        some.starts.push(some.values.len() as u32);
    }
    some
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::maths;
    use crate::layers::Materials;
    use crate::render::{cpu, synth};

    #[test]
    fn a_reduced_frame_looks_like_the_frame_reduced() {
        let cell = |i: usize| {
            let wave = |x: usize| (0.5 + 0.5 * maths::sin(x as f64 / 23.0)) as f32;
            [wave(i % 200), wave(i / 200), 0.4, 1.0]
        };
        let picture = Arc::new(Picture::from_cells(200, 160, (0..200 * 160).map(cell).collect()));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let scene = serde_json::from_str(
            r#"{"plica": 1, "layers": [{"kind": "picture", "name": "l", "image": "a", "zones": [{"name": "z",
              "outline": {"kind": "ellipse", "center": [101, 79], "radii": [70, 60]},
              "motion": [{"tool": "point", "at": [90, 70], "jump": [24, 12]}, {"tool": "still-border", "spacing": 10}],
              "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 110, "y": 60, "width": 30, "height": 40}]}}]}]}"#,
        )
        .unwrap();
        let large = synth(&scene, &materials, None).unwrap();
        let (small, expected) =
            (cpu::linear(&reduced(&large, 4), 0.6), means(&cpu::linear(&large, 0.6).into(), 4).to_linear());
        assert_eq!((small.width(), small.height()), (50, 40));
        let far = |(a, b): (&Rgba, &Rgba)| (0..4).any(|c| (a[c] - b[c]).abs() > 0.05);
        let count = small.cells().iter().zip(expected.cells()).filter(|&p| far(p)).count();
        assert!(count < 60, "{count} of 2000 differ");
    }
}
