// The sprites of a waterfall in the frame: the twin of draw.rs, with the same names.

struct Frame {
    size: vec2f,
    place: vec2f, // in the pixel
    soft: f32,
    near: f32,
}

struct Sprite {
    middle: vec2f,
    size: vec2f,
    turn: vec2f,
    side: f32, // of its pictures, in texels
    mirrored: f32,
    tint: vec3f,
    opacity: f32,
    slopes: vec4f, // of the first key, to the right and down, then of the second
    keys: array<vec4f, 4>, // the first texel in the atlas, and the weight
    residue: vec4f, // as a key
    depth: vec4f, // in meters; the rest is unused
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> sprites: array<Sprite>;
@group(0) @binding(2) var keys: texture_2d<f32>;
@group(0) @binding(3) var residues: texture_2d<f32>;
@group(0) @binding(4) var linear: sampler;
@group(0) @binding(5) var depths: texture_depth_2d;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) sprite: u32,
}

@vertex
fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) i: u32) -> Corner {
    let sprite = sprites[i];
    // Two triangles, a little larger than the sprite: which pixels it covers is decided there.
    let k = select(vertex, vertex - 2u, vertex > 2u);
    let own = (vec2f(f32(k & 1u), f32(k >> 1u)) - 0.5) * (sprite.size + 1.0);
    let turn = sprite.turn;
    let at = sprite.middle + vec2f(turn.x * own.x - turn.y * own.y, turn.y * own.x + turn.x * own.y);
    let shown = (at - frame.place + 0.5) / frame.size;
    return Corner(vec4f(2.0 * shown.x - 1.0, 1.0 - 2.0 * shown.y, 0.0, 1.0), i);
}

fn filtered(atlas: texture_2d<f32>, texel: vec2f) -> vec4f {
    return textureSampleLevel(atlas, linear, texel / vec2f(textureDimensions(atlas)), 0.0);
}

// A key, with its slopes.
fn key(first: vec2f, own: vec2f, slope: vec2f) -> vec4f {
    let across = filtered(keys, first + own + vec2f(1.0, 0.0)) - filtered(keys, first + own - vec2f(1.0, 0.0));
    let down = filtered(keys, first + own + vec2f(0.0, 1.0)) - filtered(keys, first + own - vec2f(0.0, 1.0));
    return slope.x * across + slope.y * down;
}

// What it shows at a place in texels of its level, without a residue.
fn mixed(sprite: Sprite, own: vec2f) -> vec4f {
    var color = vec4f(0.0);
    for (var k = 0; k < 4; k += 1) {
        if sprite.keys[k].z != 0.0 {
            color += sprite.keys[k].z * filtered(keys, sprite.keys[k].xy + own);
        }
    }
    if any(sprite.slopes != vec4f(0.0)) {
        color += key(sprite.keys[0].xy, own, sprite.slopes.xy) + key(sprite.keys[1].xy, own, sprite.slopes.zw);
    }
    return color;
}

// Up to this residue, the product of two filtered reads is as good as the filtered product.
const FAINT: f32 = 0.02;

// The residue there, as far as what it lies on covers.
fn residue(sprite: Sprite, own: vec2f, alpha: f32) -> f32 {
    if sprite.residue.z <= FAINT {
        return filtered(residues, sprite.residue.xy + own).x * alpha;
    }
    let first = floor(own - 0.5);
    let share = own - 0.5 - first;
    var sum = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        let step = vec2f(f32(k & 1u), f32(k >> 1u));
        let texel = min(first + step, vec2f(sprite.side - 1.0)) + 0.5;
        let weight = mix(1.0 - share, share, step);
        sum += weight.x * weight.y * filtered(residues, sprite.residue.xy + texel).x * mixed(sprite, texel).a;
    }
    return sum;
}

// What it shows at a place in texels of its level.
fn between(sprite: Sprite, own: vec2f) -> vec4f {
    let color = mixed(sprite, own);
    if sprite.residue.z == 0.0 {
        return color;
    }
    return color + vec4f(vec3f(sprite.residue.z * residue(sprite, own, color.a)), 0.0);
}

fn before(surface: f32, depth: f32) -> f32 {
    return select(f32(depth < surface), clamp((surface - depth) / frame.soft, 0.0, 1.0), frame.soft > 0.0);
}

@fragment
fn shade(at: Corner) -> @location(0) vec4f {
    let sprite = sprites[at.sprite];
    let pixel = floor(at.position.xy);
    let d = pixel + frame.place - sprite.middle;
    let turn = sprite.turn;
    var own = vec2f(turn.x * d.x + turn.y * d.y, turn.x * d.y - turn.y * d.x) / sprite.size;
    if any(abs(own) >= vec2f(0.5)) {
        discard;
    }
    own.x = select(own.x, -own.x, sprite.mirrored != 0.0);
    let color = between(sprite, clamp((own + 0.5) * sprite.side, vec2f(0.5), vec2f(sprite.side - 0.5)));
    let alpha = clamp(color.a, 0.0, 1.0);
    let light = clamp(clamp(color.rgb, vec3f(0.0), vec3f(alpha)) * sprite.tint, vec3f(0.0), vec3f(alpha));
    let near = textureLoad(depths, vec2i(pixel), 0);
    var opacity = sprite.opacity;
    if near > 0.0 {
        opacity *= before(frame.near / near, sprite.depth.x);
    }
    return vec4f(light, alpha) * opacity;
}
