//! What explains a waterfall: its flow lines, with a tick every tenth of a second.

use kurbo::Point;

use super::landing::Fall;
use super::lines::Line;
use super::synth::Synth;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Dot, Look, Mark, Overlay, Shape, View, When};
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::Eye;
use crate::layers::space::marks::{AXES, CAMERA_OVERLAY, FRUSTUM, GRID, GROUND_OVERLAY, line, spot};

const LINES: &str = "view-lines";

/// Every overlay.
pub static OVERLAYS: &[Overlay] =
    &[GROUND_OVERLAY, CAMERA_OVERLAY, Overlay::new(LINES, "L", "The flow lines of waterfalls", When::EveryFrame)];

/// A flow line of water.
static WATER: Look = Look::new("flow line", 28, [120, 200, 255, 160], 1.0).dots(Dot::Disc, 1.5);
/// A line of foam.
static FOAM: Look = Look::new("line of foam", 29, [255, 255, 255, 90], 0.6).dashed(3.0, 2.0);
/// A flow line that starts next to the node which is selected.
static NEXT: Look = Look::new("flow line at the node", 30, [255, 220, 80, 230], 2.0).dots(Dot::Diamond, 2.5);

/// A node of the lip.
static NODE: Look = Look::new("node of the lip", 31, [255, 220, 80, 230], 1.0).dots(Dot::Disc, 3.5);
/// Where the line of a node meets the pool.
static LANDING: Look = Look::new("landing of a node", 32, [255, 150, 60, 255], 1.0).dots(Dot::Square, 3.5).grip();

/// Every look, from bottom to top.
pub static LOOKS: &[&Look] = &[&GRID, &AXES[0], &AXES[1], &AXES[2], &FRUSTUM, &WATER, &FOAM, &NEXT, &NODE, &LANDING];

/// Pieces of a drawn line.
const PIECES: usize = 24;
/// Seconds from one tick to the next.
const TICK: f64 = 0.1;
/// At most so many lines are drawn, and so many ticks on each.
const MOST: usize = 2000;
const MOST_TICKS: usize = 200;
/// So many lines are next to a node.
const NEXT_TO: usize = 6;

/// The marks of a layer at one time.
pub fn marks(synth: &Synth, view: &View, moment: &Moment) -> Vec<Mark> {
    let Some(eye) = moment.eye.filter(|_| view.shows(LINES)) else { return Vec::new() };
    let next_to = view.selection.as_deref().and_then(|selection| next_to(synth, selection));
    let carrying: Vec<&Line> = synth.lines.iter().filter(|line| line.carries()).collect();
    let step = carrying.len().div_ceil(MOST).max(1);
    let next = |line: &Line| !line.foam && next_to.as_ref().is_some_and(|next_to| next_to.contains(&line.place));
    let drawn = carrying.into_iter().step_by(step).flat_map(|line| {
        let (look, path) = if next(line) {
            (&NEXT, "/lip")
        } else if line.foam {
            (&FOAM, "/foam")
        } else {
            // Not the lip: all lines would be bold while a node of it is selected.
            (&WATER, "/lines")
        };
        of_line(synth, (moment, &eye), line, (look, path))
    });
    drawn.chain(of_nodes(synth, moment, &eye)).collect()
}

/// The nodes, and where they land.
fn of_nodes(synth: &Synth, moment: &Moment, eye: &Eye) -> Vec<Mark> {
    let mut marks = Vec::new();
    for (i, node) in synth.values.lip.iter().enumerate() {
        let landing = Fall::new(&synth.values, node).end().map(|(at, _)| (&LANDING, at));
        for (look, at) in std::iter::once((&NODE, node.at)).chain(landing) {
            let dot = spot(moment, eye, at).map(Shape::Dot);
            marks.extend(dot.map(|dot| Mark::new(look, format!("/lip/{i}"), dot)));
        }
    }
    marks
}

/// A line on its own, from a node to where it lands.
pub fn of_fall(fall: &Fall, moment: &Moment) -> Vec<Mark> {
    let Some(eye) = moment.eye else { return Vec::new() };
    let pieces = fall.pieces(PIECES).into_iter().filter_map(|ends| line(moment, &eye, ends));
    let drawn = pieces.map(|points| Mark::new(&NEXT, "/lip", Shape::Line { points: points.into(), closed: false }));
    let end = fall.end().and_then(|(at, _)| spot(moment, &eye, at));
    drawn.chain(end.map(|at| Mark::new(&LANDING, "/lip", Shape::Dot(at)))).collect()
}

fn of_line(synth: &Synth, (moment, eye): (&Moment, &Eye), of: &Line, (look, path): (&'static Look, &str)) -> Vec<Mark> {
    let at = |age: f64| synth.values.laws.at(&of.path, age).0;
    let end = |i: usize| at(of.life * i as f64 / PIECES as f64);
    let mut marks = Vec::new();
    let mut run: Vec<Point> = Vec::new();
    for i in 0..PIECES {
        let Some([a, b]) = line(moment, eye, [end(i), end(i + 1)]) else { continue };
        if run.last() != Some(&a) {
            marks.extend(finished(std::mem::take(&mut run), look, path));
            run.push(a);
        }
        run.push(b);
    }
    marks.extend(finished(run, look, path));
    if !of.foam {
        let ticks = (1..MOST_TICKS).map(|i| TICK * i as f64).take_while(|age| *age < of.life);
        let dots = ticks.filter_map(|age| line(moment, eye, [at(age); 2]));
        marks.extend(dots.map(|[dot, _]| Mark::new(look, path, Shape::Dot(dot))));
    }
    marks
}

fn finished(points: Vec<Point>, look: &'static Look, path: &str) -> Option<Mark> {
    (points.len() > 1).then(|| Mark::new(look, path, Shape::Line { points, closed: false }))
}

/// How far along the lip the lines are that stand out: the [`NEXT_TO`] nearest to the node that is selected.
fn next_to(synth: &Synth, selection: &str) -> Option<std::ops::RangeInclusive<f64>> {
    let (node, _) = Pointer(selection).item_of("/lip")?;
    let lip = &synth.values.lip;
    let own: f64 = lip.windows(2).take(node).map(|pair| pair[0].at.distance(pair[1].at)).sum();
    let water = synth.lines.iter().filter(|line| !line.foam && line.carries());
    let mut away: Vec<f64> = water.map(|line| (line.place - own).abs()).collect();
    away.sort_by(f64::total_cmp);
    let farthest = *away.get(NEXT_TO - 1).or(away.last())?;
    (node < lip.len()).then_some(own - farthest..=own + farthest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::picture::Picture;
    use crate::layers::parts::materials::Materials;
    use crate::layers::ready::Making;
    use crate::layers::space::camera::Camera;
    use crate::layers::timeline::Wrap;
    use std::sync::Arc;

    #[test]
    fn lines_beside_the_selected_node_stand_out_and_nodes_have_grips_where_they_land() {
        let layer = r#"{"name": "f", "spread": 0, "lip": [{"at": [-1, 2, 0]}, {"at": [0, 2, 0]}, {"at": [3, 2, 0]}],
            "sprites": {"size": 16, "sheets": [{"image": "s"}]}}"#;
        let image = Arc::new(Picture::filled(16, 16, [0.5; 4]));
        let materials = Materials { pictures: [("s".to_owned(), image)].into(), ..Materials::default() };
        let layer = serde_json::from_str(layer).unwrap();
        let synth = Synth::new(&layer, &Making::plain(Wrap::Repeat, &materials), None).unwrap();
        let moment = Moment {
            t: 0.0,
            size_px: (200, 100),
            eye: Some(Camera::default().at(0.0, (200, 100))),
            left_out: 0,
            magnified: 1,
        };
        let view = View { selection: Some("/lip/0/at".into()), ..View::of(&[LINES]) };
        let found = marks(&synth, &view, &moment);
        let next: Vec<&Mark> = found.iter().filter(|mark| mark.look.name == NEXT.name).collect();
        let ticks = next.iter().filter(|mark| matches!(mark.shape, Shape::Dot(_))).count();
        let lines = next.len() - ticks;
        // The nearest, and a tick at each tenth of the 0.69 s that they last.
        assert_eq!(lines, NEXT_TO);
        assert_eq!(ticks, 6 * lines);
        assert!(next.iter().all(|mark| &*mark.path == "/lip"));
        let grips: Vec<&str> = found.iter().filter(|mark| mark.look.is_grip).map(|mark| &*mark.path).collect();
        assert_eq!(grips, ["/lip/0", "/lip/1", "/lip/2"]);
        assert_eq!(marks(&synth, &View::default(), &moment), []);
    }
}
