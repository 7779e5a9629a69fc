// Where strokes run, and how large they are, as in aim.rs. It follows posed.wgsl.

struct Recipe {
    // From directions in the world to camera coordinates.
    turn: mat4x4f,
    // Where the light goes, in camera coordinates.
    light: vec3f,
    overlap: f32,
    // An axis of the model.
    axis: vec3f,
    spread: f32,
    size: vec2f,
    middle: vec2f,
    // Each the cosine and the sine of an angle: of directions on a texture, clockwise of the drawing, twice of where a direction
    // is not sure; and counter-clockwise of the turn of directions.
    angle: vec2f,
    drawn: vec2f,
    unsure: vec2f,
    turned: vec2f,
    low: f32,
    high: f32,
    // Half the size of the mesh.
    half: f32,
    focal: f32,
    radius: f32,
    spacing: f32,
    reach: f32,
    px_per_m: f32,
    key: u32,
    // How many pieces there are, or cells; and how many of those are in a column.
    count: u32,
    down: u32,
}

@group(0) @binding(3) var<uniform> recipe: Recipe;
@group(0) @binding(4) var pieces: texture_2d<u32>;
// Tensors of curvature, for directions and for sizes.
@group(0) @binding(5) var ways: texture_2d<f32>;
@group(0) @binding(6) var sizes: texture_2d<f32>;
// Images, for both.
@group(0) @binding(7) var flow: texture_2d<f32>;
@group(0) @binding(8) var bright: texture_2d<f32>;

// What strokes follow, and what makes them larger.
override along: u32;
override by: u32;
const SCREEN: u32 = 0u;
const CURVATURE: u32 = 1u;
const LIGHT: u32 = 2u;
const AXIS: u32 = 3u;
const OUTLINE: u32 = 4u;
const IMAGE: u32 = 5u;
const FACING: u32 = 6u;

const UNSURE: f32 = 0.25;
const FLAT: f32 = 0.1;

// A triangle as it is seen, and a place of it.
struct Spot {
    corners: vec3u,
    a: vec3f,
    ab: vec3f,
    ac: vec3f,
    weights: vec3f,
    place: vec3f,
    // Turned to the camera.
    normal: vec3f,
    uv: vec2f,
    // How texture coordinates change along its sides.
    uv_ab: vec2f,
    uv_ac: vec2f,
}

fn spot(triangle: u32, corner_weights: vec3f) -> Spot {
    var out: Spot;
    out.corners = textureLoad(triangles, place(triangle), 0).xyz;
    out.weights = corner_weights;
    let a = vertex(out.corners.x);
    let b = vertex(out.corners.y);
    let c = vertex(out.corners.z);
    out.a = a.seen;
    out.ab = b.seen - a.seen;
    out.ac = c.seen - a.seen;
    out.place = a.seen + out.ab * out.weights.y + out.ac * out.weights.z;
    let normal = direction(a.normal * out.weights.x + b.normal * out.weights.y + c.normal * out.weights.z);
    out.normal = (recipe.turn * vec4f(normal, 0.0)).xyz * select(1.0, -1.0, dot(out.a, cross(out.ab, out.ac)) > 0.0);
    out.uv = a.uv * out.weights.x + b.uv * out.weights.y + c.uv * out.weights.z;
    out.uv_ab = b.uv - a.uv;
    out.uv_ac = c.uv - a.uv;
    return out;
}

fn laid(v: vec3f, normal: vec3f) -> vec3f {
    return v - normal * dot(v, normal);
}

fn direction(v: vec3f) -> vec3f {
    let long = length(v);
    return select(vec3f(0.0), v / long, long > 0.0);
}

// From directions, of which the world's are made so, to camera coordinates.
fn seen_from(world: mat4x4f) -> mat3x3f {
    let turn = recipe.turn * world;
    return mat3x3f(turn[0].xyz, turn[1].xyz, turn[2].xyz);
}

// How the model is turned at one of its vertices, to camera coordinates.
fn turn_at(vertex: u32) -> mat3x3f {
    let angle = bend_at(textureLoad(vertices, place(2u * vertex), 0).xyz);
    let bend = mat3x3f(bent(vec3f(1.0, 0.0, 0.0), angle), bent(vec3f(0.0, 1.0, 0.0), angle), vec3f(0.0, 0.0, 1.0));
    return seen_from(mesh.world_from_normal) * bend;
}

fn tensor_of(tensors: texture_2d<f32>, vertex: u32) -> mat3x3f {
    let first = textureLoad(tensors, place(2u * vertex), 0);
    let second = textureLoad(tensors, place(2u * vertex + 1u), 0);
    let turn = turn_at(vertex);
    let own = mat3x3f(
        vec3f(first.x, first.y, first.z),
        vec3f(first.y, first.w, second.x),
        vec3f(first.z, second.x, second.y),
    );
    return turn * own * transpose(turn);
}

fn tensor(tensors: texture_2d<f32>, spot: Spot) -> mat3x3f {
    return tensor_of(tensors, spot.corners.x) * spot.weights.x
        + tensor_of(tensors, spot.corners.y) * spot.weights.y
        + tensor_of(tensors, spot.corners.z) * spot.weights.z;
}

fn flow_at(at: vec2i, size: vec2i) -> vec2f {
    return textureLoad(flow, ((at % size) + size) % size, 0).xy;
}

// The vector of a flow map, to the right and up.
fn flowing(uv: vec2f) -> vec2f {
    let size = vec2i(textureDimensions(flow));
    let at = vec2f(uv.x, 1.0 - uv.y) * vec2f(size) - 0.5;
    let low = vec2i(floor(at));
    let part = at - floor(at);
    let above = mix(flow_at(low, size), flow_at(low + vec2i(1, 0), size), part.x);
    let below = mix(flow_at(low + vec2i(0, 1), size), flow_at(low + vec2i(1, 1), size), part.x);
    return (mix(above, below, part.y) - 128.0) / 127.0;
}

fn brightness(uv: vec2f) -> f32 {
    let size = vec2i(textureDimensions(bright));
    let at = vec2i(floor(vec2f(uv.x, 1.0 - uv.y) * vec2f(size)));
    let code = textureLoad(bright, ((at % size) + size) % size, 0).rgb;
    return dot(code, vec3f(0.2126, 0.7152, 0.0722)) / 255.0;
}

// How much larger strokes are.
fn larger_at(spot: Spot) -> f32 {
    var share = 0.0;
    switch by {
        case LIGHT: {
            share = max(-dot(spot.normal, recipe.light), 0.0);
        }
        case FACING: {
            share = abs(dot(spot.normal, direction(spot.place)));
        }
        case CURVATURE: {
            let own = tensor(sizes, spot);
            let squares = dot(own[0], own[0]) + dot(own[1], own[1]) + dot(own[2], own[2]);
            let curved = recipe.half * sqrt(squares) / (4.0 * sqrt(2.0));
            share = curved / (1.0 + curved);
        }
        case IMAGE: {
            share = brightness(spot.uv);
        }
        default: {
            return 1.0;
        }
    }
    return recipe.low + (recipe.high - recipe.low) * share;
}

// The cosine and the sine of half the angle of a direction.
fn half_angle(v: vec2f) -> vec2f {
    let long = length(v);
    if long == 0.0 {
        return vec2f(1.0, 0.0);
    }
    let way = v / long;
    if way.x >= 0.0 {
        let cosine = sqrt((1.0 + way.x) / 2.0);
        return vec2f(cosine, way.y / (2.0 * cosine));
    }
    let sine = sqrt((1.0 - way.x) / 2.0);
    return vec2f(abs(way.y) / (2.0 * sine), select(sine, -sine, way.y < 0.0));
}

// A direction that is sure, mixed with that of the drawing: by twice their angles, so that a stroke has no front.
fn blended(way: vec2f, sure: f32) -> vec2f {
    let square = dot(way, way);
    var twice = select(vec2f(1.0, 0.0), vec2f(way.x * way.x - way.y * way.y, 2.0 * way.x * way.y) / square, square > 0.0);
    // Of two ends that count the same it is the one that is exactly above or below.
    if way.x == 0.0 {
        twice.y = sign(way.y) * 1e-20;
    }
    return half_angle(sure * twice + (1.0 - sure) * UNSURE * recipe.unsure);
}

// What strokes follow on the surface, and how sure that is.
fn tangent(spot: Spot) -> vec4f {
    let normal = spot.normal;
    switch along {
        case LIGHT: {
            let way = laid(recipe.light, normal);
            return vec4f(way, length(way));
        }
        case AXIS: {
            let way = laid(turn_at(spot.corners.x) * recipe.axis, normal);
            return vec4f(way, length(way));
        }
        case IMAGE: {
            let vector = flowing(spot.uv);
            let sense = select(1.0, -1.0, spot.uv_ab.x * spot.uv_ac.y < spot.uv_ab.y * spot.uv_ac.x);
            let right = direction((spot.ab * spot.uv_ac.y - spot.ac * spot.uv_ab.y) * sense);
            let up = direction((spot.ac * spot.uv_ab.x - spot.ab * spot.uv_ac.x) * sense);
            return vec4f(laid(right * vector.x + up * vector.y, normal), min(length(vector), 1.0));
        }
        default: {
            let one = direction(laid(spot.ab, normal));
            let two = cross(normal, one);
            let own = tensor(ways, spot);
            let a = dot(one, own * one);
            let b = dot(one, own * two);
            let c = dot(two, own * two);
            // Squared, so that a saddle is unsure, and hollow and round are the same.
            let q = vec3f(a * a + b * b, a * b + b * c, b * b + c * c);
            let apart = vec2f(q.x - q.z, 2.0 * q.y);
            let way = half_angle(apart);
            let level = FLAT / recipe.half;
            return vec4f(one * way.x + two * way.y, length(apart) / (q.x + q.z + level * level));
        }
    }
}

// The direction of a stroke in the plane of its triangle, for strokes that lie on the surface.
fn on_surface(spot: Spot) -> vec3f {
    var found = vec3f(0.0);
    if along == SCREEN || along == OUTLINE {
        found = laid(turn_at(spot.corners.x) * vec3f(recipe.angle, 0.0), spot.normal);
    } else {
        found = laid(tangent(spot).xyz, spot.normal);
    }
    if all(found == vec3f(0.0)) {
        found = laid(spot.ab, spot.normal);
    }
    let way = direction(found);
    return way * recipe.turned.x + cross(spot.normal, way) * recipe.turned.y;
}

// The cosine and the sine of the angle of a stroke, clockwise.
fn run(spot: Spot) -> vec2f {
    if along == SCREEN {
        return recipe.drawn;
    }
    if along == OUTLINE {
        let way = vec2f(spot.normal.y, spot.normal.x);
        let back = vec2f(recipe.turned.x, -recipe.turned.y);
        let turned = vec2f(way.x * back.x - way.y * back.y, way.x * back.y + way.y * back.x);
        return blended(turned, length(way));
    }
    let found = tangent(spot);
    if all(found.xyz == vec3f(0.0)) {
        return recipe.drawn;
    }
    let flat = normalize(found.xyz);
    // Counter-clockwise about the normal.
    let way = flat * recipe.turned.x + cross(spot.normal, flat) * recipe.turned.y;
    let depth = -spot.place.z;
    let seen = vec2f(way.x + spot.place.x * way.z / depth, -way.y - spot.place.y * way.z / depth);
    return blended(seen, found.w * min(length(seen), 1.0));
}
