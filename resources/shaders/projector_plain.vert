// The table from a projector, where it shows the view-independent picture. Pieces before: version.glsl, camera.glsl,
// projector_light.glsl. In: position (world, metres); `compensation` 1 or 0. Out: the value that the projector needs for
// a radiance of 1, smooth enough to be interpolated; clip space, the same bits as physical.vert.

layout(location = 0) in vec3 position;

uniform float compensation;

out vec3 valueOfWhite;
invariant gl_Position;

void main() {
    vec3 normal = vec3(0.0, projectorPosition.y < position.y ? -1.0 : 1.0, 0.0);
    valueOfWhite = valueFor(position, normal, compensation);
    gl_Position = clipOf(position);
}
