// A bare surface in the room's own light: without it what no projector reaches would have no shape. Pieces before:
// version.glsl, physical_normal.glsl, room_lamp.glsl. Out: linear radiance.

in vec3 worldPosition;
uniform vec3 viewerPosition;
uniform vec3 surfaceAlbedo; // linear
uniform float roomLight;

out vec4 color;

void main() {
    vec3 normal = faceTowards(worldPosition, viewerPosition);
    float light = fromAround(normal);
#ifndef TABLE // it is turned to the device, which else would not stand out from a white table
    light += fromLamp(normal);
#endif
    color = vec4(roomLight * light * surfaceAlbedo, 1.0);
}
