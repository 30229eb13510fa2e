// Vertex stage of the eye pass. In: positions and normals in the surface's frame, coordinates (metres of the rest shape,
// or texture coordinates; of the table, TABLE, its x and z), of the device's skin the place at rest too. Out: the same
// in the world, metres, and with SHADOW the place in the shadow map with the slope of the surface's plane there.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifndef TABLE
layout(location = 2) in vec2 coordinates;
#endif
#ifdef SKIN
layout(location = 3) in vec3 restPosition;
out vec3 restPlace;
#endif

uniform mat4 worldFromSurface;
uniform mat4 normalFromSurface;

out vec3 worldPosition;
out vec3 worldNormal;
out vec2 place;

#ifdef SHADOW
uniform mat4 shadowFromWorld;      // to the map, 0 to 1, homogeneous
uniform mat4 shadowPlaneFromWorld; // of planes
uniform vec3 shadowLight;          // towards a parallel light, or where a lamp stands
uniform float shadowTexel;         // metres a pixel of the map covers; of a lamp's: at a distance of 1 m
uniform float shadowSteepest;      // largest slope, depth over map units
uniform float shadowLift;          // metres off the surface, where its normals are not its own
out vec4 shadowPlace;
out vec2 shadowSlope;

void placeInShadow() {
    vec3 n = normalize(worldNormal);
#ifdef LAMP
    vec3 towards = shadowLight - worldPosition;
    float reach = shadowTexel * length(towards);
    towards = normalize(towards);
#else
    vec3 towards = shadowLight;
    float reach = shadowTexel;
#endif
    float facing = dot(n, towards);
    vec3 at = worldPosition + n * (shadowLift + reach * 1.2 * sqrt(max(1.0 - facing * facing, 0.0)));
    shadowPlace = shadowFromWorld * vec4(at, 1.0);
    vec4 plane = shadowPlaneFromWorld * vec4(n, -dot(n, at));
    vec2 slope = -plane.xy / (abs(plane.z) > 1e-6 ? plane.z : 1e-6);
    shadowSlope = slope * min(1.0, shadowSteepest / max(length(slope), 1e-6));
}
#endif

void main() {
    worldPosition = (worldFromSurface * vec4(position, 1.0)).xyz;
    worldNormal = (normalFromSurface * vec4(normal, 0.0)).xyz;
#ifdef TABLE
    place = position.xz;
#else
    place = coordinates;
#endif
#ifdef SKIN
    restPlace = restPosition.xzy;
#endif
#ifdef SHADOW
    placeInShadow();
#endif
    gl_Position = clipOf(worldPosition);
}
