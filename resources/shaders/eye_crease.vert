// Vertex stage of lines along the folds of the device's skin. In: positions and normals in the device's frame, the place
// across the line (-1 to 1) with the line's strength, the place at rest. Out: these.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 across;
layout(location = 3) in vec3 restPosition;
uniform mat4 worldFromSurface;
out vec2 place;
out vec3 restPlace;
out vec3 worldPosition;

const float kAbove = 0.0001; // metres

void main() {
    place = across;
    restPlace = restPosition.xzy;
    worldPosition = (worldFromSurface * vec4(position + kAbove * normal, 1.0)).xyz;
    gl_Position = clipOf(worldPosition);
}
