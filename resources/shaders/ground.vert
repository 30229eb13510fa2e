#version 410 core
// The ground plane as four corners of a strip. In: groundCentre, groundHeight, groundExtent (world,
// metres), clipFromWorld of the camera. Out: worldPosition (world); clip space.

uniform vec2 groundCentre;
uniform float groundHeight;
uniform float groundExtent;
uniform mat4 clipFromWorld;

out vec3 worldPosition;

void main() {
    vec2 corner = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0);
    vec2 place = groundCentre + groundExtent * corner;
    worldPosition = vec3(place.x, groundHeight, place.y);
    gl_Position = clipFromWorld * vec4(worldPosition, 1.0);
}
