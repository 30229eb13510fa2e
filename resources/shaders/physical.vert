// A physical surface seen through a calibrated lens. Pieces before: version.glsl, camera.glsl. In: position (mesh,
// metres), worldFromMesh. Out: worldPosition (metres); clip space, the same bits in every program.

layout(location = 0) in vec3 position;

uniform mat4 worldFromMesh;

out vec3 worldPosition;
invariant gl_Position;

void main() {
    worldPosition = (worldFromMesh * vec4(position, 1.0)).xyz;
    gl_Position = clipOf(worldPosition);
}
