//! Styles that layers are drawn in, as their techniques bring them: the list, the edit that puts a layer into one, and
//! what of a style is in force in a layer.

use serde_json::Value;

use super::presets::{Applied, layer_of};
use super::{Document, Edit, json};
use crate::base::pointer::Pointer;
use crate::base::problem::{self, Problem};
use crate::layers::KINDS;
use crate::layers::starts::{Style, Styles};
use crate::layers::technique::Kind;

/// What a layer is to be drawn in.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// A style of the program.
    Named(&'static Style),
    /// A table of one's own, and where it is from.
    Own(&'a Value, &'a str),
    /// None.
    Nothing,
}

/// What a layer is drawn in if it is in no style.
pub const NOTHING: &str = "none";

/// All styles.
pub fn all() -> impl Iterator<Item = &'static Style> + Clone {
    KINDS.iter().filter_map(|kind| kind.styles).flat_map(|styles| styles.list)
}

/// The style of this name.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> Result<&'static Style, String> {
    let unknown = || {
        let hint = problem::nearest(name, all().map(|style| style.name)).unwrap_or_default();
        format!("there is no style {} ({hint})", problem::quoted(name))
    };
    all().find(|style| style.name == name).ok_or_else(unknown)
}

/// Whether layers of a technique have this style.
fn has(kind: &Kind, style: &Style) -> bool {
    kind.styles.is_some_and(|styles| styles.list.iter().any(|own| own.name == style.name))
}

/// Puts the layer `name`, or the first one that can be, into a style: by its name, or everything in force written `whole`.
///
/// # Errors
/// There is no such layer, or it cannot be drawn so.
pub fn apply(document: &Document, name: Option<&str>, source: Source, whole: bool) -> Result<Applied, String> {
    let own = match source {
        Source::Named(style) => style.name,
        Source::Own(_, place) => place,
        Source::Nothing => NOTHING,
    };
    let fits = |kind: &Kind| match source {
        Source::Named(style) => has(kind, style),
        Source::Own(..) | Source::Nothing => kind.styles.is_some(),
    };
    let (index, styles, path) = styled(document, name, own, &fits)?;
    let now = document.json().pointer(&path);
    let mut value = match source {
        Source::Named(style) => (styles.named)(now, style.name),
        Source::Own(table, _) => (styles.own)(table.clone()),
        Source::Nothing => Value::Null,
    };
    if whole && !value.is_null() {
        value = (styles.own)((styles.whole)(&value)?);
    }
    let same = json::same(now.unwrap_or(&Value::Null), &value);
    let edit = if same { Edit::default() } else { Edit::set(document, &path, value) };
    if let Source::Own(_, place) = source {
        fits_into(document, &edit, &path).map_err(|why| format!("{place}: {why}"))?;
    }
    let layer = document.scene().layers[index].technique().name();
    let told = match (source, same) {
        (Source::Nothing, _) => format!("{layer} is drawn in no style"),
        (_, true) => format!("{own} changes nothing in {layer}"),
        (_, false) => format!("{own} is applied to {layer}"),
    };
    Ok(Applied { told, edit })
}

/// The styles of a layer that is drawn in one or that can be, and where it says so.
///
/// # Errors
/// There is no such layer.
pub fn of_layer(document: &Document, name: Option<&str>) -> Result<(&'static Styles, String), String> {
    let (_, styles, path) = styled(document, name, "a style", &|kind| kind.styles.is_some())?;
    Ok((styles, path))
}

/// Whether a table of one's own fits at `path`; what is wrong has its place in the table.
fn fits_into(document: &Document, edit: &Edit, path: &str) -> Result<(), String> {
    let Err(problems) = document.apply(edit) else { return Ok(()) };
    let own = |problem: &Problem| Some(problem.clone().at(Pointer(&problem.path).below(path)?));
    problems.iter().find_map(own).map_or(Ok(()), |problem| Err(problem.to_string()))
}

/// The edit that changes the style of a layer to the built-in one of this name, if `pointer` is where the name is written. What
/// was changed of the old style is dropped.
pub fn renamed(document: &Document, pointer: &str, name: &str) -> Option<Edit> {
    let (index, way) = Pointer(pointer).item_of("/layers")?;
    let styles = document.scene().layers.get(index)?.technique().kind().styles?;
    if way.strip_prefix(styles.field) != Some(styles.name) || styles.list.iter().all(|style| style.name != name) {
        return None;
    }
    let path = format!("/layers/{index}{}", styles.field);
    Some(Edit::set(document, &path, (styles.named)(document.json().pointer(&path), name)))
}

/// The table of everything that is in force in the layer `name`, or in the first one that is drawn in a style.
///
/// # Errors
/// There is no such layer, or it has no style.
pub fn in_force(document: &Document, name: Option<&str>) -> Result<Value, String> {
    let (index, styles, path) = styled(document, name, "a style", &|kind| kind.styles.is_some())?;
    let layer = document.scene().layers[index].technique().name();
    let written = document.json().pointer(&path).filter(|written| !written.is_null());
    let written = written.ok_or_else(|| format!("the layer {} is drawn in no style", problem::quoted(layer)))?;
    (styles.whole)(written)
}

/// The layer `name`, or the first whose technique `fits`: its index, its styles, and where it says in which it is.
fn styled(
    document: &Document,
    name: Option<&str>,
    own: &str,
    fits: &dyn Fn(&Kind) -> bool,
) -> Result<(usize, &'static Styles, String), String> {
    let kind = KINDS.iter().find(|kind| fits(kind)).ok_or("no layer has styles")?;
    let (index, _) = layer_of(document, name, own, kind.name)?;
    let styles = kind.styles.ok_or("no layer has styles")?;
    Ok((index, styles, format!("/layers/{index}{}", styles.field)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_layer_takes_a_style_and_gives_it_back_whole() {
        for kind in KINDS.iter().filter(|kind| kind.styles.is_some()) {
            let document = Document::from_json(json::parse(kind.example).unwrap()).unwrap();
            for style in kind.styles.unwrap().list {
                let source = Source::Named(find(style.name).unwrap());
                let applied = apply(&document, None, source, false).unwrap();
                let with = document.apply(&applied.edit).unwrap_or_else(|problems| panic!("{problems:?}"));
                assert!(apply(&with, None, source, false).unwrap().edit.is_empty(), "{}", style.name);
                let table = in_force(&with, None).unwrap();
                // Whole, or from a file, it refers to no style and is the same.
                for edit in [
                    apply(&with, None, source, true).unwrap().edit,
                    apply(&with, None, Source::Own(&table, "a.json"), false).unwrap().edit,
                ] {
                    let own = with.apply(&edit).unwrap_or_else(|problems| panic!("{problems:?}"));
                    assert_eq!(in_force(&own, None).unwrap(), table, "{}", style.name);
                    assert!(!own.to_text().contains(&format!("\"{}\"", style.name)));
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_is_told() {
        let layer = json!({ "kind": "fill", "name": "sky" });
        let document = Document::from_json(json!({ "plica": 1, "layers": [layer] })).unwrap();
        let style = Source::Named(find("stipple").unwrap());
        let told = |name| apply(&document, name, style, false).unwrap_err();
        assert_eq!(told(None), "stipple is for layers of kind mesh, and the scene has none");
        assert_eq!(told(Some("sky")), "stipple is for layers of kind mesh; sky is of kind fill");
        assert_eq!(find("stiple").unwrap_err(), "there is no style \"stiple\" (did you mean \"stipple\"?)");
    }
}
