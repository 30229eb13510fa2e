#version 410 core
// The outline around what is marked by an alpha of 0 in a drawn frame. In: frame (texture), accent
// (sRGB-encoded), width (pixels). Space: frame pixels. Out: color, sRGB-encoded, to be blended.

uniform sampler2D frame;
uniform vec3 accent;
uniform float width;

out vec4 color;

const int kTaps = 16;

void main() {
    vec2 size = vec2(textureSize(frame, 0));
    float inside = 1.0 - texture(frame, gl_FragCoord.xy / size).a;
    float around = 0.0;
    vec2 step = vec2(1.0, 0.0);
    for (int i = 0; i < kTaps; ++i) {
        vec2 at = gl_FragCoord.xy + (width - 0.5) * step;
        around = max(around, 1.0 - texture(frame, at / size).a);
        step = mat2(0.92387953, 0.38268343, -0.38268343, 0.92387953) * step;
    }
    color = vec4(accent, around * (1.0 - inside));
}
