// Shared piece: the last step of every colour of the eye pass. In: exposure, shoulder (where the soft shoulder begins;
// 1 clips). Linear light to linear light in [0, 1]: what is below the shoulder stays as it is, what is above nears 1.

uniform float exposure;
uniform float shoulder;

vec4 shown(vec3 light, float opacity) {
    vec3 x = max(light * exposure, 0.0);
    float room = 1.0 - shoulder;
    vec3 above = max(x - shoulder, 0.0);
    return vec4(min(x, shoulder) + room * above / (above + max(room, 1e-4)), opacity);
}
