// Shared piece: light that nothing is in the way of; the same functions as studio_light.glsl.

float keyVisibility(vec3 position, vec3 normal) { return 1.0; }
float skyLight(vec3 position, vec3 normal) { return 0.5 + 0.5 * normal.y; }
