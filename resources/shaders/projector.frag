// What a projector sends to places that the eye sees. Pieces before: version.glsl, physical_normal.glsl,
// projector_light.glsl, projector_output.glsl, eye_lookup.glsl, noise.glsl. In: worldPosition; the eye's pictures of the device and
// (TABLE_VIEW) of the table. Out: the value; 1 where this place is done, a half where
// it is hidden and done only next to others.

in vec3 worldPosition;
uniform EyeView deviceView;
uniform sampler2D devicePicture;
uniform sampler2D deviceViewDepth;
#ifdef TABLE_VIEW
uniform EyeView tableView;
uniform sampler2D tablePicture;
uniform sampler2D tableViewDepth;
#endif

layout(location = 0) out vec4 color;
layout(location = 1) out float done;

void main() {
    vec3 normal = faceTowards(worldPosition, projectorPosition);
    vec4 seen = seenByEye(devicePicture, deviceViewDepth, deviceView, worldPosition, normal);
#ifdef TABLE_VIEW
    vec4 onTable = seenByEye(tablePicture, tableViewDepth, tableView, worldPosition, normal);
    float rest = onTable.a * (1.0 - seen.a);
    float all = max(seen.a + rest, 1e-6);
    seen = vec4((seen.a * seen.rgb + rest * onTable.rgb) / all, seen.a + rest);
#endif
    // Where pictures fade into the view-independent one they do so pixel by pixel: either is drawn, never both.
    if (abs(seen.a) <= noiseAt(gl_FragCoord.xy)) discard;
    // A hidden place may be steep; made up for, it would outshine the side that is seen.
    vec3 turned = seen.a > 0.0 ? normal : normalize(projectorPosition - worldPosition);
    color = sentFor(seen.rgb, worldPosition, turned);
    done = seen.a > 0.0 ? 1.0 : 0.5;
}
