// The face of a physical surface that is turned towards a point. In: worldPosition; TABLE is defined where the surface
// is the table. Out: its normal in the world.

in vec3 worldPosition;

vec3 faceTowards(vec3 point) {
#ifdef TABLE
    return vec3(0.0, point.y < worldPosition.y ? -1.0 : 1.0, 0.0);
#else
    vec3 normal = normalize(cross(dFdx(worldPosition), dFdy(worldPosition)));
    return dot(normal, point - worldPosition) < 0.0 ? -normal : normal;
#endif
}
