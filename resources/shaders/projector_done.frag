// Hides what of a projector's picture is done behind the nearest depth. Piece before: version.glsl. In: the eye's
// weight, more than 0 where it is, less where it is if a pixel beside it is. A pixel reaches over an edge to both its
// sides: with the view-independent look behind it every fold would shine. Out: depth alone.

uniform sampler2D eyeWeight;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float most = texelFetch(eyeWeight, at, 0).r;
    ivec2 last = textureSize(eyeWeight, 0) - 1;
    // Software rasterisers skip a loop, never a branch.
    for (int i = most < 0.0 ? 0 : 4; i < 4; ++i) {
        ivec2 beside = at + (1 - (i & 2)) * ((i & 1) == 0 ? ivec2(1, 0) : ivec2(0, 1));
        most = max(most, texelFetch(eyeWeight, clamp(beside, ivec2(0), last), 0).r);
    }
    if (most <= 0.0) discard;
}
