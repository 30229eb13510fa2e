#version 410 core
// Depth of casters seen from a light. In: position (mesh, metres), worldFromMesh, clipFromWorld of the
// light. Out: clip space of the light.

layout(location = 0) in vec3 position;

uniform mat4 worldFromMesh;
uniform mat4 clipFromWorld;

void main() { gl_Position = clipFromWorld * (worldFromMesh * vec4(position, 1.0)); }
