//! What is moved, turned, stretched and mirrored in a layer's picture otherwise than field by field. It works on what is
//! written, so that nothing else comes to be written.

use kurbo::Affine;
use kurbo::Rect;
use serde::Deserialize;
use serde_json::{Value, json};

use super::anchors;
use super::fold::Fold;
use super::kinds;
use super::outline::Outline;
use super::tools::{CurveFrame, Tool};
use crate::base::geometry::point;
use crate::base::number;
use crate::layers::parts::moving::{Moved, Moving, is_near, pair, written, xy};

/// All that its fields tell.
const BY_FIELDS: Moved = Moved::FieldsBut(&[]);

/// Why what is made of shapes of the scene is not moved by itself.
const SHARED: &str = "it is made of shared shapes: move those, or make it its own first (:unshare)";

/// As [`crate::layers::parts::moving::Mover`].
pub fn moved(moving: &mut Moving, value: &mut Value) -> Result<Moved, String> {
    let has = |tag: &str| value.get(tag).is_some();
    if has("tool") {
        let tool = Tool::deserialize(&*value).map_err(|_| "this tool cannot be read")?;
        return self::tool(moving, value, &tool);
    }
    if has("rule") && Fold::deserialize(&*value).is_ok_and(|fold| fold.mask().is_some()) {
        return Err("a mask is a picture, which stays where it is: take the fold away first".into());
    }
    if has("kind")
        && let Ok(outline) = Outline::deserialize(&*value)
    {
        return self::outline(moving, value, &outline);
    }
    Ok(BY_FIELDS)
}

/// A rectangle or an ellipse becomes a polygon or a path where it would not be upright.
fn outline(moving: &mut Moving, value: &mut Value, outline: &Outline) -> Result<Moved, String> {
    let (to, rect) = match outline {
        Outline::Rectangle { x, y, width, height } => ("polygon", Rect::new(*x, *y, x + width, y + height)),
        Outline::Ellipse { center: [x, y], radii: [w, h] } => ("path", Rect::new(x - w, y - h, x + w, y + h)),
        Outline::Polygon { .. } | Outline::Path { .. } => return Ok(BY_FIELDS),
        Outline::Shapes { .. } => return Err(SHARED.into()),
    };
    if !moving.is_upright() {
        *value = kinds::outline_as(outline, to).ok_or("this outline cannot be turned")?;
        return Ok(BY_FIELDS);
    }
    moving.see(rect);
    let Rect { x0, y0, x1, y1 } = moving.by.transform_rect_bbox(rect);
    let new = match to {
        "polygon" => {
            vec![("x", written(x0)), ("y", written(y0)), ("width", written(x1 - x0)), ("height", written(y1 - y0))]
        }
        _ => {
            vec![("center", pair((x0 + x1) / 2.0, (y0 + y1) / 2.0)), ("radii", pair((x1 - x0) / 2.0, (y1 - y0) / 2.0))]
        }
    };
    new.into_iter().for_each(|(name, number)| value[name] = number);
    Ok(Moved::Whole)
}

fn tool(moving: &mut Moving, value: &mut Value, tool: &Tool) -> Result<Moved, String> {
    if tool.facts().file.is_some() {
        return Err("a field that is read from a file stays where it is".into());
    }
    match tool {
        Tool::Curve { nodes, .. } if nodes.shape.is_some() => Err(SHARED.into()),
        Tool::Curve { frame: CurveFrame::Curve, .. } => own_frame(moving, value),
        // Its vector says it all.
        Tool::Translate { .. } => Ok(BY_FIELDS),
        other => anchors::transform(other).map_or(Ok(BY_FIELDS), |map| dense(moving, value, other, map)),
    }
}

/// A curve whose jump vectors are measured along it and to its left, which is its right in a mirror.
fn own_frame(moving: &Moving, value: &mut Value) -> Result<Moved, String> {
    if !moving.is_even() {
        return Err("the jump vectors of a curve in its own frame are only scaled evenly".into());
    }
    let (scale, turn) = (moving.scale(), moving.turn());
    for jump in value.get_mut("jumps").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some((along, left)) = jump.get("jump").and_then(xy) {
            jump["jump"] = pair(along * scale, left * scale * turn);
        }
    }
    Ok(Moved::FieldsBut(&["jumps"]))
}

/// A dense tool maps places to places: the new one goes back, does what the old one does, and comes again. Where its own
/// kind cannot say that, it becomes an affine map.
fn dense(moving: &mut Moving, value: &mut Value, tool: &Tool, map: Affine) -> Result<Moved, String> {
    let [a, b, c, d, e, f] = (moving.by * map * moving.by.inverse()).as_coeffs();
    let to = tool.facts().center.map(|center| moving.place(point(center)));
    let upright = is_near(b, 0.0) && is_near(c, 0.0);
    let sheared = is_near(a, 1.0) && is_near(d, 1.0);
    let kept = match tool {
        Tool::Scale { .. } if upright => Some(("factor", pair(a, d))),
        Tool::Rotate { degrees, .. } if moving.is_even() => Some(("degrees", number::json(degrees * moving.turn()))),
        Tool::Shear { .. } if sheared => Some(("factor", pair(c, b))),
        _ => None,
    };
    match (kept, to) {
        (Some((field, new)), Some(to)) => {
            value[field] = new;
            value["center"] = pair(to.x, to.y);
        }
        _ => {
            // An affine map has no place of its own: its zone has.
            let rows = [[a, c, e], [b, d, f]].map(|row| Value::from(row.map(written).to_vec()));
            *value = json!({ "tool": "affine", "matrix": rows });
        }
    }
    Ok(Moved::Whole)
}
