// The shadow on the ground of a viewport in motion, to be multiplied with what is there; follows
// version.glsl and moving_light.glsl. In: worldPosition (world), shade (how dark full shadow is).
// Out: color, the share that stays.

in vec3 worldPosition;

uniform float shade;

out vec4 color;

void main() {
    float key = keyVisibility(worldPosition, vec3(0.0, 1.0, 0.0));
    color = vec4(vec3(1.0 - 0.6 * shade * (1.0 - key)), 1.0);
}
