//! `:add`: an item at the cursor, or the picture, the mesh or the clip of a file.

use std::path::{Path, PathBuf};

use super::command::{Call, Command, Done, command};
use super::items::{add_here, go_to, target};
use crate::base::error::Error;
use crate::base::pointer::Pointer;
use crate::base::problem::quoted;
use crate::files::{clips, models, paths, picture, sources, write};
use crate::layers::parts::materials::List;
use crate::ops::new;
use crate::scene::{Known, Looks, Start};
use crate::tui::state::State;
use crate::tui::text::plain;

pub const COMMANDS: &[Command] = &[command(
    "add",
    "[PATH]",
    "Add an item to the list, an optional node, or the picture, mesh or clip of a file with a layer that shows it",
    add,
)
.change()
.counted_with(&[""])];

fn add(state: &mut State, call: &Call) -> Done {
    // The name of a file that is there needs no quotes, whatever is in it.
    let whole = paths::typed(call.text);
    let is_there = call.text.contains(' ') && beside(state, &whole.to_string_lossy()).is_file();
    let path = if is_there { Some(whole) } else { call.path()? };
    match path {
        None => add_here(state, call.times_of("add")?),
        Some(_) if call.text.starts_with(['{', '[']) => {
            Err("add takes the path of a file; a value is added by :set PATH.-=VALUE, as layers.-".into())
        }
        Some(path) => add_file(state, &path.to_string_lossy()),
    }
}

/// Adds a picture, a mesh or a clip from a file (relative to the scene), under the file's name, with a layer that shows it as
/// `plica new` makes one, unless the cursor is in the list of such files. What is there is read first, so that nothing broken is added; a
/// file may come later, and then has no layer. What the scene may not read where it is is copied beside it.
fn add_file(state: &mut State, path: &str) -> Done {
    let place = beside(state, path);
    let list = sources::list_of(&place);
    let source = (place.as_path(), path);
    let found = match list {
        List::Clips => clip(state, source)?,
        List::Meshes if place.exists() => model(state, source)?,
        List::Images if files_of(&place).exists() => picture(state, source)?,
        List::Meshes => {
            Brought::later(Start::within(state.document()).mesh(stem(path), path, None, Looks::default()), path)
        }
        // Files are pictures unless they are known as something else.
        List::Images | List::Shapes | List::Layers => {
            Brought::later(Start::within(state.document()).picture(stem(path), path, (0, 0)), path)
        }
    };
    let Brought { start, is_there, path, mut notes, copies } = found;
    let own = format!("/{}", list.words().0);
    let in_list = target(state).is_ok_and(|at| Pointer(&at).is_within(&own));
    let start = if is_there && !in_list { start } else { start.without_layers() };
    if let Some((folder, files)) = copies {
        if state.scene.read_only() {
            return Err(format!(
                "{path} is not in the scene's folder, and nothing is copied there in a read-only session"
            ));
        }
        files.iter().try_for_each(|(file, name)| write::copy_into(file, &folder, name)).map_err(refused)?;
        notes.push("copied beside the scene".to_owned());
    }
    let (edit, places) = start.edit(state.document());
    state.edit(edit, false)?;
    let pointer = places.last().ok_or("it is in the scene already")?;
    go_to(state, pointer);
    tell_added(state, list, (&places, &path), &notes);
    Ok(())
}

/// What a file brings into the scene.
struct Brought {
    start: Start,
    /// Whether the file is there.
    is_there: bool,
    /// How the scene names it.
    path: String,
    notes: Vec<String>,
    copies: Option<(PathBuf, new::Copies)>,
}

impl Brought {
    /// What is named before its file is there.
    fn later(start: Start, path: &str) -> Brought {
        Brought { start, is_there: false, path: path.to_owned(), notes: Vec::new(), copies: None }
    }
}

/// The folder of the scene, if a file has to be copied there.
fn outside(state: &State, file: &Path) -> Option<PathBuf> {
    paths::folder_beside(state.scene.path(), file).filter(|_| !state.scene.options().allow_outside)
}

fn clip(state: &State, (place, path): (&Path, &str)) -> Result<Brought, String> {
    let found = clips::find(place).map_err(refused)?;
    let folder = if place.is_dir() { path.trim_end_matches('/') } else { folder_of(path) };
    let last = Some(name_of(folder)).filter(|last| !last.is_empty()).unwrap_or("clip");
    let mut path = if folder.is_empty() { found.name.clone() } else { format!("{folder}/{}", found.name) };
    let copies = outside(state, &found.folder.join(&found.name)).map(|scene| {
        let (copy, files) = new::clip_copies(&found, &new::clip_called(place));
        path = copy.to_string_lossy().into_owned();
        (scene, files)
    });
    let first = found.files.first().map(|file| found.folder.join(file));
    // A video tells nothing before it is decoded.
    let size = first.as_ref().and_then(|first| picture::size(first, &state.scene.options().limits).ok());
    let is_still = found.is_still(&state.scene.options().limits);
    let known = size.map(|size_px| Known { size_px, frames: found.files.len(), is_still });
    let name = clips::called(&found.name, last);
    let start = Start::within(state.document()).clip(name, &path, found.first, known);
    Ok(Brought { start, is_there: first.is_some_and(|first| first.exists()), path, notes: Vec::new(), copies })
}

fn model(state: &State, (place, path): (&Path, &str)) -> Result<Brought, String> {
    let models::Model { mesh, picture, color, both_sides, beside, notes } =
        models::read(place, state.scene.options()).map_err(refused)?;
    let mut named = path.to_owned();
    let copies = bring(place, outside(state, place), beside, &mut named)?;
    let picture = picture.map(|picture| paths::sibling(&named, &picture));
    let called = picture.as_deref().map(|picture| new::called(Path::new(picture)));
    let picture = called.as_deref().zip(picture.as_deref());
    let looks = Looks { picture, color: color.as_deref(), both_sides };
    let start = Start::within(state.document()).mesh(stem(path), &named, Some(mesh), looks);
    Ok(Brought { start, is_there: true, path: named, notes, copies })
}

fn picture(state: &State, (place, path): (&Path, &str)) -> Result<Brought, String> {
    let found = sources::picture(place, &state.scene.options().limits).map_err(refused)?;
    let size = (found.picture.width(), found.picture.height());
    let mut named = path.to_owned();
    let copies = bring(place, outside(state, place), Vec::new(), &mut named)?;
    let start = Start::within(state.document()).picture(stem(path), &named, size);
    Ok(Brought { start, is_there: true, path: named, notes: found.notes, copies })
}

fn refused(error: Error) -> String {
    error.to_string()
}

/// What is copied into a folder, if there is one: a picture or a model with the files that it names; `path` is then that of the
/// copy.
fn bring(
    place: &Path,
    folder: Option<PathBuf>,
    named: Vec<String>,
    path: &mut String,
) -> Result<Option<(PathBuf, new::Copies)>, String> {
    let Some(folder) = folder else { return Ok(None) };
    let copied = || {
        let own = new::file_name(place)?;
        *path = own.clone();
        new::copies(place, [paths::file_of(&own).to_owned()].into_iter().chain(named).collect())
    };
    Ok(Some((folder, copied().map_err(refused)?)))
}

/// Where a path as typed is, as a picture, a model or a clip is named: with the part of the file that it means.
fn beside(state: &State, path: &str) -> PathBuf {
    let file = paths::beside(state.scene.path(), path);
    match path.strip_prefix(paths::file_of(path)).filter(|part| !part.is_empty()) {
        Some(part) => file.with_file_name(format!("{}{part}", file.file_name().unwrap_or_default().to_string_lossy())),
        None => file,
    }
}

/// The file of a path that may mean a part of it.
fn files_of(place: &Path) -> &Path {
    place.to_str().map_or(place, |place| Path::new(paths::file_of(place)))
}

/// Says what was added, what of it is not supported, and whether its file is missing: a clip was found before.
fn tell_added(state: &mut State, list: List, (places, path): (&[String], &str), notes: &[String]) {
    let (map, one) = list.words();
    let place = paths::beside(state.scene.path(), path);
    // Of a clip of numbered files, some are there.
    let found = place.exists() || list == List::Clips && name_of(path).contains('%');
    if !found {
        let missing = format!("{path} is among the {map}; there is no file {} yet", place.display());
        return state.say(plain(&missing));
    }
    let layer = places.last().filter(|place| Pointer(place).is_within("/layers"));
    let layer = layer.and_then(|place| state.document().json().pointer(place)?.get("name")?.as_str());
    let entry = places.iter().find_map(|place| List::entry(place).filter(|(of, _)| *of == list));
    let name = entry.map_or_else(|| stem(path).to_owned(), |(_, name)| name);
    let next = match layer {
        Some(layer) => format!(", and the layer {} shows it", quoted(layer)),
        None if state.document().scene().layers.is_empty() => {
            ": now add a layer that shows it (o on layers)".to_owned()
        }
        None => String::new(),
    };
    let notes: String = notes.iter().map(|note| format!("; {note}")).collect();
    state.say(plain(&format!("the {one} {} is among the {map}{next}{notes}", quoted(&name))));
}

/// The name in a path, without the folder.
fn name_of(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// The folder in a path, without the slash.
fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The name of a file without folder and extension.
pub fn stem(path: &str) -> &str {
    let file = name_of(path);
    file.split_once('.').map_or(file, |(stem, _)| stem)
}
