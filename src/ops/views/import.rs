//! `plica views import`: pictures with the cameras that another program found or rendered them with.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use glob::Pattern;

use super::beside::Beside;
use super::{feather, table};
use crate::base::error::{Error, Result};
use crate::base::mesh::Mesh;
use crate::base::problem::{Problem, quoted};
use crate::files::cameras::{self, Cameras, Reading};
use crate::files::{self, disk, models, paths, picture};
use crate::layers::parts::materials::Materials;
use crate::layers::parts::shots::{Feeds, SeenFrom, Shot, misshapen};
use crate::ops::scene_options::{RecoveryOptions, SceneOptions};
use crate::ops::{Context, set};
use crate::scene::shots::{self, Image, Picture};
use crate::scene::{Document, Edit};

#[derive(clap::Args)]
pub struct Args {
    /// cameras.json, transforms.json (Blender, NeRF, instant-ngp), or the folder of a COLMAP text model
    file: PathBuf,
    /// The scene
    scene: PathBuf,
    /// Name of the layer [default: the first mesh with views, otherwise the first mesh]
    #[arg(long, value_name = "LAYER")]
    layer: Option<String>,
    /// The folder of the pictures [default: as the file says; for COLMAP images beside its folder]
    #[arg(long, value_name = "DIR")]
    images: Option<PathBuf>,
    /// What the views feed
    #[arg(long, value_name = "KIND", value_parser = Feeds::ALL.map(Feeds::word))]
    kind: Option<String>,
    /// Take every Nth picture only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Take pictures only whose file names are like this: 'IMG_*.jpg'
    #[arg(long, value_name = "GLOB")]
    names: Option<String>,
    /// Take pictures that are for testing too
    #[arg(long)]
    all: bool,
    /// The axis that points up where the cameras were made; z-up turns them
    #[arg(long, value_name = "AXES", default_value = "y-up", value_parser = ["y-up", "z-up"])]
    axes: String,
    #[command(flatten)]
    recovery: RecoveryOptions,
    #[command(flatten)]
    reading: SceneOptions,
}

/// Lays the pictures on the layer, as one edit.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    set::refuse_input(&args.scene)?;
    let options = args.reading.options()?;
    let reading = Reading { images: args.images.as_deref(), all: args.all, limits: &options.limits };
    let mut found = cameras::read(&args.file, &reading)?;
    choose(&mut found, &args)?;
    if args.axes == "z-up" {
        found.shots.iter_mut().for_each(|(_, shot)| *shot = shot.from_z_up());
    }
    let root = args.images.as_deref().unwrap_or_else(|| disk::folder_of(&args.file));
    let mut pictures = Vec::new();
    for (path, shot) in &found.shots {
        context.check_cancelled()?;
        pictures.push(taken(path, shot, root, &args, &options)?);
    }
    let told = RefCell::<Vec<String>>::default();
    let elsewhere = set::change(&args.scene, (&args.recovery, &args.reading), |document| {
        let (edit, lines) = edit(document, &found, &pictures, &args, &options)?;
        pictures.iter().try_for_each(|(_, file)| file.copy(&args.scene))?;
        told.replace(lines);
        Ok(edit)
    })?;
    found.notes.iter().chain(&told.take()).for_each(|line| context.messages.say(line));
    if elsewhere {
        context.messages.say("that was in the editor that has the scene open; save it there");
    }
    Ok(())
}

/// Leaves out what `--names` and `--every` do not mean.
fn choose(found: &mut Cameras, args: &Args) -> Result<()> {
    if let Some(names) = &args.names {
        let pattern = Pattern::new(names).map_err(|error| Error::at(format!("--names {names}"), error))?;
        let file = |path: &Path| path.file_name().is_some_and(|name| pattern.matches(&name.to_string_lossy()));
        found.shots.retain(|(path, _)| file(path));
    }
    let mut index = 0;
    found.shots.retain(|_| {
        index += 1;
        (index - 1) % args.every == 0
    });
    if found.shots.is_empty() {
        let error = Error::at(args.file.display(), "has no pictures, or none that are meant");
        return Err(error.cure("see --names and --all"));
    }
    Ok(())
}

/// A picture as it is to lie on the layer, and its file.
fn taken(path: &Path, shot: &Shot, root: &Path, args: &Args, options: &files::Options) -> Result<(Picture, Beside)> {
    let read = picture::read(path, &options.limits)?.picture;
    let size_px = [read.width() as u32, read.height() as u32];
    if let Some(wrong) = shot.size_px.and_then(|camera| misshapen(size_px, camera)) {
        return Err(
            Error::at(path.display(), wrong).cure("give it the picture that its camera took, not cut or stretched")
        );
    }
    let file = Beside::new(path, root, &args.scene)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let shot = Shot { size_px: Some(shot.size_px.unwrap_or(size_px)), ..*shot };
    let image = Image::File(file.path.clone());
    let (from, kind, feather_px) = (SeenFrom::Shot(shot), args.kind.clone(), feather::px(&read));
    let picture = Picture { name, image, from, kind, feather_px, edge_px: 0.0, guide: None };
    Ok((picture, file))
}

/// The whole edit, and what is told of it.
fn edit(
    document: &Document,
    found: &Cameras,
    pictures: &[(Picture, Beside)],
    args: &Args,
    options: &files::Options,
) -> Result<(Edit, Vec<String>)> {
    let wrong = |why: String| Error::at(args.scene.display(), why);
    let refused = |problems| Error::Scene { file: args.scene.display().to_string(), problems };
    let mut edits = Vec::new();
    let mut now = document.clone();
    let layer = match (shots::layer(document, args.layer.as_deref()), &found.mesh) {
        (Ok(layer), _) => layer,
        (Err(_), Some(mesh)) if args.layer.is_none() => {
            let file = Beside::new(mesh, disk::folder_of(&args.file), &args.scene)?;
            file.copy(&args.scene)?;
            let name = mesh.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let added = shots::add_mesh(document, &name, &file.path);
            let (edit, layer) = added.ok_or_else(|| wrong("no mesh can be added".into()))?;
            now = now.apply(&edit).map_err(refused)?;
            edits.push(edit);
            layer
        }
        (Err(why), _) if args.layer.is_some() => return Err(wrong(why)),
        (Err(why), _) => {
            return Err(wrong(why).cure("plica new MODEL makes a scene with one"));
        }
    };
    let all: Vec<Picture> = pictures.iter().map(|(picture, _)| picture.clone()).collect();
    let applied = shots::lay(&now, layer, all).map_err(wrong)?;
    let mut told = vec![applied.told];
    edits.push(applied.edit);
    let technique = now.scene().layers[layer].technique();
    let place = technique.model_to_world(0.0).unwrap_or_default();
    let mesh = match shots::mesh_of(&now, layer) {
        Some((_, path)) => models::read(&paths::beside(&args.scene, path), options)?.mesh,
        None => Mesh::default(),
    };
    let corners: Vec<DVec3> = mesh.vertices.iter().map(|vertex| vertex.position).collect();
    let shots: Vec<Shot> = found.shots.iter().zip(pictures).filter_map(|(_, (picture, _))| shot_of(picture)).collect();
    told.extend(meaning(&shots, &corners, &place, technique.name()));
    let no_camera = document.json().get("camera").is_none_or(|camera| camera == &serde_json::json!({}));
    if let (true, Some(first)) = (no_camera, shots.first()) {
        edits.push(frame_camera(document, first, &corners, &place));
    }
    let edit = Edit::all(edits);
    told.extend(odd(&document.apply(&edit).map_err(refused)?, layer, mesh).iter().map(Problem::to_string));
    Ok((edit, told))
}

/// What is odd about how the pictures lie on the mesh.
fn odd(document: &Document, layer: usize, mesh: Mesh) -> Vec<Problem> {
    let Some((name, _)) = shots::mesh_of(document, layer) else { return Vec::new() };
    let meshes = [(name.to_owned(), Arc::new(mesh))].into();
    table::odd(document, layer, &Materials { meshes, ..Materials::default() })
}

fn shot_of(picture: &Picture) -> Option<Shot> {
    match picture.from {
        SeenFrom::Shot(shot) => Some(shot),
        SeenFrom::Standing { .. } => None,
    }
}

/// The first picture's camera as that of the scene, looking at the place of its axis that is nearest to the middle of the
/// mesh.
fn frame_camera(document: &Document, shot: &Shot, corners: &[DVec3], place: &DAffine3) -> Edit {
    let least = corners.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let most = corners.iter().copied().reduce(DVec3::max).unwrap_or_default();
    let distance = ((least + most) / 2.0 - shot.position()).dot(shot.forward()).max(1e-3);
    let height_px = shot.size_px.map_or(1.0, |[_, height]| f64::from(height));
    shots::camera(document, shot, place, distance, height_px)
}

/// The least share of z in the mean up of cameras whose world has z up.
const UPRIGHT: f64 = 0.8;

/// What the cameras mean: how many see the mesh, and whether they stand on their heads.
fn meaning(shots: &[Shot], corners: &[DVec3], place: &DAffine3, layer: &str) -> Vec<String> {
    let sees_it = |shot: &Shot| corners.iter().any(|corner| sees(shot, *corner));
    let seeing = shots.iter().filter(|shot| sees_it(shot)).count();
    let mut told = vec![format!("{seeing} of {} cameras see the mesh", shots.len())];
    let up: DVec3 = shots.iter().map(|shot| place.transform_vector3(shot.up()).normalize_or_zero()).sum();
    let up = up.normalize_or_zero();
    if seeing == 0 {
        let turned = shots.iter().any(|shot| sees_it(&shot.from_z_up()));
        told.push(match turned {
            true => "none sees it: --axes z-up turns cameras of a world whose z points up".into(),
            false => "none sees it, nor would one if z were up in their world: they may be of another mesh".into(),
        });
    } else if up.z > UPRIGHT {
        told.push(format!(
            "z is up in their world: --axes z-up turns them to a mesh that stands, pose.rotate [-90, 0, 0] of {} both",
            quoted(layer)
        ));
    } else if up.z < -UPRIGHT {
        told.push(format!(
            "z is down in their world: leave --axes z-up out, or pose.rotate [90, 0, 0] of {} would turn it",
            quoted(layer)
        ));
    } else if up.y < -0.2 {
        told.push(format!(
            "their pictures stand on their heads: pose.rotate [180, 0, 0] of {} would turn it",
            quoted(layer)
        ));
    }
    told
}

/// Whether a point is in the picture.
fn sees(shot: &Shot, point: DVec3) -> bool {
    let seen = shot.turn * point + shot.shift;
    let [width, height] = shot.size_px.unwrap_or([1, 1]).map(f64::from);
    let [x, y] = shot.center_px.unwrap_or([width / 2.0, height / 2.0]);
    let (x, y) = (x + shot.focal_px[0] * seen.x / seen.z, y + shot.focal_px[1] * seen.y / seen.z);
    seen.z > 0.0 && (0.0..width).contains(&x) && (0.0..height).contains(&y)
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;

    #[test]
    fn what_is_up_for_the_cameras_is_told_where_it_is_not_y() {
        // From the rows of a turn: x right, y down, z forward.
        let shot = |down: DVec3, forward: DVec3| Shot {
            turn: DMat3::from_cols(down.cross(forward), down, forward).transpose(),
            shift: DVec3::new(0.0, 0.0, 4.0),
            focal_px: [100.0; 2],
            center_px: None,
            size_px: Some([100, 100]),
        };
        for (down, forward, told) in [
            (DVec3::NEG_Y, DVec3::NEG_Z, None),
            (DVec3::Y, DVec3::NEG_Z, Some("stand on their heads: pose.rotate [180, 0, 0] of \"m\"")),
            (DVec3::Z, DVec3::Y, Some("z is down in their world: leave --axes z-up out")),
            (DVec3::NEG_Z, DVec3::Y, Some("z is up in their world: --axes z-up turns them")),
        ] {
            let found = meaning(&[shot(down, forward)], &[DVec3::ZERO], &DAffine3::IDENTITY, "m");
            assert_eq!(found[0], "1 of 1 cameras see the mesh");
            assert_eq!(found.len(), 1 + usize::from(told.is_some()), "{found:?}");
            assert!(told.is_none_or(|told| found[1].contains(told)), "{found:?}");
        }
        // From [0, 0, 4] along -z; turned from z up, from [0, 4, 0] down.
        let past = shot(DVec3::NEG_Y, DVec3::NEG_Z);
        for (corner, told) in
            [(DVec3::new(0.0, 0.0, 9.0), "of another mesh"), (DVec3::new(0.0, -20.0, 0.0), "--axes z-up")]
        {
            let found = meaning(&[past], &[corner], &DAffine3::IDENTITY, "m");
            assert!(found[0].starts_with("0 of 1") && found[1].contains(told), "{found:?}");
        }
    }
}
