// The table from a projector, where it shows the view-independent picture. Piece before: version.glsl. In: valueOfWhite
// of projector_plain.vert; the picture; the weights where SHARED is defined. Out: the value as in projector.frag.

in vec3 valueOfWhite;

uniform sampler2D unseen;
uniform vec2 unseenCorner;  // the pixel of the projector at which that picture begins
#ifdef SHARED
uniform sampler2D weights;
#endif
#ifdef GAMMA
uniform float inverseGamma;
#endif

out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 value = texelFetch(unseen, pixel - ivec2(unseenCorner), 0).rgb * valueOfWhite;
#ifdef SHARED
    vec2 weight = texelFetch(weights, pixel, 0).rg;
    value *= weight.g > 0.0 ? weight.r / weight.g : 1.0;
#endif
    value = clamp(value, 0.0, 1.0);
#ifdef GAMMA
    value = pow(value, vec3(inverseGamma));
#endif
    color = vec4(value, 1.0);
}
