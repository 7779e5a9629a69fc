//! A view map in the document, as a kind of surface.

use std::sync::Arc;

use super::arrays::{Arrays, ELEMENT_BYTES};
use super::blend::Points;
use super::cells::{Cells, Layer, MOST_CELLS};
use super::id::depth_of;
use super::map::{KEPT_BYTES, Map, UNSEEN, Wanted, automatic};
use super::model::{Atlas, ViewMap};
use super::ready::Ready;
use super::report;
use super::view::View;
use super::wanted::{laid_flat, misfits, wanted};
use super::{atlas, bundle, check, lay, marks, passes, plan, warnings};
use crate::base::budget::Share;
use crate::base::last::Last;
use crate::base::mesh::Mesh;
use crate::base::pixels::encode;
use crate::base::pointer::Pointer;
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::layers::mesh::added::Added;
use crate::layers::mesh::surface::{Before, ReadySurface, SurfaceSlot};
use crate::layers::parts::bundle::Form;
use crate::layers::parts::materials::{List, Materials, Of, Use, What};
use crate::layers::parts::pass::Pass;
use crate::layers::parts::shots::Lying;
use crate::layers::ready::Making;

/// The memory of a pixel of a picture while a view looks, in bytes: four pixels of the image of triangles.
const LOOKED_BYTES: u64 = 4 * 24;

/// What is known of them without a layer.
pub const ADDED: Added = Added {
    programs: &[&plan::SAMPLED],
    twins: plan::TWINS,
    overlays: &[marks::OVERLAY],
    looks: &[&marks::CAMERA, &marks::WHOLE, &marks::GONE, &marks::BLEND],
    passes: &[passes::INDEPENDENT, passes::DEPENDENT, passes::COVERAGE],
    colors: &[passes::COLORS],
    ..Added::NONE
};

impl SurfaceSlot for ViewMap {
    fn check(&self) -> Vec<Problem> {
        let mut problems = check::problems(self);
        problems.extend(self.levels.and_then(|levels| too_many(self.cells, levels)));
        problems
    }

    fn check_materials(&self, materials: &Materials) -> Vec<Problem> {
        misfits(self, materials)
    }

    fn check_lying(&self, mesh: &Mesh) -> Vec<Problem> {
        let atlas = atlas::Atlas::new(mesh, laid_flat(self, mesh));
        let levels = self.levels.map_or(UNSEEN, |levels| levels as usize);
        let cells = Cells::new(&atlas, self.cells, levels);
        let finest = cells.layers.last();
        finest.and_then(|finest| warnings::of_atlas(mesh, &atlas, finest)).into_iter().collect()
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let named = self.views.iter().enumerate().flat_map(|(i, view)| {
            let all = [("image", Some(&view.image)), ("mask", view.mask.as_ref()), ("changed", view.changed.as_ref())];
            all.into_iter().filter_map(move |(field, name)| Some((format!("/views/{i}/{field}"), name?)))
        });
        named.map(|(at, name)| Use { at, of: Of::Name(List::Images, name), what: What::Picture }).collect()
    }

    fn pass_colors(&self, pass: &Pass) -> Vec<(&str, [u8; 3])> {
        let views = self.views.iter().enumerate().filter(|(_, view)| view.active && *pass == passes::COVERAGE);
        let code = |number: usize| {
            let [r, g, b] = passes::color(number).map(|light| light as f32);
            let [r, g, b, _] = encode([r, g, b, 1.0]);
            [r, g, b]
        };
        views.map(|(i, view)| (view.name.as_str(), code(i + 1))).collect()
    }

    fn lying(&self) -> Option<Vec<Lying<'_>>> {
        Some(lay::lying(self))
    }

    fn item_name(&self, path: &str) -> Option<&str> {
        self.views.get(Pointer(path).item("/views")?).map(|view| view.name.as_str())
    }

    fn needs_uv(&self) -> bool {
        self.atlas == Some(Atlas::Uv)
    }

    fn files(&self) -> Vec<(Form, String)> {
        bundle::ends()
    }

    fn explains(&self) -> bool {
        true
    }

    fn synth(&self, mesh: &Arc<Mesh>, making: &Making, before: Before) -> Result<Arc<dyn ReadySurface>, Problem> {
        let materials = making.materials;
        let wanted = wanted(self, mesh, materials)?;
        let points = Points::new(&self.blend, mesh);
        let before = before.and_then(|before| before.downcast::<Ready>());
        let side = self.directions.map(|side| side as usize);
        if let Some(ready) = before.filter(|before| before.is_of(&wanted, side)) {
            return Ok(Arc::new(Ready { points, seen: Last::default(), ..ready.clone() }));
        }
        // An incomplete map is no start for a complete one.
        let before = before.filter(|before| before.lacks.is_none()).map(|before| &*before.map);
        let filled = filled((wanted, side), before, materials)?;
        Ok(Arc::new(Ready { points, side, ..filled }))
    }

    fn check_made(&self, made: &dyn ReadySurface) -> Vec<Problem> {
        made.downcast::<Ready>().map_or_else(Vec::new, |made| warnings::warnings(self, &made.map))
    }
}

/// A map filled, and its arrays of so many directions a side; without what there is no memory for, if that may be left out.
fn filled(
    (wanted, side): (Wanted, Option<usize>),
    before: Option<&Map>,
    materials: &Materials,
) -> Result<Ready, Problem> {
    let pixels: Vec<u64> = wanted.views.iter().map(pixels).collect();
    // They look first if the levels follow from that.
    let rounds = if wanted.levels.is_none() { 2 } else { 1 };
    materials.expect(rounds * pixels.iter().sum::<u64>());
    // Each thread looks with one view at a time.
    let looked = pixels.iter().max().copied().unwrap_or(0) * LOOKED_BYTES * rayon::current_num_threads() as u64;
    let (stopped, stop) = (|| materials.stopped(), || Problem::error("", "stopped"));
    let watch = Watch { stopped: &stopped, done: &|view| materials.made(pixels[view]) };
    let looking = match materials.budget.try_take(looked) {
        Ok(looking) => looking,
        Err(short) => {
            // What they tell is not known before they look: the cure is to be enough for that too.
            let problem =
                short.then(most_bytes(&wanted, side)).problem_of("", "make the pictures of its views smaller");
            let nothing = Wanted { views: Vec::new(), ..wanted };
            let map = || Map::new(nothing, None, 0, &watch).ok_or_else(stop);
            return left_out(problem, "nothing of its views is shown", materials, map);
        }
    };
    let room = usize::try_from(materials.budget.left()).map_or(KEPT_BYTES, |left| left.min(KEPT_BYTES));
    let mut map = Map::new(wanted, before, room, &watch).ok_or_else(stop)?;
    drop(looking);
    let bytes = bytes(&map, map.cells.layers.len(), side);
    let kept = materials.budget.try_take(bytes + map.seen_bytes()).or_else(|_| {
        map.forget_seen();
        materials.budget.try_take(bytes)
    });
    let kept = match kept {
        Ok(kept) => kept,
        Err(short) => {
            let problem = short.problem_of("", &smaller(&map, side, short.left()));
            return left_out(problem, "only its base coat is shown", materials, || Ok(map.coat_alone()));
        }
    };
    let arrays = side.map(|side| Arrays::new(&map, side, &stopped).ok_or_else(stop)).transpose()?;
    Ok(ready(map, arrays, kept, None))
}

/// A map without what there is no memory for.
///
/// # Errors
/// That problem, if nothing may be left out.
fn left_out(
    problem: Problem,
    shown: &str,
    materials: &Materials,
    map: impl FnOnce() -> Result<Map, Problem>,
) -> Result<Ready, Problem> {
    if !materials.leaves_out {
        return Err(problem);
    }
    let message = format!("{}: {shown}", problem.message);
    Ok(ready(map()?, None, Share::default(), Some(Problem { message, ..problem })))
}

fn ready(map: Map, arrays: Option<Arrays>, kept: Share, lacks: Option<Problem>) -> Ready {
    Ready {
        map: Arc::new(map),
        arrays: arrays.map(Arc::new),
        points: Points::default(),
        kept: Arc::new(kept),
        side: None,
        lacks,
        seen: Last::default(),
    }
}

/// The memory of the first layers of a map, and of their arrays of so many directions a side.
fn bytes(map: &Map, levels: usize, side: Option<usize>) -> u64 {
    let entries: usize = map.lists.iter().take(levels).map(|lists| lists.entries.len()).sum();
    let cells: usize = map.cells.layers.iter().take(levels).map(Layer::len).sum();
    entries as u64 * report::ENTRY_BYTES + side.map_or(0, |side| (cells * side * side) as u64 * ELEMENT_BYTES)
}

/// The most memory that a map may take, before it is known what its views see: if each tells each cell something.
fn most_bytes(wanted: &Wanted, side: Option<usize>) -> u64 {
    let atlas = atlas::Atlas::new(&wanted.mesh, wanted.by);
    let levels = wanted.levels.unwrap_or_else(|| Cells::fitting(&atlas, wanted.first, likely_levels(wanted)));
    let cells: f64 = (1..=levels).map(|levels| Cells::most(&atlas, wanted.first, levels)).sum();
    let of_cell =
        wanted.views.len() as u64 * report::ENTRY_BYTES + side.map_or(0, |side| (side * side) as u64 * ELEMENT_BYTES);
    (cells as u64).saturating_mul(of_cell)
}

/// How many layers there would be if each view saw the mesh straight from the front, and as near as its nearest vertex.
fn likely_levels(wanted: &Wanted) -> usize {
    let mesh = &wanted.mesh;
    let area: f64 = (0..mesh.triangles.len()).map(|triangle| atlas::normal(mesh, triangle).length() / 2.0).sum();
    let cells = 0.5 / area * f64::from(wanted.first * wanted.first);
    let depth = |view: &View| {
        let far = mesh.vertices.iter().map(|vertex| view.camera.position.distance(vertex.position));
        let nearest = far.min_by(f64::total_cmp)?;
        Some(depth_of(cells * nearest * nearest / view.camera.focal_px.element_product()))
    };
    automatic(&wanted.views.iter().map(depth).collect::<Vec<_>>())
}

/// How a map that needs more than is left gets along with that: with fewer layers, or without arrays.
fn smaller(map: &Map, side: Option<usize>, left: u64) -> String {
    let levels = map.cells.layers.len();
    let fewer = (1..levels).rev().find(|levels| bytes(map, *levels, side) <= left);
    let exact = side.filter(|_| bytes(map, levels, None) <= left).map(|_| "no \"directions\"".to_owned());
    let all: Vec<String> = fewer.map(|fewer| format!("\"levels\": {fewer}")).into_iter().chain(exact).collect();
    if all.is_empty() { "make \"cells\" smaller".into() } else { format!("{} would fit", all.join(" or ")) }
}

fn pixels(view: &View) -> u64 {
    (view.camera.size_px.0 * view.camera.size_px.1) as u64
}

/// What is wrong with so many layers, if they have too many cells: the surface covers half of a unit of the atlas.
fn too_many(cells: u32, levels: u32) -> Option<Problem> {
    let count = |levels: u32| f64::from(cells) * f64::from(cells) * f64::from(1_u32 << (2 * (levels - 1))) / 2.0;
    (count(levels) > MOST_CELLS).then(|| {
        let fit = (1..levels).rev().find(|levels| count(*levels) <= MOST_CELLS).unwrap_or(1);
        let message = format!("{levels} levels are {:.0} million cells; {fit} fit", count(levels) / 1e6);
        Problem::error("/levels", message).hint(format!("make it {fit}"))
    })
}
