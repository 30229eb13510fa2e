// One of the two passes that turn a map of edges (0) into the distance from them, at most `radius` pixels, which is 1.
// Piece before: version.glsl. In: the map so far, the pass's axis. Out: the distance with that axis taken in.

uniform sampler2D before;
uniform vec2 axis;
uniform int radius;

out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(before, 0) - 1;
    float nearest = 1.0;
    for (int i = -radius; i <= radius; ++i) {
        float there = texelFetch(before, clamp(pixel + i * ivec2(axis), ivec2(0), last), 0).r;
        nearest = min(nearest, length(vec2(float(i) / float(radius), there)));
    }
    color = vec4(nearest);
}
