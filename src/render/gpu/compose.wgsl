// What is no technique's own: one picture laid into a frame, and a finished frame encoded as pixels.rs does it.

@group(0) @binding(0) var source: texture_2d<f32>;

@vertex
fn whole_frame(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// Pixel by pixel; nothing beyond the picture's edge.
@fragment
fn lay(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let size = vec2i(textureDimensions(source));
    let color = textureLoad(source, min(pixel, size - 1), 0);
    return select(vec4f(0.0), color, all(pixel < size));
}

fn srgb_from_linear(light: vec3f) -> vec3f {
    let l = clamp(light, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(l, vec3f(1.0 / 2.4)) - 0.055, 12.92 * l, l <= vec3f(0.0031308));
}

// Linear, premultiplied to sRGB with straight alpha, each channel the nearest of 256 codes.
@fragment
fn encode(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let color = textureLoad(source, vec2i(at.xy), 0);
    if color.a <= 0.0 {
        return vec4f(0.0);
    }
    let straight = vec4f(srgb_from_linear(color.rgb / color.a), min(color.a, 1.0));
    return floor(straight * 255.0 + 0.5) / 255.0;
}
