// Hides what of a projector's picture is done behind the nearest depth. Piece before: version.glsl. In: 1 where it is, a
// half where it is if a pixel beside it is. A pixel reaches over an edge to both its sides: with the view-independent
// look behind it every fold would shine. Out: depth alone.

uniform sampler2D done;

const float kHidden = 0.25; // more than nothing
const float kSeen = 0.75;   // more than a half

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float most = texelFetch(done, at, 0).r;
    ivec2 last = textureSize(done, 0) - 1;
    // Software rasterisers skip a loop, never a branch.
    for (int i = most > kHidden && most < kSeen ? 0 : 4; i < 4; ++i) {
        ivec2 beside = at + (1 - (i & 2)) * ((i & 1) == 0 ? ivec2(1, 0) : ivec2(0, 1));
        most = max(most, texelFetch(done, clamp(beside, ivec2(0), last), 0).r);
    }
    if (most < kSeen) discard;
}
