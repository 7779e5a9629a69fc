// A fill on the GPU: the twin of frame.rs, with the same names and structure.

const MOST_STOPS = 64u;

struct Stop {
    color: vec4f,
    along: f32,
}

struct Fill {
    stops: array<Stop, MOST_STOPS>,
    origin: vec2f, // where the line begins, in pixels
    axis: vec2f, // its direction divided by its length
    place: vec2f, // in the pixel
    count: u32, // of stops
}

@group(0) @binding(0) var<uniform> fill: Fill;

@fragment
fn color(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let along = dot(fill.axis, floor(at.xy) + fill.place - fill.origin);
    var before = fill.stops[0];
    for (var i = 0u; i < fill.count; i += 1u) {
        let after = fill.stops[i];
        if along < after.along {
            let share = select((along - before.along) / (after.along - before.along), 0.0, i == 0u);
            return mix(before.color, after.color, share);
        }
        before = after;
    }
    return before.color;
}
