// Marks: how noises and tones become a drawing, pixel by pixel, as in ink.rs and tone.rs.

struct Style {
    paper: vec3f,
    fade: f32,
    toward: vec3f,
    ambient: f32,
    dark: f32,
    light: f32,
    gamma: f32,
    ground: u32,
    count: u32,
    by_light: u32,
}

struct Mark {
    // Its color, to which the scene's own is added so many times.
    color: vec3f,
    scene: f32,
    kind: u32,
    // The layers of its noise, its grain and its distances to rims; less than 0 for none.
    noise: i32,
    grain: i32,
    rims: i32,
    start: f32,
    full: f32,
    amount: f32,
    soft: f32,
    opacity: f32,
    rim: f32,
    grained: f32,
    side: f32,
    strength: f32,
    even: f32,
    half_width: f32,
    vary: f32,
    toward: vec2f,
}

@group(0) @binding(4) var<uniform> style: Style;
@group(0) @binding(5) var<storage, read> marks: array<Mark>;
@group(0) @binding(6) var shaded: texture_2d<f32>;
@group(0) @binding(7) var values: texture_2d_array<f32>;

const INK: u32 = 0u;
const PIGMENT: u32 = 1u;
const RELIEF: u32 = 2u;
const SCENE: u32 = 1u;
const CLEAR: u32 = 2u;
const PI: f32 = 3.1415927;

fn power(x: f32, exponent: f32) -> f32 {
    return select(0.0, pow(x, exponent), x > 0.0);
}

fn value(at: vec2i, layer: i32) -> f32 {
    return select(0.0, textureLoad(values, at, max(layer, 0), 0).x, layer >= 0);
}

fn tone(at: vec2i, scene: vec3f) -> f32 {
    var color = scene;
    if style.by_light == 1u {
        let facing = dot(normal_of(textureLoad(facts, at, 0)), style.toward);
        color = vec3f(style.ambient + (1.0 - style.ambient) * max(facing, 0.0));
    }
    let light = dot(color, vec3f(0.2126, 0.7152, 0.0722));
    let code = select(1.055 * power(light, 1.0 / 2.4) - 0.055, 12.92 * light, light <= 0.0031308);
    return power(clamp((code - style.dark) / (style.light - style.dark), 0.0, 1.0), style.gamma);
}

// The value that a noise is below in this share of places.
fn threshold(share: f32, even: f32) -> f32 {
    let normal = (power(share, 0.135) - power(1.0 - share, 0.135)) / 0.1975;
    return select(normal, (normal - sqrt(2.0) * cos(PI * share)) / 2.0, even > 0.0);
}

fn inked(mark: Mark, at: vec2i, tone: f32) -> f32 {
    var share = select(0.0, 1.0, tone < mark.start);
    if mark.start != mark.full {
        share = clamp((mark.start - tone) / (mark.start - mark.full), 0.0, 1.0);
    }
    share = clamp(mark.amount * share, 0.0, 1.0);
    if share == 0.0 {
        return 0.0;
    }
    var x = value(at, mark.noise);
    if mark.grain >= 0 {
        x = sqrt(1.0 - mark.grained * mark.grained) * x + mark.grained * value(at, mark.grain);
    }
    let below = mark.side * x - threshold(share, mark.even);
    var covered = select(0.0, 1.0, below < 0.0);
    if mark.soft > 0.0 {
        covered = 1.0 - smoothstep(-mark.soft, mark.soft, below);
    }
    return min(mark.opacity * (covered + 4.0 * mark.rim * covered * (1.0 - covered)), 1.0);
}

// How a noise grows along one axis: the mean of the differences to the pixels of the layer on both sides.
fn slope(at: vec2i, layer: i32, way: vec2i) -> f32 {
    let own = value(at, layer);
    var sum = 0.0;
    var count = 0.0;
    if is_inside(at - way) && is_own(at - way) {
        sum += own - value(at - way, layer);
        count += 1.0;
    }
    if is_inside(at + way) && is_own(at + way) {
        sum += value(at + way, layer) - own;
        count += 1.0;
    }
    return sum / max(count, 1.0);
}

fn outlined(mark: Mark, at: vec2i) -> f32 {
    let inside = mark.half_width * (1.0 + mark.vary * value(at, mark.noise)) - value(at, mark.rims);
    return mark.opacity * clamp(inside / mark.soft + 0.5, 0.0, 1.0);
}

@fragment
fn drawn(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    if !is_own(at) {
        discard;
    }
    let own = textureLoad(shaded, at, 0);
    let scene = select(vec3f(0.0), own.rgb / own.a, own.a > 0.0);
    let own_tone = tone(at, scene);
    // Premultiplied.
    var color = vec4f(style.paper, 1.0);
    if style.ground == SCENE {
        color = vec4f(mix(scene, style.paper, style.fade), 1.0);
    } else if style.ground == CLEAR {
        color = vec4f(0.0);
    }
    for (var i = 0u; i < style.count; i++) {
        let mark = marks[i];
        var straight = color.rgb / max(color.a, 1e-9);
        if mark.kind == PIGMENT {
            let more = mark.strength * clamp(value(at, mark.noise) / 2.0, -1.0, 1.0);
            straight *= 1.0 - (1.0 - straight) * more;
            color = vec4f(straight * color.a, color.a);
        } else if mark.kind == RELIEF {
            let way = vec2f(slope(at, mark.noise, vec2i(1, 0)), slope(at, mark.noise, vec2i(0, 1)));
            let light = clamp(1.0 - mark.strength * dot(way, mark.toward), 0.0, 2.0);
            color = vec4f(color.rgb * light, color.a);
        } else {
            var covered = 0.0;
            if mark.kind == INK {
                covered = inked(mark, at, own_tone);
            } else {
                covered = outlined(mark, at);
            }
            color = mix(color, vec4f(mark.color + scene * mark.scene, 1.0), covered);
        }
    }
    return color * own.a;
}
