// Kernels and what is made of their sums, as in sum.rs and curves.rs.

struct Noise {
    reach: f32,
    variance: f32,
    radius: f32,
    spacing: f32,
    px_per_m: f32,
    deviation: f32,
    wide: i32,
}

@group(0) @binding(4) var<uniform> noise: Noise;

// The curve of a kernel by the place, 1 being its edge.
fn curve(place: f32) -> f32 {
    let x = place * place;
    var value = 0.054373876;
    value = value * x - 0.35808085;
    value = value * x + 1.1621629;
    value = value * x - 2.5392845;
    value = value * x + 4.2006918;
    value = value * x - 5.393351;
    value = value * x + 5.1569455;
    value = value * x - 3.2834574;
    value = value * x + 0.9999998;
    return select(0.0, value, x < 1.0);
}

// The cosine of so many turns.
fn wave(turns: f32) -> f32 {
    let quarter = 0.25 - abs(turns - round(turns));
    let x = quarter * quarter;
    var value = 39.759827;
    value = value * x - 76.58117;
    value = value * x + 81.60248;
    value = value * x - 41.34168;
    value = value * x + 6.2831855;
    return value * quarter;
}

// What a kernel adds: to the noise, and to its variance.
fn added(weight: f32, turns: f32) -> vec4f {
    return vec4f(weight * wave(turns), weight * weight * 0.5, 0.0, 0.0);
}

fn within(away: f32) -> f32 {
    return 1.0 - smoothstep(noise.reach, 2.0 * noise.reach, away);
}
