// Shared piece: the face of a physical surface that is turned towards a point. In: the place on it; TABLE is defined
// where the surface is the table. Out: its normal in the world.

vec3 faceTowards(vec3 place, vec3 point) {
#ifdef TABLE
    return vec3(0.0, point.y < place.y ? -1.0 : 1.0, 0.0);
#else
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    return dot(normal, point - place) < 0.0 ? -normal : normal;
#endif
}
