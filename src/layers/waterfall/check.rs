//! What can be wrong with a waterfall layer: on its own, and with its clip and sheets.

use super::automatic::Values;
use super::births::Births;
use super::hash::Random;
use super::lines::{Line, lines, water};
use super::look::Look;
use super::model::{Node, WaterfallLayer};
use super::sprites::cut::Sources;
use super::sprites::model::{Growth, Pick, Shows, Sprites};
use super::sprites::{SIDE_STEP, bytes_of};
use crate::base::budget::size;
use crate::base::clip::Clip;
use crate::base::problem::Problem;
use crate::layers::check as rules;

/// The most sprites at once.
const MOST_SPRITES: f64 = 2e6;
/// The most bytes of keys.
const MOST_BYTES: u64 = 1 << 30;

/// The checks beyond shape.
pub fn problems(layer: &WaterfallLayer) -> Vec<Problem> {
    let mut problems = of_sprites(layer);
    let dry = dry(&layer.lip);
    let flows = dry.is_none();
    problems.extend(dry);
    problems.extend(of_look(&layer.look, "/look"));
    problems.extend(of_look(&layer.foam.look, "/foam/look"));
    if flows {
        problems.extend(of_lines(layer));
    }
    problems
}

/// The problem with a lip that no water leaves.
fn dry(lip: &[Node]) -> Option<Problem> {
    if !lip.iter().any(|node| node.flow > 0.0) {
        return Some(Problem::error("/lip", "no water flows at any node").hint("give a node a flow above 0"));
    }
    // Nodes at one place are a point, where it is enough that one of them has a flow.
    let mut pieces = lip.windows(2).filter(|pair| pair[0].at != pair[1].at).peekable();
    let flows = pieces.peek().is_none() || pieces.any(|pair| pair[0].flow + pair[1].flow > 0.0);
    let dry = || Problem::error("/lip", "no water flows between any two nodes that are apart");
    (!flows).then(|| dry().hint("give one of such two a flow above 0"))
}

fn of_sprites(layer: &WaterfallLayer) -> Vec<Problem> {
    let sprites = &layer.sprites;
    let mut problems = Vec::new();
    let laid = sprites.sheets.iter().any(|sheet| sheet.kind == Shows::Water);
    if layer.clip.is_none() && !(laid && sprites.picks.is_empty()) {
        problems
            .push(Problem::error("", "a waterfall needs a clip or sprites.sheets").hint("name a clip of the scene"));
    }
    let side = sprites.size;
    if !side.is_multiple_of(SIDE_STEP) {
        let near = [side / SIDE_STEP * SIDE_STEP, side.div_ceil(SIDE_STEP) * SIDE_STEP].map(|side| side.to_string());
        let problem = Problem::error("/sprites/size", format!("{side} is no multiple of {SIDE_STEP}"));
        problems.push(problem.hint(near.join(", ")));
    }
    if sprites.matte.low >= sprites.matte.high {
        let (low, high) = (sprites.matte.low, sprites.matte.high);
        let problem = Problem::error("/sprites/matte/low", format!("low is not below high ({low} and {high})"));
        problems.push(problem.hint("make it smaller"));
    }
    let bytes = bytes_of(sprites);
    if bytes > MOST_BYTES {
        let message = format!("its keys take {}, and {} is the most", size(bytes), size(MOST_BYTES));
        problems.push(Problem::error("/sprites", message).hint(enough(sprites)));
    }
    problems
}

/// Which size alone, or which number of keys or of tracks that are chosen, takes no more memory than may be.
fn enough(sprites: &Sprites) -> String {
    let fits = |changed: &Sprites| bytes_of(changed) <= MOST_BYTES;
    let sized = |side: u32| Sprites { size: side, ..sprites.clone() };
    let keyed = |keys: u32| Sprites { keys, ..sprites.clone() };
    let grown = |max: u32| Sprites { growth: Growth { max, ..sprites.growth.clone() }, ..sprites.clone() };
    let picked = |count: usize| Sprites { picks: sprites.picks[..count].to_vec(), ..sprites.clone() };
    let counts: Vec<usize> = (1..=sprites.picks.len()).collect();
    let picks = counts.partition_point(|count| fits(&picked(*count)));
    let sides = (SIDE_STEP..sprites.size).step_by(SIDE_STEP as usize).rev();
    let all = [
        ("size", sides.clone().find(|side| fits(&sized(*side)))),
        ("keys", (1..sprites.keys).rev().find(|keys| fits(&keyed(*keys)))),
        ("growth.max", (1..sprites.growth.max).rev().find(|max| fits(&grown(*max)))),
        ("picks, as many as", Some(picks as u32).filter(|_| (1..sprites.picks.len()).contains(&picks))),
    ];
    let told = all.into_iter().filter_map(|(name, most)| Some(format!("{name} {}", most?))).collect::<Vec<_>>();
    match told.is_empty() {
        true => "use fewer sheets and picks".to_owned(),
        false => format!("lower one of them: {} is enough", told.join(" or ")),
    }
}

fn of_look(look: &Look, path: &str) -> Vec<Problem> {
    let at = |i: usize| format!("{path}/tint/{i}");
    let ages = look.tint.iter().map(|tint| tint.at);
    let ascending = rules::ascending("ages of colors", ages, |i| at(i) + "/at");
    let colors = look.tint.iter().enumerate();
    let colors = colors.filter_map(|(i, tint)| rules::color(&tint.color, &(at(i) + "/color")));
    ascending.into_iter().chain(colors).collect()
}

fn of_lines(layer: &WaterfallLayer) -> Vec<Problem> {
    let (values, random) = (Values::of(layer), Random(layer.seed));
    let water = water(&values, random);
    let mut problems = Vec::new();
    if !water.iter().any(Line::carries) {
        let highest = values.lip.iter().map(|node| node.at.y).fold(f64::NEG_INFINITY, f64::max);
        let message = format!("no line leaves the lip: it lies under the pool (y {highest}, pool {})", layer.pool);
        problems.push(Problem::warning("/lip", message).hint("raise the lip, or lower the pool"));
    }
    // Lines are short compared with the longest life; they are only looked at if that would be too many.
    let [falling, springing] = &values.kinds;
    let most = falling.rate * falling.life + f64::from(layer.foam.lines) * springing.rate * springing.life;
    if most * f64::from(values.lines) > MOST_SPRITES {
        let lines = lines(&values, &layer.foam, random);
        let count: f64 = lines.iter().map(|line| line.life * values.kinds[usize::from(line.foam)].rate).sum();
        problems.extend(too_many(count));
    }
    problems
}

/// The problem with so many sprites at once, if they are too many.
fn too_many(count: f64) -> Option<Problem> {
    let message = || format!("{count:.0} sprites at once, at most {MOST_SPRITES:.0} are allowed");
    (count > MOST_SPRITES).then(|| Problem::error("/lines", message()).hint("lower lines, rate or life"))
}

/// How much lines carry at once, in the mean.
pub fn carried(lines: &[Line], births: &[Births; 2]) -> f64 {
    let of = |line: &Line| {
        let births = births[usize::from(line.foam)];
        births.count as f64 * line.life / births.period
    };
    lines.iter().map(of).sum()
}

/// The problem with what lines carry at once, if it is too much.
pub fn crowd(lines: &[Line], births: &[Births; 2]) -> Option<Problem> {
    too_many(carried(lines, births))
}

/// The problems that only show with the clip and the images of sheets.
pub fn with_sources(layer: &WaterfallLayer, sources: &Sources) -> Vec<Problem> {
    let sprites = &layer.sprites;
    let side = sprites.size as usize;
    let mut problems = Vec::new();
    for (i, (sheet, image)) in sprites.sheets.iter().zip(&sources.sheets).enumerate() {
        let (columns, rows) = (sheet.columns as usize, sheet.rows as usize);
        if (image.width(), image.height()) != (columns * side, rows * side) {
            let uneven = [(image.width(), columns, "columns"), (image.height(), rows, "rows")];
            let uneven = uneven.into_iter().find(|(size, count, _)| size % count != 0);
            let cells = format!("cells of {} x {}", image.width() / columns, image.height() / rows);
            let message = match uneven {
                Some((size, count, what)) => format!("{size} px do not divide by {count} {what}"),
                None => format!("{cells}; sprites.size is {side}"),
            };
            let hint = "give columns and rows as the image has them, or its size";
            problems.push(Problem::error(format!("/sprites/sheets/{i}"), message).hint(hint));
        }
    }
    let Some(clip) = &sources.clip else { return problems };
    let (width, height) = clip.size_px();
    if width < side || height < side {
        let message = format!("sprites of {side} px do not fit in the clip's {width} x {height}");
        let hint = match (width.min(height) as u32) / SIDE_STEP * SIDE_STEP {
            0 => format!("take a clip of {SIDE_STEP} x {SIDE_STEP} at least"),
            most => format!("make it {most}"),
        };
        problems.push(Problem::error("/sprites/size", message).hint(hint));
        return problems;
    }
    let needed = (sprites.track_frames() - 1).max(sprites.step as usize) + 1;
    if sprites.is_automatic() && clip.frames.len() < needed {
        let (keys, step, name) = (sprites.keys, sprites.step, layer.clip.as_deref().unwrap_or_default());
        let message = format!(
            "{keys} keys {step} frames apart need {needed} frames; the clip \"{name}\" has {}",
            clip.frames.len()
        );
        problems.push(Problem::error("/sprites", message).hint(shorter(sprites, clip.frames.len())));
    }
    let picks = sprites.picks.iter().enumerate();
    problems.extend(picks.flat_map(|(i, pick)| {
        let path = format!("/sprites/picks/{i}");
        of_pick(sprites, pick, clip).into_iter().map(move |problem| problem.under(&path))
    }));
    problems
}

/// Which step, or which number of keys, a clip of so many frames is long enough for.
fn shorter(sprites: &Sprites, frames: usize) -> String {
    let apart = frames.saturating_sub(1) as u32;
    match apart / sprites.keys.saturating_sub(1).max(1) {
        0 if apart == 0 => "take a longer clip".to_owned(),
        0 => format!("make keys {frames} and step 1"),
        step => format!("make step {step}"),
    }
}

fn of_pick(sprites: &Sprites, pick: &Pick, clip: &Clip) -> Vec<Problem> {
    let side = f64::from(sprites.size);
    let (width, height) = clip.size_px();
    let mut problems = Vec::new();
    let outside = pick.at.into_iter().zip([width, height]).find_map(|(at, size)| {
        let edge = (at - side / 2.0 + 0.5).floor();
        (edge < 0.0 || edge + side > size as f64).then_some((edge, edge + side, size as f64))
    });
    if let Some((from, to, size)) = outside {
        let message = format!("its window, {from} px to {to} px, leaves the clip's {size} px");
        let hint = format!("its middle can be from {} to {} px", side / 2.0, size - side / 2.0);
        problems.push(Problem::error("", message).hint(hint));
    }
    let (frame, count) = (pick.frame as usize, clip.frames.len());
    let frames = if pick.track { sprites.track_frames() } else { 1 };
    if frame + frames > count {
        let what = if pick.track {
            format!("frame {frame} and its track of {frames} frames pass the clip's end ({count})")
        } else {
            format!("frame {frame} passes the clip's end ({count})")
        };
        let hint = match count.checked_sub(frames) {
            Some(last) => format!("the last that it can be is {last}"),
            None => "track false makes it a single picture".to_owned(),
        };
        problems.push(Problem::error("", what).hint(hint));
    }
    problems
}
