#version 410 core
// A surface in a viewport. In: position, normal, rest position (mesh, metres), worldFromMesh and
// normalFromMesh, clipFromWorld of the camera. Out: worldPosition, worldNormal (world), fibrePlace
// (metres on the paper, sticks to the surface when it deforms); clip space.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;

uniform mat4 worldFromMesh;
uniform mat4 normalFromMesh;
uniform mat4 clipFromWorld;

out vec3 worldPosition;
out vec3 worldNormal;
out vec2 fibrePlace;

void main() {
    worldPosition = (worldFromMesh * vec4(position, 1.0)).xyz;
    worldNormal = mat3(normalFromMesh) * normal;
    // Skewed, so that no upright wall sees one line of the pattern only.
    fibrePlace = rest.xz + rest.y * vec2(0.6, 0.8);
    gl_Position = clipFromWorld * vec4(worldPosition, 1.0);
}
