// Hides what of a projector's picture is done behind the nearest depth. Piece before: version.glsl. In: 1 where it is.
// Out: depth alone.

uniform sampler2D done;

void main() {
    if (texelFetch(done, ivec2(gl_FragCoord.xy), 0).r < 0.5) discard;
}
