//! Groups on whose surfaces something is drawn: that needs all of a frame at once, so it is made once for all its rows, and
//! for all samples of a pixel from one frame that is as many times larger.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::made::{DrawnPass, LastMade, MadeOf, Synth, Whole, Wholes};
use super::stage::Group;
use crate::base::last::Last;
use crate::base::pixels::Rgba;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::pass::{COLOR, Which};
use crate::layers::ready::{Still, Surfaces};

impl LastMade {
    /// What is made whole of one frame: as it is kept, or made now.
    pub fn frame(synth: &Synth, scene_time: f64) -> Arc<Wholes> {
        let make = || Wholes::new(std::slice::from_ref(synth), scene_time);
        kept(&synth.kept.frame, (synth, scene_time), |_| true, make)
    }

    /// The same of a pass.
    pub fn pass(synth: &Synth, scene_time: f64, which: Which) -> Arc<DrawnPass> {
        let make = || {
            let moment = synth.moment(scene_time);
            let groups = synth.stage.groups.iter().map(|group| pass(synth, group, &moment, which)).collect();
            DrawnPass { pass: *which.pass, of: which.of.map(str::to_owned), groups }
        };
        let is_same = |drawn: &DrawnPass| drawn.pass == *which.pass && drawn.of.as_deref() == which.of;
        kept(&synth.kept.pass, (synth, scene_time), is_same, make)
    }
}

/// What was made last, if it was made of the same and fits, or what is made now.
fn kept<T>(
    last: &Last<MadeOf, T>,
    (synth, scene_time): (&Synth, f64),
    fits: impl Fn(&T) -> bool,
    make: impl FnOnce() -> T,
) -> Arc<T> {
    if !synth.has_strokes() {
        return Arc::new(make());
    }
    let is_same = |(time, stage, layers): &MadeOf| {
        let mut pairs = layers.iter().zip(&synth.layers);
        *time == scene_time && *stage == synth.stage && pairs.all(|(own, other)| Arc::ptr_eq(own, other))
    };
    let made_of = || (!synth.is_stopped()).then(|| (scene_time, synth.stage.clone(), synth.layers.clone()));
    last.get(|made_of, made| is_same(made_of) && fits(made), make, made_of)
}

/// Colors, premultiplied, and how far away they are.
pub type Surfaced<'a> = (Cow<'a, [Rgba]>, Cow<'a, [f64]>);

/// Bytes that a pixel takes while it is drawn: what a layer hands out, a few noises, and the drawing.
const PIXEL_BYTES: u64 = 160;

/// Bytes that the strokes of a scene need while a frame is drawn, with so many samples a pixel in each direction.
pub fn bytes(synth: &Synth, each_way: u32) -> u64 {
    let pixels = synth.size.0 as u64 * synth.size.1 as u64 * u64::from(each_way) * u64::from(each_way);
    if synth.has_strokes() { pixels * PIXEL_BYTES } else { 0 }
}

/// Whether a group of a scene is made whole.
fn is_whole(synth: &Synth, group: &Group) -> bool {
    matches!(group, Group::World(layers) if layers.iter().any(|&layer| synth.layers[layer].has_strokes()))
}

impl Wholes {
    /// Makes them at a scene time. Of several samples a pixel, any will do.
    pub fn new(samples: &[Synth], scene_time: f64) -> Wholes {
        let each_way = (1..).take_while(|n| n * n <= samples.len()).last().unwrap_or(1);
        let Some(synth) = samples.first() else { return Wholes { each_way, groups: Vec::new() } };
        let size = (synth.size.0 * each_way, synth.size.1 * each_way);
        let moment = Moment { magnified: each_way as u32, ..synth.stage.moment(scene_time, size) };
        let groups = synth.stage.groups.iter();
        let make = |group| is_whole(synth, group).then(|| Whole::new(synth, group, &moment, COLOR_OF_ALL));
        Wholes { each_way, groups: groups.map(make).collect() }
    }

    /// The colors and the depths of a group in these columns and rows of one of the samples, if it is among them.
    pub fn of(&self, group: usize, sample: usize, columns: Columns, rows: &[usize]) -> Option<Surfaced<'_>> {
        let whole = self.groups.get(group)?.as_ref()?;
        if let (1, Columns::All, [first, .., last]) = (self.each_way, columns, rows)
            && last - first + 1 == rows.len()
        {
            let own = first * whole.width..(last + 1) * whole.width;
            return Some((Cow::Borrowed(&whole.color[own.clone()]), Cow::Borrowed(&whole.depth[own])));
        }
        let (each, across, down) = (self.each_way, sample % self.each_way, sample / self.each_way);
        let count = match columns {
            Columns::All => whole.width / each,
            Columns::Some(columns) => columns.len(),
        };
        let (mut color, mut depth) = (vec![[0.0; 4]; rows.len() * count], vec![0.0; rows.len() * count]);
        let lines = color.par_chunks_mut(count.max(1)).zip(depth.par_chunks_mut(count.max(1))).zip(rows);
        lines.for_each(|((color, depth), y)| {
            let row = (y * each + down) * whole.width + across;
            for (cell, (color, depth)) in color.iter_mut().zip(depth).enumerate() {
                let i = row + columns.at(cell) * each;
                (*color, *depth) = (whole.color[i], whole.depth[i]);
            }
        });
        Some((color.into(), depth.into()))
    }
}

/// The finished color.
const COLOR_OF_ALL: Which = Which { pass: &COLOR, of: None };

impl Whole {
    fn new(synth: &Synth, group: &Group, moment: &Moment, which: Which) -> Whole {
        let layers = group.layers();
        let stills: Vec<(usize, Box<dyn Still + '_>)> =
            layers.iter().map(|&layer| (layer, synth.layers[layer].at(moment))).collect();
        let mut whole = surfaces(synth, &stills, moment.size_px);
        whole.draw(&stills, which);
        whole
    }

    fn draw(&mut self, stills: &[(usize, Box<dyn Still + '_>)], which: Which) {
        let Whole { color, depth, layer, part, .. } = self;
        for (own, still) in stills {
            still.strokes(which, &Surfaces { depth, layer, part, own: *own as u32 }, color);
        }
    }
}

/// The surfaces of a group, with nothing drawn on them.
fn surfaces(synth: &Synth, stills: &[(usize, Box<dyn Still + '_>)], (width, height): (usize, usize)) -> Whole {
    let mut color = vec![[0.0; 4]; width * height];
    let mut depth = vec![f64::INFINITY; color.len()];
    let (mut layer, mut part) = (vec![u32::MAX; color.len()], vec![u32::MAX; color.len()]);
    let width_or_1 = width.max(1);
    let rows = color.par_chunks_mut(width_or_1).zip(depth.par_chunks_mut(width_or_1));
    let parts = layer.par_chunks_mut(width_or_1).zip(part.par_chunks_mut(width_or_1));
    rows.zip(parts).enumerate().for_each(|(y, ((color, depth), (layer, part)))| {
        let mut before = depth.to_vec();
        for (own, still) in stills {
            if synth.layers[*own].has_strokes() {
                still.parts(y, depth, part);
            } else {
                still.surface(y, Columns::All, depth, color);
            }
            let nearer = layer.iter_mut().zip(&mut before).zip(&*depth).filter(|((_, before), now)| *now < before);
            nearer.for_each(|((layer, before), now)| (*layer, *before) = (*own as u32, *now));
        }
    });
    Whole { width, color, depth, layer, part }
}

/// What a pass shows that is drawn on the surfaces of a group, in these columns and rows; transparent elsewhere. `None` if
/// nothing is drawn there.
fn pass(synth: &Synth, group: &Group, moment: &Moment, which: Which) -> Option<Vec<Rgba>> {
    is_whole(synth, group).then(|| {
        let stills: Vec<(usize, Box<dyn Still + '_>)> =
            group.layers().iter().map(|&layer| (layer, synth.layers[layer].at(moment))).collect();
        let mut whole = surfaces(synth, &stills, moment.size_px);
        whole.color.fill([0.0; 4]);
        whole.draw(&stills, which);
        whole.color
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use glam::DVec3;

    use super::*;
    use crate::base::mesh::{Mesh, Vertex};
    use crate::layers::parts::materials::Materials;
    use crate::render::cpu;
    use crate::render::stage::Stage;
    use crate::scene::Scene;

    fn synth(stop: Option<Arc<AtomicBool>>) -> Synth {
        let scene: Scene = serde_json::from_str(
            r#"{"plica": 1, "size": [40, 30], "camera": {"position": [0, 0, 2]}, "meshes": {"m": {"path": "m.obj"}},
                "layers": [{"kind": "mesh", "name": "m", "mesh": "m", "sides": "both", "strokes": {}}]}"#,
        )
        .unwrap();
        let corner = |[x, y]: [f64; 2]| Vertex { position: DVec3::new(x, y, 0.0), ..Vertex::default() };
        let vertices = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(corner).to_vec();
        let mesh = Arc::new(Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() });
        let materials = Materials { meshes: [("m".to_owned(), mesh)].into(), stop, ..Materials::default() };
        crate::render::synth(&scene, &materials, None).unwrap()
    }

    #[test]
    fn a_frame_is_made_once_for_all_that_want_pixels_of_it() {
        let synth = synth(None);
        let first = LastMade::frame(&synth, 0.25);
        assert!(Arc::ptr_eq(&first, &LastMade::frame(&synth.clone(), 0.25)));
        assert!(!Arc::ptr_eq(&first, &LastMade::frame(&synth, 0.5)), "another time");
        let last = LastMade::frame(&synth, 0.5);
        let other = Synth { stage: Arc::new(Stage { camera: None, ..(*synth.stage).clone() }), ..synth.clone() };
        assert!(!Arc::ptr_eq(&last, &LastMade::frame(&other, 0.5)), "another camera");
        assert_eq!(cpu::lattice(&synth, 0.5, &[9, 20], &[11]).cells()[1], *cpu::linear(&synth, 0.5).get(20, 11));
    }

    #[test]
    fn a_pass_is_made_once_for_all_that_want_pixels_of_it() {
        let synth = synth(None);
        let [ink, tone] =
            ["ink", "tone"].map(|name| crate::render::passes::all().find(|pass| pass.name == name).unwrap());
        let of = |pass, time| LastMade::pass(&synth, time, Which { pass, of: None });
        let first = of(ink, 0.25);
        assert!(Arc::ptr_eq(&first, &of(ink, 0.25)) && first.groups[0].is_some());
        assert!(!Arc::ptr_eq(&of(ink, 0.25), &of(tone, 0.25)) && !Arc::ptr_eq(&of(tone, 0.5), &of(tone, 0.25)));
    }

    #[test]
    fn what_is_stopped_is_neither_drawn_nor_kept() {
        let stop = Arc::new(AtomicBool::new(true));
        let synth = synth(Some(stop.clone()));
        let first = LastMade::frame(&synth, 0.0);
        let paper = |wholes: &Wholes| {
            let colors = &wholes.groups[0].as_ref().unwrap().color;
            // Without noise only outlines are drawn.
            colors.iter().filter(|color| color[3] == 1.0 && color[0] > 0.8).count()
        };
        stop.store(false, Ordering::Relaxed);
        let second = LastMade::frame(&synth, 0.0);
        assert!(!Arc::ptr_eq(&first, &second));
        assert_ne!(paper(&first), paper(&second));
    }
}
