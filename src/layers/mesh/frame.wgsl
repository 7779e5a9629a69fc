// What a mesh shows: the same as frame.rs. It follows posed.wgsl.

@group(0) @binding(3) var picture: texture_2d<f32>;

struct Corner {
    // Invariant: the same depth, to the bit, in every draw.
    @builtin(position) @invariant position: vec4f,
    @location(0) normal: vec3f,
    @location(1) uv: vec2f,
}

fn projected(seen: vec3f) -> vec4f {
    let depth = -seen.z;
    return vec4f(seen.xy * mesh.focal + depth * mesh.shift, mesh.near, depth);
}

@vertex
fn corner(@builtin(vertex_index) i: u32) -> Corner {
    let triangle = textureLoad(triangles, place(i / 3u), 0);
    let own = vertex(triangle[i % 3u]);
    var out: Corner;
    out.position = projected(own.seen);
    out.normal = own.normal;
    out.uv = own.uv;
    return out;
}

fn shown(front: bool) {
    if !front && mesh.both == 0.0 {
        discard;
    }
}

fn shaded(color: vec4f, normal: vec3f, front: bool) -> vec4f {
    let facing = normalize(normal) * select(-1.0, 1.0, front);
    let light = mesh.ambient + (1.0 - mesh.ambient) * max(dot(facing, mesh.light), 0.0);
    return vec4f(color.rgb * light, color.a);
}

fn texel(at: vec2i, size: vec2i) -> vec4f {
    return textureLoad(picture, ((at % size) + size) % size, 0);
}

fn pictured_at(uv: vec2f) -> vec4f {
    let size = vec2i(textureDimensions(picture));
    let at = vec2f(fract(uv.x), 1.0 - fract(uv.y)) * vec2f(size) - 0.5;
    let low = vec2i(floor(at));
    let part = at - floor(at);
    let top = mix(texel(low, size), texel(low + vec2i(1, 0), size), part.x);
    let bottom = mix(texel(low + vec2i(0, 1), size), texel(low + vec2i(1, 1), size), part.x);
    return mix(top, bottom, part.y);
}

@fragment
fn plain(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    shown(front);
    return shaded(mesh.color, in.normal, front);
}

@fragment
fn pictured(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    shown(front);
    return shaded(pictured_at(in.uv), in.normal, front);
}

// The same for what is drawn on the surface: with what each pixel shows.
struct Facet {
    @builtin(position) @invariant position: vec4f,
    @location(0) normal: vec3f,
    @location(1) uv: vec2f,
    @location(2) @interpolate(flat) triangle: u32,
    @location(3) @interpolate(flat) slope: vec2f,
}

struct Facts {
    // The shaded color, premultiplied.
    @location(0) shaded: vec4f,
    // The triangle's number and 1, the normal, and how fast 1 / depth grows to the right and down, on the plane at focal length 1.
    @location(1) facts: vec4u,
}

// How fast 1 / depth grows across a triangle, to the right and down; all its corners must agree.
fn slope(triangle: vec4u) -> vec2f {
    let a = vertex(triangle.x).seen;
    let normal = cross(vertex(triangle.y).seen - a, vertex(triangle.z).seen - a);
    return vec2f(normal.x, -normal.y) / dot(normal, a);
}

@vertex
fn facet(@builtin(vertex_index) i: u32) -> Facet {
    let number = i / 3u;
    let triangle = textureLoad(triangles, place(number), 0);
    let own = vertex(triangle[i % 3u]);
    return Facet(projected(own.seen), own.normal, own.uv, number, slope(triangle));
}

// A direction in two numbers: on an octahedron, folded flat.
fn packed(way: vec3f) -> u32 {
    let flat = way.xy / (abs(way.x) + abs(way.y) + abs(way.z));
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return pack2x16snorm(select(flat, folded, way.z < 0.0));
}

fn facts(in: Facet, front: bool, shaded: vec4f) -> Facts {
    let facing = normalize(in.normal) * select(-1.0, 1.0, front);
    return Facts(shaded, vec4u(in.triangle + 1u, packed(facing), bitcast<vec2u>(in.slope)));
}

@fragment
fn plain_facts(in: Facet, @builtin(front_facing) front: bool) -> Facts {
    shown(front);
    return facts(in, front, shaded(mesh.color, in.normal, front));
}

@fragment
fn pictured_facts(in: Facet, @builtin(front_facing) front: bool) -> Facts {
    shown(front);
    return facts(in, front, shaded(pictured_at(in.uv), in.normal, front));
}
