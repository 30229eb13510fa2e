#version 410 core
// A straight line as a quad of constant width. In: from, to (world, metres), tone (sRGB-encoded), width
// (pixels; after scaling), clipFromWorld, frameSize (pixels). Six vertices a line. Out: place (pixels
// along and across), reach (length and half width, pixels), lineColor; clip space.

layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 tone; // a is the width

uniform mat4 clipFromWorld;
uniform vec2 frameSize;

out vec2 place;
flat out vec2 reach;
flat out vec3 lineColor;

void main() {
    vec4 a = clipFromWorld * vec4(from, 1.0);
    vec4 b = clipFromWorld * vec4(to, 1.0);
    float nearA = a.z + a.w;
    float nearB = b.z + b.w;
    lineColor = tone.rgb;
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    place = vec2(0.0);
    reach = vec2(0.0);
    if (nearA <= 0.0 && nearB <= 0.0) return;
    if (nearA < 0.0) a = mix(a, b, 1.0001 * nearA / (nearA - nearB));
    if (nearB < 0.0) b = mix(b, a, 1.0001 * nearB / (nearB - nearA));

    vec2 pixelA = (0.5 * a.xy / a.w + 0.5) * frameSize;
    vec2 pixelB = (0.5 * b.xy / b.w + 0.5) * frameSize;
    float span = distance(pixelA, pixelB);
    vec2 along = span > 1e-3 ? (pixelB - pixelA) / span : vec2(1.0, 0.0);
    int corner = gl_VertexID % 6;
    bool end = corner == 1 || corner == 2 || corner == 4;
    float side = corner == 2 || corner == 4 || corner == 5 ? 1.0 : -1.0;
    float margin = 0.5 * tone.a + 1.0;
    reach = vec2(span, 0.5 * tone.a);
    place = vec2(end ? span + margin : -margin, side * margin);
    vec2 pixel = pixelA + along * place.x + vec2(-along.y, along.x) * place.y;
    gl_Position = vec4(2.0 * pixel / frameSize - 1.0, end ? b.z / b.w : a.z / a.w, 1.0);
}
