//! What explains a waterfall: its flow lines, with a tick every tenth of a second.

use kurbo::Point;

use super::lines::Line;
use super::synth::Synth;
use crate::base::pointer::Pointer;
use crate::layers::parts::marks::{Dot, Look, Mark, Overlay, Shape, View, When};
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::Eye;
use crate::layers::space::marks::{AXES, CAMERA_OVERLAY, FRUSTUM, GRID, GROUND_OVERLAY, line};

const LINES: &str = "view-lines";

/// Every overlay.
pub static OVERLAYS: &[Overlay] =
    &[GROUND_OVERLAY, CAMERA_OVERLAY, Overlay::new(LINES, "S", "The flow lines of waterfalls", When::EveryFrame)];

/// A flow line of water.
static WATER: Look = Look::new("flow line", 28, [120, 200, 255, 160], 1.0).dots(Dot::Disc, 1.5);
/// A line of foam.
static FOAM: Look = Look::new("line of foam", 29, [255, 255, 255, 90], 0.6).dashed(3.0, 2.0);
/// A flow line that starts next to the node which is selected.
static NEXT: Look = Look::new("flow line at the node", 30, [255, 220, 80, 230], 2.0).dots(Dot::Diamond, 2.5);

/// Every look, from bottom to top.
pub static LOOKS: &[&Look] = &[&GRID, &AXES[0], &AXES[1], &AXES[2], &FRUSTUM, &WATER, &FOAM, &NEXT];

/// Pieces of a drawn line.
const PIECES: usize = 24;
/// Seconds from one tick to the next.
const TICK: f64 = 0.1;
/// At most so many lines are drawn, and so many ticks on each.
const MOST: usize = 2000;
const MOST_TICKS: usize = 200;

/// The marks of a layer at one time.
pub fn marks(synth: &Synth, view: &View, moment: &Moment) -> Vec<Mark> {
    let Some(eye) = moment.eye.filter(|_| view.shows(LINES)) else { return Vec::new() };
    let reach = view.selection.as_deref().and_then(|selection| reach(synth, selection));
    let carrying: Vec<&Line> = synth.lines.iter().filter(|line| line.carries()).collect();
    let step = carrying.len().div_ceil(MOST).max(1);
    let next = |line: &Line| !line.foam && reach.as_ref().is_some_and(|reach| reach.contains(&line.place));
    let drawn = carrying.into_iter().step_by(step).flat_map(|line| {
        let (look, path) = if next(line) {
            (&NEXT, "/lip")
        } else if line.foam {
            (&FOAM, "/foam")
        } else {
            (&WATER, "/lip")
        };
        of_line(synth, (moment, &eye), line, (look, path))
    });
    drawn.collect()
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

/// How far along the lip lines are next to the node that is selected.
fn reach(synth: &Synth, selection: &str) -> Option<std::ops::RangeInclusive<f64>> {
    let (node, _) = Pointer(selection).item_of("/lip")?;
    let lip = &synth.values.lip;
    let before = |node: usize| lip.windows(2).take(node).map(|pair| pair[0].at.distance(pair[1].at)).sum::<f64>();
    (node < lip.len()).then(|| before(node.saturating_sub(1))..=before(node + 1))
}
