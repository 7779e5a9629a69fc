//! What a view map tells of its views and of itself, as JSON for tools and tables.

use serde_json::{Value, json};

use super::looked::Filled;
use super::map::Map;
use super::view::View;
use super::{balance, compare, report};
use crate::base::number;
use crate::base::progress::Watch;
use crate::layers::parts::shots::Feeds;

/// An object for each active view, in order, then one for the map; with `compare` also how well each view comes back.
pub fn told(filled: Filled, compare: Option<&Watch>) -> Vec<Value> {
    let again = compare.map(|watch| compare::compare(filled, watch)).unwrap_or_default();
    let views = report::views(filled.0).into_iter().enumerate().map(|(i, of)| {
        let cells = of.cells.iter().map(
            |[own, finer, coarser, beside]| json!({ "own": own, "finer": finer, "coarser": coarser, "beside": beside }),
        );
        let mut told = json!({
            "view": of.view.name,
            "kind": kind(of.view),
            "depth": of.depth,
            "pixels": number::json(of.pixels),
            "beyond": number::json(of.beyond),
            "cells": cells.collect::<Vec<_>>(),
        });
        if compare.is_some() {
            let again = again.get(i).copied().flatten();
            let finite =
                |number: Option<f64>| number.filter(|number| number.is_finite()).map_or(Value::Null, number::json);
            told["psnr"] = finite(again.map(|again| again.psnr));
            told["share"] = finite(again.map(|again| number::rounded(again.share, 4)));
        }
        told
    });
    let of = report::map(filled);
    let whole = json!({ "map": {
        "charts": of.charts,
        "levels": of.levels,
        "cells": of.cells,
        "known": of.known,
        "filled": of.filled,
        "entries": of.entries,
        "bytes": of.bytes,
    } });
    views.chain([whole]).collect()
}

fn kind(view: &View) -> &'static str {
    let feeds = match (view.base, view.dependent) {
        (true, true) => Feeds::Both,
        (true, false) => Feeds::Independent,
        (false, _) => Feeds::Dependent,
    };
    feeds.word()
}

/// The gains with which photographs agree: the number of each view in the document, and the gain.
pub fn balanced(map: &Map) -> Vec<(usize, [f64; 3])> {
    let factors = balance::factors(map);
    let changed = map.wanted.views.iter().zip(factors).filter(|(_, factor)| *factor != [1.0; 3]);
    let gain = |view: &View, by: [f64; 3], k: usize| number::rounded(view.paint.gain[k] * by[k], 4);
    changed.map(|(view, by)| (view.number, [0, 1, 2].map(|k| gain(view, by, k)))).collect()
}
