// Shared piece: what a projector sends for the light that a place should have. Pieces before: projector_light.glsl and,
// where RESPONSE is defined, projector_response.glsl. In: whether incidence and distance are made up for; the colour of
// the bare surface; where SHARED is defined this projector's weight and the sum of all; with RESPONSE what no place is
// darker than, and the light on white that all projectors' black makes. Out: the value, linear for an sRGB framebuffer
// or, where GAMMA or RESPONSE is defined, encoded.

uniform float compensation; // 1: of incidence and distance; 0: none
uniform vec3 surfaceAlbedo; // linear
#ifdef SHARED
uniform sampler2D weights;
#endif
#ifdef GAMMA
uniform float inverseGamma;
#endif
#ifdef RESPONSE
uniform vec3 blackFloor;
#ifdef SHARED
uniform sampler2D blacks;
#endif

// Light on white that is there anyway.
vec3 blackLight(vec3 world, vec3 normal) {
#ifdef SHARED
    return texelFetch(blacks, ivec2(gl_FragCoord.xy), 0).rgb;
#else
    return projectorBlack * mix(projectorPeak, fullLight(world, normal), compensation);
#endif
}
#endif

vec4 sentFor(vec3 radiance, vec3 world, vec3 normal) {
#ifdef RESPONSE
    vec3 missing = max(radiance / surfaceAlbedo, blackFloor) - blackLight(world, normal);
    vec3 value = missing * valueFor(world, normal, compensation) / (1.0 - projectorBlack);
#else
    vec3 value = radiance / surfaceAlbedo * valueFor(world, normal, compensation);
#endif
#ifdef SHARED
    vec2 weight = texelFetch(weights, ivec2(gl_FragCoord.xy), 0).rg;
    value *= weight.g > 0.0 ? weight.r / weight.g : 1.0;
#endif
    value = clamp(value, 0.0, 1.0);
#ifdef GAMMA
    value = pow(value, vec3(inverseGamma));
#endif
#ifdef RESPONSE
    value = valueOfLight(value);
#endif
    return vec4(value, 1.0);
}
