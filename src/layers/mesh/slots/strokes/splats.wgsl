// Kernels on the screen, each a square around its impulse.

struct Splat {
    at: vec2f,
    radius: f32,
    factor: f32,
    // Turns a pixel, to the right and down; and those in the middle.
    waves: vec2f,
    phase: f32,
    // What differences of 1 / depth are multiplied by to be radii.
    scale: f32,
    // 1 / the depth of its triangle's plane: in the middle, and what that grows by to the right and down.
    slope: vec2f,
    inverse: f32,
    triangle: u32,
}

@group(0) @binding(5) var<storage, read> splats: array<Splat>;

// What it covers: what is near its plane, all of the layer, its own triangle, or all as far as it is seen.
override covers: u32;
const NEAR: u32 = 0u;
const TRIANGLE: u32 = 2u;
const SEEN: u32 = 3u;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) middle: vec4f,
    @location(1) @interpolate(flat) waves: vec4f,
    @location(2) @interpolate(flat) plane: vec4f,
}

// How much of an impulse is seen, as in visible.rs.
fn seen(splat: Splat) -> f32 {
    var sum = 0.0;
    var count = 0.0;
    for (var tap = 0; tap < 13; tap++) {
        let ring = select(select(2.0, 1.0, tap < 5), 0.0, tap == 0);
        let eighth = select(f32(tap - 5) + 0.5, 2.0 * f32(tap - 1), tap < 5);
        let angle = eighth * 0.78539816;
        let pixel = floor(splat.at + vec2f(cos(angle), sin(angle)) * (ring / 3.0 * splat.radius));
        if !is_inside(vec2i(pixel)) {
            continue;
        }
        count += 1.0;
        let shown = inverse(vec2i(pixel));
        let nearer = shown - (splat.inverse + dot(splat.slope, pixel + 0.5 - splat.at));
        sum += select(1.0, within(nearer * splat.scale), shown > 0.0);
    }
    return select(1.0, sum / count, count > 0.0);
}

@vertex
fn corner(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> Corner {
    let splat = splats[number];
    let side = vec2f(f32(((i + 1u) / 3u) & 1u), f32(i & 1u)) * 2.0 - 1.0;
    let at = (splat.at + side * splat.radius) / sheet.size * 2.0 - 1.0;
    var factor = splat.factor;
    if covers == SEEN {
        factor *= seen(splat);
    }
    var out: Corner;
    out.position = vec4f(at.x, -at.y, 0.0, 1.0);
    out.middle = vec4f(splat.at, 1.0 / splat.radius, factor);
    out.waves = vec4f(splat.waves, splat.phase, splat.scale);
    out.plane = vec4f(splat.slope, splat.inverse, bitcast<f32>(splat.triangle + 1u));
    return out;
}

@fragment
fn kernel(in: Corner) -> @location(0) vec4f {
    let pixel = vec2i(in.position.xy);
    let away = in.position.xy - in.middle.xy;
    let place = away * in.middle.z;
    var weight = in.middle.w * curve(place.x) * curve(place.y);
    let shown = textureLoad(own_depth, pixel, 0) / sheet.near;
    if shown == 0.0 {
        return vec4f(0.0);
    }
    if covers == NEAR {
        weight *= within(abs(shown - (in.plane.z + dot(in.plane.xy, away))) * in.waves.w);
    } else if covers == TRIANGLE {
        weight *= select(0.0, 1.0, textureLoad(facts, pixel, 0).x == bitcast<u32>(in.plane.w));
    }
    return added(weight, dot(in.waves.xy, away) + in.waves.z);
}
