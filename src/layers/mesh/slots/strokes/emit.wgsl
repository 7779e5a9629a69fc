// The impulses of a noise, as in impulse.rs, grid.rs and flat.rs: they are counted piece by piece, then each is made by a thread
// of its own, in the same order in every frame. It follows aim.wgsl.

// How many impulses the pieces of a block before each piece have, and the blocks before each block; and then all of them.
@group(0) @binding(9) var<storage, read_write> before_piece: array<u32>;
@group(0) @binding(10) var<storage, read_write> before_block: array<u32>;
// `Splat` in splats.wgsl or `Flat` in flats.wgsl.
@group(0) @binding(11) var<storage, read_write> made: array<vec4u>;
// `Tally` of a plan.
@group(0) @binding(12) var<storage, read_write> tally: array<u32, 8>;

// What kernels are fixed to.
override anchor: u32;
const SURFACE: u32 = 0u;
const FRAME: u32 = 1u;
const TEXTURE: u32 = 2u;

// Threads of a group, pieces of a block.
const WIDE: u32 = 256u;
const PI: f32 = 3.1415927;
// 2 - 2 ln 2.
const FADE: f32 = 0.6137056;
const MOST: f32 = 16384.0 * FADE;

fn mixed(v: vec4u) -> vec4u {
    var m = v;
    m.x += m.y * m.w;
    m.y += m.z * m.x;
    m.z += m.x * m.y;
    m.w += m.y * m.z;
    return m;
}

fn pcg4d(v: vec4u) -> vec4u {
    let m = mixed(v * 1664525u + 1013904223u);
    return mixed(m ^ (m >> vec4u(16u)));
}

fn unit(bits: u32) -> f32 {
    return f32(bits >> 8u) / 16777216.0;
}

fn rank(number: u32, dice: vec4u) -> f32 {
    return f32(number) + f32((dice.w >> 8u) + 1u) / 16777216.0;
}

// A part of a triangle, or a cell of the frame: its numbers, its corners as weights of the first two of the triangle's, and its
// share of the area.
struct Piece {
    number: vec2u,
    corners: array<vec2f, 3>,
    share: f32,
}

fn piece(i: u32) -> Piece {
    if anchor == FRAME {
        let cell = vec2u(i / recipe.down, i % recipe.down) - 1u;
        return Piece(cell, array(vec2f(0.0), vec2f(0.0), vec2f(0.0)), 1.0);
    }
    let first = textureLoad(pieces, place(2u * i), 0);
    let second = bitcast<vec4f>(textureLoad(pieces, place(2u * i + 1u), 0));
    let corners = array(bitcast<vec2f>(first.zw), second.xy, second.zw);
    return Piece(first.xy, corners, 1.0 / f32(1u << firstLeadingBit(first.y)));
}

// Impulses for each square pixel, where kernels are so many times as large.
fn density(larger: f32) -> f32 {
    let radius = recipe.radius * larger;
    return recipe.overlap / (PI * radius * radius);
}

// How many impulses a cell has, or a piece on the surface, whatever is seen of it.
fn fixed(own: Piece, spot: Spot) -> f32 {
    if anchor == FRAME {
        return 4.0 * recipe.overlap / PI;
    }
    let area = length(cross(spot.ab, spot.ac)) / 2.0;
    return density(1.0) * recipe.px_per_m * recipe.px_per_m * area * own.share;
}

fn in_frame(seen: vec3f) -> vec2f {
    return recipe.middle + vec2f(seen.x, -seen.y) * (recipe.focal / -seen.z);
}

// What a piece would have at a depth of 1, in square pixels; 0 if it cannot be seen.
fn area_of(own: Piece, spot: Spot) -> f32 {
    let volume = dot(spot.a, cross(spot.ab, spot.ac));
    let hidden = volume > 0.0 && mesh.both == 0.0;
    return select(recipe.focal * recipe.focal * abs(volume) * own.share / 2.0, 0.0, hidden);
}

// How many impulses a piece has at most.
fn most_of(own: Piece) -> f32 {
    if anchor == FRAME {
        return fixed(own, Spot());
    }
    let spot = spot(own.number.x, vec3f(1.0, 0.0, 0.0));
    if anchor == TEXTURE {
        return fixed(own, spot);
    }
    let reach = recipe.radius * max(recipe.low, recipe.high);
    var nearest = 1e30;
    var near = 0u;
    var beside = vec4<bool>(true);
    for (var k = 0; k < 3; k++) {
        let weights = own.corners[k];
        let corner = spot.a + spot.ab * weights.y + spot.ac * (1.0 - weights.x - weights.y);
        nearest = min(nearest, -corner.z);
        near += select(0u, 1u, -corner.z < mesh.near);
        let at = in_frame(corner);
        beside &= vec4<bool>((at + reach) < vec2f(0.0), (at - reach) > recipe.size);
    }
    if near == 3u || near == 0u && any(beside) {
        return 0.0;
    }
    let depth = max(nearest, mesh.near);
    return density(min(recipe.low, recipe.high)) * area_of(own, spot) / (depth * depth * depth);
}

// The sum over the threads up to and including this one.
var<workgroup> sums: array<u32, WIDE>;
fn sum_to(lane: u32, own: u32) -> u32 {
    sums[lane] = own;
    for (var away = 1u; away < WIDE; away *= 2u) {
        workgroupBarrier();
        var before = 0u;
        if lane >= away {
            before = sums[lane - away];
        }
        workgroupBarrier();
        sums[lane] += before;
    }
    workgroupBarrier();
    return sums[lane];
}

// Counts the impulses of a piece: ranks grow by 1, so that only the last has to be looked at.
@compute @workgroup_size(WIDE)
fn count(@builtin(workgroup_id) block: vec3u, @builtin(local_invocation_index) lane: u32) {
    let i = block.x * WIDE + lane;
    var count = 0u;
    if i < recipe.count {
        let own = piece(i);
        let most = min(most_of(own), MOST) / FADE;
        if most > 0.0 {
            count = u32(most);
            count += select(0u, 1u, rank(count, pcg4d(vec4u(own.number, count, recipe.key))) < most);
        }
    }
    let upto = sum_to(lane, count);
    if i < recipe.count {
        before_piece[i] = upto - count;
    }
    if lane == WIDE - 1u {
        before_block[block.x] = upto;
    }
}

fn blocks() -> u32 {
    return (recipe.count + WIDE - 1u) / WIDE;
}

// Adds up the blocks, in one group.
@compute @workgroup_size(WIDE)
fn scan(@builtin(local_invocation_index) lane: u32) {
    var all = 0u;
    for (var first = 0u; first < blocks(); first += WIDE) {
        let i = first + lane;
        var own = 0u;
        if i < blocks() {
            own = before_block[i];
        }
        let upto = sum_to(lane, own);
        if i < blocks() {
            before_block[i] = all + upto - own;
        }
        all += sums[WIDE - 1u];
        workgroupBarrier();
    }
    if lane > 0u {
        return;
    }
    before_block[blocks()] = all;
    let lumps = select(3u, 4u, anchor == TEXTURE);
    tally[0] = max(tally[0], all * lumps);
    // With less room all of this counts for nothing.
    let drawn = min(all, arrayLength(&made) / lumps);
    let groups = (drawn + WIDE - 1u) / WIDE;
    tally[1] = min(groups, 65535u);
    tally[2] = (groups + 65534u) / 65535u;
    tally[3] = 1u;
    tally[4] = 6u;
    tally[5] = drawn;
}

// How much an impulse of this rank counts where so many are wanted.
fn factor(wanted: f32, rank: f32) -> f32 {
    let counted = min(wanted, MOST);
    return clamp(counted / (FADE * rank) - 1.0, 0.0, 1.0) * sqrt(wanted / counted);
}

// Random numbers for an impulse, and how far it is turned, clockwise.
struct Dice {
    bits: vec4u,
    rank: f32,
    spread: f32,
}

fn dice(piece: vec2u, number: u32) -> Dice {
    let bits = pcg4d(vec4u(piece, number, recipe.key));
    let spread = recipe.spread * (2.0 * unit(pcg4d(vec4u(piece, number, recipe.key ^ 0x80000000u)).x) - 1.0);
    return Dice(bits, rank(number, bits), spread);
}

fn spot_of(own: Piece, dice: Dice) -> Spot {
    let outward = sqrt(unit(dice.bits.x));
    let along = unit(dice.bits.y);
    let within = vec3f(1.0 - outward, outward * (1.0 - along), outward * along);
    let weights = own.corners[0] * within.x + own.corners[1] * within.y + own.corners[2] * within.z;
    return spot(own.number.x, vec3f(weights, 1.0 - weights.x - weights.y));
}

fn turned(way: vec2f, angle: f32) -> vec2f {
    return vec2f(way.x * cos(angle) - way.y * sin(angle), way.x * sin(angle) + way.y * cos(angle));
}

// Makes a splat, all 0 if it is not seen.
fn splat(own: Piece, number: u32) -> array<vec4u, 4> {
    let dice = dice(own.number, number);
    var at = vec2f(0.0);
    var slope = vec2f(0.0);
    var depth = 1.0;
    var larger = 1.0;
    var wanted = 0.0;
    var way = recipe.drawn;
    if anchor == FRAME {
        at = (vec2f(vec2i(own.number)) + vec2f(unit(dice.bits.x), unit(dice.bits.y))) * (2.0 * recipe.radius);
        wanted = fixed(own, Spot());
    } else {
        let spot = spot_of(own, dice);
        depth = -spot.place.z;
        if depth < mesh.near {
            return array<vec4u, 4>();
        }
        larger = larger_at(spot);
        wanted = density(larger) * area_of(own, spot) / (depth * depth * depth);
        at = in_frame(spot.place);
        let level = cross(spot.ab, spot.ac);
        slope = vec2f(level.x, -level.y) / (dot(spot.a, level) * recipe.focal);
        way = run(spot);
    }
    let counts = factor(wanted, dice.rank);
    if !(counts > 0.0) {
        return array<vec4u, 4>();
    }
    let radius = recipe.radius * larger;
    way = turned(way, dice.spread);
    return array(
        bitcast<vec4u>(vec4f(at, radius, counts)),
        bitcast<vec4u>(vec4f(vec2f(-way.y, way.x) / (recipe.spacing * larger), unit(dice.bits.z), depth * recipe.focal / radius)),
        vec4u(bitcast<vec3u>(vec3f(slope, select(1.0 / depth, 0.0, anchor == FRAME))), own.number.x),
        vec4u(),
    );
}

// Makes a kernel on the surface, all 0 if it covers no pixel.
fn flat_kernel(own: Piece, number: u32) -> array<vec4u, 4> {
    let dice = dice(own.number, number);
    var spot = spot_of(own, dice);
    spot.normal = direction(cross(spot.ab, spot.ac));
    let counts = factor(fixed(own, spot), dice.rank);
    let way = on_surface(spot);
    let along = way * cos(dice.spread) - cross(spot.normal, way) * sin(dice.spread);
    let across = cross(along, spot.normal);
    let pixels = covered(spot.place, array(along, across, 2.0 * recipe.reach * spot.normal));
    if !(counts > 0.0) || !all(pixels.xy < pixels.zw) {
        return array<vec4u, 4>();
    }
    return array(
        bitcast<vec4u>(vec4f(spot.place, counts)),
        bitcast<vec4u>(vec4f(along, unit(dice.bits.z))),
        bitcast<vec4u>(vec4f(across, 0.0)),
        bitcast<vec4u>(pixels),
    );
}

// The pixels that a kernel with these axes, in its radii, may cover.
fn covered(at: vec3f, axes: array<vec3f, 3>) -> vec4f {
    var sides = axes;
    var low = vec2f(1e30);
    var high = vec2f(-1e30);
    var near = 0u;
    for (var k = 0u; k < 8u; k++) {
        let sense = select(vec3f(1.0), vec3f(-1.0), (vec3u(k) >> vec3u(0u, 1u, 2u) & vec3u(1u)) == vec3u(1u));
        let away = sides[0] * sense.x + sides[1] * sense.y + sides[2] * sense.z;
        let corner = at + away * (recipe.radius / recipe.px_per_m);
        near += select(0u, 1u, -corner.z < mesh.near);
        low = min(low, in_frame(corner));
        high = max(high, in_frame(corner));
    }
    if near > 0u {
        return select(vec4f(vec2f(0.0), recipe.size), vec4f(0.0), near == 8u);
    }
    return vec4f(max(floor(low), vec2f(0.0)), min(ceil(high), recipe.size));
}

@compute @workgroup_size(WIDE)
fn emit(@builtin(global_invocation_id) id: vec3u) {
    let number = id.y * 65535u * WIDE + id.x;
    if number >= before_block[blocks()] {
        return;
    }
    // The last block that begins before it, and the last piece there.
    var low = 0u;
    var high = blocks();
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if before_block[middle] <= number {
            low = middle;
        } else {
            high = middle;
        }
    }
    let in_block = number - before_block[low];
    low *= WIDE;
    high = min(low + WIDE, recipe.count);
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if before_piece[middle] <= in_block {
            low = middle;
        } else {
            high = middle;
        }
    }
    let own = piece(low);
    let in_piece = in_block - before_piece[low];
    if anchor == TEXTURE {
        let out = flat_kernel(own, in_piece);
        made[4u * number] = out[0];
        made[4u * number + 1u] = out[1];
        made[4u * number + 2u] = out[2];
        made[4u * number + 3u] = out[3];
    } else {
        let out = splat(own, in_piece);
        made[3u * number] = out[0];
        made[3u * number + 1u] = out[1];
        made[3u * number + 2u] = out[2];
    }
}
