//! Where a position function is not smooth: where s jumps, and where it bends.

use serde::Serialize;

use super::position::{Pieces, Position, Segment};
use crate::layers::keyframes::Between;

/// A jump in s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Break {
    /// Local time τ of the jump.
    pub tau: f64,
    /// Which side's value applies at exactly that τ.
    pub holds: Side,
}

/// A side of a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The one before.
    Before,
    /// The one after.
    After,
}

impl Position {
    /// Where s jumps, ascending in τ.
    pub fn breaks(&self) -> Vec<Break> {
        match self.pieces() {
            Pieces::Points(points, Between::Step) => {
                let jumps = points.windows(2).filter(|pair| pair[0][1] != pair[1][1]);
                jumps.map(|pair| Break { tau: pair[1][0], holds: Side::After }).collect()
            }
            Pieces::Segments(segments) => piecewise_breaks(segments),
            Pieces::Whole | Pieces::Points(_, Between::Linear | Between::Smooth) => Vec::new(),
        }
    }

    /// Where s may bend or jump, ascending in τ.
    pub fn corners(&self) -> Vec<f64> {
        match self.pieces() {
            Pieces::Points(points, _) => points.iter().map(|point| point[0]).collect(),
            Pieces::Segments(segments) => {
                let mut corners = Vec::new();
                let mut start = 0.0;
                for segment in segments {
                    corners.extend(segment.ease.corners().into_iter().map(|tau| start + tau * (segment.until - start)));
                    corners.push(segment.until);
                    start = segment.until;
                }
                corners
            }
            Pieces::Whole => Vec::new(),
        }
    }
}

fn piecewise_breaks(segments: &[Segment]) -> Vec<Break> {
    let mut breaks = Vec::new();
    let mut start = 0.0;
    for (i, segment) in segments.iter().enumerate() {
        let inner = segment.ease.breaks().into_iter();
        breaks.extend(inner.map(|b| Break { tau: start + b.tau * (segment.until - start), ..b }));
        start = segment.until;
        let next = segments.get(i + 1);
        if next.is_some_and(|next| next.at(next.ease.eval(0.0)) != segment.at(segment.ease.eval(1.0))) {
            breaks.push(Break { tau: segment.until, holds: Side::Before });
        }
    }
    breaks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(json: &str) -> Position {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn corners_are_where_s_bends() {
        let bent = r#"{"function":"keyframes","points":[[0,0],[0.5,1],[1,0]]}"#;
        assert_eq!(parse(bent).corners(), [0.0, 0.5, 1.0]);
        let segments = format!(
            r#"{{"function":"piecewise","segments":[{{"until":0.25,"from":0,"to":1}},{{"until":1,"from":1,"to":2,"ease":{bent}}}]}}"#
        );
        assert_eq!(parse(&segments).corners(), [0.25, 0.25, 0.625, 1.0, 1.0]);
        assert!(parse(r#"{"function":"sine"}"#).corners().is_empty());
    }

    #[test]
    fn breaks_are_where_s_jumps() {
        let of = |json: &str| parse(json).breaks().into_iter().map(|b| (b.tau, b.holds)).collect::<Vec<_>>();
        assert_eq!(of(r#"{"function":"sine"}"#), []);
        let steps = r#"{"function":"keyframes","points":[[0,1],[0.5,3],[0.75,3],[1,4]],"between":"step"}"#;
        assert_eq!(of(steps), [(0.5, Side::After), (1.0, Side::After)]);
        let teleport = format!(
            r#"{{"function":"piecewise","segments":[{{"until":0.25,"from":0,"to":1}},{{"until":0.5,"from":1,"to":2}},
              {{"until":0.75,"from":0,"to":1}},{{"until":1,"from":1,"to":2,"ease":{steps}}}]}}"#
        );
        let inner = [(0.875, Side::After), (1.0, Side::After)];
        // The eased segment begins at its `from` and once more its way: a jump of its own.
        assert_eq!(of(&teleport), [[(0.5, Side::Before), (0.75, Side::Before)], inner].concat());
    }
}
