// Shared piece: the light of a viewport in motion, cheap enough for software GL; the same functions as
// studio_light.glsl. In: keyDirection (towards the light, world), keyShadow (depth map, 1 is lit) with
// its matrix (world to map, 0 to 1), shadowBias (metres along the normal), keySoftness (radius of the
// soft edge, map units). Space: world, metres.

uniform vec3 keyDirection;
uniform mat4 keyMapFromWorld;
uniform sampler2DArrayShadow keyShadow;
uniform float keySoftness;
uniform vec2 shadowBias;

// Share of the key light that reaches a point, 0 to 1.
float keyVisibility(vec3 position, vec3 normal) {
    vec3 map = (keyMapFromWorld * vec4(position + shadowBias.x * normal, 1.0)).xyz;
    bool outside = any(greaterThan(abs(map - 0.5), vec3(0.5)));
    // A loop is left by a software rasteriser, a branch is not.
    int taps = outside ? 0 : 3;
    float lit = 0.0;
    vec2 around = 0.6 * keySoftness * vec2(0.866, 0.5);
    for (int i = 0; i < taps; ++i) {
        lit += texture(keyShadow, vec4(map.xy + around, 0.0, map.z));
        around = mat2(-0.5, 0.866, -0.866, -0.5) * around;
    }
    return outside ? 1.0 : lit / 3.0;
}

// Light of an even sky on a surface, 1 on open level ground.
float skyLight(vec3 position, vec3 normal) { return 0.5 + 0.5 * normal.y; }
