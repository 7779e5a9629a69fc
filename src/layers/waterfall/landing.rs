//! Where the line from a node of the lip ends, and the velocity with which it ends as wanted. The line is that of the node
//! itself, without thickness and spread. Vertical and level motion are independent of one another, so the place where it
//! lands is solved in closed form.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::automatic::{Node, Values};
use super::lines::LEAST_LIFE;
use super::model::{self, WaterfallLayer};
use super::path::{Laws, Path, first};
use crate::base::pointer::Pointer;
use crate::base::text::short;
use crate::layers::parts::derived::Derived;
use crate::layers::parts::goal::Goal;
use crate::layers::space::eye::Ray;

const fn column(name: &'static str, unit: &'static str, help: &'static str) -> Derived {
    Derived { name, of: "velocity", unit, help }
}

const SPEED: Derived =
    column("speed", "m/s", "How fast water leaves the node. A new speed keeps the direction of the velocity.");
const LAND_X: Derived = column(
    "land x",
    "m",
    "Where the line of the node meets the pool: x. A new place changes vx, and keeps the air time.",
);
const LAND_Z: Derived = column(
    "land z",
    "m",
    "Where the line of the node meets the pool: z. A new place changes vz, and keeps the air time.",
);
const AIR_TIME: Derived =
    column("air time", "s", "How long the line of the node takes to the pool. A new time changes vy alone.");
const IMPACT: Derived = column(
    "impact",
    "m/s",
    "How fast the line of the node meets the pool. A new speed changes vx and vz, and keeps the air time.",
);

/// The columns that tell of a landing.
static OF_LANDING: &[Derived] = &[LAND_X, LAND_Z, AIR_TIME];

/// The columns of the lip that follow from its nodes.
pub static COLUMNS: &[Derived] = &[SPEED, LAND_X, LAND_Z, AIR_TIME, IMPACT];

/// No water is thrown faster than this, in m/s.
const FASTEST: f64 = 1e6;
/// Decimals in messages.
const DECIMALS: usize = 3;

/// The line of one node.
pub struct Fall {
    laws: Laws,
    path: Path,
    pool: f64,
    /// The longest life, in seconds.
    most: f64,
}

impl Fall {
    /// The line of a node as it is in the document; `None` if it is none.
    pub fn of(layer: &WaterfallLayer, node: &Value) -> Option<Fall> {
        let values = Values::of(layer);
        let node: model::Node = serde_json::from_value(node.clone()).ok()?;
        Some(Fall::new(&values, &Node::of(&node, values.height)))
    }

    /// The line of a node.
    pub fn new(values: &Values, node: &Node) -> Fall {
        let path = Path { start: node.at, velocity: node.velocity };
        Fall { laws: values.laws, path, pool: values.pool, most: values.kinds[0].life }
    }

    /// How long it takes to the pool; `None` if it never meets it.
    fn air_time(&self) -> Option<f64> {
        let life = self.laws.life(&self.path, self.pool, self.most);
        (LEAST_LIFE..self.most).contains(&life).then_some(life)
    }

    /// So many pieces of it, from one end to the other; nothing if it never meets the pool.
    pub fn pieces(&self, count: usize) -> Vec<[DVec3; 2]> {
        let Some(life) = self.air_time() else { return Vec::new() };
        let at = |i: usize| self.laws.at(&self.path, life * i as f64 / count as f64).0;
        (0..count).map(|i| [at(i), at(i + 1)]).collect()
    }

    /// Where it lands, and how fast.
    pub fn end(&self) -> Option<(DVec3, DVec3)> {
        Some(self.laws.at(&self.path, self.air_time()?))
    }

    /// The number in a column; `None` if it never meets the pool.
    pub fn value(&self, column: &Derived) -> Option<f64> {
        match column.name {
            name if name == SPEED.name => Some(self.path.velocity.length()),
            name if name == LAND_X.name => Some(self.end()?.0.x),
            name if name == LAND_Z.name => Some(self.end()?.0.z),
            name if name == AIR_TIME.name => self.air_time(),
            _ => Some(self.end()?.1.length()),
        }
    }

    /// The velocity with which it has this number in a column.
    ///
    /// # Errors
    /// Why there is none.
    pub fn solved(&self, column: &Derived, to: f64) -> Result<DVec3, String> {
        let velocity = match column.name {
            name if name == SPEED.name => self.faster(to),
            name if name == LAND_X.name => self.landing(Some(to), None),
            name if name == LAND_Z.name => self.landing(None, Some(to)),
            name if name == AIR_TIME.name => self.thrown(to),
            _ => self.hitting(to),
        }?;
        let possible = velocity.is_finite() && velocity.abs().max_element() <= FASTEST;
        possible.then_some(velocity).ok_or_else(|| format!("no velocity gives the line this {}", column.name))
    }

    /// The velocity with which it lands there; what is not given stays.
    ///
    /// # Errors
    /// It never meets the pool.
    pub fn landing(&self, x: Option<f64>, z: Option<f64>) -> Result<DVec3, String> {
        let (Laws { wind, .. }, Path { start, velocity }) = (self.laws, self.path);
        let age = self.met()?;
        let reaching = |from: f64, to: f64, wind: f64| self.laws.reaching(to - from, wind, age);
        Ok(DVec3::new(
            x.map_or(velocity.x, |x| reaching(start.x, x, wind.x)),
            velocity.y,
            z.map_or(velocity.z, |z| reaching(start.z, z, wind.y)),
        ))
    }

    fn met(&self) -> Result<f64, String> {
        let told = || {
            let pool = short(self.pool, DECIMALS);
            format!("the line of this node never meets the pool (y {pool}): change its air time or vy first")
        };
        self.air_time().ok_or_else(told)
    }

    fn faster(&self, to: f64) -> Result<DVec3, String> {
        match self.path.velocity.try_normalize() {
            _ if to < 0.0 => Err("a speed is at least 0".into()),
            None => Err("a velocity of 0 has no direction: set vx, vy or vz first".into()),
            Some(way) => Ok(way * to),
        }
    }

    fn thrown(&self, to: f64) -> Result<DVec3, String> {
        if !(LEAST_LIFE..self.most).contains(&to) {
            let (least, most) = (short(LEAST_LIFE, DECIMALS), short(self.most, DECIMALS));
            return Err(format!("an air time is at least {least} s, and less than the life of {most} s"));
        }
        let way = self.pool - self.path.start.y;
        // The faster it is thrown up, the higher it is then.
        let far = |v: f64| self.laws.fall.after(v, to)[0] >= way;
        let reach = std::iter::successors(Some(1.0), |reach| Some(reach * 2.0)).take_while(|reach| *reach <= FASTEST);
        let mut found = reach.filter(|reach| far(*reach) && !far(-reach)).map(|reach| first([-reach, reach], far));
        let velocity = found.next().map(|y| DVec3 { y, ..self.path.velocity });
        let comes_down = |velocity: &DVec3| {
            let path = Path { velocity: *velocity, ..self.path };
            (self.laws.life(&path, self.pool, self.most) - to).abs() < 1e-6
        };
        velocity.filter(comes_down).ok_or_else(|| "no velocity gives the line this air time".into())
    }

    fn hitting(&self, to: f64) -> Result<DVec3, String> {
        let age = self.met()?;
        let (_, end) = self.laws.at(&self.path, age);
        let level = to * to - end.y * end.y;
        if to < 0.0 || level < 0.0 {
            let least = short(end.y.abs(), DECIMALS);
            return Err(format!("it comes down at {least} m/s: its impact is at least that (more, or lower vy)"));
        }
        let way = DVec2::new(end.x, end.z).try_normalize();
        let way = way.ok_or("it comes straight down: set vx or vz first")? * level.sqrt();
        let becoming = |v: f64, wind: f64| self.laws.becoming(v, wind, age);
        let Laws { wind, .. } = self.laws;
        Ok(DVec3::new(becoming(way.x, wind.x), self.path.velocity.y, becoming(way.y, wind.y)))
    }
}

/// The velocity with which the line of the node at `path` ends where a ray meets the pool, and its path.
///
/// # Errors
/// There is no node, or its line or the ray never meets the pool.
pub fn aimed(layer: &WaterfallLayer, path: &str, ray: &Ray) -> Result<(String, Value), String> {
    let values = Values::of(layer);
    let (index, node) = node(&values, path)?;
    let missed = || format!("the pool (y {}) is not seen there", short(values.pool, DECIMALS));
    let at = ray.meets_level(values.pool).ok_or_else(missed)?;
    let velocity = Fall::new(&values, node).landing(Some(at.x), Some(at.z))?;
    Ok((format!("/lip/{index}/velocity"), json!(velocity.to_array())))
}

/// The line of the node at `path` if it ended where a ray meets the pool; `None` if it cannot.
pub fn would_fall(layer: &WaterfallLayer, path: &str, ray: &Ray) -> Option<Fall> {
    let values = Values::of(layer);
    let (_, node) = node(&values, path).ok()?;
    let at = ray.meets_level(values.pool)?;
    let velocity = Fall::new(&values, node).landing(Some(at.x), Some(at.z)).ok()?;
    Some(Fall::new(&values, &Node { velocity, ..*node }))
}

/// Where the line of the node at `path` ends.
///
/// # Errors
/// There is no node.
pub fn goal(layer: &WaterfallLayer, path: &str) -> Result<Goal, String> {
    let values = Values::of(layer);
    let (_, node) = node(&values, path)?;
    let at = Fall::new(&values, node).end().map(|(at, _)| at);
    Ok(Goal { at, level: values.pool, told: OF_LANDING })
}

/// The node at `path`, and its number.
fn node<'a>(values: &'a Values, path: &str) -> Result<(usize, &'a Node), String> {
    let found = Pointer(path).item_of("/lip").and_then(|(index, _)| Some((index, values.lip.get(index)?)));
    found.ok_or_else(|| "only nodes of the lip land: select one (w, b)".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::space::camera::Camera;
    use crate::layers::tests::words;
    use crate::layers::waterfall::model::{DragModel, WindMode};

    fn layer(more: &Value) -> WaterfallLayer {
        let mut json = json!({ "name": "falls" });
        json.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        serde_json::from_value(json).unwrap()
    }

    const NODE: &str = r#"{"at": [0.3, 2, -0.2], "velocity": [0.4, 0.7, 1.1]}"#;

    #[test]
    fn what_is_solved_for_comes_out() {
        let node: Value = serde_json::from_str(NODE).unwrap();
        for model in words::<DragModel>() {
            for wind in words::<WindMode>() {
                for rate in [0.0, 0.6, 4.0] {
                    let layer = layer(&json!({
                        "drag": { "model": model, "amount": 0.5 },
                        "wind": { "speed": 1.5, "angle": 30, "mode": wind, "rate": rate }
                    }));
                    for (column, wanted) in COLUMNS.iter().flat_map(|column| match column.name {
                        "speed" => [0.2, 7.0].map(|to| (column, to)),
                        "air time" => [0.3, 1.9].map(|to| (column, to)),
                        "impact" => [6.8, 12.5].map(|to| (column, to)),
                        _ => [-1.25, 3.0].map(|to| (column, to)),
                    }) {
                        let velocity = Fall::of(&layer, &node).unwrap().solved(column, wanted).unwrap();
                        let mut node = node.clone();
                        node["velocity"] = json!(velocity.to_array());
                        let found = Fall::of(&layer, &node).unwrap().value(column).unwrap();
                        assert!((found - wanted).abs() < 1e-9, "{model} {wind} {rate}: {} {found}", column.name);
                    }
                }
            }
        }
    }

    #[test]
    fn a_landing_keeps_the_air_time_and_an_air_time_the_rest_of_the_velocity() {
        let node: Value = serde_json::from_str(NODE).unwrap();
        let fall = Fall::of(&layer(&json!({})), &node).unwrap();
        let landed = fall.solved(&LAND_X, 5.0).unwrap();
        assert_eq!((landed.y, landed.z), (0.7, 1.1));
        let thrown = fall.solved(&AIR_TIME, 1.0).unwrap();
        assert_eq!((thrown.x, thrown.z), (0.4, 1.1));
        assert!(thrown.y > 0.7, "it flies longer than before");
        assert_eq!(fall.solved(&IMPACT, 9.0).unwrap().y, 0.7);
    }

    #[test]
    fn a_node_lands_where_a_ray_meets_the_pool() {
        let layer = layer(&json!({ "lip": [{ "at": [-1, 2, 0] }, { "at": [1, 2, 0] }], "pool": -0.5 }));
        let eye = Camera::default().at(0.0, (200, 100));
        let place = DVec3::new(0.7, -0.5, 0.4);
        let ray = eye.ray_in_world(eye.project(eye.seen(place)));
        let (path, velocity) = aimed(&layer, "/lip/1/at", &ray).unwrap();
        assert_eq!(path, "/lip/1/velocity");
        let landed = Fall::of(&layer, &json!({ "at": [1, 2, 0], "velocity": velocity })).unwrap().end().unwrap().0;
        assert!((landed - place).length() < 1e-9, "{landed}");
        let fall = would_fall(&layer, "/lip/1", &ray).unwrap();
        let pieces = fall.pieces(4);
        assert!((pieces[3][1] - place).length() < 1e-9 && pieces[0][0] == DVec3::new(1.0, 2.0, 0.0), "{pieces:?}");
        assert!(pieces.windows(2).all(|pair| pair[0][1] == pair[1][0]) && pieces.len() == 4);
        let sky = eye.ray_in_world(DVec2::new(100.0, -100.0));
        assert!(would_fall(&layer, "/lip/1", &sky).is_none());
        assert!(aimed(&layer, "/lip/1", &sky).unwrap_err().contains("the pool (y -0.5) is not seen there"));
        for path in ["/lip", "/lip/2", "/look"] {
            assert!(aimed(&layer, path, &ray).unwrap_err().contains("select one"), "{path}");
        }
    }

    #[test]
    fn a_node_without_a_velocity_has_the_automatic_one() {
        let fall = Fall::of(&layer(&json!({})), &json!({ "at": [0, 2, 0] })).unwrap();
        let speed = fall.value(&SPEED).unwrap();
        assert!((speed - 0.8 / (4.0_f64 / 9.81).sqrt()).abs() < 1e-12, "{speed}");
    }

    #[test]
    fn what_has_no_answer_is_refused_with_the_reason() {
        let (smoke, low) = (json!({ "gravity": -1.2 }), json!({ "pool": 3 }));
        let (still, up) = (json!({ "at": [0, 2, 0], "velocity": [0, 0, 0] }), json!({ "at": [0, 2, 0] }));
        for (more, node, column, to, why) in [
            (&smoke, &up, &LAND_X, 1.0, "never meets the pool (y 0)"),
            (&low, &up, &IMPACT, 9.0, "never meets the pool (y 3)"),
            (&json!({}), &still, &SPEED, 1.0, "no direction"),
            (&json!({}), &up, &SPEED, -1.0, "at least 0"),
            (&json!({}), &up, &IMPACT, 3.0, "at least that"),
            (&json!({}), &still, &IMPACT, 9.0, "straight down"),
            (&json!({}), &up, &AIR_TIME, 60.0, "life of 5.108 s"),
            (&json!({}), &up, &AIR_TIME, 0.0, "at least 0.001 s"),
            (&low, &up, &AIR_TIME, 0.01, "no velocity"),
        ] {
            let told = Fall::of(&layer(more), node).unwrap().solved(column, to).unwrap_err();
            assert!(told.contains(why), "{} {to}: {told}", column.name);
        }
        assert_eq!(Fall::of(&layer(&smoke), &up).unwrap().value(&AIR_TIME), None);
        assert!(Fall::of(&layer(&smoke), &json!({ "at": 7 })).is_none());
    }
}
