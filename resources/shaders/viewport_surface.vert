#version 410 core
// A surface in a viewport. In: position, normal (mesh, metres), worldFromMesh and
// normalFromMesh, clipFromWorld of the camera. Out: worldPosition, worldNormal (world), fibrePlace
// (mesh, metres); clip space.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 worldFromMesh;
uniform mat4 normalFromMesh;
uniform mat4 clipFromWorld;

out vec3 worldPosition;
out vec3 worldNormal;
out vec3 fibrePlace;

void main() {
    worldPosition = (worldFromMesh * vec4(position, 1.0)).xyz;
    worldNormal = mat3(normalFromMesh) * normal;
    fibrePlace = position;
    gl_Position = clipFromWorld * vec4(worldPosition, 1.0);
}
