// Shared piece: tone.glsl for a viewport in motion, by a polynomial that is within a step of eight bits
// of it for light between 0.001 and 1.4.

vec3 shown(vec3 light) {
    vec3 s = sqrt(light);
    return -0.0312263 + s * (1.3492069 + s * (-0.5659692 + s * 0.1310330));
}
