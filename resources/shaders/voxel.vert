// A corner of an exposed face of a voxel; follows version.glsl,
// light_colors.glsl and tone.glsl. In: corner (x, y, z of the voxel; face, place and sides packed
// as in viewport_voxels.cpp), tone (sRGB-encoded), worldFromVoxels (a voxel's corner is whole), inset
// (half the gap between two cubes, voxels), clipFromWorld, keyDirection (world), exposure. Out: faceColor
// (sRGB-encoded), facePlace (voxels from the middle of the face), sides; clip space.

layout(location = 0) in uvec4 corner;
layout(location = 1) in vec4 tone;

uniform mat4 worldFromVoxels;
uniform float inset;
uniform mat4 clipFromWorld;
uniform vec3 keyDirection;
uniform float exposure;

out vec3 faceColor;
out vec2 facePlace;
flat out uint sides;

vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), c)); }

// A free side ends before the gap, where the body goes on the face meets the next one, and in a
// concave edge it reaches the face that stands on it.
float reach(uint side) {
    uint state = (sides >> (2u * side)) & 3u;
    return 0.5 + inset * (float(state) - 1.0);
}

void main() {
    uint face = corner.w & 7u;
    uint place = (corner.w >> 3) & 3u;
    sides = corner.w >> 5;
    int axis = int(face >> 1);
    float outwards = (face & 1u) == 0u ? -1.0 : 1.0;
    bool right = (place & 1u) != 0u;
    bool upper = (place & 2u) != 0u;
    facePlace = vec2(right ? reach(1u) : -reach(0u), upper ? reach(3u) : -reach(2u));
    vec3 at = vec3(corner.xyz) + 0.5;
    at[axis] += outwards * (0.5 - inset);
    at[(axis + 1) % 3] += facePlace.x;
    at[(axis + 2) % 3] += facePlace.y;
    gl_Position = clipFromWorld * (worldFromVoxels * vec4(at, 1.0));

    vec3 normal = vec3(0.0);
    normal[axis] = outwards;
    float key = max(dot(normal, keyDirection), 0.0);
    vec3 light = studioLight(key, 0.5 + 0.5 * normal.y, 0.5 - 0.5 * normal.y);
    faceColor = shown(exposure * linear(tone.rgb) * (light + 0.08));
}
