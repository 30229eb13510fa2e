// What a projector sends to places that the eye sees. Pieces before: version.glsl, physical_normal.glsl,
// packed_normal.glsl, projector_eye_weight.glsl, projector_light.glsl, projector_output.glsl (RESPONSE:
// projector_response.glsl before it), eye_lookup.glsl, noise.glsl. In: of the table (TABLE) worldPosition, of the device what projector_surface.frag has found; the eye's
// pictures of the device and (TABLE_VIEW) of the table. Out: the value; the eye's weight (projector_eye_weight.glsl)
// where this place is done, -1 where it is hidden and done only next to others.

#ifdef TABLE
in vec3 worldPosition;
#else
uniform sampler2D surfacePlace;
uniform sampler2D surfaceAlong;
#endif
uniform EyeView deviceView;
uniform sampler2D devicePicture;
uniform sampler2D deviceViewDepth;
#ifdef TABLE_VIEW
uniform EyeView tableView;
uniform sampler2D tablePicture;
uniform sampler2D tableViewDepth;
#endif

layout(location = 0) out vec4 color;
layout(location = 1) out float eyeWeight;

const float kLeastWeight = 1e-4; // more than nothing, in half precision

void main() {
#ifdef TABLE
    vec3 world = worldPosition;
    vec3 normal = faceTowards(world, projectorPosition);
    vec4 footprint = footprintOf(deviceView, world);
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 place = texelFetch(surfacePlace, pixel, 0);
    if (place.w == 0.0) discard;
    vec3 world = place.xyz;
    vec3 normal = unpackedNormal(place.w);
    vec4 footprint = texelFetch(surfaceAlong, pixel, 0);
#endif
    vec4 seen = seenByEye(devicePicture, deviceViewDepth, deviceView, world, normal, footprint);
#ifdef TABLE_VIEW
    vec4 onTable = seenByEye(tablePicture, tableViewDepth, tableView, world, normal, footprintOf(tableView, world));
    float rest = onTable.a * (1.0 - seen.a);
    float all = max(seen.a + rest, 1e-6);
    seen = vec4((seen.a * seen.rgb + rest * onTable.rgb) / all, seen.a + rest);
#endif
    // Where pictures fade into the view-independent one they do so pixel by pixel: either is drawn, never both.
    if (abs(seen.a) <= noiseAt(gl_FragCoord.xy)) discard;
    // A hidden place may be steep; made up for, it would outshine the side that is seen.
    vec3 turned = seen.a > 0.0 ? normal : normalize(projectorPosition - world);
    color = sentFor(seen.rgb, world, turned);
    float weight = eyeWeightOf(world, normal, projectorPosition, dot(surfaceAlbedo, surfaceAlbedo) / 3.0);
    eyeWeight = seen.a > 0.0 ? max(weight, kLeastWeight) : -1.0;
}
