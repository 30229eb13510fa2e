// A matte, paper-like surface; follows version.glsl, backdrop.glsl, studio_light.glsl,
// light_colors.glsl and tone.glsl.
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

void main() {
    vec3 toEye = normalize(eye - worldPosition);
    vec3 normal = normalize(worldNormal);
    if (!gl_FrontFacing) normal = -normal;

    float facing = max(dot(normal, keyDirection), 0.0);
    float key = facing > 0.0 ? facing * keyVisibility(worldPosition, normal) : 0.0;
    float sky = skyLight(worldPosition, normal);
    float bounce = 0.5 - 0.5 * normal.y;
    vec3 light = studioLight(key, sky, bounce);
    // Paper is a little brighter seen edge-on.
    float grazing = pow(1.0 - abs(dot(normal, toEye)), 3.0);
    vec3 shaded = baseColor * light * (1.0 + 0.15 * grazing);
    color = vec4(dithered(shown(exposure * shaded)), mix(opacity, 1.0, rim * 0.55 * grazing));
}
