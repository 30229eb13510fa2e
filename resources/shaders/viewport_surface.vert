#version 410 core
// A surface in a viewport. In: position, normal (mesh, metres), tint (sRGB and how much of it), worldFromMesh and
// normalFromMesh, clipFromWorld of the camera. Out: worldPosition, worldNormal (world), fibrePlace
// (mesh, metres), vertexTint (linear and how much of it); clip space.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tint;

uniform mat4 worldFromMesh;
uniform mat4 normalFromMesh;
uniform mat4 clipFromWorld;

out vec3 worldPosition;
out vec3 worldNormal;
out vec3 fibrePlace;
out vec4 vertexTint;

void main() {
    worldPosition = (worldFromMesh * vec4(position, 1.0)).xyz;
    worldNormal = mat3(normalFromMesh) * normal;
    fibrePlace = position;
    vertexTint = vec4(pow(tint.rgb, vec3(2.2)), tint.a);
    gl_Position = clipFromWorld * vec4(worldPosition, 1.0);
}
