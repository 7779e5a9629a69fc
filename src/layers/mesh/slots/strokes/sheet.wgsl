// What a frame shows of a layer that strokes are drawn on: before the code of each of their shaders.

struct Sheet {
    size: vec2f,
    middle: vec2f,
    focal: f32,
    near: f32,
}

@group(0) @binding(0) var<uniform> sheet: Sheet;
// See `Facts` in frame.wgsl.
@group(0) @binding(1) var facts: texture_2d<u32>;
// Near / depth of the layer alone, and of all surfaces.
@group(0) @binding(2) var own_depth: texture_depth_2d;
@group(0) @binding(3) var depth: texture_depth_2d;

fn is_inside(at: vec2i) -> bool {
    return all(at >= vec2i(0)) && all(at < vec2i(sheet.size));
}

// Whether a pixel shows the layer.
fn is_own(at: vec2i) -> bool {
    let own = textureLoad(own_depth, at, 0);
    return own > 0.0 && own >= textureLoad(depth, at, 0);
}

// 1 / the depth of what a pixel shows, 0 where that is nothing.
fn inverse(at: vec2i) -> f32 {
    return textureLoad(depth, at, 0) / sheet.near;
}

// The normal in the world, turned to the camera.
fn normal_of(facts: vec4u) -> vec3f {
    let flat = unpack2x16snorm(facts.y);
    let up = 1.0 - abs(flat.x) - abs(flat.y);
    let under = max(-up, 0.0);
    return normalize(vec3f(flat - select(vec2f(-under), vec2f(under), flat >= vec2f(0.0)), up));
}
