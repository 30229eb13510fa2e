// Shared piece: what a projector sends for the light that a place should have. Piece before: projector_light.glsl. In:
// whether incidence and distance are made up for; the colour of the bare surface; where SHARED is defined this
// projector's weight and the sum of all. Out: the value, linear for an sRGB framebuffer or, where GAMMA is defined,
// encoded.

uniform float compensation; // 1: of incidence and distance; 0: none
uniform vec3 surfaceAlbedo; // linear
#ifdef SHARED
uniform sampler2D weights;
#endif
#ifdef GAMMA
uniform float inverseGamma;
#endif

vec4 sentFor(vec3 radiance, vec3 world, vec3 normal) {
    vec3 value = radiance / surfaceAlbedo * valueFor(world, normal, compensation);
#ifdef SHARED
    vec2 weight = texelFetch(weights, ivec2(gl_FragCoord.xy), 0).rg;
    value *= weight.g > 0.0 ? weight.r / weight.g : 1.0;
#endif
    value = clamp(value, 0.0, 1.0);
#ifdef GAMMA
    value = pow(value, vec3(inverseGamma));
#endif
    return vec4(value, 1.0);
}
