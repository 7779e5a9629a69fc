// What is common to all techniques: drawing a layer's picture over those beneath, and encoding a finished frame as in
// pixels.rs.

@group(0) @binding(0) var source: texture_2d<f32>;

// Both pictures have the frame's size.
@fragment
fn lay(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(source, vec2i(at.xy), 0);
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
