// Shared piece: the colours of the studio's lights.

// Light on a surface from the shares of key light, sky and ground that reach it.
vec3 studioLight(float key, float sky, float bounce) {
    return vec3(1.0, 0.95, 0.88) * 1.05 * key + vec3(0.86, 0.93, 1.0) * 0.42 * sky +
           vec3(1.0, 0.96, 0.92) * 0.08 * bounce;
}
