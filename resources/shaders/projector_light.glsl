// How much of a projector's light a surface sends on. In: where the projector stands (world), its radiance on white at
// the reference distance (peak times gain). All linear.

uniform vec3 projectorPosition;
uniform vec3 projectorPeak;
uniform float projectorReference; // metres

// Radiance of white for full white.
vec3 fullLight(vec3 world, vec3 normal) {
    vec3 way = projectorPosition - world;
    float square = dot(way, way);
    return projectorPeak *
           (max(dot(way, normal), 0.0) * projectorReference * projectorReference * inversesqrt(square) / square);
}
