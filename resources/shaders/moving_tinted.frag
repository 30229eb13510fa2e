// A tinted surface of a viewport in motion; follows version.glsl and moving_tone.glsl. In: see
// moving_surface.vert; keyShadow (depth map, 1 is lit), keepAlpha (0 marks outlined
// surfaces), tintClasses and tintColors as in tint.glsl. Out: color, sRGB-encoded.

in vec3 mapPlace;
in vec3 litLight;
in vec3 shadedLight;
in vec3 tintPlace;
in vec3 surfaceColor;
in float alpha;

uniform sampler2DArrayShadow keyShadow;
uniform float keepAlpha;
uniform usampler3D tintClasses;
uniform vec4 tintColors[4];

out vec4 color;

void main() {
    float key = texture(keyShadow, vec4(mapPlace.xy, 0.0, mapPlace.z));
    ivec3 voxel = ivec3(floor(tintPlace));
    ivec3 last = textureSize(tintClasses, 0) - 1;
    bool inside = all(greaterThanEqual(voxel, ivec3(0))) && all(lessThanEqual(voxel, last));
    uint found = min(texelFetch(tintClasses, clamp(voxel, ivec3(0), last), 0).r, 3u);
    vec4 tint = tintColors[inside ? found : 0u];
    color = vec4(shown(mix(surfaceColor, tint.rgb, tint.a) * mix(shadedLight, litLight, key)), keepAlpha * alpha);
}
