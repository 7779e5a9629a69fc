//! The layer with everything set: what the document leaves out follows the height of the fall, so that a fall of 50 m
//! looks like one of 2 m without further work.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::drag::Fall;
use super::look::FullLook;
use super::model::{Surge, WaterfallLayer, WindMode};
use super::path::Laws;
use crate::base::maths::{cos, sin};
use crate::base::pointer::Pointer;

/// The gravity of water, in m/s2, whatever that of the layer is.
const EARTH: f64 = 9.81;

/// A layer with everything set.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// The height of the fall, in meters.
    pub height: f64,
    /// The nodes of the lip.
    pub lip: Vec<Node>,
    /// Flow lines.
    pub lines: u32,
    /// How thick the sheet is, in meters.
    pub thickness: f64,
    /// The standard deviation of velocities, in m/s.
    pub spread: f64,
    /// The height of the pool, in meters.
    pub pool: f64,
    /// How far sprites stray: at birth, and more each second.
    pub scatter: [f64; 2],
    /// What acts in the air.
    pub laws: Laws,
    /// Clumps.
    pub surge: Clumps,
    /// Water, then foam.
    pub kinds: [Kind; 2],
    /// Sprites fade over this distance before a surface, in meters.
    pub soft: f64,
}

/// A node of the lip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Where it is.
    pub at: DVec3,
    /// How fast water leaves there.
    pub velocity: DVec3,
    /// How much.
    pub flow: f64,
}

/// Clumps of water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clumps {
    /// Their size along the lip, in meters.
    pub width: f64,
    /// How long one takes to leave it, in seconds.
    pub time: f64,
    /// How empty gaps are.
    pub amount: f64,
    /// How sharply they are told apart.
    pub contrast: f64,
    /// How fast they drift sideways, in m/s.
    pub sway: f64,
}

/// What differs between water and foam.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// Sprites a second on one line.
    pub rate: f64,
    /// The longest life, in seconds.
    pub life: f64,
    /// How they look.
    pub look: FullLook,
}

impl Node {
    /// A node with everything set, of a fall of this height.
    pub fn of(node: &super::model::Node, height: f64) -> Node {
        let velocity = DVec3::new(0.0, 0.0, 0.4 * height / free_fall(height));
        Node { at: node.at.into(), velocity: node.velocity.map_or(velocity, DVec3::from), flow: node.flow }
    }
}

/// How long a free fall from this height takes, in seconds.
fn free_fall(height: f64) -> f64 {
    (2.0 * height / EARTH).sqrt()
}

impl Values {
    /// The layer with everything set.
    pub fn of(layer: &WaterfallLayer) -> Values {
        let highest = layer.lip.iter().map(|node| node.at[1]).fold(f64::NEG_INFINITY, f64::max) - layer.pool;
        let h = layer.height.unwrap_or(if highest > 0.1 { highest } else { 1.0 });
        let free = free_fall(h);
        let lip: Vec<Node> = layer.lip.iter().map(|node| Node::of(node, h)).collect();
        let length: f64 = lip.windows(2).map(|pair| pair[0].at.distance(pair[1].at)).sum();
        let automatic = (120.0 * length / h + 0.5).floor().clamp(24.0, 4000.0) as u32;
        let Surge { amount, contrast, .. } = layer.surge;
        let surge = Clumps {
            width: layer.surge.width.unwrap_or(0.12 * h),
            time: layer.surge.time.unwrap_or(0.4 * free),
            amount,
            contrast,
            sway: layer.surge.sway.unwrap_or(0.05 * h / free),
        };
        let water = Kind {
            rate: layer.rate.unwrap_or(20.0 / free),
            life: layer.life.unwrap_or(8.0 * free),
            look: layer.look.or(FullLook::water(h, free)),
        };
        let foam = Kind {
            rate: layer.foam.rate.unwrap_or(8.0 / free),
            life: layer.foam.life.unwrap_or(3.0 * free),
            look: layer.foam.look.or(FullLook::foam(h)),
        };
        Values {
            height: h,
            lip,
            lines: layer.lines.unwrap_or(automatic),
            thickness: layer.thickness.unwrap_or(0.05 * h),
            spread: layer.spread.unwrap_or(0.03 * h / free),
            pool: layer.pool,
            scatter: layer.scatter.unwrap_or([0.015 * h, 0.05 * h / free]),
            laws: laws(layer),
            surge,
            kinds: [water, foam],
            soft: layer.soft.unwrap_or(0.05 * h),
        }
    }

    /// The number, or numbers, that stand for a field which is not set, by its JSON pointer in the layer.
    pub fn field(&self, path: &str) -> Option<Value> {
        let [water, foam] = &self.kinds;
        if let Some((index, "/velocity")) = Pointer(path).item_of("/lip") {
            return Some(json!(self.lip.get(index)?.velocity.to_array()));
        }
        if let Some(field) = Pointer(path).below("/look") {
            return look(&water.look, field);
        }
        if let Some(field) = Pointer(path).below("/foam/look") {
            return look(&foam.look, field);
        }
        Some(match path {
            "/height" => json!(self.height),
            "/lines" => json!(self.lines),
            "/rate" => json!(water.rate),
            "/life" => json!(water.life),
            "/thickness" => json!(self.thickness),
            "/spread" => json!(self.spread),
            "/scatter" => json!(self.scatter),
            "/surge/width" => json!(self.surge.width),
            "/surge/time" => json!(self.surge.time),
            "/surge/sway" => json!(self.surge.sway),
            "/foam/rate" => json!(foam.rate),
            "/foam/life" => json!(foam.life),
            "/soft" => json!(self.soft),
            _ => return None,
        })
    }
}

fn look(look: &FullLook, field: &str) -> Option<Value> {
    Some(match field {
        "/width" => json!(look.width),
        "/jitter" => json!(look.jitter),
        "/streak" => json!(look.streak),
        "/align" => json!(look.align),
        "/snap" => json!(look.snap),
        "/tilt" => json!(look.tilt),
        "/spin" => json!(look.spin),
        "/mirror" => json!(look.mirror),
        "/opacity" => json!(look.opacity),
        "/fade" => json!(look.fade),
        "/gain" => json!(look.gain),
        _ => return None,
    })
}

fn laws(layer: &WaterfallLayer) -> Laws {
    let angle = layer.wind.angle.to_radians();
    Laws {
        fall: Fall { model: layer.drag.model, amount: layer.drag.amount, gravity: layer.gravity },
        wind: DVec2::new(cos(angle), sin(angle)) * layer.wind.speed,
        rate: (layer.wind.mode == WindMode::Relax).then_some(layer.wind.rate),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(json: &str) -> Values {
        Values::of(&serde_json::from_str(json).unwrap())
    }

    #[test]
    fn what_is_not_set_follows_the_height() {
        let free = |h: f64| (2.0 * h / 9.81).sqrt();
        for (more, height, lines) in [
            ("", 2.0, 120),
            (r#", "height": 1"#, 1.0, 240),
            (r#", "pool": -1"#, 3.0, 80),
            (r#", "pool": 1.95"#, 1.0, 240),
            (r#", "lip": [{"at": [0, 50, 0]}]"#, 50.0, 24),
            (r#", "lip": [{"at": [0, 1, 0]}, {"at": [300, 0, 0]}]"#, 1.0, 4000),
        ] {
            let found = values(&format!(r#"{{"name": "falls"{more}}}"#));
            assert_eq!((found.height, found.lines), (height, lines), "{more}");
            assert_eq!(found.kinds[0].rate, 20.0 / free(height));
            assert_eq!(found.lip[0].velocity.z, 0.4 * height / free(height));
            assert_eq!(found.kinds[1].look.width, [0.06 * height, 0.2 * height]);
        }
    }

    #[test]
    fn every_field_without_a_default_tells_what_stands_for_it() {
        let all = values(r#"{"name": "falls"}"#);
        for path in ["/height", "/lip/1/velocity", "/scatter", "/look/align", "/foam/look/width", "/surge/sway"] {
            assert!(all.field(path).is_some(), "{path}");
        }
        assert_eq!(all.field("/foam/look/opacity"), Some(json!(0.3)));
        assert_eq!(all.field("/lip/2/velocity"), None);
        assert_eq!(all.field("/gravity"), None);
    }
}
