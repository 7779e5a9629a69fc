//! The flow lines: where they start, evenly along the lip but jittered, and the foam that springs from where they end.

use glam::DVec3;
use rayon::prelude::*;

use super::automatic::{Node, Values};
use super::hash::Random;
use super::model::Foam;
use super::path::Path;
use crate::base::geometry;
use crate::base::maths::{TAU, cos, sin};

/// Foam starts so far above the pool, in meters.
const ABOVE: f64 = 1e-6;
/// Lines with a shorter life carry nothing, in seconds.
pub const LEAST_LIFE: f64 = 1e-3;

/// Places of a line that are looked at for where it is.
const PLACES: usize = 16;

/// A flow line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Its number: first all lines from the lip, then those of foam.
    pub number: u32,
    /// Whether it is foam.
    pub foam: bool,
    /// Its path.
    pub path: Path,
    /// How long what it carries lives, in seconds.
    pub life: f64,
    /// How far along the lip it starts, in meters; for foam, how far the line started that it springs from.
    pub place: f64,
}

impl Line {
    /// Whether it carries sprites.
    pub fn carries(&self) -> bool {
        self.life >= LEAST_LIFE
    }
}

/// All lines, in the order of their numbers.
pub fn lines(values: &Values, foam: &Foam, random: Random) -> Vec<Line> {
    let mut all = water(values, random);
    let count = foam.lines as usize;
    let springing = (0..all.len() * count).into_par_iter();
    let springing: Vec<Line> =
        springing.map(|i| spring(values, foam, &all[i / count], (i % count) as u32, random)).collect();
    all.extend(springing);
    all
}

/// How far all lines reach along each of these ways, as wide as what they carry.
pub fn reach(values: &Values, lines: &[Line], ways: &[DVec3]) -> Option<Vec<f64>> {
    let of_kind = |foam: bool| {
        let wide = values.kinds[usize::from(foam)].look.widest() / 2.0;
        let places = lines.par_iter().filter(|line| line.foam == foam && line.carries()).flat_map_iter(|line| {
            (0..=PLACES).map(|i| values.laws.at(&line.path, line.life * i as f64 / PLACES as f64).0)
        });
        let far = geometry::reach(places, ways)?;
        Some(far.into_iter().zip(ways).map(|(far, way)| far + wide * way.length()).collect())
    };
    [false, true].into_iter().filter_map(of_kind).reduce(geometry::farther)
}

/// Those from the lip.
pub fn water(values: &Values, random: Random) -> Vec<Line> {
    let lip = Lip::new(&values.lip);
    (0..values.lines).into_par_iter().map(|number| falling(values, &lip, number, random)).collect()
}

fn falling(values: &Values, lip: &Lip, number: u32, random: Random) -> Line {
    let jitter = random.of(number, 0, 1);
    let spread = [2, 3, 4].map(|component| values.spread * random.bell(number, 0, component));
    let (at, velocity, place) = lip.start(f64::from(number), f64::from(values.lines), values.thickness, jitter);
    let path = Path { start: at, velocity: velocity + DVec3::from(spread) };
    let life = values.laws.life(&path, values.pool, values.kinds[0].life);
    Line { number, foam: false, path, life, place }
}

fn spring(values: &Values, foam: &Foam, from: &Line, k: u32, random: Random) -> Line {
    let number = values.lines + from.number * foam.lines + k;
    let [x, y, z, _] = random.of(number, 0, 1);
    let (end, impact) = values.laws.at(&from.path, from.life);
    let azimuth = TAU * (f64::from(k) + x) / f64::from(foam.lines);
    let elevation = (foam.elevation + foam.fan * (2.0 * y - 1.0)).to_radians();
    let speed = foam.restitution * impact.length() * (0.5 + z);
    let level = cos(elevation);
    let way = DVec3::new(level * cos(azimuth), sin(elevation), level * sin(azimuth));
    let path = Path { start: DVec3::new(end.x, values.pool + ABOVE, end.z), velocity: way * speed };
    let met = from.life > 0.0 && from.life < values.kinds[0].life;
    let life =
        if met && path.velocity.y > 0.0 { values.laws.life(&path, values.pool, values.kinds[1].life) } else { 0.0 };
    Line { number, foam: true, path, life, place: from.place }
}

/// The lip as pieces between nodes.
struct Lip<'a> {
    nodes: &'a [Node],
    /// For each piece, how much flows from before its end, and how far along the lip it begins.
    pieces: Vec<(f64, f64)>,
}

impl<'a> Lip<'a> {
    fn new(nodes: &'a [Node]) -> Self {
        let (mut flow, mut along) = (0.0, 0.0);
        let pieces = nodes.windows(2).map(|pair| {
            let length = pair[0].at.distance(pair[1].at);
            flow += length * (pair[0].flow + pair[1].flow) / 2.0;
            along += length;
            (flow, along - length)
        });
        Lip { nodes, pieces: pieces.collect() }
    }

    /// Where line `number` of `count` starts, how fast, and how far along the lip.
    fn start(&self, number: f64, count: f64, thickness: f64, [x, y, z, _]: [f64; 4]) -> (DVec3, DVec3, f64) {
        let total = self.pieces.last().map_or(0.0, |(flow, _)| *flow);
        if total <= 0.0 {
            let first = self.nodes[0];
            let radius = thickness / 2.0 * y.sqrt();
            let disc = DVec3::new(cos(TAU * z), 0.0, sin(TAU * z)) * radius;
            return (first.at + disc, first.velocity, 0.0);
        }
        let wanted = (number + x) * total / count;
        let i = self.pieces.partition_point(|(flow, _)| *flow < wanted).min(self.pieces.len() - 1);
        let before = i.checked_sub(1).map_or(0.0, |before| self.pieces[before].0);
        let (a, b) = (self.nodes[i], self.nodes[i + 1]);
        let length = a.at.distance(b.at);
        let share = share_of((wanted - before) / length, a.flow, b.flow);
        let way = (b.at - a.at) / length;
        let across = DVec3::new(way.z, 0.0, -way.x).try_normalize().unwrap_or(DVec3::Z);
        let at = a.at.lerp(b.at, share) + across * (thickness * (y - 0.5));
        (at, a.velocity.lerp(b.velocity, share), self.pieces[i].1 + share * length)
    }
}

/// The share of a piece at which `amount` has flowed, if the flow changes evenly from `a` to `b`.
fn share_of(amount: f64, a: f64, b: f64) -> f64 {
    let root = (a * a + 2.0 * (b - a) * amount).max(0.0).sqrt();
    if a + root > 0.0 { (2.0 * amount / (a + root)).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::waterfall::model::WaterfallLayer;

    fn all(json: &str) -> (Values, Vec<Line>) {
        let layer: WaterfallLayer = serde_json::from_str(json).unwrap();
        let values = Values::of(&layer);
        let lines = lines(&values, &layer.foam, Random(layer.seed));
        (values, lines)
    }

    #[track_caller]
    fn near(found: DVec3, wanted: [f64; 3]) {
        assert!((found - DVec3::from(wanted)).length() < 2e-9, "{found} {wanted:?}");
    }

    #[test]
    fn the_default_layer_has_the_checked_lines() {
        let (values, lines) = all(r#"{"name": "falls"}"#);
        let first = lines[0];
        near(first.path.start, [-0.998_267_099, 2.0, 0.016_910_458]);
        near(first.path.velocity, [-0.148_910_724, 0.071_239_667, 1.360_116_955]);
        assert!((first.life - 0.689_358_214).abs() < 1e-9);
        near(values.laws.at(&first.path, first.life).0, [-1.100_919_930, 0.0, 0.954_518_253]);
        let foam = lines[120];
        near(foam.path.velocity, [2.301_567_572, 1.270_031_350, 0.447_804_010]);
        assert!((foam.life - 0.252_550_972).abs() < 1e-9);
        assert_eq!((lines.len(), foam.number, foam.foam, foam.place), (720, 120, true, first.place));
    }

    #[test]
    fn lines_start_where_water_flows() {
        let lip =
            r#"[{"at": [0, 2, 0], "flow": 0}, {"at": [1, 2, 0]}, {"at": [1, 2, 0]}, {"at": [3, 2, 0], "flow": 0}]"#;
        let (_, lines) = all(&format!(r#"{{"name": "falls", "lines": 3000, "thickness": 0, "lip": {lip}}}"#));
        let at = |x: f64| lines[..3000].iter().filter(|line| line.path.start.x < x).count();
        // A triangle of flow: a third of it before the second node, a quarter of that before half way.
        for (x, share) in [(0.5, 1.0 / 12.0), (1.0, 1.0 / 3.0), (2.0, 1.0 - 2.0 / 3.0 / 4.0), (3.0, 1.0)] {
            assert!((at(x) as f64 / 3000.0 - share).abs() < 1e-3, "{x}: {}", at(x));
        }
        assert!(lines[..3000].iter().all(|line| (line.place - line.path.start.x).abs() < 1e-12));
    }

    #[test]
    fn a_point_source_is_a_disc_and_a_vertical_lip_a_sheet() {
        for lip in [r#"[{"at": [1, 2, 3]}]"#, r#"[{"at": [1, 2, 3]}, {"at": [1, 2, 3]}]"#] {
            let (_, lines) = all(&format!(r#"{{"name": "f", "lines": 50, "thickness": 0.5, "lip": {lip}}}"#));
            let far: Vec<f64> =
                lines[..50].iter().map(|line| line.path.start.distance(DVec3::new(1.0, 2.0, 3.0))).collect();
            assert!(far.iter().all(|far| *far <= 0.25) && far.iter().any(|far| *far > 0.2), "{lip}");
            assert!(lines.iter().all(|line| line.place == 0.0));
        }
        let (_, lines) = all(r#"{"name": "f", "lip": [{"at": [0, 1, 0]}, {"at": [0, 2, 0]}]}"#);
        assert!(lines[..24].iter().all(|line| line.path.start.x == 0.0 && line.path.start.z.abs() <= 0.05));
    }

    #[test]
    fn foam_keeps_its_numbers_where_none_springs_up() {
        let (_, lines) = all(r#"{"name": "smoke", "gravity": -1, "lines": 4, "foam": {"lines": 3}}"#);
        let numbers: Vec<u32> = lines.iter().map(|line| line.number).collect();
        assert_eq!(numbers, (0..16).collect::<Vec<_>>());
        assert!(lines[4..].iter().all(|line| line.foam && line.life == 0.0));
    }
}
