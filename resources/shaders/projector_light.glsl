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
    // Faces that light can only graze stay dark anyway. They get no more than one turned to the light would: made up
    // for, the pixel would outshine what it also lights beyond their rims; left black, it would draw a dark seam there.
    float slant = dot(normal, normalize(projectorPosition - world));
    vec3 turned = mix(normalize(projectorPosition - world), normal, smoothstep(0.0, kGrazing, slant));
    vec3 light = mix(projectorPeak, fullLight(world, turned), compensation);
    return 1.0 / max(light, vec3(1e-6));
}
