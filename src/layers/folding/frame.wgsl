// One zone of a frame on the GPU: the twin of frame.rs, with the same names and structure. Runs once for every pixel of
// the zone's box. Everything that depends on time alone is in the number s. The rule and the edge are override
// constants, never branches on a uniform: those made Mesa rebuild the shader for every frame.

override rule: u32 = 0u; // a RULE_ below, as in fold.rs
override clamps: bool = true; // whether a read beyond the sampler image's edge gives the edge, or nothing

const RULE_NONE = 0u;
const RULE_COVER = 1u;
const RULE_RETURN = 2u;
const RULE_FLY_OVER = 3u;

struct Zone {
    offset: vec2f, // o, in pixels
    origin: vec2i, // the box's first pixel
    s: f32,
}

@group(0) @binding(0) var<uniform> zone: Zone;
// One texel per pixel of the box, see texels.rs: J.x, J.y, then where its crossings begin, ahead and behind, with
// flags.
@group(0) @binding(1) var pixels: texture_2d<u32>;
// All lists of crossings as distances from s = 0, ascending; each list ends with a number that no s reaches.
@group(0) @binding(2) var crossings: texture_2d<f32>;
@group(0) @binding(3) var picture: texture_2d<f32>;

const MEMBER = 0x80000000u; // is in the zone
const INSIDE = 0x40000000u; // is in a fold region at s = 0
const INDEX = 0x3fffffffu;

struct State {
    inside: bool, // in a fold region, at s
    entered: f32, // the last crossing between 0 and s
    met: bool, // whether there is such a crossing
}

// The effect of s on a pixel: whether its sampler is active, and the effective s.
struct Effect {
    shows: bool,
    e: f32,
}

// Crossing i of all lists.
fn crossing(i: u32) -> f32 {
    let columns = textureDimensions(crossings).x;
    return textureLoad(crossings, vec2u(i % columns, i / columns), 0).x;
}

// Exactly on a crossing, the state on the side of 0 applies.
fn state_at(texel: vec4u, s: f32) -> State {
    let first = select(texel.w, texel.z, s > 0.0) & INDEX;
    let distance = abs(s);
    var n = 0u;
    var last = 0.0;
    loop {
        let next = crossing(first + n);
        if !(next < distance) {
            break;
        }
        last = next;
        n += 1u;
    }
    let inside = ((texel.w & INSIDE) != 0u) != (n % 2u == 1u);
    return State(inside, select(-last, last, s > 0.0), n > 0u);
}

fn effective(texel: vec4u, s: f32) -> Effect {
    if rule == RULE_NONE {
        return Effect(true, s);
    }
    let state = state_at(texel, s);
    if rule == RULE_COVER {
        return Effect(!state.inside || state.met, select(s, state.entered, state.inside));
    }
    if rule == RULE_RETURN {
        return Effect(!state.inside, s);
    }
    if rule == RULE_FLY_OVER {
        return Effect(state.inside, s);
    }
    return Effect(false, s); // a rule that has no line here shows nothing, so that tests notice
}

fn pixel_of_picture(at: vec2i) -> vec4f {
    let size = vec2i(textureDimensions(picture));
    let edge = clamp(at, vec2i(0), size - 1);
    let color = textureLoad(picture, edge, 0);
    if clamps {
        return color;
    }
    return select(vec4f(0.0), color, all(at == edge));
}

// The bilinear read at q + d for the pixel whose center is q: only d has a fractional part.
fn read(pixel: vec2i, d: vec2f) -> vec4f {
    let whole = floor(d);
    let part = d - whole;
    let first = pixel + vec2i(clamp(whole, vec2f(-1e9), vec2f(1e9)));
    let top = mix(pixel_of_picture(first), pixel_of_picture(first + vec2i(1, 0)), part.x);
    let bottom = mix(pixel_of_picture(first + vec2i(0, 1)), pixel_of_picture(first + vec2i(1, 1)), part.x);
    return mix(top, bottom, part.y);
}

// A pixel that shows nothing of the zone is discarded: what is beneath stays. The others are blended over it if the
// sampler image is a named one or a mask.
@fragment
fn shown(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let texel = textureLoad(pixels, pixel - zone.origin, 0);
    let effect = effective(texel, zone.s);
    if (texel.w & MEMBER) == 0u || !effect.shows {
        discard;
    }
    return read(pixel, zone.offset + effect.e * bitcast<vec2f>(texel.xy));
}
