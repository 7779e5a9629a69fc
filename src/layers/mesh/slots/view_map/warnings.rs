//! What is odd about a map that only shows once it is filled. Paths are relative to the surface.

use std::f64::consts::PI;

use glam::DVec3;

use super::atlas::{self, Atlas};
use super::cells::{Cells, Layer};
use super::map::Map;
use super::model::{Extremes, View, ViewMap};
use super::report::{self, OfView};
use crate::base::maths::{acos, atan2};
use crate::base::mesh::Mesh;
use crate::base::problem::Problem;
use crate::layers::parts::shots::Feeds;

/// The share of a view that may be finer than the finest layer.
const MOST_BEYOND: f64 = 0.25;
/// The most levels that there can be.
const MOST_LEVELS: f64 = 9.0;

/// The share of the finest cells on which a chart may cover itself.
const MOST_COVERED: f64 = 0.01;
/// How many times larger the cells of the 95th percentile may be on the surface than those of the 5th.
const MOST_STRETCHED: f64 = 8.0;

/// Less than so many degrees past the middle of a mesh a camera is meant for it.
const NEARLY: f64 = 20.0;

/// The share of all directions in which there is the inside of a mesh for a point that is in it.
const MOST_ROUND: f64 = 0.75;

/// Everything odd.
pub fn warnings(own: &ViewMap, map: &Map) -> Vec<Problem> {
    let depends = |view: &&View| view.active && view.kind != Feeds::Independent;
    let alone = own.views.iter().filter(depends).count() == 1;
    let all = report::views(map).into_iter().filter_map(|found| {
        let (number, view) = (found.view.number, own.views.get(found.view.number)?);
        let problem = of_view(&found, map).or_else(|| of_lone(view).filter(|_| alone && depends(&view)))?;
        Some(problem.under(&format!("/views/{number}")))
    });
    let finest = map.cells.layers.last();
    all.chain(finest.and_then(|finest| of_atlas(&map.wanted.mesh, &map.atlas, finest))).collect()
}

/// What is odd about how the mesh is laid flat, where this is the finest layer of cells.
pub fn of_atlas(mesh: &Mesh, atlas: &Atlas, finest: &Layer) -> Option<Problem> {
    let middles = finest.middles(atlas);
    let twice = middles.iter().filter(|(count, _)| *count > 1).count() as f64 / middles.len().max(1) as f64;
    if twice > MOST_COVERED {
        let message = format!("on {:.0} % of its cells two places of the surface share their colors", 100.0 * twice);
        return Some(Problem::warning("", message).hint("set atlas to \"box\""));
    }
    let area = |(_, triangle): &(u32, u32)| {
        let triangle = *triangle as usize;
        atlas::normal(mesh, triangle).length() / 2.0 / atlas.areas[triangle]
    };
    let mut areas: Vec<f64> = middles.iter().filter(|(count, _)| *count > 0).map(area).collect();
    areas.sort_by(f64::total_cmp);
    let at = |share: f64| areas.get((share * areas.len().saturating_sub(1) as f64) as usize).copied();
    let stretched = at(0.95)? / at(0.05)?;
    (stretched > MOST_STRETCHED).then(|| {
        let message = format!("its cells are of very different sizes on the surface ({stretched:.0} to 1)");
        Problem::warning("", message).hint("set atlas to \"box\"")
    })
}

/// Whether a point is in a closed mesh: the solid angle that it fills from there (Van Oosterom and Strackee 1983).
fn is_inside(mesh: &Mesh, point: DVec3) -> bool {
    let angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| (mesh.vertices[corner as usize].position - point).normalize_or_zero());
        2.0 * atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    mesh.triangles.iter().map(angle).sum::<f64>() > MOST_ROUND * 4.0 * PI
}

fn of_view(found: &OfView, map: &Map) -> Option<Problem> {
    if is_inside(&map.wanted.mesh, found.view.camera.position) {
        let problem = Problem::warning("/camera", "it is in the mesh");
        return Some(problem.hint("move it out; it is in the model's coordinates, before the pose"));
    }
    let Some(depth) = found.depth else {
        let middle = map.wanted.mesh.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) / 2.0);
        let camera = &found.view.camera;
        let past = |turned: fn(DVec3) -> DVec3| {
            let toward = (middle - turned(camera.position)).normalize_or_zero();
            acos((-turned(camera.axes()[2]).dot(toward)).clamp(-1.0, 1.0)).to_degrees()
        };
        let (looks, upright) = (past(|at| at), past(|at| DVec3::new(at.x, at.z, -at.y)));
        let problem = Problem::warning("", format!("sees nothing of the mesh (it looks {looks:.0} degrees past it)"));
        return Some(problem.hint(match upright < NEARLY && looks > NEARLY {
            true => "its world has z up, as it seems: plica views import --axes z-up turns cameras",
            false => "the camera is in the model's coordinates, y up",
        }));
    };
    if found.cells.iter().flatten().all(|cells| *cells == 0) {
        let problem = Problem::warning("", "nothing of its picture counts");
        return Some(problem.hint("look at its mask, at changed and at the alpha of the picture"));
    }
    let finest = map.cells.layers.len().saturating_sub(1);
    (found.beyond > MOST_BEYOND).then(|| {
        let holds = ((depth + 1.0).ceil() + 1.0).max(finest as f64 + 2.0).min(MOST_LEVELS);
        let finer = format!("{:.0} % of it is finer than layer {finest}", 100.0 * found.beyond);
        match Cells::fitting(&map.atlas, map.wanted.first, holds as usize) {
            most if most > finest + 1 => {
                let message = format!("{finer}; levels {most} would hold it");
                Problem::warning("", message).hint(format!("set levels to {most}"))
            }
            _ => Problem::warning("", format!("{finer}, and no more fit")).hint("a smaller picture looks the same"),
        }
    })
}

fn of_lone(view: &View) -> Option<Problem> {
    let Extremes::Auto { reach } = &view.extremes else { return None };
    let message = format!("its extremes are automatic, and there is no other view: it is gone at {reach} degrees");
    Some(Problem::warning("/extremes", message).hint("make them a cone"))
}
