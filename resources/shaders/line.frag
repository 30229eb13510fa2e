#version 410 core
// A line with round ends and smooth edges. In: place (pixels along and across), reach (length and half
// width, pixels), lineColor (sRGB-encoded), opacity. Out: color, sRGB-encoded.

in vec2 place;
flat in vec2 reach;
flat in vec3 lineColor;

uniform float opacity;

out vec4 color;

void main() {
    float beyond = max(max(-place.x, place.x - reach.x), 0.0);
    float away = length(vec2(beyond, place.y));
    color = vec4(lineColor, opacity * clamp(reach.y + 0.5 - away, 0.0, 1.0));
}
