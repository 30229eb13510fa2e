// Shared piece: fog between the eye and a place. Piece before: noise.glsl. In: boxes [-0.5, 0.5]^3 with colour (lit) and greatest extinction a
// metre, and their grain: a picture of noise that repeats, and how often it does so across the box. A few steps through
// each box, begun at another share of a step from pixel to pixel so that no layers show. Space: world, metres.

#ifdef SECOND_FOG
const int kFogs = 2;
#else
const int kFogs = 1;
#endif
const int kFogSteps = 4;
uniform mat4 fogFromWorld[kFogs];
uniform vec4 fogColors[kFogs];
uniform vec3 fogGrains[kFogs];
uniform vec2 fogDrifts[kFogs];
uniform sampler2D fogGrain;

// Thin at the box's sides and top, in clouds that lean.
float fogDensity(vec3 at, vec3 grains, vec2 drift) {
    vec3 inside = clamp((0.5 - abs(at)) * 5.0, 0.0, 1.0);
    float top = clamp((0.5 - at.y) * 1.6, 0.0, 1.0);
    vec3 place = at * grains;
    float cloud = textureLod(fogGrain, place.xz + vec2(0.7, 0.4) * place.y - drift, 0.0).r;
    return inside.x * inside.z * top * clamp(3.0 * cloud - 0.9, 0.0, 1.0);
}

vec3 fogged(vec3 light, vec3 place, vec3 eye) {
    float start = noiseAt(gl_FragCoord.xy);
    for (int i = 0; i < kFogs; ++i) {
        vec3 from = (fogFromWorld[i] * vec4(eye, 1.0)).xyz;
        vec3 way = (fogFromWorld[i] * vec4(place, 1.0)).xyz - from;
        vec3 slow = vec3(way.x == 0.0 ? 1e-9 : way.x, way.y == 0.0 ? 1e-9 : way.y, way.z == 0.0 ? 1e-9 : way.z);
        vec3 a = (-0.5 - from) / slow;
        vec3 b = (0.5 - from) / slow;
        vec3 low = min(a, b);
        vec3 high = max(a, b);
        float enter = max(max(low.x, low.y), max(low.z, 0.0));
        float leave = min(min(high.x, high.y), min(high.z, 1.0));
        int steps = leave > enter ? kFogSteps : 0;
        float sum = 0.0;
        for (int k = 0; k < steps; ++k) {
            float share = mix(enter, leave, (float(k) + start) / float(kFogSteps));
            sum += fogDensity(from + share * way, fogGrains[i], fogDrifts[i]);
        }
        float metres = max(leave - enter, 0.0) * distance(place, eye) / float(kFogSteps);
        float clear = exp(-sum * metres * fogColors[i].a);
        light = mix(fogColors[i].rgb, light, clear);
    }
    return light;
}
