//! The page of the scene file, made from its schema as the forms of the editor are.

use std::collections::BTreeSet;

use super::roff;
use crate::scene::expected;
use crate::scene::schema::{Body, Shape};

const BEGIN: &str = "A scene is one file of JSON, NAME.plica.json. Every field has a default but those that are marked as required; \
unknown fields are errors that name the nearest known one. Positions and lengths are pixels of the layer's picture from its \
top left corner, y downwards; angles are degrees. Files are named relative to the scene. plica schema prints the same as JSON \
Schema, plica check tells what is wrong in a scene, plica get and plica set read and change fields by paths such as \
layers.face.zones.eye.feather.";

/// The page.
pub fn page() -> String {
    let mut page = roff::title("plica-scene", 5, "the scene file of plica");
    page += &roff::heading("DESCRIPTION");
    page += &roff::paragraph(BEGIN);
    let mut waiting = vec![("the scene".to_owned(), Shape::root())];
    let mut seen = BTreeSet::new();
    while !waiting.is_empty() {
        let (title, shape) = waiting.remove(0);
        if seen.insert(shape.id()) {
            page += &roff::heading(&title.to_uppercase());
            page += &object(&title, shape, &mut waiting);
        }
    }
    page
}

/// The fields of an object, or of each kind of it; objects inside wait for a heading of their own.
fn object(title: &str, shape: Shape, waiting: &mut Vec<(String, Shape)>) -> String {
    let Body::Tagged(tag) = shape.body() else { return fields(title, shape, waiting) };
    let mut text = String::new();
    for (name, help) in shape.choices() {
        let Some(variant) = shape.variant(name) else { continue };
        text += &roff::subheading(&format!("{tag}: {name}"));
        text += &roff::paragraph(help);
        if let Some(formula) = variant.formula() {
            text += &roff::paragraph(formula);
        }
        text += &fields(name, variant, waiting);
    }
    text
}

fn fields(title: &str, shape: Shape, waiting: &mut Vec<(String, Shape)>) -> String {
    let required: BTreeSet<&str> = shape.required().collect();
    let mut text = String::new();
    for (name, _) in shape.fields().into_iter().flatten() {
        let Some(field) = shape.property(None, name).filter(|_| shape.constant(name).is_none()) else { continue };
        let mut kind = expected(field);
        if required.contains(name.as_str()) {
            kind += ", required";
        } else if let Some(default) = field.default().filter(|default| !default.is_null()) {
            kind += &format!(", default {default}");
        }
        text += &roff::tagged(name, &kind, field.help());
        let inside = field.body().item().unwrap_or(field);
        if inside.body().is_object() {
            let holder = if title == "the scene" { String::new() } else { format!("{title}: ") };
            waiting.push((format!("{holder}{name}"), inside));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_every_field_of_a_scene_once() {
        let page = page();
        for part in [
            ".TH PLICA-SCENE 5",
            "\\fB\\&timeline\\fR",
            "kind: picture",
            "tool: still\\-border",
            "function: cubic\\-bezier",
            "\\fB\\&feather\\fR",
            "required",
        ] {
            assert!(page.contains(part), "{part}");
        }
        let headings: Vec<&str> = page.lines().filter(|line| line.starts_with(".SH")).collect();
        let distinct: BTreeSet<&&str> = headings.iter().collect();
        assert_eq!(distinct.len(), headings.len(), "{headings:?}");
        assert_eq!(page.matches("tool: point").count(), 1);
    }
}
