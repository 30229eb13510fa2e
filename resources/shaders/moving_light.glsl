#define MOVING
// Shared piece: the light of a viewport in motion, cheap enough for software GL; the same functions as
// studio_light.glsl. In: keyDirection (towards the light, world), keyShadow (depth map, 1 is lit) with
// its matrix (world to map, 0 to 1), shadowBias (metres along the normal). Space: world, metres.

uniform vec3 keyDirection;
uniform mat4 keyMapFromWorld;
uniform sampler2DArrayShadow keyShadow;
uniform vec2 shadowBias;

// Share of the key light that reaches a point, 0 to 1: one filtered comparison.
float keyVisibility(vec3 position, vec3 normal) {
    vec3 map = (keyMapFromWorld * vec4(position + shadowBias.x * normal, 1.0)).xyz;
    return texture(keyShadow, vec4(map.xy, 0.0, map.z));
}

// Light of an even sky on a surface, 1 on open level ground.
float skyLight(vec3 position, vec3 normal) { return 0.5 + 0.5 * normal.y; }
