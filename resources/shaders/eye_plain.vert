// Vertex stage of the plain program that stands in for one the driver refuses. In: positions and normals in the
// surface's frame. Out: the world's normal.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 worldFromSurface;
uniform mat4 normalFromSurface;
out vec3 worldNormal;

void main() {
    worldNormal = (normalFromSurface * vec4(normal, 0.0)).xyz;
    gl_Position = clipOf((worldFromSurface * vec4(position, 1.0)).xyz);
}
