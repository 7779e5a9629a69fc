// Lays a waterfall's picture, made on the CPU, over what is there; it has the frame's size.

@group(0) @binding(0) var picture: texture_2d<f32>;

@fragment
fn lay(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(picture, vec2i(at.xy), 0);
}
