// Where a layer has a rim, and how far each pixel is from it, as in rim.rs.

struct Rim {
    step: f32,
    // The cosine of the least angle between normals at a crease; below -1 there are none.
    crease: f32,
    // No rim farther than so many pixels counts.
    reach: i32,
}

@group(0) @binding(4) var<uniform> rim: Rim;
@group(0) @binding(5) var found: texture_2d<f32>;

const NOWHERE: f32 = 16384.0;

// Whether a pixel of the layer is at a rim toward its neighbor.
fn parts(here: vec2i, other: vec2i) -> bool {
    if !is_inside(other) {
        return false;
    }
    let own = inverse(here);
    let beside = inverse(other);
    let farther = beside < own;
    if !is_own(other) {
        return farther;
    }
    let own_facts = textureLoad(facts, here, 0);
    let facts_beside = textureLoad(facts, other, 0);
    let crease = dot(normal_of(own_facts), normal_of(facts_beside)) < rim.crease;
    if crease || !farther {
        return crease;
    }
    let way = vec2f(other - here) / sheet.focal;
    let from_own = own + dot(bitcast<vec2f>(own_facts.zw), way) - beside;
    let from_other = own - (beside - dot(bitcast<vec2f>(facts_beside.zw), way));
    return min(from_own, from_other) * sheet.focal / own > rim.step;
}

@fragment
fn rims(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let is_rim = is_own(pixel)
        && (parts(pixel, pixel - vec2i(1, 0)) || parts(pixel, pixel + vec2i(1, 0))
            || parts(pixel, pixel - vec2i(0, 1)) || parts(pixel, pixel + vec2i(0, 1)));
    return vec4f(select(0.0, 1.0, is_rim), 0.0, 0.0, 0.0);
}

// The distance to the nearest in the column.
@fragment
fn in_column(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    for (var away = 0; away <= rim.reach; away++) {
        let up = pixel - vec2i(0, away);
        let down = pixel + vec2i(0, away);
        if is_inside(up) && textureLoad(found, up, 0).x > 0.0 || is_inside(down) && textureLoad(found, down, 0).x > 0.0 {
            return vec4f(f32(away), 0.0, 0.0, 0.0);
        }
    }
    return vec4f(NOWHERE, 0.0, 0.0, 0.0);
}

// The distance to the nearest of all.
@fragment
fn nearest(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var least = NOWHERE * NOWHERE;
    for (var away = -rim.reach; away <= rim.reach; away++) {
        let pixel = vec2i(at.xy) + vec2i(away, 0);
        if is_inside(pixel) {
            let down = textureLoad(found, pixel, 0).x;
            least = min(least, f32(away * away) + down * down);
        }
    }
    return vec4f(sqrt(least), 0.0, 0.0, 0.0);
}
