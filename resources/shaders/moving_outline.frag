#version 410 core
// The outline in a viewport in motion, cheap enough for software GL: as outline.frag, from single pixels
// of the frame. In: frame (texture), accent (sRGB-encoded), width (pixels). Space: frame pixels. Out:
// color, sRGB-encoded, to be blended.

uniform sampler2D frame;
uniform vec3 accent;
uniform float width;

out vec4 color;

const int kTaps = 8;
const mat2 kTurn = mat2(0.70710678, 0.70710678, -0.70710678, 0.70710678);

void main() {
    ivec2 last = textureSize(frame, 0) - 1;
    float inside = 1.0 - texelFetch(frame, ivec2(gl_FragCoord.xy), 0).a;
    int taps = inside > 0.0 ? 0 : kTaps; // groups of pixels inside cost nothing
    float around = 0.0;
    vec2 ring = vec2(width, 0.0);
    for (int i = 0; i < taps; ++i) {
        ivec2 at = clamp(ivec2(gl_FragCoord.xy + ring), ivec2(0), last);
        around += 1.0 - texelFetch(frame, at, 0).a;
        ring = kTurn * ring;
    }
    // The more taps are marked, the nearer the marked side: a soft outer edge.
    color = vec4(accent, min(0.6 * around, 1.0) * (1.0 - inside));
}
