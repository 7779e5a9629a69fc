//! Folding: where along its path a sampler is active, and where it waits (docs/folding.md, section 3).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::outline::Outline;

/// Where one part of the picture slides over another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Fold {
    /// An eyelid over an eyeball: inside a region a sampler waits at the edge where it entered; one that never left keeps still.
    #[schemars(extend("formula" = "outside e(s) = s; inside e(s) = the crossing nearest to s where it came in; still if it never was outside"))]
    Cover {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A sampler is still inside a region and active outside.
    #[schemars(extend("formula" = "e(s) = s outside every region; still inside"))]
    Return {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A car past a wall: a sampler is active inside a region and still outside.
    #[schemars(extend("formula" = "e(s) = s inside a region; still outside"))]
    FlyOver {
        /// The regions, which count as their union.
        #[schemars(length(min = 1))]
        regions: Vec<Outline>,
    },
    /// A copy of the picture whose alpha is 0 in the fold regions; samplers read it, laid over what is beneath.
    #[schemars(extend("formula" = "shown = mask(q + s J) over what lies beneath"))]
    Mask {
        /// Name of the mask, one of the scene's images, of the picture's size.
        #[schemars(extend("reference" = "images"))]
        image: String,
    },
}

impl Fold {
    /// The name of the mask, if it is one.
    pub fn mask(&self) -> Option<&str> {
        match self {
            Fold::Mask { image } => Some(image),
            Fold::Cover { .. } | Fold::Return { .. } | Fold::FlyOver { .. } => None,
        }
    }

    /// The rule, as in the document.
    pub fn name(&self) -> &'static str {
        match self {
            Fold::Cover { .. } => "cover",
            Fold::Return { .. } => "return",
            Fold::FlyOver { .. } => "fly-over",
            Fold::Mask { .. } => "mask",
        }
    }

    /// The same, to be changed.
    pub fn regions_mut(&mut self) -> &mut [Outline] {
        match self {
            Fold::Cover { regions } | Fold::Return { regions } | Fold::FlyOver { regions } => regions,
            Fold::Mask { .. } => &mut [],
        }
    }

    /// The fold regions; empty for a mask.
    pub fn regions(&self) -> &[Outline] {
        match self {
            Fold::Cover { regions } | Fold::Return { regions } | Fold::FlyOver { regions } => regions,
            Fold::Mask { .. } => &[],
        }
    }
}

/// A fold rule that works by regions (docs/folding.md, section 3). A mask needs none: it is only a different source to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Inside a region a sampler waits at the edge where it entered.
    Cover,
    /// Still inside a region.
    Return,
    /// Still outside every region.
    FlyOver,
}

/// What the rules by regions do, for whoever writes a player.
pub const IN_WORDS: &str = "return is active outside, fly-over inside, with e = s; cover is active outside with e = s, and inside with e = the last crossing passed, or still if none was; a pixel that is not active shows what lies beneath";

impl Rule {
    /// The number by which frame.wgsl knows it; 0 is no rule.
    pub fn number(self) -> u32 {
        match self {
            Rule::Cover => 1,
            Rule::Return => 2,
            Rule::FlyOver => 3,
        }
    }

    /// Whether a sampler whose init-position is in a region moves from there.
    pub fn moves_inside(self) -> bool {
        match self {
            Rule::FlyOver => true,
            Rule::Cover | Rule::Return => false,
        }
    }

    /// Whether a sampler that comes into a region stays shown, at the edge where it entered.
    pub fn waits(self) -> bool {
        match self {
            Rule::Cover => true,
            Rule::Return | Rule::FlyOver => false,
        }
    }

    /// The place that a probe reports for a sampler that is still at `s`: where it stays is its init-position, unless the
    /// rule only hides it on its way.
    pub fn still_place(self, s: f64) -> f64 {
        match self {
            Rule::Cover => 0.0,
            Rule::Return | Rule::FlyOver => s,
        }
    }

    /// The effective place e(s) of an active sampler; `None` if it is still. `inside` says whether the init-position is
    /// in a region; `crossings` are the places where that changes, on the same side of 0 as s, from 0 outwards. Exactly
    /// on a crossing, the state on the side of 0 applies.
    pub fn effective(self, inside: bool, crossings: &[f64], s: f64) -> Option<f64> {
        let crossed = crossings.iter().take_while(|c| c.abs() < s.abs()).count();
        let inside = inside ^ (crossed % 2 == 1);
        match (self, inside) {
            (Rule::Cover, false) | (Rule::Return, false) | (Rule::FlyOver, true) => Some(s),
            (Rule::Return, true) | (Rule::FlyOver, false) => None,
            (Rule::Cover, true) => crossed.checked_sub(1).map(|last| crossings[last]),
        }
    }
}

impl Fold {
    /// The rule by regions; `None` for a mask.
    pub fn rule(&self) -> Option<Rule> {
        match self {
            Fold::Cover { .. } => Some(Rule::Cover),
            Fold::Return { .. } => Some(Rule::Return),
            Fold::FlyOver { .. } => Some(Rule::FlyOver),
            Fold::Mask { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::layers::tests::variants;

    /// A fold of this rule, with one region or a mask.
    fn fold(rule: &str) -> Fold {
        let region = json!({ "kind": "rectangle", "x": 0, "y": 0, "width": 9, "height": 9 });
        let [regions, mask] = [json!({ "rule": rule, "regions": [region] }), json!({ "rule": rule, "image": "a" })]
            .map(serde_json::from_value);
        regions.or(mask).unwrap()
    }

    #[test]
    fn a_rule_has_the_name_of_the_document_and_facts_that_fit_it() {
        let mut numbers = Vec::new();
        for name in variants::<Fold>("rule") {
            assert_eq!(fold(&name).name(), name);
            let Some(rule) = fold(&name).rule() else { continue };
            assert_eq!(rule.effective(true, &[], 0.3).is_some(), rule.moves_inside(), "{name}");
            assert_eq!(rule.effective(false, &[], 0.3).is_some(), !rule.moves_inside(), "{name}");
            assert_eq!(rule.effective(false, &[0.4], 0.6) == Some(0.4), rule.waits(), "{name}");
            assert!(IN_WORDS.contains(&format!("{name} is")) || IN_WORDS.contains(&format!("{name} inside")), "{name}");
            numbers.push(rule.number());
        }
        assert_eq!(numbers, (1..=numbers.len() as u32).collect::<Vec<_>>(), "0 is no rule");
    }

    #[test]
    fn rules_follow_the_table() {
        let (none, some) = (None, Some);
        for (rule, inside, crossings, s, effective) in [
            (Rule::Cover, false, &[0.4, 0.8][..], 0.3, some(0.3)),
            (Rule::Cover, false, &[0.4, 0.8], 0.4, some(0.4)),
            (Rule::Cover, false, &[0.4, 0.8], 0.6, some(0.4)),
            (Rule::Cover, false, &[0.4, 0.8], 0.8, some(0.4)),
            (Rule::Cover, false, &[0.4, 0.8], 0.9, some(0.9)),
            (Rule::Cover, true, &[0.5], 0.5, none),
            (Rule::Cover, true, &[0.5], 0.6, some(0.6)),
            (Rule::Cover, true, &[0.5, 0.7], 0.9, some(0.7)),
            (Rule::Cover, true, &[], 0.9, none),
            (Rule::Cover, false, &[-0.4], -0.6, some(-0.4)),
            (Rule::Cover, true, &[-0.4], -0.4, none),
            (Rule::Return, false, &[0.4, 0.8], 0.4, some(0.4)),
            (Rule::Return, false, &[0.4, 0.8], 0.6, none),
            (Rule::Return, false, &[0.4, 0.8], 0.9, some(0.9)),
            (Rule::FlyOver, false, &[0.4, 0.8], 0.4, none),
            (Rule::FlyOver, false, &[0.4, 0.8], 0.8, some(0.8)),
            (Rule::FlyOver, false, &[0.4, 0.8], 0.9, none),
            (Rule::FlyOver, true, &[], -2.0, some(-2.0)),
            (Rule::Cover, true, &[0.0, 0.5], 0.7, some(0.5)),
            (Rule::Return, true, &[0.0], 0.0, none),
            (Rule::Return, true, &[0.0], 0.1, some(0.1)),
        ] {
            assert_eq!(rule.effective(inside, crossings, s), effective, "{rule:?} {inside} {crossings:?} {s}");
        }
    }
}
