// What of the device lies under each pixel of a projector. Lookups are dear: they are made from this, once for each
// pixel, and not for all that small triangles touch on their way. Pieces before: version.glsl, physical_normal.glsl,
// packed_normal.glsl, eye_lookup.glsl. In: worldPosition; where the projector stands; how the eye looks. Out: the place
// and the packed normal towards the projector, world; the change of the place in the eye's picture a pixel to the right
// and up.

in vec3 worldPosition;
uniform vec3 projectorPosition;
uniform EyeView deviceView;

layout(location = 0) out vec4 place;
layout(location = 1) out vec4 along;

void main() {
    place = vec4(worldPosition, packedNormal(faceTowards(worldPosition, projectorPosition)));
    along = footprintOf(deviceView, worldPosition);
}
