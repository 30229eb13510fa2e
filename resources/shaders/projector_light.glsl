// A projector's light on a physical surface. In: where the projector stands (world), its radiance on white at the
// reference distance (peak times gain). All linear.

uniform vec3 projectorPosition;
uniform vec3 projectorPeak;
uniform float projectorReference; // metres

const float kGrazing = 0.12; // cosine of 83 degrees of incidence

// Radiance of white for full white.
vec3 fullLight(vec3 world, vec3 normal) {
    vec3 way = projectorPosition - world;
    float square = dot(way, way);
    return projectorPeak *
           (max(dot(way, normal), 0.0) * projectorReference * projectorReference * inversesqrt(square) / square);
}

// The value that makes a radiance of 1; without compensation (0), as if the surface met the light head on at the
// reference distance.
vec3 valueFor(vec3 world, vec3 normal, float compensation) {
    vec3 light = mix(projectorPeak, fullLight(world, normal), compensation);
    // Faces that light can only graze stay dark anyway; full light for them would spill over their rims.
    float slant = dot(normal, normalize(projectorPosition - world));
    return mix(1.0, smoothstep(0.0, kGrazing, slant), compensation) / max(light, vec3(1e-6));
}
