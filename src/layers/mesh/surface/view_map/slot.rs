//! A view map in the document, as a kind of surface.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use super::super::{Before, ReadySurface, Slot};
use super::blend::Points;
use super::check;
use super::map::{Map, Wanted, Watch};
use super::model::{Atlas, ViewMap};
use super::ready::Ready;
use super::wanted::wanted;
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::layers::parts::materials::{List, Of, Use, What};
use crate::layers::ready::Making;

/// The maps that are in use: several samples of a frame, and what looks at one pixel, share them.
static ALIVE: Mutex<Vec<Weak<Map>>> = Mutex::new(Vec::new());

/// The most cells of the finest layer.
const MOST_CELLS: f64 = 16_777_216.0;

impl Slot for ViewMap {
    fn check(&self) -> Vec<Problem> {
        let mut problems = check::problems(self);
        problems.extend(self.levels.and_then(|levels| too_many(self.cells, levels)));
        problems
    }

    fn uses(&self) -> Vec<Use<'_>> {
        let named = self.views.iter().enumerate().flat_map(|(i, view)| {
            let all = [("image", Some(&view.image)), ("mask", view.mask.as_ref()), ("changed", view.changed.as_ref())];
            all.into_iter().filter_map(move |(field, name)| Some((format!("/views/{i}/{field}"), name?)))
        });
        named.map(|(at, name)| Use { at, of: Of::Name(List::Images, name), what: What::Picture }).collect()
    }

    fn needs_uv(&self) -> bool {
        self.atlas == Some(Atlas::Uv)
    }

    fn explains(&self) -> bool {
        true
    }

    fn synth(&self, mesh: &Arc<Mesh>, making: &Making, before: Before) -> Result<Arc<dyn ReadySurface>, Problem> {
        let materials = making.materials;
        let wanted = wanted(self, mesh, materials)?;
        let points = Points::new(&self.blend, mesh);
        let before = before.and_then(|before| before.downcast::<Ready>());
        if let Some(map) = alive(&wanted) {
            return Ok(Arc::new(Ready { map, points }));
        }
        let pixels =
            |i: usize| wanted.views.get(i).map_or(0, |view| view.camera.size_px.0 * view.camera.size_px.1) as u64;
        materials.expect((0..wanted.views.len()).map(pixels).sum());
        let sizes: Vec<u64> = (0..wanted.views.len()).map(pixels).collect();
        let watch = Watch { stopped: &|| materials.stopped(), done: &|view| materials.made(sizes[view]) };
        let map = Map::new(wanted, before.map(|before| &*before.map), &watch);
        let map = Arc::new(map.ok_or_else(|| Problem::error("", "stopped"))?);
        ALIVE.lock().unwrap_or_else(PoisonError::into_inner).push(Arc::downgrade(&map));
        Ok(Arc::new(Ready { map, points }))
    }
}

/// The same map, if it is in use.
fn alive(wanted: &Wanted) -> Option<Arc<Map>> {
    let mut alive = ALIVE.lock().unwrap_or_else(PoisonError::into_inner);
    alive.retain(|map| map.strong_count() > 0);
    alive.iter().filter_map(Weak::upgrade).find(|map| map.wanted.same(wanted))
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
