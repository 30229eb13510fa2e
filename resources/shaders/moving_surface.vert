// A surface of a viewport in motion, lit at its vertices; follows version.glsl, light_colors.glsl and
// moving_tone.glsl. In: position, normal (mesh, metres), tint (sRGB and how much of it), worldFromMesh, normalFromMesh, clipFromWorld of
// the camera, eye (world; w is 0 for the direction towards a parallel eye), keyDirection (world),
// keyMapFromWorld (world to map, 0 to 1), shadowBias (metres along the normal), baseColor (linear),
// exposure, opacity, rim, twoSided (1: the normal that faces the eye counts), tintFromWorld and tintNudge
// as in tint.glsl. Out: mapPlace (of the key's map), litColor and shadedColor (sRGB-encoded), litLight and
// shadedLight (linear), surfaceColor (linear), tintPlace (voxels), alpha; clip space.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tint;

uniform mat4 worldFromMesh;
uniform mat4 normalFromMesh;
uniform mat4 clipFromWorld;
uniform vec4 eye;
uniform vec3 keyDirection;
uniform mat4 keyMapFromWorld;
uniform vec2 shadowBias;
uniform vec3 baseColor;
uniform float exposure;
uniform float opacity;
uniform float rim;
uniform float twoSided;
uniform mat4 tintFromWorld;
uniform float tintNudge;

out vec3 mapPlace;
out vec3 litColor;
out vec3 shadedColor;
out vec3 litLight;
out vec3 shadedLight;
out vec3 tintPlace;
out vec3 surfaceColor;
out float alpha;

void main() {
    vec3 world = (worldFromMesh * vec4(position, 1.0)).xyz;
    vec3 toEye = normalize(eye.xyz - eye.w * world);
    vec3 n = mat3(normalFromMesh) * normal;
    n *= inversesqrt(max(dot(n, n), 1e-20));
    float across = dot(n, toEye);
    if (twoSided > 0.5 && across < 0.0) n = -n;

    float edge = 1.0 - min(abs(across), 1.0);
    float grazing = edge * edge * edge;
    float sky = 0.5 + 0.5 * n.y;
    float gain = exposure * (1.0 + 0.15 * grazing);
    shadedLight = gain * studioLight(0.0, sky, 1.0 - sky);
    litLight = gain * studioLight(max(dot(n, keyDirection), 0.0), sky, 1.0 - sky);
    surfaceColor = mix(baseColor, pow(tint.rgb, vec3(2.2)), tint.a);
    shadedColor = shown(surfaceColor * shadedLight);
    litColor = shown(surfaceColor * litLight);
    alpha = mix(opacity, 1.0, rim * 0.55 * grazing);
    mapPlace = (keyMapFromWorld * vec4(world + shadowBias.x * n, 1.0)).xyz;
    tintPlace = (tintFromWorld * vec4(world - tintNudge * n, 1.0)).xyz;
    gl_Position = clipFromWorld * vec4(world, 1.0);
}
