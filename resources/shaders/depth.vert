#version 410 core
// Only the depth of surfaces, seen from a light or from the eye. In: position (mesh, metres), worldFromMesh,
// clipFromWorld of the light or the camera. Out: its clip space.

layout(location = 0) in vec3 position;

uniform mat4 worldFromMesh;
uniform mat4 clipFromWorld;

void main() {
    vec3 world = (worldFromMesh * vec4(position, 1.0)).xyz;
    gl_Position = clipFromWorld * vec4(world, 1.0);
}
