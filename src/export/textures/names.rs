//! The names of the files in a folder of textures, known before anything is made: which ones a scene's textures may have, and
//! which ones an earlier run wrote.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use super::Depth;
use crate::files::hash;
use crate::files::lines;
use crate::layers::KINDS;
use crate::layers::parts::bundle::{self, Form};
use crate::layers::technique::{Kind, Technique};
use crate::scene::Scene;

/// The file that names all others.
pub const MANIFEST: &str = "manifest.json";
/// The extensions of a picture: in codes and in floats.
pub const PICTURES: [&str; 2] = ["png", "exr"];
/// The extension of a mesh.
pub const MESHES: [&str; 1] = ["obj"];

/// The names that the textures of a scene may have.
pub struct Names {
    /// Of each technique, with the beginnings of the names of its items' files.
    bundles: Vec<(bundle::Names, Vec<String>)>,
    extension: &'static str,
}

impl Names {
    /// Those of `scene` at this depth.
    pub fn of(scene: &Scene, depth: Depth) -> Names {
        let bundles = KINDS.iter().filter_map(|kind| {
            let layers: Vec<&dyn Technique> = of_kind(scene, kind).map(|(_, layer)| layer).collect();
            kind.bundle.as_ref().filter(|_| !layers.is_empty()).map(|bundle| (bundle.names)(&layers))
        });
        let stems = |names: &bundle::Names| {
            names.items.iter().map(|(layer, item)| stem(layer.as_deref(), item)).collect::<Vec<_>>()
        };
        let bundles = bundles.map(|names| (names.clone(), stems(&names)));
        Names { bundles: bundles.collect(), extension: depth.extension() }
    }

    /// Whether a file of this name may be made.
    pub fn may_be(&self, name: &str) -> bool {
        name == MANIFEST || self.bundles.iter().any(|(bundle, stems)| self.is_of(bundle, stems, name))
    }

    fn is_of(&self, bundle: &bundle::Names, stems: &[String], name: &str) -> bool {
        let Some((name, extension)) = name.rsplit_once('.') else { return false };
        let is = |form: Form| self.extensions(form).contains(&extension);
        let own = |form: Form, names: &[String]| is(form) && names.iter().any(|own| own == name);
        // The file that is called as its item is has no - behind that.
        let whole = if is(Form::Mesh) { format!("{name}-") } else { name.to_owned() };
        let of_item = |stem: &String| {
            let rest = whole.strip_prefix(stem.as_str())?;
            // Things of the same name are numbered.
            let part = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            let part = if part.len() < rest.len() { part.strip_prefix('-')? } else { part };
            bundle.ends.iter().any(|(form, end)| is(*form) && end == part).then_some(())
        };
        own(Form::Picture, &bundle.pictures)
            || own(Form::Texture, &bundle.textures)
            || stems.iter().any(|stem| of_item(stem).is_some())
    }

    /// The extensions that a file may have.
    fn extensions(&self, form: Form) -> &[&str] {
        match form {
            Form::Texture => std::slice::from_ref(&self.extension),
            Form::Picture => &PICTURES,
            Form::Halves => &PICTURES[1..],
            Form::Mesh => &MESHES,
        }
    }

    /// Whether something is baked if that is asked for.
    pub fn bakes(&self) -> bool {
        self.bundles.iter().any(|(bundle, _)| bundle.bakes)
    }
}

/// The layers of a kind, each with its index.
pub fn of_kind<'a>(scene: &'a Scene, kind: &'a Kind) -> impl Iterator<Item = (usize, &'a dyn Technique)> {
    let layers = scene.layers.iter().map(|layer| layer.technique()).enumerate();
    layers.filter(|(_, layer)| layer.kind().name == kind.name)
}

/// The longest beginning of a file's name, in bytes: with what follows it no file system takes it for too long.
const LONGEST: usize = 200;

/// How the files of a zone begin: its name in plain letters, the layer's before it where there are several. One that is too
/// long is cut, and ends in what tells it from others that begin alike.
pub fn stem(layer: Option<&str>, zone: &str) -> String {
    const MARK: usize = 8;
    let whole = layer.map(|layer| format!("{}-", plain(layer))).unwrap_or_default() + &plain(zone);
    if whole.len() < LONGEST {
        return whole + "-";
    }
    let mark = hash::of(whole.as_bytes());
    format!("{}-{}-", &whole[..whole.floor_char_boundary(LONGEST - MARK - 2)], &mark[..MARK])
}

/// A name as file systems compare it that take upper and lower case for the same.
pub fn folded(name: &str) -> String {
    // Twice: some letters have an upper case of which the lower is another letter.
    name.to_lowercase().to_uppercase().to_lowercase()
}

/// A name with `-` in place of everything but letters, digits, `-` and `_`: of accents that stand apart from their letters too,
/// so that the two spellings of é, which some file systems take for one, give two names.
fn plain(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { '-' }).collect();
    let plain = plain.trim_matches('-');
    if plain.is_empty() { "zone".into() } else { plain.into() }
}

/// The files that an earlier run wrote to `dir`, from its manifest; `None` if there is no manifest.
pub fn earlier(dir: &Path) -> BTreeSet<String> {
    let text = lines::read(&dir.join(MANIFEST)).ok();
    let manifest = text.and_then(|text| serde_json::from_str::<Value>(&text).ok());
    let Some(manifest) = manifest.filter(|manifest| manifest.get("plica_textures").is_some()) else {
        return BTreeSet::new();
    };
    let mut names = BTreeSet::from([MANIFEST.to_owned()]);
    collect(&manifest, &mut names);
    names
}

/// The names of files in a manifest; only those that a run writes.
fn collect(value: &Value, names: &mut BTreeSet<String>) {
    let is_ours = |name: &&String| {
        let ours = [".png", ".exr", ".obj"].iter().any(|end| name.ends_with(end));
        ours && !name.contains('/') && !name.starts_with('.')
    };
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, value)| match value {
            Value::String(name) if key == "file" => names.extend(Some(name).filter(is_ours).cloned()),
            _ => collect(value, names),
        }),
        Value::Array(items) => items.iter().for_each(|item| collect(item, names)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        for (layer, zone, expected) in [
            (None, "left eye", "left-eye-"),
            (None, "../../etc/passwd", "etc-passwd-"),
            (None, "眼", "眼-"),
            (None, "caf\u{e9}", "caf\u{e9}-"),
            (None, "cafe\u{301}", "cafe-"),
            (None, "e\u{301}te", "e-te-"),
            (None, "...", "zone-"),
            (Some("face"), "lid", "face-lid-"),
        ] {
            assert_eq!(stem(layer, zone), expected);
        }
    }

    #[test]
    fn long_names_are_cut_and_stay_apart() {
        let long = "猫".repeat(90);
        let all = [long.clone(), format!("{long}a"), format!("{long}b"), "x".repeat(199), "x".repeat(300)];
        let stems: BTreeSet<String> = all.iter().map(|zone| stem(None, zone)).collect();
        assert_eq!(stems.len(), all.len());
        for stem in stems.iter().chain([&stem(Some(&"y".repeat(130)), &"z".repeat(130))]) {
            assert!(stem.len() <= LONGEST && stem.ends_with('-'), "{stem}");
        }
        assert_eq!(stem(None, &"x".repeat(199)), "x".repeat(199) + "-");
    }

    #[test]
    fn files_of_items_are_called_by_them() {
        let ends =
            vec![(Form::Mesh, String::new()), (Form::Picture, "base-0".into()), (Form::Texture, "turns-0".into())];
        let bundle = bundle::Names { items: vec![(None, "body".into())], ends, ..bundle::Names::default() };
        let names = Names { bundles: vec![(bundle, vec!["body-".into()])], extension: "png" };
        for name in ["body.obj", "body-2.obj", "body-base-0.png", "body-base-0.exr", "body-2-turns-0.png"] {
            assert!(names.may_be(name), "{name}");
        }
        for name in ["body.png", "body-.obj", "bodyx.obj", "body-base-1.png", "body-turns-0.exr", "body-base-0.obj"] {
            assert!(!names.may_be(name), "{name}");
        }
    }

    #[test]
    fn a_manifest_names_what_a_run_wrote_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let names = |text: &str| {
            std::fs::write(folder.path().join(MANIFEST), text).unwrap();
            earlier(folder.path()).into_iter().collect::<Vec<_>>()
        };
        let text = r#"{"plica_textures": 1, "colour": {"file": "colour.png"}, "layers": [{"zones": [
            {"init": {"file": "a-init.exr"}, "name": "x.png", "jump": {"file": "../b.png"}},
            {"init": {"file": ".hidden.png"}, "jump": {"file": "photo.jpg"}}]}], "meshes": [{"file": "a.obj"}]}"#;
        assert_eq!(names(text), ["a-init.exr", "a.obj", "colour.png", MANIFEST]);
        assert!(names(r#"{"colour": {"file": "colour.png"}}"#).is_empty());
        assert!(names("no JSON").is_empty());
        assert!(earlier(&folder.path().join("none")).is_empty());
    }
}
