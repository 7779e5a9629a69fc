// A layer's own picture, pixel by pixel; transparent beyond its edge. Zones are drawn over it.

@group(0) @binding(0) var picture: texture_2d<f32>;

@fragment
fn still(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let size = vec2i(textureDimensions(picture));
    let color = textureLoad(picture, min(pixel, size - 1), 0);
    return select(vec4f(0.0), color, all(pixel < size));
}
