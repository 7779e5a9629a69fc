//! Styles that layers are drawn in, as their techniques bring them: the list, the edit that puts a layer into one, and
//! what of a style is in force in a layer.

use serde_json::Value;

use super::presets::{Applied, layer_of};
use super::{Document, Edit, json};
use crate::base::problem;
use crate::layers::KINDS;
use crate::layers::technique::{Kind, Style, Styles};

/// What a layer is to be drawn in.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// A style of the program.
    Named(&'static Style),
    /// A table of one's own, and where it is from.
    Own(&'a Value, &'a str),
}

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
    };
    let fits = |kind: &Kind| match source {
        Source::Named(style) => has(kind, style),
        Source::Own(..) => kind.styles.is_some(),
    };
    let (index, styles, path) = styled(document, name, own, &fits)?;
    let now = document.json().pointer(&path);
    let mut value = match source {
        Source::Named(style) => (styles.named)(now, style.name),
        Source::Own(table, _) => (styles.own)(table.clone()),
    };
    if whole {
        value = (styles.own)((styles.whole)(&value)?);
    }
    let same = now.is_some_and(|now| json::same(now, &value));
    let edit = if same { Edit::default() } else { Edit::set(document, &path, value) };
    let done = if same { "changes nothing in" } else { "is applied to" };
    let layer = document.scene().layers[index].technique().name();
    Ok(Applied { told: format!("{own} {done} {layer}"), edit })
}

/// The table of everything that is in force in the layer `name`, or in the first one that is drawn in a style.
///
/// # Errors
/// There is no such layer, or it is drawn in none.
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
