// The vertices of a mesh, bent, posed and seen by the camera, as in pose.rs: stands before the code that uses them.

struct Mesh {
    eye_from_model: mat4x4f,
    world_from_normal: mat4x4f,
    along: vec3f,
    start: f32,
    light: vec3f,
    ambient: f32,
    color: vec4f,
    focal: vec2f,
    shift: vec2f,
    bend: f32,
    length: f32,
    near: f32,
    both: f32,
}

@group(0) @binding(0) var<uniform> mesh: Mesh;
@group(0) @binding(1) var vertices: texture_2d<f32>;
@group(0) @binding(2) var triangles: texture_2d<u32>;

const WIDTH: u32 = 4096u;

fn place(i: u32) -> vec2u {
    return vec2u(i % WIDTH, i / WIDTH);
}

// About the model's z.
fn bent(v: vec3f, angle: f32) -> vec3f {
    let c = cos(angle);
    let s = sin(angle);
    return vec3f(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
}

// The angle by which the model is bent at a place.
fn bend_at(at: vec3f) -> f32 {
    return mesh.bend * clamp((dot(at, mesh.along) - mesh.start) / mesh.length, 0.0, 1.0);
}

// A corner of a triangle, and where it is in camera coordinates.
struct Vertex {
    seen: vec3f,
    normal: vec3f,
    uv: vec2f,
}

fn vertex(number: u32) -> Vertex {
    let first = textureLoad(vertices, place(2u * number), 0);
    let second = textureLoad(vertices, place(2u * number + 1u), 0);
    let angle = bend_at(first.xyz);
    var out: Vertex;
    out.seen = (mesh.eye_from_model * vec4f(bent(first.xyz, angle), 1.0)).xyz;
    out.normal = (mesh.world_from_normal * vec4f(bent(second.xyz, angle), 0.0)).xyz;
    out.uv = vec2f(first.w, second.w);
    return out;
}
