// Kernels on the surface itself, as in flat.rs: each a box of pixels that it may cover.

struct Flat {
    at: vec3f,
    factor: f32,
    // Along its stroke, and across it.
    along: vec3f,
    phase: f32,
    across: vec3f,
    unused: f32,
    // Left, top, right, bottom.
    pixels: vec4f,
}

@group(0) @binding(5) var<storage, read> flats: array<Flat>;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) number: u32,
}

@vertex
fn corner(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> Corner {
    let pixels = flats[number].pixels;
    let side = vec2f(f32(((i + 1u) / 3u) & 1u), f32(i & 1u));
    let at = mix(pixels.xy, pixels.zw, side) / sheet.size * 2.0 - 1.0;
    return Corner(vec4f(at.x, -at.y, 0.0, 1.0), number);
}

@fragment
fn kernel(in: Corner) -> @location(0) vec4f {
    let shown = textureLoad(own_depth, vec2i(in.position.xy), 0) / sheet.near;
    if shown == 0.0 {
        return vec4f(0.0);
    }
    let own = flats[in.number];
    let plane = (in.position.xy - sheet.middle) / sheet.focal;
    let away = (vec3f(plane.x, -plane.y, -1.0) / shown - own.at) * noise.px_per_m;
    let across = dot(away, own.across);
    let trimmed = within(abs(dot(away, cross(own.across, own.along))) / noise.radius);
    let weight = own.factor * trimmed * curve(dot(away, own.along) / noise.radius) * curve(across / noise.radius);
    return added(weight, across / noise.spacing + own.phase);
}
