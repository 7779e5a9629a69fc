//! The fill layer as in the document. The doc comments become the help texts of forms and schema.

use kurbo::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::base::color;
use crate::base::geometry::Xy;
use crate::base::pixels::{Rgba, decode};
use crate::base::problem::Problem;
use crate::layers::check;

/// The most stops of a gradient: the shader searches them one by one.
pub const MOST_STOPS: usize = 64;

/// A color or a gradient over the whole frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FillLayer {
    /// Unique among the layers.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The color where there is no gradient: sRGB with straight alpha, #rrggbb or #rrggbbaa.
    #[serde(default = "white")]
    pub color: String,
    /// A gradient in place of the color.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gradient: Option<Gradient>,
}

/// Colors that change along a line and are constant across it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gradient {
    /// Where the line begins; the first color goes on before it.
    #[schemars(extend("unit" = "px"))]
    pub from: Xy,
    /// Where it ends; the last color goes on behind it.
    #[schemars(extend("unit" = "px"))]
    pub to: Xy,
    /// Colors along the line, ascending; between two of them light changes evenly.
    #[schemars(length(min = 1))]
    pub stops: Vec<Stop>,
}

/// A color of a gradient: its place, and the color there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("columns" = ["along", "color"]))]
pub struct Stop(
    /// Its place, as a share of the line.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1"))]
    pub f64,
    /// sRGB with straight alpha: #rrggbb or #rrggbbaa.
    pub String,
);

fn white() -> String {
    "#ffffff".into()
}

impl FillLayer {
    /// The colors that it shows.
    pub fn colors(&self) -> impl Iterator<Item = &str> {
        let stops = self.gradient.iter().flat_map(|gradient| gradient.stops.iter().map(|Stop(_, color)| &**color));
        stops.chain(self.gradient.is_none().then_some(&*self.color))
    }

    /// The checks beyond shape.
    pub fn check(&self) -> Vec<Problem> {
        let mut problems: Vec<Problem> = check::color(&self.color, "/color").into_iter().collect();
        let Some(Gradient { from, to, stops }) = &self.gradient else { return problems };
        if from == to {
            let hint = "give its line a direction, or take a color alone";
            problems.push(Problem::error("/gradient/to", "the gradient ends where it begins").hint(hint));
        }
        if stops.len() > MOST_STOPS {
            let message = format!("{} colors of a gradient, at most {MOST_STOPS} are shown", stops.len());
            problems.push(Problem::error("/gradient/stops", message));
        }
        let at = |i: usize| format!("/gradient/stops/{i}");
        let ascending = check::ascending("places of colors", stops.iter().map(|stop| stop.0), |i| at(i) + "/0");
        let colors = stops.iter().enumerate();
        let colors = colors.filter_map(|(i, stop)| check::color(&stop.1, &(at(i) + "/1")));
        problems.into_iter().chain(ascending).chain(colors).collect()
    }

    /// Colors along a line; only one if there is no gradient. An invalid color counts as transparent.
    pub fn stops(&self) -> Vec<(f64, Rgba)> {
        let light = |text: &str| color::parse(text).map_or([0.0; 4], decode);
        match &self.gradient {
            None => vec![(0.0, light(&self.color))],
            Some(gradient) => gradient.stops.iter().map(|stop| (stop.0, light(&stop.1))).collect(),
        }
    }

    /// Where the line begins, and its direction divided by its length: the point `from + v` is at `axis.dot(v)` along
    /// it.
    pub fn line(&self) -> (Vec2, Vec2) {
        let Some(Gradient { from, to, .. }) = &self.gradient else { return (Vec2::ZERO, Vec2::ZERO) };
        let (from, to) = (Vec2::from((from[0], from[1])), Vec2::from((to[0], to[1])));
        (from, (to - from) / (to - from).hypot2())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        let layer: FillLayer = serde_json::from_str(
            r##"{"name": "f", "color": "red", "gradient": {"from": [1, 2], "to": [1, 2],
                "stops": [[0.5, "#000000"], [0.5, "#00"]]}}"##,
        )
        .unwrap();
        let paths: Vec<String> = layer.check().into_iter().map(|problem| problem.path).collect();
        assert_eq!(paths, ["/color", "/gradient/to", "/gradient/stops/1/0", "/gradient/stops/1/1"]);
    }
}
