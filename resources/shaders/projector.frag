// What a projector sends out. Pieces before: version.glsl, physical_normal.glsl, projector_light.glsl, eye_lookup.glsl
// where EYE is defined. In: worldPosition; the view-independent picture from the projector; where EYE is defined the
// eye's pictures of the device and (EYE 2) of the table, where SHARED is defined this projector's weight and the sum
// of all. Out: the value, linear for an sRGB framebuffer or, where GAMMA is defined, encoded.

uniform sampler2D unseen;
uniform vec2 unseenCorner;  // the pixel of the projector at which that picture begins
uniform float compensation; // 1: of incidence and distance; 0: none
#ifdef EYE
uniform EyeView deviceView;
uniform sampler2D devicePicture;
uniform sampler2D deviceViewDepth;
#if EYE == 2
uniform EyeView tableView;
uniform sampler2D tablePicture;
uniform sampler2D tableViewDepth;
#endif
#endif
#ifdef SHARED
uniform sampler2D weights;
#endif
#ifdef GAMMA
uniform float inverseGamma;
#endif

out vec4 color;

void main() {
    vec3 normal = faceTowards(projectorPosition);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 radiance = texelFetch(unseen, pixel - ivec2(unseenCorner), 0).rgb;
#ifdef EYE
#if EYE == 2
    vec4 onTable = seenByEye(tablePicture, tableViewDepth, tableView, worldPosition, normal);
    radiance = mix(radiance, onTable.rgb, onTable.a);
#endif
    vec4 onDevice = seenByEye(devicePicture, deviceViewDepth, deviceView, worldPosition, normal);
    radiance = mix(radiance, onDevice.rgb, onDevice.a);
#endif
    vec3 value = radiance * valueFor(worldPosition, normal, compensation);
#ifdef SHARED
    vec2 weight = texelFetch(weights, pixel, 0).rg;
    value *= weight.g > 0.0 ? weight.r / weight.g : 1.0;
#endif
    value = clamp(value, 0.0, 1.0);
#ifdef GAMMA
    value = pow(value, vec3(inverseGamma));
#endif
    color = vec4(value, 1.0);
}
