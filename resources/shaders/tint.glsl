#define TINTED
// Shared piece: the tint at a world position. In: tintClasses (class of each voxel), tintFromWorld
// (world to voxels: a voxel's corner is whole), tintColors (linear, strength), tintNudge (metres
// inwards), tintTaps (1: nearest voxel,
// 8: the edge between classes runs smoothly).

uniform usampler3D tintClasses;
uniform mat4 tintFromWorld;
uniform vec4 tintColors[4];
uniform float tintNudge;
uniform int tintTaps;

// Colour times strength, and strength.
vec4 tintAt(vec3 position, vec3 normal) {
    vec3 place = (tintFromWorld * vec4(position - tintNudge * normal, 1.0)).xyz;
    ivec3 size = textureSize(tintClasses, 0);
    vec3 corner = tintTaps == 1 ? place : place - 0.5;
    ivec3 cell = ivec3(floor(corner));
    vec3 share = fract(corner);
    vec4 weight = vec4(0.0);
    for (int i = 0; i < tintTaps; ++i) {
        ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec3 w = mix(1.0 - share, share, vec3(step));
        ivec3 at = cell + step;
        bool inside = all(greaterThanEqual(at, ivec3(0))) && all(lessThan(at, size));
        uint found = inside ? min(texelFetch(tintClasses, at, 0).r, 3u) : 0u;
        weight += w.x * w.y * w.z * vec4(equal(uvec4(0u, 1u, 2u, 3u), uvec4(found)));
    }
    weight *= weight;
    weight *= weight;
    float sum = weight.x + weight.y + weight.z + weight.w;
    if (sum <= 0.0) return vec4(0.0);
    vec4 tint = vec4(0.0);
    for (int i = 0; i < 4; ++i) tint += weight[i] * tintColors[i].a * vec4(tintColors[i].rgb, 1.0);
    return tint / sum;
}
