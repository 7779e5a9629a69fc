// What a view map shows: the same as sample.rs, with what that reads (gauge.rs, mixer.rs, mix.rs, arrays.rs). It follows
// frame.wgsl.

struct Map {
    // Of each layer: the first of its squares, and the first of its cells.
    layers: array<vec4u, 9>,
    missing: vec3f,
    // How much of the base coat alone is seen.
    base: f32,
    // What a triangle's area has to be multiplied with, and divided by its volume, to be the cells of layer 0 that a pixel covers
    // at depth 1.
    scale: f32,
    // How many cells of layer 0 are side by side in a unit of the atlas.
    first: f32,
    levels: u32,
    charts: u32,
    // How many directions there are along the side of an array.
    side: u32,
}

@group(0) @binding(3) var<uniform> map: Map;
@group(0) @binding(4) var corners: texture_2d<f32>;
@group(0) @binding(5) var charts: texture_2d<u32>;
@group(0) @binding(6) var squares: texture_2d<u32>;
@group(0) @binding(7) var coats: texture_2d<f32>;
// What views tell.
@group(0) @binding(8) var starts: texture_2d<u32>;
@group(0) @binding(9) var entries: texture_2d<u32>;
// Of each view two; then the extreme places of all.
@group(0) @binding(10) var<storage, read> views: array<vec4f>;

// Arrays of directions.
@group(0) @binding(11) var turns: texture_2d<f32>;
@group(0) @binding(12) var elements: texture_2d<f32>;

// Whether the arrays are read, instead of asking each view.
override from_arrays: bool;

const NONE: u32 = 0xffffffffu;

struct Spot {
    @builtin(position) @invariant position: vec4f,
    @location(0) seen: vec3f,
    @location(1) point: vec3f,
    // Where it is in its chart.
    @location(2) at: vec2f,
    @location(3) @interpolate(flat) chart: u32,
    // The cells of layer 0 that a pixel covers at depth 1.
    @location(4) @interpolate(flat) cells: f32,
    // As those of a `Facet`.
    @location(5) normal: vec3f,
    @location(6) @interpolate(flat) triangle: u32,
    @location(7) @interpolate(flat) slope: vec2f,
}

@vertex
fn spot(@builtin(vertex_index) i: u32) -> Spot {
    let number = i / 3u;
    let own = i % 3u;
    let triangle = textureLoad(triangles, place(number), 0);
    let ab = textureLoad(corners, place(2u * number), 0);
    let c = textureLoad(corners, place(2u * number + 1u), 0);
    let corner = vertex(triangle[own]);
    // Each corner must say the same.
    let a = vertex(triangle.x).seen;
    let volume = abs(dot(a, cross(vertex(triangle.y).seen - a, vertex(triangle.z).seen - a)));
    var out: Spot;
    out.position = projected(corner.seen);
    out.seen = corner.seen;
    out.point = textureLoad(vertices, place(2u * triangle[own]), 0).xyz;
    out.at = select(select(ab.xy, ab.zw, own == 1u), c.xy, own == 2u);
    out.chart = u32(c.w);
    out.cells = map.scale * c.z / volume;
    out.normal = corner.normal;
    out.triangle = number;
    out.slope = slope(triangle);
    return out;
}

fn number_of(list: texture_2d<u32>, i: u32) -> u32 {
    return textureLoad(list, place(i / 4u), 0)[i % 4u];
}

// The cells that count at a place, by layer, and how much.
struct Cells {
    layer: u32,
    cells: array<u32, 8>,
    weights: array<f32, 8>,
    all: f32,
}

fn find(layer: u32, number: u32, at: vec2i) -> u32 {
    let chart = textureLoad(charts, place(layer * map.charts + number), 0);
    if at.x < 0 || at.y < 0 || at.x >= i32(chart.y) || at.y >= i32(chart.z) {
        return NONE;
    }
    return number_of(squares, map.layers[layer].x + chart.x + u32(at.y) * chart.y + u32(at.x));
}

fn cells_at(in: Spot) -> Cells {
    let depth = -in.seen.z;
    let deep = clamp(-0.5 * log2(in.cells * depth * depth * depth), 0.0, f32(map.levels - 1u));
    var found: Cells;
    found.layer = u32(deep);
    let near = deep - floor(deep);
    for (var k = 0u; k < 2u; k++) {
        let share = select(1.0 - near, near, k == 1u);
        if share <= 0.0 {
            continue;
        }
        let at = in.at * (map.first * f32(1u << (found.layer + k))) - 0.5;
        let part = at - floor(at);
        var sides = array(1.0 - part, part);
        var sum = 0.0;
        for (var n = 0u; n < 4u; n++) {
            let to = vec2u(n & 1u, n >> 1u);
            let cell = find(found.layer + k, in.chart, vec2i(floor(at)) + vec2i(to));
            let weight = select(sides[to.x].x * sides[to.y].y, 0.0, cell == NONE);
            found.cells[4u * k + n] = cell;
            found.weights[4u * k + n] = weight;
            sum += weight;
        }
        if sum > 0.0 {
            found.all += share;
            for (var n = 4u * k; n < 4u * k + 4u; n++) {
                found.weights[n] *= share / sum;
            }
        }
    }
    return found;
}

// The way from a place to the eye, in the model.
fn way_from(in: Spot) -> vec3f {
    let turn = mat3x3f(mesh.eye_from_model[0].xyz, mesh.eye_from_model[1].xyz, mesh.eye_from_model[2].xyz);
    return normalize(bent(-in.seen * turn, -bend_at(in.point)));
}

// What a cell shows: the dependent views over its base coat.
fn over(layer: u32, cell: u32, dependent: vec4f) -> vec3f {
    let coat = textureLoad(coats, place(map.layers[layer].y + cell), 0).rgb;
    return mix(dependent.rgb + (1.0 - dependent.a) * coat, coat, map.base);
}

// What is told to a cell, and by whom.
struct Told {
    color: vec3f,
    mask: f32,
    facing: f32,
    depth: f32,
    view: u32,
}

// A half float, not negative, in the low bits: not every device unpacks one.
fn half(bits: u32) -> f32 {
    return bitcast<f32>((bits & 0x7fffu) << 13u) * 5.192296858534828e33;
}

fn told(at: u32) -> Told {
    let bits = textureLoad(entries, place(at), 0);
    var out: Told;
    out.color = vec3f(half(bits.x), half(bits.x >> 16u), half(bits.y));
    out.facing = unpack2x16unorm(bits.y >> 16u).x;
    out.depth = bitcast<f32>(bits.z);
    out.mask = f32(bits.w >> 8u) / 16777215.0;
    out.view = bits.w & 255u;
    return out;
}

struct View {
    position: vec3f,
    // The tangent of half the angle that it reaches to.
    reach: f32,
    // How much faster it fades for what it holds.
    steep: f32,
    kind: u32,
    // Its extreme places.
    first: u32,
    count: u32,
}

const INDEPENDENT: u32 = 0u;
const AUTO: u32 = 1u;
const POINTS: u32 = 3u;
// This is added where the fade is linear.
const LINEAR: u32 = 4u;

fn view(number: u32) -> View {
    let first = views[2u * number];
    let second = vec4u(views[2u * number + 1u]);
    return View(first.xyz, first.w, views[2u * number + 1u].x, second.y, second.z, second.w);
}

const SAME_WAY: f32 = 0.99985;
const BEHIND: f32 = -0.999;
const MIDDLE: f32 = 1e-9;
const LEAST: f32 = 1e-3;

// How a place is looked at, and who tells something there.
struct Look {
    point: vec3f,
    eye: vec3f,
    start: u32,
    end: u32,
}

fn flat_of(way: vec3f, middle: vec3f, least: f32) -> vec3f {
    return (way - dot(way, middle) * middle) / max(1.0 + dot(way, middle), least);
}

fn extreme(own: View, k: u32, look: Look, middle: vec3f) -> vec3f {
    return flat_of(normalize(views[own.first + k % own.count].xyz - look.point), middle, LEAST);
}

// How far the way to the line between extreme places is.
fn polygon(own: View, look: Look, middle: vec3f) -> f32 {
    let at = flat_of(look.eye, middle, 0.0);
    if length(at) < MIDDLE {
        return 0.0;
    }
    var a = extreme(own, 0u, look, middle);
    for (var k = 1u; k <= own.count; k++) {
        let b = extreme(own, k, look, middle);
        let before = dot(middle, cross(a, at));
        let after = dot(middle, cross(at, b));
        let whole = dot(middle, cross(a, b));
        if before >= 0.0 && after >= 0.0 && whole > 0.0 {
            return (before + after) / whole;
        }
        a = b;
    }
    return 1.0;
}

// How far the way to its limit the eye is, for a view that is seen in direction `middle`.
fn gauge(own: View, look: Look, middle: vec3f) -> f32 {
    if (own.kind & 3u) == POINTS {
        return polygon(own, look, middle);
    }
    // The tangent of half the angle between both.
    var most = length(middle - look.eye) / length(middle + look.eye) / own.reach;
    if (own.kind & 3u) != AUTO {
        return most;
    }
    let along = dot(middle, look.eye);
    for (var i = look.start; i < look.end && most < 1.0; i++) {
        let limit = told(i);
        let other = view(limit.view);
        if other.kind == INDEPENDENT {
            continue;
        }
        let way = normalize(other.position - look.point);
        if dot(way, middle) <= SAME_WAY {
            let across = dot(look.eye - along * middle, way - middle);
            let whole = (1.0 + along) * 0.5 * dot(way - middle, way - middle);
            most = max(most, limit.mask * limit.facing * across / whole);
        }
    }
    return most;
}

fn factor(number: u32, look: Look) -> f32 {
    let own = view(number);
    let middle = normalize(own.position - look.point);
    if own.kind == INDEPENDENT || dot(middle, look.eye) <= BEHIND {
        return 0.0;
    }
    let y = clamp((1.0 - gauge(own, look, middle)) * own.steep, 0.0, 1.0);
    return select(y * y * (3.0 - 2.0 * y), y, own.kind >= LINEAR);
}

// How far a depth is from a layer.
fn far(depth: f32, layer: f32) -> f32 {
    return select(abs(depth - layer), 8.0 * (layer - depth) - 7.0, depth < layer - 1.0);
}

const WHOLE: f32 = 16777215.0;

// Who counts at a cell: its place in the list, and how much. Of the module: what is of a function is cleared by each call.
var<private> parts: array<u32, 256>;

// What depends on the direction, at a cell: light times opacity, then that.
fn mixed(layer: u32, cell: u32, point: vec3f, eye: vec3f) -> vec4f {
    let start = map.layers[layer].y + layer + cell;
    let look = Look(point, eye, number_of(starts, start), number_of(starts, start + 1u));
    var count = 0u;
    for (var i = look.start; i < look.end; i++) {
        let whole = factor(told(i).view, look);
        if whole > 0.0 {
            parts[count] = (i - look.start) | (u32(whole * WHOLE) << 8u);
            count++;
        }
    }
    var masks = 0.0;
    var counted = vec4f(0.0);
    for (var k = 0u; k < count; k++) {
        let own = told(look.start + (parts[k] & 255u));
        let own_far = far(own.depth, f32(layer));
        var left = f32(parts[k] >> 8u) / WHOLE;
        for (var n = 0u; n < count; n++) {
            let other = told(look.start + (parts[n] & 255u));
            let other_far = far(other.depth, f32(layer));
            let hides = clamp((own_far - other_far) / max(1.0 - other_far, 0.25), 0.0, 1.0);
            left *= 1.0 - f32(parts[n] >> 8u) / WHOLE * other.mask * other.facing * hides;
        }
        masks += left * own.mask;
        counted += left * own.mask * own.facing * vec4f(own.color, 1.0);
    }
    let opacity = min(masks, 1.0);
    return vec4f(counted.rgb * (opacity / max(counted.a, 1e-30)), opacity);
}

fn element(layer: u32, cell: u32, at: vec2u) -> vec4f {
    let first = (map.layers[layer].y + cell) * map.side * map.side;
    return textureLoad(elements, place(first + at.y * map.side + at.x), 0);
}

// The same as an array has it.
fn kept(layer: u32, cell: u32, way: vec3f) -> vec4f {
    let number = map.layers[layer].y + cell;
    let normal = textureLoad(turns, place(2u * number), 0).xyz;
    let along = textureLoad(turns, place(2u * number + 1u), 0).xyz;
    let low = vec2f(dot(way, along), dot(way, cross(normal, along)));
    let up = dot(way, normal);
    let rim = select(normalize(low), vec2f(0.0), length(low) <= 1e-12);
    let most = f32(map.side - 1u);
    let on = (select(low / (1.0 + max(up, 0.0)), rim, up < 0.0) + 1.0) * (0.5 * f32(map.side)) - 0.5;
    let at = clamp(on, vec2f(0.0), vec2f(most));
    let first = vec2u(at);
    let last = min(first + 1u, vec2u(map.side - 1u));
    let part = at - vec2f(first);
    let top = mix(element(layer, cell, first), element(layer, cell, vec2u(last.x, first.y)), part.x);
    let bottom = mix(element(layer, cell, vec2u(first.x, last.y)), element(layer, cell, last), part.x);
    return mix(top, bottom, part.y);
}

fn light_of(in: Spot) -> vec4f {
    var found = cells_at(in);
    let way = way_from(in);
    var sum = select(map.missing, vec3f(0.0), found.all > 0.0);
    for (var k = 0u; k < 8u; k++) {
        if found.weights[k] > 0.0 {
            let layer = found.layer + k / 4u;
            let cell = found.cells[k];
            var dependent = vec4f(0.0);
            if from_arrays {
                dependent = kept(layer, cell, way);
            } else {
                dependent = mixed(layer, cell, in.point, way);
            }
            sum += found.weights[k] / found.all * over(layer, cell, dependent);
        }
    }
    return vec4f(sum, 1.0);
}

@fragment
fn sampled(in: Spot, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    shown(front);
    return light_of(in);
}

@fragment
fn sampled_facts(in: Spot, @builtin(front_facing) front: bool) -> Facts {
    shown(front);
    return facts(Facet(in.position, in.normal, vec2f(0.0), in.triangle, in.slope), front, light_of(in));
}
