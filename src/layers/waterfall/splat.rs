//! Where a sprite is in the frame, and what it shows.

use std::borrow::Cow;

use glam::{DVec2, DVec3, Vec4};
use rayon::prelude::*;

use super::between::{Mix, catmull, hermite, residue};
use super::births::Alive;
use super::lines::Line;
use super::look::FullLook;
use super::model::{Between, Order, Tangents};
use super::sprites::KeyPlace;
use super::sprites::levels::Levels;
use super::synth::Synth;
use crate::base::maths::{atan2, cos, lerp, log2, sin, smoothstep};
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::{Eye, NEAR_M};

/// The smallest side of a sprite, in pixels.
const SMALLEST_PX: f64 = 2.0;
/// A slower velocity has no direction, in m/s.
const STANDING: f64 = 1e-6;
/// Purposes in the hash.
const SCATTER: u32 = 17;
const SHAPE: u32 = 18;
const SHUFFLE: u32 = 256;

/// A sprite in the frame: a rectangle parallel to the picture plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Splat {
    /// The number of its line.
    pub line: u32,
    /// Whether it is foam.
    pub foam: bool,
    /// What it is on its line.
    pub alive: Alive,
    /// How long it lives, in seconds.
    pub life: f64,
    /// Where it is in the world.
    pub at: DVec3,
    /// Its middle in the frame, in pixels.
    pub middle: DVec2,
    /// How far away it is, in meters.
    pub depth: f64,
    /// Its width and its length, in pixels.
    pub size_px: DVec2,
    /// How far it is turned from x toward y, in degrees.
    pub angle: f64,
    /// Cosine and sine of that.
    pub turn: DVec2,
    /// Whether it is mirrored left to right.
    pub mirrored: bool,
    /// How much it covers.
    pub opacity: f64,
    /// What its color is multiplied by; its alpha by 1.
    pub tint: Vec4,
    /// The level of the pictures that it shows.
    pub level: usize,
    /// The key that it has left, by its number among those that it runs through, and how far it is to the next.
    pub key: (usize, f64),
    /// What it shows.
    pub mix: Mix,
}

/// All sprites that the camera may see, in order: by line, birth, age.
pub fn splats<'a>(synth: &'a Synth, moment: &Moment) -> Vec<Splat> {
    let Some(eye) = moment.eye else { return Vec::new() };
    let now = synth.now(moment);
    let of_line = |line: &'a Line| {
        let alive = synth.births[usize::from(line.foam)].alive(synth.random, line, now, moment.left_out);
        alive.filter_map(move |alive| splat(synth, &eye, moment.size_px, line, alive))
    };
    synth.lines.par_iter().flat_map_iter(of_line).collect()
}

fn splat(synth: &Synth, eye: &Eye, frame: (usize, usize), line: &Line, alive: Alive) -> Option<Splat> {
    let values = &synth.values;
    let look = &values.kinds[usize::from(line.foam)].look;
    let (age, s) = (alive.age, alive.age / line.life);
    let (at, velocity) = values.laws.at(&line.path, age);
    let at = at + strayed(synth, line, &alive);
    let seen = eye.seen(at);
    let depth = -seen.z;
    if depth < NEAR_M {
        return None;
    }
    let [wide, tilt, ..] = synth.random.of(line.number, alive.birth, SHAPE);
    let width = lerp(look.width[0], look.width[1], s) * (1.0 + look.jitter * (2.0 * wide - 1.0));
    let way = on_screen(eye, velocity);
    let far = if look.align { way.length() } else { way.y.abs() };
    let scale = eye.focal_px / depth;
    let size = DVec2::new(scale * width, scale * (width + look.streak * far));
    let (middle, size_px) = (eye.project(seen), size.max(DVec2::splat(SMALLEST_PX)));
    if is_outside(middle, size_px, frame) {
        return None;
    }
    let sense = if alive.own[2] < 0.5 { 1.0 } else { -1.0 };
    let angle = turned(look, look.tilt * (2.0 * tilt - 1.0) + sense * look.spin * s, way);
    let turn = if angle == 0.0 { DVec2::X } else { DVec2::new(cos(angle.to_radians()), sin(angle.to_radians())) };
    let tint = look.tint(s);
    let near = (depth / width - 0.5).clamp(0.0, 1.0);
    let thin = (size / SMALLEST_PX).min(DVec2::ONE);
    let side = synth.pictures.side;
    let level = (log2(side as f64 / size_px.x) + 0.5).floor().clamp(0.0, Levels::last(side) as f64) as usize;
    let mirrored = look.mirror && alive.own[3] < 0.5;
    let direction = |age: f64| {
        let way = on_screen(eye, values.laws.at(&line.path, age).1);
        let Some(way) = way.try_normalize().filter(|_| way.length() >= STANDING) else { return DVec2::Y };
        let own = DVec2::new(turn.x * way.x + turn.y * way.y, turn.x * way.y - turn.y * way.x);
        if mirrored { DVec2::new(-own.x, own.y) } else { own }
    };
    let (key, mix) = mixed(synth, line, &alive, direction);
    let opacity = look.opacity * faded(look.fade, s) * tint[3] * clumped(synth, line, &alive) * near * thin.x * thin.y;
    Some(Splat {
        line: line.number,
        foam: line.foam,
        alive,
        life: line.life,
        at,
        middle,
        depth,
        size_px,
        angle,
        turn,
        mirrored,
        opacity,
        tint: (DVec3::from_slice(&tint) * look.gain).as_vec3().extend(1.0),
        level,
        key,
        mix,
    })
}

/// Whether a sprite is outside the frame however it is turned: it ends here, before most of the work for it.
fn is_outside(middle: DVec2, size_px: DVec2, (width, height): (usize, usize)) -> bool {
    let reach = size_px.length() / 2.0 + 1.0;
    let outside = |at: f64, size: usize| at + reach < 0.0 || at - reach > size as f64;
    outside(middle.x, width) || outside(middle.y, height)
}

/// The angle of a sprite in degrees, if it is turned by `own` itself and its line runs this way.
fn turned(look: &FullLook, own: f64, way: DVec2) -> f64 {
    let aligned = look.align && way.length() > STANDING;
    let angle = own + if aligned { atan2(-way.x, way.y).to_degrees() } else { 0.0 };
    let angle = angle - 360.0 * (angle / 360.0).round();
    if angle.abs() < look.snap { 0.0 } else { angle }
}

/// A velocity as it is seen: right and down.
fn on_screen(eye: &Eye, velocity: DVec3) -> DVec2 {
    let seen = eye.turn * velocity;
    DVec2::new(seen.x, -seen.y)
}

/// How far a sprite has strayed from its line.
fn strayed(synth: &Synth, line: &Line, alive: &Alive) -> DVec3 {
    let values = &synth.values;
    let [a, b, c, d] = synth.random.of(line.number, alive.birth, SCATTER);
    let scatter = values.scatter[0] + values.scatter[1] * alive.age;
    let aside = DVec3::new(a + b - 1.0, 0.0, c + d - 1.0) * scatter;
    if values.surge.sway == 0.0 {
        return aside;
    }
    let [x, z] = [1, 2].map(|q| 2.0 * synth.noise.at(q, line.place, alive.born) - 1.0);
    aside + DVec3::new(x, 0.0, z) * (values.surge.sway * alive.age)
}

fn faded([first, last]: [f64; 2], s: f64) -> f64 {
    let part = |share: f64, fade: f64| if fade == 0.0 { 1.0 } else { smoothstep(0.0, 1.0, share / fade) };
    part(s, first) * part(1.0 - s, last)
}

/// How much of a sprite is there: little in the gaps between clumps.
fn clumped(synth: &Synth, line: &Line, alive: &Alive) -> f64 {
    let surge = &synth.values.surge;
    if surge.amount == 0.0 {
        return 1.0;
    }
    let noise = synth.noise.at(0, line.place, alive.born);
    1.0 - surge.amount + surge.amount * ((noise - 0.5) * surge.contrast + 0.5).clamp(0.0, 1.0)
}

/// The keys that a sprite runs through.
fn keys<'a>(synth: &'a Synth, line: &Line, alive: &Alive) -> Cow<'a, [KeyPlace]> {
    let kind = usize::from(line.foam);
    let pick = |share: f64, count: usize| (share * count as f64).floor() as usize;
    let all = &synth.keys[kind];
    if synth.between.order == Order::Track {
        let tracks = &synth.tracks[kind];
        return Cow::Borrowed(&all[tracks[pick(alive.own[1], tracks.len())].clone()]);
    }
    let mut found: Vec<usize> = Vec::with_capacity(synth.shuffled);
    for i in 0..synth.shuffled as u32 {
        let next = pick(synth.random.of(line.number, alive.birth, SHUFFLE + i)[0], all.len());
        let again = found.last() == Some(&next);
        found.push(if again { (next + 1) % all.len() } else { next });
    }
    found.into_iter().map(|i| all[i]).collect()
}

/// What a sprite shows; `direction` tells where its line runs at an age, in the sprite's own axes.
fn mixed(synth: &Synth, line: &Line, alive: &Alive, direction: impl Fn(f64) -> DVec2) -> ((usize, f64), Mix) {
    let keys = keys(synth, line, alive);
    let last = keys.len() - 1;
    if last == 0 {
        return ((0, 0.0), mix(&synth.between, &keys, (0, 0.0), |_| DVec2::Y));
    }
    let pass = (synth.between.passes * alive.age / line.life).rem_euclid(2.0);
    let x = if pass > 1.0 { 2.0 - pass } else { pass } * last as f64;
    let i = (x.floor() as usize).min(last - 1);
    let key = (i, x - i as f64);
    (key, mix(&synth.between, &keys, key, |k| direction(k as f64 * line.life / last as f64)))
}

/// What is shown between key `i` and the next, `u` of the way; `ahead` tells where the line runs at a key.
pub fn mix(between: &Between, keys: &[KeyPlace], (i, u): (usize, f64), ahead: impl Fn(usize) -> DVec2) -> Mix {
    let [first] = keys else {
        let [a, b, leaving, reaching] = hermite(u);
        let mut mix = Mix::of(&[(keys[i], a as f32), (keys[i + 1], b as f32)]);
        match between.tangents {
            Tangents::Zero => {}
            Tangents::Catmull => {
                let (before, after) = (i.checked_sub(1).map(|i| keys[i]), keys.get(i + 2));
                let weights = catmull(u, before.is_some(), after.is_some()).map(|weight| weight as f32);
                mix = Mix::of(&[(keys[i], weights[1]), (keys[i + 1], weights[2])]);
                before.into_iter().for_each(|key| mix.add((key, weights[0])));
                after.into_iter().for_each(|key| mix.add((*key, weights[3])));
            }
            Tangents::Advect => {
                let slope = |k: usize, weight: f64| (ahead(k) * (-between.drift * weight)).to_array().map(|v| v as f32);
                mix.slopes = [slope(i, leaving), slope(i + 1, reaching)];
            }
        }
        if between.noise > 0.0 {
            mix.residue = Some((keys[i].0, i, (between.noise * residue(u)) as f32));
        }
        return mix;
    };
    Mix::of(&[(*first, 1.0)])
}
