// Vertex stage of shadow maps. In: positions in the surface's frame. Out: clip space of the light.

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 coordinates;
#ifdef SKIN
layout(location = 3) in vec3 restPosition;
out vec3 restPlace;
#endif
uniform mat4 clipFromWorld;
uniform mat4 worldFromMesh;
uniform float stepBack; // clip depth
out vec2 place;

void main() {
    place = coordinates;
#ifdef SKIN
    restPlace = restPosition.xzy;
#endif
    gl_Position = clipFromWorld * (worldFromMesh * vec4(position, 1.0));
    gl_Position.z += stepBack * gl_Position.w;
}
