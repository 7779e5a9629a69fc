//! What of an item of a layer, or of a shape, can be dragged in the picture: places, the ends of vectors, and the corners of
//! boxes. The schema tells which fields these are.

use kurbo::{Point, Vec2};
use serde_json::Value;

use super::Document;
use super::field::{layer_of, steps};
use super::schema::{Body, Place};
use super::words::item_of;
use crate::base::pointer::Pointer;
use crate::layers::parts::moving::{pair, written, xy};

/// Of lists that are longer only the item that is selected can be dragged.
const MOST: usize = 300;
/// A box is dragged to no less than this, in pixels.
const LEAST_PX: f64 = 1.0;

/// Something that can be dragged.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip {
    /// JSON pointer of what goes elsewhere.
    pub pointer: String,
    /// Where it stands, in pixels of the picture.
    pub at: Point,
    /// Where the vector begins whose end it is; `None` if it is none.
    pub from: Option<Point>,
}

impl Grip {
    /// Whether it is the end of a vector without length, which lies where that begins.
    pub fn is_drawn_in(&self) -> bool {
        self.from == Some(self.at)
    }
}

/// What a grip changes.
enum Of {
    Place,
    /// A vector from there.
    Vector(Point),
    /// Half of a width and of a height, around there.
    Radii(Point),
    /// The numbers x and y beside it.
    Corner,
    /// Width and height from there on.
    Size(Point),
}

/// All that can be dragged of what `selection` is in: a zone, for one, or a shape. Nothing of a layer that is only seen on others: its
/// places are not those of the frame.
pub fn grips(document: &Document, selection: &str) -> Vec<Grip> {
    let layer = Pointer(selection).item_of("/layers").map(|(layer, _)| layer);
    let item = match shape_of(selection) {
        _ if layer.is_some_and(|layer| document.scene().textures().contains(&layer)) => None,
        Some(shape) => Some(shape),
        None => {
            layer_of(document, selection).filter(|(layer, _)| layer.mover().is_some()).and_then(|_| item_of(selection))
        }
    };
    let mut found = Vec::new();
    if let Some((item, place)) = item.and_then(|item| Some((item, Place::of(document.json(), item)?))) {
        collect(place, item, selection, &mut found);
    }
    found
}

/// The fields, and their values, with which what a grip moves goes to a place of the picture; `None` if nothing there can be
/// dragged.
pub fn dragged(document: &Document, pointer: &str, to: Point) -> Option<Vec<(String, Value)>> {
    let (holder, _) = Pointer(pointer).split()?;
    let inside = steps(Place::of(document.json(), holder)?);
    let (_, of) = standing(&inside, holder).into_iter().find(|(grip, _)| grip.pointer == pointer)?;
    let one = |value| vec![(pointer.to_owned(), value)];
    let both = |names: [&str; 2], values: [f64; 2]| {
        names.into_iter().zip(values).map(|(name, value)| (Pointer(holder).join(name), written(value))).collect()
    };
    Some(match of {
        Of::Place => one(pair(to.x, to.y)),
        Of::Vector(from) => one(pair(to.x - from.x, to.y - from.y)),
        Of::Radii(center) => {
            let radius = |far: f64| far.abs().max(LEAST_PX / 2.0);
            one(pair(radius(to.x - center.x), radius(to.y - center.y)))
        }
        Of::Corner => both(["x", "y"], [to.x, to.y]),
        Of::Size(corner) => {
            both(["width", "height"], [to.x - corner.x, to.y - corner.y].map(|side| side.max(LEAST_PX)))
        }
    })
}

/// The shape of the scene that a pointer is in.
fn shape_of(pointer: &str) -> Option<&str> {
    let (_, way) = Pointer(Pointer(pointer).below("/shapes")?).first()?;
    pointer.strip_suffix(way)
}

fn collect(place: Place, at: &str, selection: &str, found: &mut Vec<Grip>) {
    let inside = steps(place);
    let every = inside.len() <= MOST;
    let wanted = |pointer: &str| every || Pointer(selection).is_within(pointer);
    let standing = standing(&inside, at).into_iter().map(|(grip, _)| grip);
    found.extend(standing.filter(|grip| wanted(&grip.pointer)));
    for (token, inner) in inside {
        let pointer = Pointer(at).join(token);
        if wanted(&pointer) {
            collect(inner, &pointer, selection, found);
        }
    }
}

/// What can be dragged of what is directly in the object or the list at `holder`.
fn standing(inside: &[(String, Place)], holder: &str) -> Vec<(Grip, Of)> {
    let in_picture = || inside.iter().filter(|(_, place)| place.shape.unit() == Some("px"));
    let pairs = || in_picture().filter(|(_, place)| matches!(place.shape.body(), Body::Numbers(2)));
    let is_size = |place: &Place| place.shape.range().is_some_and(|(least, _)| least >= 0.0);
    let read = |place: &Place| place.value.and_then(xy).map(|(x, y)| Vec2::new(x, y));
    let is_place = |place: &Place| !place.shape.is_relative() && !is_size(place);
    let here = pairs().find(|(_, place)| is_place(place)).and_then(|(_, place)| read(place)).map(Vec2::to_point);
    let grip = |token: &str, at, from| Grip { pointer: Pointer(holder).join(token), at, from };
    let of_pair = |(token, place): &(String, Place)| {
        let value = read(place)?;
        match is_place(place) {
            true => Some((grip(token, value.to_point(), None), Of::Place)),
            false if is_size(place) => here.map(|center| (grip(token, center + value, None), Of::Radii(center))),
            false => here.map(|from| (grip(token, from + value, Some(from)), Of::Vector(from))),
        }
    };
    let number = |name: &str| in_picture().find(|(token, _)| token == name)?.1.value?.as_f64();
    let corner = number("x").zip(number("y")).map(Point::from);
    let size = number("width").zip(number("height")).map(Vec2::from);
    let of_box = corner.zip(size).map(|(corner, size)| {
        [(grip("x", corner, None), Of::Corner), (grip("width", corner + size, None), Of::Size(corner))]
    });
    pairs().filter_map(of_pair).chain(of_box.into_iter().flatten()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Edit;

    const ZONE: &str = "/layers/0/zones/0";

    fn document(outline: &str, motion: &str) -> Document {
        Document::parse(&format!(
            r#"{{ "plica": 1, "images": {{"a": {{"path": "a.png"}}}},
              "shapes": {{"lid": {{"nodes": [{{"at": [10, 10], "out": [5, 0]}}, {{"at": [30, 10]}}]}}}},
              "layers": [{{ "kind": "picture", "name": "l", "image": "a", "zones": [{{ "name": "z",
                "outline": {outline}, "motion": {motion} }}] }}] }}"#
        ))
        .unwrap()
    }

    fn all(document: &Document, selection: &str) -> Vec<(String, Point, Option<Point>)> {
        grips(document, selection).into_iter().map(|Grip { pointer, at, from }| (pointer, at, from)).collect()
    }

    const BOX: &str = r#"{"kind": "rectangle", "x": 5, "y": 6, "width": 40, "height": 30}"#;
    const ROUND: &str = r#"{"kind": "ellipse", "center": [20, 20], "radii": [9, 7]}"#;
    const CORNERS: &str = r#"{"kind": "polygon", "points": [[1, 2], [30, 2], [30, 40]]}"#;

    type Row = (
        &'static str,
        &'static str,
        &'static str,
        (f64, f64),
        Option<(f64, f64)>,
        (f64, f64),
        &'static str,
        &'static str,
    );

    /// Outline and motion; a grip, where it is and where its vector begins; where it is dragged; what is there then.
    const DRAGGED: &[Row] = &[
        (
            BOX,
            "[]",
            "/outline/x",
            (5.0, 6.0),
            None,
            (8.0, 4.5),
            "/outline",
            r#"{"height":30,"kind":"rectangle","width":40,"x":8,"y":4.5}"#,
        ),
        (
            BOX,
            "[]",
            "/outline/width",
            (45.0, 36.0),
            None,
            (25.0, 2.0),
            "/outline",
            r#"{"height":1,"kind":"rectangle","width":20,"x":5,"y":6}"#,
        ),
        (ROUND, "[]", "/outline/center", (20.0, 20.0), None, (21.0, 22.0), "/outline/center", "[21,22]"),
        (ROUND, "[]", "/outline/radii", (29.0, 27.0), None, (8.0, 20.0), "/outline/radii", "[12,0.5]"),
        (CORNERS, "[]", "/outline/points/2", (30.0, 40.0), None, (29.5, 41.0), "/outline/points/2", "[29.5,41]"),
        (
            BOX,
            r#"[{"tool": "point", "at": [9, 9], "jump": [3, -4]}]"#,
            "/motion/0/jump",
            (12.0, 5.0),
            Some((9.0, 9.0)),
            (9.0, 19.0),
            "/motion/0/jump",
            "[0,10]",
        ),
        (
            BOX,
            r#"[{"tool": "point", "at": [9, 9], "jump": [3, -4]}]"#,
            "/motion/0/at",
            (9.0, 9.0),
            None,
            (9.1, 9.2),
            "/motion/0",
            r#"{"at":[9.1,9.2],"jump":[3,-4],"tool":"point"}"#,
        ),
        (
            BOX,
            r#"[{"tool": "rotate", "center": [9, 9], "degrees": 3}]"#,
            "/motion/0/center",
            (9.0, 9.0),
            None,
            (1.0, 2.0),
            "/motion/0/center",
            "[1,2]",
        ),
        (
            BOX,
            r#"[{"tool": "lasso", "vertices": [{"from": [1, 1], "to": [2, 2]}, {"from": [9, 1], "to": [9, 2]}, {"from": [9, 9], "to": [9, 8]}]}]"#,
            "/motion/0/vertices/2/to",
            (9.0, 8.0),
            None,
            (7.0, 7.0),
            "/motion/0/vertices/2/to",
            "[7,7]",
        ),
    ];

    #[test]
    fn what_has_a_place_is_dragged_by_it() {
        for &(outline, motion, pointer, at, from, to, changed, value) in DRAGGED {
            let document = document(outline, motion);
            let pointer = format!("{ZONE}{pointer}");
            let found = grips(&document, ZONE).into_iter().find(|grip| grip.pointer == pointer).expect(&pointer);
            assert_eq!((found.at, found.from), (at.into(), from.map(Point::from)), "{pointer}");
            let set = dragged(&document, &pointer, to.into()).unwrap().into_iter();
            let set = Edit::all(set.map(|(pointer, value)| Edit::set(&document, &pointer, value)));
            let after = document.apply(&set).unwrap();
            let value: Value = serde_json::from_str(value).unwrap();
            assert_eq!(after.json().pointer(&format!("{ZONE}{changed}")), Some(&value), "{pointer}");
        }
    }

    #[test]
    fn a_zone_shows_all_that_is_in_it_and_nothing_else() {
        let point = r#"{"tool": "point", "at": [9, 9], "jump": [0, 0]}"#;
        let two =
            document(r#"{"kind": "ellipse", "center": [20, 20], "radii": [9, 7]}"#, &format!("[{point}, {point}]"));
        let pointers = |selection| all(&two, selection).into_iter().map(|(pointer, ..)| pointer).collect::<Vec<_>>();
        let of_zone =
            ["/outline/center", "/outline/radii", "/motion/0/at", "/motion/0/jump", "/motion/1/at", "/motion/1/jump"]
                .map(|way| format!("{ZONE}{way}"));
        for selection in [ZONE, "/layers/0/zones/0/motion/1/jump", "/layers/0/zones/0/name"] {
            let mut found = pointers(selection);
            found.sort();
            let mut expected = of_zone.to_vec();
            expected.sort();
            assert_eq!(found, expected, "{selection}");
        }
        assert_eq!(pointers("/shapes/lid"), pointers("/shapes/lid/nodes/1/at"));
        let handles = [(0, "in", true), (0, "out", false), (1, "in", true), (1, "out", true)];
        let of_lid = grips(&two, "/shapes/lid");
        for (node, handle, is_drawn_in) in handles {
            let pointer = format!("/shapes/lid/nodes/{node}/{handle}");
            let grip = of_lid.iter().find(|grip| grip.pointer == pointer).unwrap();
            assert_eq!(grip.is_drawn_in(), is_drawn_in, "{pointer}");
        }
        let drawn = dragged(&two, "/shapes/lid/nodes/1/out", Point::new(33.0, 6.0));
        assert_eq!(drawn, Some(vec![("/shapes/lid/nodes/1/out".into(), serde_json::json!([3, -4]))]));
        for selection in ["", "/layers/0", "/layers/0/zones", "/layers/7/zones/0", "/timeline", "/shapes"] {
            assert!(pointers(selection).is_empty(), "{selection}");
        }
        assert_eq!(dragged(&two, "/layers/0/zones/0/name", Point::ZERO), None);
    }

    #[test]
    fn of_a_long_list_only_what_is_selected_can_be_dragged() {
        let points: Vec<String> = (0..MOST + 1).map(|i| format!(r#"{{"tool": "point", "at": [{i}, 9]}}"#)).collect();
        let many = document(
            r#"{"kind": "rectangle", "x": 5, "y": 6, "width": 40, "height": 30}"#,
            &format!("[{}]", points.join(",")),
        );
        assert_eq!(grips(&many, ZONE).len(), 2);
        assert_eq!(grips(&many, "/layers/0/zones/0/motion/7").len(), 4);
    }
}
