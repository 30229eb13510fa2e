// Shared piece: the light of the studio at a world position. In: keyDirection, skyDirections (towards
// the light, world), keyShadow and skyShadow (depth maps, 1 is lit), their matrices (world to map, 0 to
// 1), shadowBias (metres along the normal for key and sky), keySoftness (radius of the soft edge, map
// units), sceneSphere (centre and radius of what casts shadows). Space: world, metres; light is linear.

const int kSkyCount = 16;
const int kKeyTaps = 20;
const mat2 kGoldenTurn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

uniform vec3 keyDirection;
uniform mat4 keyMapFromWorld;
uniform sampler2DArrayShadow keyShadow;
uniform float keySoftness;
uniform vec3 skyDirections[kSkyCount];
uniform mat4 skyMapFromWorld[kSkyCount];
uniform sampler2DArrayShadow skyShadow;
uniform vec2 shadowBias;
uniform vec4 sceneSphere;
uniform int keyShadowOn;
uniform int skyOcclusionOn;

// Whether a place is further than `margin` outside a map, where nothing can be in the way.
bool outside(vec2 map, float margin) { return any(greaterThan(abs(map - 0.5), vec2(0.5 + margin))); }

// Share of the key light that reaches a point, 0 to 1: a disc of filtered comparisons, sunflower order.
float keyVisibility(vec3 position, vec3 normal) {
    vec3 map = (keyMapFromWorld * vec4(position + shadowBias.x * normal, 1.0)).xyz;
    int taps = keyShadowOn == 0 || outside(map.xy, keySoftness) ? 0 : kKeyTaps;
    float lit = 0.0;
    vec2 around = vec2(1.0, 0.0);
    for (int i = 0; i < taps; ++i) {
        float radius = keySoftness * sqrt((float(i) + 0.5) / float(kKeyTaps));
        lit += texture(keyShadow, vec4(map.xy + radius * around, 0.0, map.z));
        around = kGoldenTurn * around;
    }
    return taps == 0 ? 1.0 : lit / float(kKeyTaps);
}

// Light of an even sky on a surface, 1 on open level ground. Far from the scene nothing hides the sky.
float skyLight(vec3 position, vec3 normal) {
    float away = distance(position, sceneSphere.xyz) / sceneSphere.w;
    float open = 0.5 + 0.5 * normal.y;
    int count = skyOcclusionOn == 0 || away > 2.0 ? 0 : kSkyCount;
    float sum = 0.0;
    float whole = 0.0;
    for (int i = 0; i < count; ++i) {
        vec3 map = (skyMapFromWorld[i] * vec4(position + shadowBias.y * normal, 1.0)).xyz;
        float lit = outside(map.xy, 0.02) ? 1.0 : texture(skyShadow, vec4(map.xy, float(i), map.z));
        sum += max(dot(normal, skyDirections[i]), 0.0) * lit;
        whole += skyDirections[i].y;
    }
    return count == 0 ? open : mix(sum / whole, open, smoothstep(1.4, 2.0, away));
}
