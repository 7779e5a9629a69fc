//! What frames are made from, as pictures of numbers: depth, normals, which layer and which triangle.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;

use rayon::prelude::*;

use super::stage::Group;
use super::{Synth, cpu, made};
use crate::base::pixels::{Frame, Grid, Linear, Rgba, encode};
use crate::base::problem::{like, nearest, quoted, there_are};
use crate::layers::KINDS;
use crate::layers::parts::moment::{Columns, Space};
use crate::layers::parts::pass::{self, COLOR, Holds, OBJECT, PASSES, Pass, Which};
use crate::layers::ready::Still;
use crate::layers::technique::Technique;
use crate::scene::Scene;

/// A pass of a scene, or of one of its layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The pass.
    pub pass: &'static Pass,
    /// What it is of, by its name, for passes of things that have names; `None` for the first.
    pub of: Option<Arc<str>>,
    /// The only layer, by its index; `None` for all of them.
    pub layer: Option<usize>,
}

/// Every pass: those of all layers in space, and those that techniques add.
pub fn all() -> impl Iterator<Item = &'static Pass> {
    PASSES.into_iter().chain(KINDS.iter().flat_map(|kind| kind.passes.iter().copied().flatten()))
}

/// The names of the passes, besides the frame, in which a scene has something.
#[cfg(feature = "window")]
pub fn shown(scene: &Scene) -> Vec<&'static str> {
    all().filter(|pass| **pass != COLOR && is_shown(pass, None, scene)).map(|pass| pass.name).collect()
}

/// The pass of these that is so many places after one, as [`Asked::parse`] reads it, or after the frame: one after the other,
/// then the frame.
#[cfg(feature = "window")]
pub fn step(passes: &[&'static str], now: Option<&str>, by: isize) -> &'static str {
    let name = now.and_then(|now| now.split(':').next());
    let at = passes.iter().position(|pass| Some(*pass) == name).map_or(0, |at| at + 1);
    let to = (at as isize + by).rem_euclid(passes.len() as isize + 1);
    (to as usize).checked_sub(1).map_or(COLOR.name, |to| passes[to])
}

/// The table of passes, one per line.
pub fn table() -> String {
    let widest = all().map(|pass| pass.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for pass in all() {
        let _ = writeln!(text, "  {:widest$}  {}", pass.name, pass.help); // text takes everything
    }
    text.trim_end().to_owned()
}

impl Asked {
    /// The finished frame.
    pub const FRAME: Asked = Asked { pass: &COLOR, of: None, layer: None };

    /// The pass that `NAME` asks for, or `NAME:LAYER`, or `NAME:OF` or `NAME:OF:LAYER` of something that has a name.
    ///
    /// # Errors
    /// There is no such pass or layer; in words.
    pub fn parse(text: &str, scene: &Scene) -> Result<Asked, String> {
        let (name, rest) = text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)));
        let pass = all().find(|pass| pass.name == name);
        // A slip of a finger means any of them; else those are told that have something here.
        let shown = || all().filter(|pass| is_shown(pass, None, scene)).map(|pass| pass.name);
        let meant = like(name, all().map(|pass| pass.name)).map(|name| format!("did you mean {}?", quoted(name)));
        let known = || meant.unwrap_or_else(|| there_are(shown()));
        let pass = pass.ok_or_else(|| format!("there is no pass {} ({})", quoted(name), known()))?;
        let known: BTreeSet<&str> = scene.layers.iter().flat_map(|layer| layer.technique().pass_names(pass)).collect();
        let of = rest.map(|rest| rest.split_once(':').map_or((rest, None), |(of, layer)| (of, Some(layer))));
        let (of, layer) = match of.filter(|(of, _)| known.contains(of)) {
            Some((of, layer)) => (Some(of.into()), layer),
            None => (None, rest),
        };
        let index = |layer: &str| {
            let hint = nearest(layer, known.iter().copied()).unwrap_or_default();
            let also = |told| format!("there is no {name} {} ({hint}), and {told}", quoted(layer));
            let none =
                |told| if is_shown(pass, None, scene) { told } else { format!("{told}, and no layer has {name}") };
            scene.layer_called(layer).map_err(|told| if known.is_empty() { none(told) } else { also(told) })
        };
        Ok(Asked { pass, of, layer: layer.map(index).transpose()? })
    }

    /// The only layer that is shown, by its index, where a pass that [`Asked::parse`] reads is of one.
    pub fn only_shown(pass: Option<&str>, scene: &Scene) -> Option<usize> {
        Asked::parse(pass?, scene).ok()?.layer
    }

    /// That the pass is empty, if no layer has something in it.
    pub fn emptiness(&self, scene: &Scene) -> Option<String> {
        if is_shown(self.pass, self.layer, scene) {
            return None;
        }
        let layer = self.layer.and_then(|layer| scene.layers.get(layer)).map(|layer| layer.technique());
        let why = match layer.filter(|layer| layer.kind().space != Space::World) {
            Some(flat) => format!("{} is not a layer in space", flat.name()),
            None => format!("no layer has {}", self.words(scene)),
        };
        Some(format!("{why}: the picture is empty"))
    }

    /// What its colors mean where it is looked at, by names.
    #[cfg(feature = "window")]
    pub fn colors(&self, scene: &Scene) -> Vec<(String, [u8; 3])> {
        let layers = scene.layers.iter().enumerate().filter(|(i, _)| self.layer.is_none_or(|only| only == *i));
        let colors = layers.flat_map(|(_, layer)| layer.technique().pass_colors(self.pass));
        colors.map(|(name, color)| (name.to_owned(), color)).collect()
    }

    /// What is looked at in place of it, if it is not that itself.
    pub fn looked_at(&self) -> Asked {
        let pass = if let Holds::Codes(other) = self.pass.holds { other } else { self.pass };
        Asked { pass, ..self.clone() }
    }

    /// The finished frame in place of it, of the same layer.
    pub fn in_color(&self) -> Asked {
        Asked { pass: &COLOR, of: None, ..self.clone() }
    }

    fn which(&self) -> Which<'_> {
        Which { pass: self.pass, of: self.of.as_deref() }
    }

    /// What it is, as [`Asked::parse`] reads it.
    pub fn words(&self, scene: &Scene) -> String {
        let layer = self.layer.and_then(|layer| scene.layers.get(layer)).map(|layer| layer.technique().name());
        let parts = [Some(self.pass.name), self.of.as_deref(), layer];
        parts.into_iter().flatten().collect::<Vec<_>>().join(":")
    }

    /// The synthesis that is to be shown for it.
    pub fn only(&self, synth: &Synth) -> Synth {
        match self.layer {
            Some(layer) => synth.only(layer),
            None => synth.clone(),
        }
    }

    /// The whole pass at a scene time.
    pub fn picture(&self, synth: &Synth, time: f64) -> Linear {
        if *self.pass == COLOR {
            return cpu::linear(&self.only(synth), time);
        }
        lines(self.which(), &self.only(synth), time, Columns::All, &(0..synth.size.1).collect::<Vec<_>>())
    }

    /// The pixels of these columns and rows (ascending, within the frame); no others are computed.
    pub fn lattice(&self, synth: &Synth, time: f64, columns: &[usize], rows: &[usize]) -> Linear {
        if *self.pass == COLOR {
            return cpu::lattice(&self.only(synth), time, columns, rows);
        }
        lines(self.which(), &self.only(synth), time, Columns::Some(columns), rows)
    }
}

/// Whether a layer, or the one with this index, has something in a pass.
fn is_shown(pass: &Pass, layer: Option<usize>, scene: &Scene) -> bool {
    let textures = scene.textures();
    let mut layers = scene.layers.iter().enumerate().filter(|(i, _)| layer.is_none_or(|only| only == *i));
    let common = PASSES.contains(&pass);
    let has = |layer: &dyn Technique| match common {
        true => layer.kind().space == Space::World && layer.has_pass(pass),
        false => layer.kind().passes.iter().any(|passes| passes.contains(pass)) && layer.has_pass(pass),
    };
    *pass == COLOR || layers.any(|(i, layer)| has(layer.technique()) && !textures.contains(&i))
}

/// These rows of a pass, other than color: of the topmost group that covers a pixel, its nearest surface.
fn lines(which: Which, synth: &Synth, time: f64, columns: Columns, rows: &[usize]) -> Linear {
    let pass = which.pass;
    let width = match columns {
        Columns::All => synth.size.0,
        Columns::Some(columns) => columns.len(),
    };
    let moment = synth.moment(time);
    let stills: Vec<Box<dyn Still + '_>> = synth.layers.iter().map(|layer| layer.at(&moment)).collect();
    // What is drawn on surfaces, for passes that not all layers in space have.
    let own = PASSES.iter().all(|common| *common != pass);
    let drawn = own.then(|| made::LastMade::pass(synth, time, which));
    let mut picture = Linear::filled(width, rows.len(), [0.0; 4]);
    let lines = picture.cells_mut().par_chunks_mut(width.max(1)).zip(rows.par_iter());
    lines.for_each(|(out, &y)| {
        for (i, group) in synth.stage.groups.iter().enumerate() {
            let Group::World(layers) = group else { continue };
            let mut depth = vec![f64::INFINITY; width];
            let mut own = vec![[0.0; 4]; width];
            // Sprites come after surfaces, as in the frame.
            let is_sprites = |layer: &&usize| synth.layers[**layer].has_sprites();
            let (sprites, surfaces): (Vec<&usize>, Vec<&usize>) = layers.iter().partition(is_sprites);
            for &layer in surfaces.into_iter().chain(sprites) {
                let before = depth.clone();
                stills[layer].pass(pass, y, columns, &mut depth, &mut own);
                if *pass == OBJECT {
                    let number = (layer + 1) as f32;
                    let nearer = own.iter_mut().zip(before).zip(&depth).filter(|((_, before), now)| *now < before);
                    nearer.for_each(|((cell, _), _)| *cell = [number, number, number, 1.0]);
                }
            }
            if let Some(Some(drawn)) = drawn.as_ref().and_then(|drawn| drawn.groups.get(i)) {
                let at = |cell: usize| drawn[y * synth.size.0 + columns.at(cell)];
                let drawn = own.iter_mut().enumerate().map(|(cell, own)| (own, at(cell)));
                drawn.filter(|(_, drawn)| drawn[3] > 0.0).for_each(|(own, drawn)| *own = drawn);
            }
            let covered = out.iter_mut().zip(own).zip(depth);
            let covered = covered.filter(|((_, own), depth)| depth.is_finite() || own[3] > 0.0);
            covered.for_each(|((cell, own), _)| *cell = own);
        }
    });
    picture
}

/// The layer in space that a pixel shows, by its index, if it shows one.
pub fn topmost(synth: &Synth, time: f64, (x, y): (usize, usize)) -> Option<usize> {
    let within = x < synth.size.0 && y < synth.size.1 && synth.stage.camera.is_some();
    let number = within.then(|| {
        lines(Which { pass: &OBJECT, of: None }, synth, time, Columns::Some(&[x]), &[y]).get(0, 0)[0] as usize
    })?;
    number.checked_sub(1)
}

/// The same as [`Asked::picture`], thinned out to at most so many pixels; and how many pixels of the frame each of them is
/// wide. For pictures that are made again at every step of the camera.
#[cfg(feature = "window")]
pub fn thinned(asked: &Asked, synth: &Synth, time: f64, most: usize) -> (Linear, usize) {
    let (width, height) = synth.size;
    let each = ((width * height) as f64 / most as f64).sqrt().ceil().max(1.0) as usize;
    if each == 1 {
        return (asked.picture(synth, time), 1);
    }
    let [columns, rows] = [width, height].map(|side| (each / 2..side).step_by(each).collect::<Vec<_>>());
    (asked.lattice(synth, time, &columns, &rows), each)
}

/// The numbers of a pass as colors to look at.
pub fn view(pass: &Pass, picture: &Linear) -> Frame {
    let shown = if pass.holds == Holds::Speed { 2 } else { 0 };
    let covered = picture.cells().iter().filter(|cell| cell[3] != 0.0).map(|cell| cell[shown]);
    let range = covered.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    let cells = picture.cells().par_iter().map(|cell| color(pass, *cell, range)).collect();
    Grid::from_cells(picture.width(), picture.height(), cells)
}

/// How bright a frame is that lies under a pass.
const DIMMED: f32 = 0.25;

/// The same as [`view`], over the dimmed frame where that tells what is where: thin lines alone do not.
pub fn view_over(asked: &Asked, picture: &Linear, frame: impl FnOnce() -> Linear) -> Frame {
    let shown = view(asked.pass, picture);
    if asked.pass.holds != Holds::Speed {
        return shown;
    }
    let dimmed = |[r, g, b, a]: Rgba| encode([r * DIMMED, g * DIMMED, b * DIMMED, a]);
    let under = frame();
    let cells = shown.cells().iter().zip(under.cells());
    let cells = cells.map(|(code, light)| if code[3] == 0 { dimmed(*light) } else { *code }).collect();
    Grid::from_cells(shown.width(), shown.height(), cells)
}

/// The color of a number that lies in a range over the whole picture.
fn color(pass: &Pass, cell: Rgba, [low, high]: [f32; 2]) -> [u8; 4] {
    let [x, y, z, covered] = cell;
    let code = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
    match pass.holds {
        Holds::Light => encode(cell),
        Holds::Count if covered == 0.0 => [0, 0, 0, 255],
        _ if covered == 0.0 => [0; 4],
        Holds::Vector if *pass == pass::UV => [code(x.rem_euclid(1.0)), code(y.rem_euclid(1.0)), 0, 255],
        Holds::Vector => [code(x * 0.5 + 0.5), code(y * 0.5 + 0.5), code(z * 0.5 + 0.5), 255],
        Holds::Number if *pass == OBJECT => {
            let [r, g, b] = hue(x as u32);
            [r, g, b, 255]
        }
        // One is already brighter than none, and the most are white.
        Holds::Count => {
            let many = code(0.15 + 0.85 * x / high.max(1.0));
            [many, many, many, 255]
        }
        Holds::Speed => {
            let [r, g, b] = heat(if high > low { (z - low) / (high - low) } else { 0.5 });
            [code(r), code(g), code(b), 255]
        }
        Holds::Share | Holds::Codes(_) => {
            let share = code(x);
            [share, share, share, 255]
        }
        // Three standard deviations to either side.
        Holds::Noise => {
            let gray = code(0.5 + x / 6.0);
            [gray, gray, gray, 255]
        }
        // The nearest is white and the farthest is not yet black, whatever the scale of the scene.
        Holds::Number => {
            let far = if high > low { (x - low) / (high - low) } else { 0.0 };
            let near = code(1.0 - 0.9 * far);
            [near, near, near, 255]
        }
    }
}

/// From blue through green to red: for shares from 0 to 1.
fn heat(share: f32) -> [f32; 3] {
    const COLORS: [[f32; 3]; 3] = [[0.15, 0.3, 1.0], [0.2, 0.85, 0.35], [1.0, 0.25, 0.15]];
    let at = share.clamp(0.0, 1.0) * 2.0;
    let (below, above) = if at < 1.0 { (COLORS[0], COLORS[1]) } else { (COLORS[1], COLORS[2]) };
    let part = at - if at < 1.0 { 0.0 } else { 1.0 };
    std::array::from_fn(|c| below[c] + (above[c] - below[c]) * part)
}

/// A color that tells a number from its neighbors.
fn hue(number: u32) -> [u8; 3] {
    let mixed = number.wrapping_mul(0x9E37_79B1).rotate_left(15).wrapping_mul(0x85EB_CA77);
    let [_, r, g, b] = mixed.to_be_bytes();
    [r | 0x40, g | 0x40, b | 0x40]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(feature = "window")]
    #[test]
    fn passes_in_which_nothing_is_are_not_offered() {
        for (layer, passes) in [
            (r#"{ "kind": "mesh", "name": "a", "mesh": "m" }"#, &["depth", "normal", "uv", "object", "shade"][..]),
            (r#"{ "kind": "waterfall", "name": "a", "clip": "c" }"#, &["lines", "sprites"]),
            (r##"{ "kind": "fill", "name": "a", "color": "#102030" }"##, &[]),
        ] {
            let scene: Scene = serde_json::from_str(&format!(r#"{{ "plica": 1, "layers": [{layer}] }}"#)).unwrap();
            assert_eq!(shown(&scene), passes, "{layer}");
            let depth = Asked::parse("depth", &scene).unwrap();
            assert_eq!(depth.emptiness(&scene).is_none(), passes.contains(&"depth"), "{layer}");
            let is_flat = layer.contains("fill");
            let told = Asked::parse("uv:a", &scene).unwrap().emptiness(&scene);
            assert_eq!(told.is_some_and(|told| told.starts_with("a is not a layer in space:")), is_flat, "{layer}");
        }
    }

    #[test]
    fn depth_to_look_at_uses_all_grays_between_the_nearest_and_the_farthest() {
        let cells = [0.0, 5.0, 5.1, 5.2].map(|v: f32| [v, v, v, if v > 0.0 { 1.0 } else { 0.0 }]);
        let shown = view(&pass::DEPTH, &Linear::from_cells(4, 1, cells.to_vec()));
        let codes: Vec<[u8; 2]> = shown.cells().iter().map(|[r, _, _, a]| [*r, *a]).collect();
        assert_eq!(codes, [[0, 0], [255, 255], [140, 255], [26, 255]]);
    }

    fn seen(holds: Holds, cells: &[Rgba]) -> Vec<[u8; 4]> {
        let pass = Pass { name: "test", help: "", holds };
        view(&pass, &Linear::from_cells(cells.len(), 1, cells.to_vec())).cells().to_vec()
    }

    #[test]
    fn counts_to_look_at_are_brighter_the_more_there_are() {
        let shown = seen(Holds::Count, &[0.0, 1.0, 20.0, 40.0].map(|v: f32| [v, v, v, v.min(1.0)]));
        assert_eq!(
            shown.iter().map(|[r, .., a]| [*r, *a]).collect::<Vec<_>>(),
            [[0, 255], [44, 255], [147, 255], [255, 255]]
        );
    }

    #[test]
    fn speeds_to_look_at_go_from_blue_through_green_to_red_whatever_they_are() {
        for unit in [0.01, 1.0, 300.0] {
            let shown = seen(Holds::Speed, &[1.0, 2.0, 3.0].map(|v| [7.0, 0.4, v * unit, 1.0]));
            let most = |[r, g, b, _]: [u8; 4]| [r, g, b].iter().enumerate().max_by_key(|(_, v)| **v).unwrap().0;
            assert_eq!(shown.iter().map(|code| most(*code)).collect::<Vec<_>>(), [2, 1, 0], "{unit}: {shown:?}");
        }
        assert_eq!(seen(Holds::Speed, &[[0.0; 4]]), [[0; 4]], "no line, no color");
    }

    #[test]
    fn lines_lie_over_the_dimmed_frame_and_other_passes_alone() {
        let asked =
            |holds| Asked { pass: Box::leak(Box::new(Pass { name: "test", help: "", holds })), of: None, layer: None };
        let picture = Linear::from_cells(2, 1, vec![[0.0; 4], [1.0; 4]]);
        let frame = || Linear::filled(2, 1, [1.0, 0.0, 0.0, 1.0]);
        let shown = view_over(&asked(Holds::Speed), &picture, frame);
        assert_eq!(shown.cells()[0], [137, 0, 0, 255]);
        assert_ne!(shown.cells()[1][1], 0, "a line hides it");
        assert_eq!(view_over(&asked(Holds::Count), &picture, frame).cells()[0], [0, 0, 0, 255]);
    }
}
