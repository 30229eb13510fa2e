// A bare surface in the room's own light, half of it from everywhere and half from a low lamp on the left: without it
// what no projector reaches would have no shape. Pieces before: version.glsl, camera.glsl,
// physical_normal.glsl. Out: linear radiance.

in vec3 worldPosition;
uniform vec3 viewerPosition;
uniform vec3 surfaceAlbedo; // linear
uniform float roomLight;

out vec4 color;

void main() {
    vec3 normal = faceTowards(worldPosition, viewerPosition);
    const vec3 kLamp = vec3(-0.79, 0.5, 0.35); // so low that slopes of a few degrees differ
    float light = 0.36 + 0.16 * normal.y;
#ifndef TABLE // it is turned to the device, which else would not stand out from a white table
    light += 0.96 * max(dot(normal, kLamp), 0.0);
#endif
    color = vec4(roomLight * light * surfaceAlbedo, 1.0);
}
