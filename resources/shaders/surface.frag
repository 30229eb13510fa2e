// A matte, paper-like surface; follows version.glsl, backdrop.glsl and studio_light.glsl.
// In: worldPosition, worldNormal (world), eye (world), baseColor (linear), opacity, rim (0 or 1: a
// translucent surface grows denser where it is seen edge-on). Out: color, sRGB-encoded.

in vec3 worldPosition;
in vec3 worldNormal;

uniform vec3 eye;
uniform vec3 baseColor;
uniform float opacity;
uniform float rim;
uniform float exposure;

out vec4 color;

// Bright tones roll off softly instead of clipping; dark and middle tones stay nearly as they are.
vec3 toneMapped(vec3 light) {
    return light * (1.0 + light / 5.8) / (1.0 + light * 0.55);
}

vec3 encoded(vec3 light) {
    vec3 c = clamp(light, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}

void main() {
    vec3 toEye = normalize(eye - worldPosition);
    vec3 normal = normalize(worldNormal);
    if (!gl_FrontFacing) normal = -normal;

    float facing = max(dot(normal, keyDirection), 0.0);
    float key = facing > 0.0 ? facing * keyVisibility(worldPosition, normal) : 0.0;
    float sky = skyLight(worldPosition, normal);
    float bounce = 0.5 - 0.5 * normal.y;
    vec3 light = vec3(1.0, 0.95, 0.88) * 1.05 * key + vec3(0.86, 0.93, 1.0) * 0.42 * sky +
                 vec3(1.0, 0.96, 0.92) * 0.08 * bounce;
    // Paper is a little brighter seen edge-on.
    float grazing = pow(1.0 - abs(dot(normal, toEye)), 3.0);
    vec3 shaded = baseColor * light * (1.0 + 0.15 * grazing);
    color = vec4(dithered(encoded(toneMapped(exposure * shaded))), mix(opacity, 1.0, rim * 0.55 * grazing));
}
