// The window: the frame, scaled, and strokes over it. Lengths are physical pixels of the window.

override reduces: bool = false; // whether a pixel of the screen covers more than one of the frame
override differs: bool = false; // whether the difference of two frames is shown
override encodes: bool = true; // whether the surface takes sRGB codes; else it encodes linear light by itself

struct Screen {
    size: vec2f, // of the window
    origin: vec2f, // of the frame in the window
    frame: vec2f, // the frame's size on the screen
    zoom: f32, // pixels of the screen a pixel of the frame
    check: f32, // side of a check
    ground: vec4f, // around the frame; colors here are linear
    light: vec4f, // checks under transparency
    dark: vec4f,
}

@group(0) @binding(0) var<uniform> screen: Screen;
@group(0) @binding(1) var frame: texture_2d<f32>;
@group(0) @binding(2) var other: texture_2d<f32>; // the frame that it is compared with
@group(0) @binding(3) var atlas: texture_2d<f32>; // glyphs, premultiplied

const DIFFERENCE: f32 = 8.0; // how much stronger a difference is shown

fn linear_from_srgb(code: vec3f) -> vec3f {
    return select(pow((code + 0.055) / 1.055, vec3f(2.4)), code / 12.92, code <= vec3f(0.04045));
}

fn pixel(at: vec2f) -> vec4f {
    let size = vec2i(textureDimensions(frame));
    return textureLoad(frame, clamp(vec2i(at), vec2i(0), size - 1), 0);
}

// Hard pixels with borders smoothed over one pixel of the screen; at 1:1 exactly the frame.
fn enlarged(at: vec2f) -> vec4f {
    let q = at - 0.5;
    let first = floor(q);
    let part = clamp((q - first - 0.5) * screen.zoom + 0.5, vec2f(0.0), vec2f(1.0));
    let top = mix(pixel(first), pixel(first + vec2f(1.0, 0.0)), part.x);
    let bottom = mix(pixel(first + vec2f(0.0, 1.0)), pixel(first + vec2f(1.0, 1.0)), part.x);
    return mix(top, bottom, part.y);
}

// The mean of up to 8 x 8 pixels under one of the screen.
fn reduced(at: vec2f) -> vec4f {
    let side = 1.0 / screen.zoom;
    let n = min(ceil(side), 8.0);
    var sum = vec4f(0.0);
    for (var y = 0.5; y < n; y += 1.0) {
        for (var x = 0.5; x < n; x += 1.0) {
            sum += pixel(floor(at + (vec2f(x, y) / n - 0.5) * side));
        }
    }
    return sum / (n * n);
}

// The largest difference of sRGB codes among up to 8 x 8 pixels under one of the screen.
fn difference(at: vec2f) -> vec3f {
    let size = vec2i(textureDimensions(frame));
    let side = max(1.0 / screen.zoom, 1.0);
    let n = min(ceil(side), 8.0);
    var most = vec3f(0.0);
    for (var y = 0.5; y < n; y += 1.0) {
        for (var x = 0.5; x < n; x += 1.0) {
            let place = vec2i(floor(at + (vec2f(x, y) / n - 0.5) * (side - 1.0)));
            let texel = clamp(place, vec2i(0), size - 1);
            let a = textureLoad(frame, texel, 0);
            let b = textureLoad(other, texel, 0);
            most = max(most, abs(srgb_from_linear(a.rgb) - srgb_from_linear(b.rgb)));
            most = max(most, vec3f(abs(a.a - b.a)));
        }
    }
    return most * DIFFERENCE;
}

@fragment
fn show_frame(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let place = at.xy - screen.origin;
    let within = all(place >= vec2f(0.0)) && all(place < screen.frame);
    let odd = (i32(floor(place.x / screen.check)) + i32(floor(place.y / screen.check))) & 1;
    let beneath = select(screen.ground, select(screen.light, screen.dark, odd == 1), within);
    var color: vec4f;
    if differs {
        color = vec4f(linear_from_srgb(min(difference(place / screen.zoom), vec3f(1.0))), 1.0);
    } else if reduces {
        color = reduced(place / screen.zoom);
    } else {
        color = enlarged(place / screen.zoom);
    }
    color = select(vec4f(0.0), color, within);
    let light = color.rgb + beneath.rgb * (1.0 - color.a);
    if encodes {
        return vec4f(floor(srgb_from_linear(light) * 255.0 + 0.5) / 255.0, 1.0);
    }
    return vec4f(light, 1.0);
}

const LINE = 0u;
const BOX = 1u;
const GLYPH = 3u;

struct Stroke {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
    @location(1) @interpolate(flat) ends: vec4f,
    @location(2) @interpolate(flat) radius: f32,
    @location(3) @interpolate(flat) form: u32,
    @location(4) @interpolate(flat) color: vec4f,
    @location(5) @interpolate(flat) texel: vec2u,
}

// A box around the stroke, along it where it is a line.
@vertex
fn place_stroke(
    @builtin(vertex_index) i: u32,
    @location(0) a: vec2f,
    @location(1) b: vec2f,
    @location(2) radius: f32,
    @location(3) form: u32,
    @location(4) color: vec4f,
    @location(5) texel: vec2u,
) -> Stroke {
    let way = b - a;
    let long = length(way);
    let along = select(vec2f(1.0, 0.0), way / max(long, 1e-6), form == LINE && long > 1e-6);
    let across = vec2f(-along.y, along.x);
    let rim = select(radius + 1.0, 1.0, form == BOX || form == GLYPH);
    let half_size = vec2f(abs(dot(way, along)), abs(dot(way, across))) * 0.5 + rim;
    let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0;
    let at = (a + b) * 0.5 + along * (corner.x * half_size.x) + across * (corner.y * half_size.y);
    let clip = vec2f(at.x / screen.size.x * 2.0 - 1.0, 1.0 - at.y / screen.size.y * 2.0);
    return Stroke(vec4f(clip, 0.0, 1.0), at, vec4f(a, b), radius, form, color, texel);
}

fn distance_to_line(at: vec2f, a: vec2f, b: vec2f) -> f32 {
    let way = b - a;
    let along = clamp(dot(at - a, way) / max(dot(way, way), 1e-6), 0.0, 1.0);
    return distance(at, a + way * along);
}

fn distance_to_box(at: vec2f, a: vec2f, b: vec2f, radius: f32) -> f32 {
    let beyond = abs(at - (a + b) * 0.5) - abs(b - a) * 0.5 + radius;
    return length(max(beyond, vec2f(0.0))) + min(max(beyond.x, beyond.y), 0.0) - radius;
}

fn distance_to_diamond(at: vec2f, a: vec2f, radius: f32) -> f32 {
    let away = abs(at - a);
    return (away.x + away.y - radius) * 0.70710678;
}

// A pixel of the atlas for each of the screen; none beyond the glyph.
fn glyph(at: vec2f, a: vec2f, b: vec2f, texel: vec2u) -> vec4f {
    let within = all(at >= a) && all(at < b);
    let place = vec2i(texel) + vec2i(floor(clamp(at, a, b - 0.5) - a));
    return select(vec4f(0.0), textureLoad(atlas, place, 0), within);
}

@fragment
fn fill_stroke(stroke: Stroke) -> @location(0) vec4f {
    var d = distance_to_diamond(stroke.at, stroke.ends.xy, stroke.radius);
    if stroke.form == LINE {
        d = distance_to_line(stroke.at, stroke.ends.xy, stroke.ends.zw) - stroke.radius;
    } else if stroke.form == BOX {
        d = distance_to_box(stroke.at, stroke.ends.xy, stroke.ends.zw, stroke.radius);
    }
    let alpha = stroke.color.a * clamp(0.5 - d, 0.0, 1.0);
    var color = stroke.color.rgb;
    if !encodes {
        color = linear_from_srgb(color);
    }
    if stroke.form == GLYPH {
        return vec4f(color, 1.0) * (stroke.color.a * glyph(stroke.at, stroke.ends.xy, stroke.ends.zw, stroke.texel));
    }
    return vec4f(color * alpha, alpha);
}
