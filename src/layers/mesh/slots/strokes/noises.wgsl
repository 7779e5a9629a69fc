// Noises from the sums of kernels, as in sum.rs and even.rs.

@group(0) @binding(5) var sums: texture_2d<f32>;
@group(0) @binding(6) var rows: texture_2d<f32>;

// The least share of the variance that a sum is divided by.
const LEAST: f32 = 0.0625;
// The least mean square that an even noise is divided by.
const LEAST_EVEN: f32 = 0.02;

fn value(at: vec2i) -> f32 {
    let sum = textureLoad(sums, at, 0).xy;
    return select(0.0, sum.x / sqrt(max(sum.y, noise.variance * LEAST)), is_own(at));
}

fn weight(away: i32) -> f32 {
    let x = f32(away) / noise.deviation;
    return exp(-0.5 * x * x);
}

@fragment
fn plain(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(value(vec2i(at.xy)), 0.0, 0.0, 0.0);
}

// The weighted sums of squares and of ones around each pixel in its row.
@fragment
fn along_rows(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var sum = vec2f(0.0);
    for (var away = -noise.wide; away <= noise.wide; away++) {
        let pixel = vec2i(at.xy) + vec2i(away, 0);
        if is_inside(pixel) && is_own(pixel) {
            let x = value(pixel);
            sum += weight(away) * vec2f(x * x, 1.0);
        }
    }
    return vec4f(sum, 0.0, 0.0);
}

@fragment
fn even(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var sum = vec2f(0.0);
    for (var away = -noise.wide; away <= noise.wide; away++) {
        let pixel = vec2i(at.xy) + vec2i(0, away);
        if is_inside(pixel) {
            sum += weight(away) * textureLoad(rows, pixel, 0).xy;
        }
    }
    let even = value(vec2i(at.xy)) / sqrt(max(sum.x / max(sum.y, 1e-20), LEAST_EVEN));
    return vec4f(even, 0.0, 0.0, 0.0);
}
