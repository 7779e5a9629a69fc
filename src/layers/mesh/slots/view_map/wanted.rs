//! What a document asks of a view map, with the pictures that it names.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use super::atlas::By;
use super::camera::{Camera, nearest_turn};
use super::entries::Reach;
use super::map::Wanted;
use super::model::{self, Atlas, ViewCamera, ViewMap};
use super::paint::{Paint, differs};
use super::view::{Extremes, Fade, View, nearest_on_axis};
use crate::base::color;
use crate::base::maths::tan;
use crate::base::mesh::Mesh;
use crate::base::picture::Picture;
use crate::base::pixels::decode;
use crate::base::problem::{Problem, quoted};
use crate::layers::parts::materials::Materials;
use crate::layers::parts::shots::Feeds;
use crate::layers::parts::shots::misshapen;
use crate::layers::space::eye::Eye;

/// The field of view of a camera that has none, in degrees.
const FOV: f64 = 40.0;
/// So many pixels along each side are compared with a guide.
const LOOKED_AT: usize = 64;
/// A picture that differs from its guide in more than this share has probably been saved in the place of another.
const MOST_PAINTED: f64 = 0.9;

/// What is to be filled.
///
/// # Errors
/// If a picture is not there or does not fit; the problem's path is relative to the surface.
pub fn wanted(map: &ViewMap, mesh: &Arc<Mesh>, materials: &Materials) -> Result<Wanted, Problem> {
    let views = map.views.iter().enumerate().filter(|(_, view)| view.active);
    let views = views.map(|(number, own)| {
        view(own, number, mesh, materials).map_err(|problem| problem.under(&format!("/views/{number}")))
    });
    let [r, g, b, _] = color::parse(&map.missing).map_or([0.0; 4], decode);
    Ok(Wanted {
        mesh: mesh.clone(),
        by: laid_flat(map, mesh),
        first: map.cells,
        levels: map.levels.map(|levels| levels as usize),
        missing: [r, g, b],
        views: views.collect::<Result<_, _>>()?,
    })
}

/// What does not fit: pictures to their cameras, masks and guides to their pictures; and what is unlike its guide. Paths are relative
/// to the surface.
pub fn misfits(map: &ViewMap, materials: &Materials) -> Vec<Problem> {
    let views = map.views.iter().enumerate().filter(|(_, view)| view.active);
    let of = |(number, own)| {
        let problems = misfits_of(own, materials);
        let unlike = if problems.is_empty() { unlike(own, materials) } else { None };
        problems.into_iter().chain(unlike).map(move |problem| (number, problem))
    };
    views.flat_map(of).map(|(number, problem)| problem.under(&format!("/views/{number}"))).collect()
}

/// The same of one view; what is not there is no misfit.
fn misfits_of(own: &model::View, materials: &Materials) -> Vec<Problem> {
    let size = |name: &String| {
        let picture = materials.pictures.get(name)?;
        Some([picture.width(), picture.height()].map(|side| side as u32))
    };
    let Some(picture) = size(&own.image) else { return Vec::new() };
    let shape = own
        .camera
        .size
        .and_then(|camera| misshapen(picture, camera))
        .map(|message| Problem::error("", message).hint("give camera.size the size that focal and center are for"));
    let beside = [("/mask", &own.mask), ("/changed", &own.changed)].into_iter().filter_map(|(path, name)| {
        let ([width, height], [own_width, own_height]) = (picture, name.as_ref().and_then(size)?);
        let message = || format!("{own_width}x{own_height}, the picture is {width}x{height}");
        // A guide is what the picture was painted over: of the two, the picture was saved last.
        let cure = match path {
            "/changed" => format!("save the picture with {own_width}x{own_height} pixels, as its guide has"),
            _ => "make it as large as the picture".to_owned(),
        };
        let problem = || Problem::error(path, message()).hint(cure);
        ([width, height] != [own_width, own_height]).then(problem)
    });
    shape.into_iter().chain(beside).collect()
}

/// That a picture has nearly nothing of its guide, as when something else was saved in its place. Some of its pixels tell.
fn unlike(own: &model::View, materials: &Materials) -> Option<Problem> {
    let name = own.changed.as_ref()?;
    let (picture, guide) = (materials.pictures.get(&own.image)?, materials.pictures.get(name)?);
    let [across, down] =
        [picture.width(), picture.height()].map(|side| (0..side).step_by(side.div_ceil(LOOKED_AT).max(1)));
    let places = down.flat_map(|y| across.clone().map(move |x| (x, y)));
    let pairs = places.map(|(x, y)| (picture.texel(x, y), guide.texel(x, y)));
    let shown = pairs.filter(|(own, other)| own[3] > 0.0 || other[3] > 0.0);
    let (all, differ) =
        shown.fold((0_u32, 0_u32), |(all, differ), (own, other)| (all + 1, differ + u32::from(differs(own, other))));
    let share = f64::from(differ) / f64::from(all.max(1));
    (share > MOST_PAINTED).then(|| {
        let message = format!("about {:.0} % of it differs from its guide {}, and counts as paint", 100.0 * share, quoted(name));
        let cure = "if less is painted, another picture was saved, or in another place or size; set changed to null if all of it is meant";
        Problem::warning("/image", message).hint(cure)
    })
}

/// How the mesh is laid flat.
pub fn laid_flat(map: &ViewMap, mesh: &Mesh) -> By {
    match map.atlas {
        Some(Atlas::Uv) => By::Uv,
        None if mesh.without_uv.is_none() => By::Uv,
        Some(Atlas::Box) | None => By::Box,
    }
}

/// A view with its pictures.
///
/// # Errors
/// As [`wanted`]; the problem's path is relative to the view.
fn view(own: &model::View, number: usize, mesh: &Mesh, materials: &Materials) -> Result<View, Problem> {
    let picture = materials.picture(&own.image, "/image")?;
    let size = (picture.width(), picture.height());
    let beside = |name: &Option<String>, path: &str| -> Result<Option<Arc<Picture>>, Problem> {
        let Some(name) = name else { return Ok(None) };
        materials.picture(name, path).map(Some)
    };
    let (mask, guide) = (beside(&own.mask, "/mask")?, beside(&own.changed, "/changed")?);
    if let Some(misfit) = misfits_of(own, materials).into_iter().next() {
        return Err(misfit);
    }
    let (camera, target) = camera(&own.camera, size, mesh);
    let half = |degrees: f64| tan(degrees.to_radians() / 2.0);
    Ok(View {
        name: own.name.clone(),
        number,
        camera,
        target,
        paint: Paint { picture, mask, guide, feather_px: own.feather, gain: own.gain },
        base: own.kind != Feeds::Dependent,
        dependent: own.kind != Feeds::Independent,
        extremes: match &own.extremes {
            model::Extremes::Auto { reach } => Extremes::Auto(half(*reach)),
            model::Extremes::Cone { degrees } => Extremes::Cone(half(*degrees)),
            model::Extremes::Points { points } => {
                let points: Vec<DVec2> = points.iter().map(|point| DVec2::from(*point)).collect();
                Extremes::points(&camera, target, &points)
            }
        },
        fade: Fade { linear: own.fade == model::Fade::Linear, hold: own.hold },
        reach: Reach { closer: own.closer, farther: own.farther },
        edge_px: own.edge,
    })
}

/// The camera of a view whose picture has this size, and what it looks at.
fn camera(own: &ViewCamera, size: (usize, usize), mesh: &Mesh) -> (Camera, DVec3) {
    let (Some(matrix), Some(focal)) = (own.matrix, own.focal) else {
        let [position, target] = [own.position, own.target].map(|place| DVec3::from(place.unwrap_or_default()));
        let up = DVec3::from(own.up.unwrap_or([0.0, 1.0, 0.0]));
        let eye = Eye::new([position, target, up], own.fov.unwrap_or(FOV), size);
        return (Camera::of_eye(&eye, size), target);
    };
    let whole = own.size.map_or(size, |[width, height]| (width as usize, height as usize));
    let middle = own.center.map_or(DVec2::new(whole.0 as f64, whole.1 as f64) / 2.0, DVec2::from);
    let row = |k: usize| DVec3::new(matrix[k][0], matrix[k][1], matrix[k][2]);
    let turn = nearest_turn(DMat3::from_cols(row(0), row(1), row(2)).transpose());
    let shift = DVec3::new(matrix[0][3], matrix[1][3], matrix[2][3]);
    let camera = Camera::of_turn(turn, shift, DVec2::from(focal), middle, whole).resized(size);
    let center = mesh.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) / 2.0);
    (camera, nearest_on_axis(&camera, center))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_picture_that_has_nothing_of_its_guide_is_told() {
        let map = json!({ "views": [{ "name": "a", "image": "own", "changed": "over", "camera": { "position": [0, 0, 4] } }] });
        let map: ViewMap = serde_json::from_value(map).unwrap();
        // A pattern that is clear at its border, so far to the right, and painted over in its first rows.
        let picture = |shift: usize, painted: usize| {
            let cell = |i: usize| {
                let (x, y) = (i % 100, i / 100);
                let light = (((x + 100 - shift) * 37 + y * 11) % 64) as f32 / 64.0;
                let a = if (10..90).contains(&x) { 1.0 } else { 0.0 };
                if y < painted { [a, 0.0, 0.0, a] } else { [0.0, light * a, light * a, a] }
            };
            Arc::new(Picture::from_cells(100, 50, (0..5000).map(cell).collect()))
        };
        for (shift, painted, told) in
            [(0, 0, None), (0, 30, None), (0, 50, Some("about 100 %")), (3, 0, Some("about 100 %"))]
        {
            let pictures = [("own", picture(shift, painted)), ("over", picture(0, 0))];
            let pictures = pictures.map(|(name, picture)| (name.to_owned(), picture)).into();
            let found = misfits(&map, &Materials { pictures, ..Materials::default() });
            let found: Vec<_> = found.iter().map(ToString::to_string).collect();
            assert_eq!(found.len(), usize::from(told.is_some()), "{shift} {painted}: {found:?}");
            let start =
                told.map(|told| format!("views.0.image: warning: {told} of it differs from its guide \"over\""));
            assert!(start.is_none_or(|start| found[0].starts_with(&start)), "{found:?}");
        }
    }
}
