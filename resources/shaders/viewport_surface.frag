// A surface in a still viewport; follows version.glsl, backdrop.glsl, studio_light.glsl, light_colors.glsl,
// tone.glsl and, where it is tinted, tint.glsl.
// In: worldPosition, worldNormal (world), fibrePlace (mesh, metres), vertexTint (linear, and how much of it), eye (world; w is 0 for the direction
// towards a parallel eye), baseColor (linear), opacity, rim (0 or 1: a translucent surface grows denser
// where it is seen edge-on), fibre (texture, 0.5 is plain), paper (0 to 1), fibreTile (metres), exposure,
// keepAlpha (0 marks outlined surfaces). Out: color, sRGB-encoded.

in vec3 worldPosition;
in vec3 worldNormal;
in vec3 fibrePlace;
in vec4 vertexTint;

uniform vec4 eye;
uniform vec3 baseColor;
uniform float opacity;
uniform float rim;
uniform float exposure;
uniform float paper;
uniform float fibreTile;
uniform sampler2D fibre;
uniform float keepAlpha;

out vec4 color;

void main() {
    vec3 toEye = normalize(eye.xyz - eye.w * worldPosition);
    vec3 normal = normalize(worldNormal);
    if (!gl_FrontFacing) normal = -normal;

    float facing = max(dot(normal, keyDirection), 0.0);
    float key = facing * keyVisibility(worldPosition, normal);
    float sky = skyLight(worldPosition, normal);
    vec3 light = studioLight(key, sky, 0.5 - 0.5 * normal.y);

    vec3 base = mix(baseColor, vertexTint.rgb, vertexTint.a);
#ifdef TINTED
    vec4 tint = tintAt(worldPosition, normal);
    base = mix(base, tint.rgb / max(tint.a, 1e-4), tint.a);
#endif
    // Seen along the axis that the surface faces most.
    vec3 side = abs(normal);
    vec2 place = side.y >= max(side.x, side.z) ? fibrePlace.xz : side.x > side.z ? fibrePlace.zy : fibrePlace.xy;
    base *= 1.0 + paper * 0.2 * (texture(fibre, place / fibreTile).r - 0.5);
    // Paper is a little brighter seen edge-on.
    float edge = 1.0 - abs(dot(normal, toEye));
    float grazing = edge * edge * edge;
    vec3 shaded = base * light * (1.0 + 0.15 * grazing);
    float alpha = mix(opacity, 1.0, rim * 0.55 * grazing);
    color = vec4(dithered(shown(exposure * shaded)), keepAlpha * alpha);
}
