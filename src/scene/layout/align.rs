//! Which old item each new one comes from. Equal items that occur once in each list are matched first, as in patience
//! diff; between them the most similar items are paired.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;

use serde_json::{Map, Value};

use crate::scene::json::same;

/// Stretches with more possible pairs than this are simply paired in order.
const MOST_PAIRS: usize = 10_000;

/// Where a new item comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It is new.
    New,
    /// The old item at this index, among its old neighbors.
    Stays(usize),
    /// The old item at this index, moved elsewhere.
    Moved(usize),
}

impl Origin {
    /// The index of the old item, if there is one.
    pub fn from(self) -> Option<usize> {
        match self {
            Origin::New => None,
            Origin::Stays(at) | Origin::Moved(at) => Some(at),
        }
    }

    /// The index of the old item, if it is still among its old neighbors.
    pub fn stays(self) -> Option<usize> {
        if let Origin::Stays(at) = self { Some(at) } else { None }
    }
}

/// Matches the fields of an object by key; one under a new key by its value.
pub fn align_keys(old: &Map<String, Value>, new: &Map<String, Value>) -> Vec<Origin> {
    let places: HashMap<&str, usize> = old.keys().enumerate().map(|(at, key)| (key.as_str(), at)).collect();
    let known: Vec<(usize, usize)> =
        new.keys().enumerate().filter_map(|(i, key)| Some((i, *places.get(key.as_str())?))).collect();
    let mut origins = vec![Origin::New; new.len()];
    known.iter().for_each(|&(i, at)| origins[i] = Origin::Moved(at));
    rising(&known).into_iter().for_each(|(i, at)| origins[i] = Origin::Stays(at));
    let mut gone: Vec<(usize, &Value)> = old
        .iter()
        .enumerate()
        .filter(|(_, (key, _))| !new.contains_key(*key))
        .map(|(at, (_, value))| (at, value))
        .collect();
    for (origin, value) in origins.iter_mut().zip(new.values()).filter(|(origin, _)| **origin == Origin::New) {
        if let Some(found) = gone.iter().position(|(_, old)| same(old, value)) {
            *origin = Origin::Moved(gone.remove(found).0);
        }
    }
    origins
}

/// Matches the items of a list by value.
pub fn align_values(old: &[Value], new: &[Value]) -> Vec<Origin> {
    let lists = Lists { old, new, old_hashes: hashes(old), new_hashes: hashes(new) };
    let mut pairs = Vec::new();
    lists.stretch(0..old.len(), 0..new.len(), &mut pairs);
    let mut origins = vec![Origin::New; new.len()];
    let mut used = vec![false; old.len()];
    for (i, at) in pairs {
        origins[i] = Origin::Stays(at);
        used[at] = true;
    }
    let mut gone: HashMap<u64, Vec<usize>> = HashMap::new();
    (0..old.len()).rev().filter(|at| !used[*at]).for_each(|at| gone.entry(lists.old_hashes[at]).or_default().push(at));
    for i in (0..new.len()).filter(|i| origins[*i] == Origin::New).collect::<Vec<_>>() {
        let moved = gone.get_mut(&lists.new_hashes[i]).and_then(Vec::pop);
        moved.into_iter().filter(|at| same(&old[*at], &new[i])).for_each(|at| origins[i] = Origin::Moved(at));
    }
    origins
}

fn hashes(items: &[Value]) -> Vec<u64> {
    let hash = |item: &Value| {
        let mut hasher = DefaultHasher::new();
        item.to_string().hash(&mut hasher);
        hasher.finish()
    };
    items.iter().map(hash).collect()
}

struct Lists<'a> {
    old: &'a [Value],
    new: &'a [Value],
    old_hashes: Vec<u64>,
    new_hashes: Vec<u64>,
}

impl Lists<'_> {
    fn equal(&self, at: usize, i: usize) -> bool {
        self.old_hashes[at] == self.new_hashes[i] && same(&self.old[at], &self.new[i])
    }

    /// Adds the pairs (new, old) of one stretch of both lists.
    fn stretch(&self, mut old: Range<usize>, mut new: Range<usize>, pairs: &mut Vec<(usize, usize)>) {
        while !old.is_empty() && !new.is_empty() && self.equal(old.start, new.start) {
            pairs.push((new.start, old.start));
            (old.start, new.start) = (old.start + 1, new.start + 1);
        }
        while !old.is_empty() && !new.is_empty() && self.equal(old.end - 1, new.end - 1) {
            (old.end, new.end) = (old.end - 1, new.end - 1);
            pairs.push((new.end, old.end));
        }
        if old.is_empty() || new.is_empty() {
            return;
        }
        let anchors = rising(&self.once_in_both(&old, &new));
        if anchors.is_empty() {
            return self.pair_similar(old, new, pairs);
        }
        for (i, at) in anchors {
            self.stretch(old.start..at, new.start..i, pairs);
            pairs.push((i, at));
            (old.start, new.start) = (at + 1, i + 1);
        }
        self.stretch(old, new, pairs);
    }

    /// The items that occur exactly once in each of the stretches, as pairs (new, old) in the order of the new ones.
    fn once_in_both(&self, old: &Range<usize>, new: &Range<usize>) -> Vec<(usize, usize)> {
        let once = |hashes: &[u64], range: &Range<usize>| {
            let mut places: HashMap<u64, Option<usize>> = HashMap::new();
            for at in range.clone() {
                places.entry(hashes[at]).and_modify(|place| *place = None).or_insert(Some(at));
            }
            places
        };
        let (olds, news) = (once(&self.old_hashes, old), once(&self.new_hashes, new));
        let pair = |i: usize| {
            let hash = self.new_hashes[i];
            let at = news.get(&hash).copied().flatten().and(olds.get(&hash).copied().flatten())?;
            self.equal(at, i).then_some((i, at))
        };
        new.clone().filter_map(pair).collect()
    }

    /// Pairs what is left, in order, so that the pairs have as much in common as possible.
    fn pair_similar(&self, old: Range<usize>, new: Range<usize>, pairs: &mut Vec<(usize, usize)>) {
        let (rows, columns) = (old.len(), new.len());
        if rows == columns || rows * columns > MOST_PAIRS {
            pairs.extend(new.zip(old));
            return;
        }
        // best[i][j]: the best sum for the first i of one and the first j of the other.
        let mut best = vec![vec![0_usize; columns + 1]; rows + 1];
        for row in 0..rows {
            for column in 0..columns {
                let common = common(&self.old[old.start + row], &self.new[new.start + column]);
                let paired = if common > 0 { best[row][column] + common } else { 0 };
                best[row + 1][column + 1] = paired.max(best[row][column + 1]).max(best[row + 1][column]);
            }
        }
        let (mut row, mut column) = (rows, columns);
        while row > 0 && column > 0 {
            if best[row][column] == best[row - 1][column] {
                row -= 1;
            } else if best[row][column] == best[row][column - 1] {
                column -= 1;
            } else {
                (row, column) = (row - 1, column - 1);
                pairs.push((new.start + column, old.start + row));
            }
        }
    }
}

/// How much two values have in common; 0 if they are of different kinds.
fn common(old: &Value, new: &Value) -> usize {
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            let equal = old.iter().filter(|(key, value)| new.get(*key).is_some_and(|new| same(value, new))).count();
            let named = old.get("name").is_some_and(|name| Some(name) == new.get("name"));
            1 + 2 * equal + if named { 100 } else { 0 }
        }
        (Value::Array(old), Value::Array(new)) => {
            1 + 2 * old.iter().zip(new).filter(|(old, new)| same(old, new)).count()
        }
        (Value::Object(_) | Value::Array(_), _) | (_, Value::Object(_) | Value::Array(_)) => 0,
        _ => 1,
    }
}

/// The longest subsequence of pairs in which the second numbers rise with the first.
fn rising(pairs: &[(usize, usize)]) -> Vec<(usize, usize)> {
    // For each length, the pair that ends the best run of that length; for each pair, the one before it.
    let mut ends: Vec<usize> = Vec::new();
    let mut before = vec![None; pairs.len()];
    for (index, (_, at)) in pairs.iter().enumerate() {
        let length = ends.partition_point(|&end| pairs[end].1 < *at);
        before[index] = length.checked_sub(1).map(|shorter| ends[shorter]);
        if length == ends.len() { ends.push(index) } else { ends[length] = index }
    }
    let mut run: Vec<_> =
        std::iter::successors(ends.last().copied(), |&index| before[index]).map(|i| pairs[i]).collect();
    run.reverse();
    run
}
