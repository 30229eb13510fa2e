// Shared piece: a direction as one whole number from 1 to 2^24, which a float holds: 12 bits for each side of the
// octahedron unfolded (Meyer et al., On Floating-Point Normal Vectors, EGSR 2010). To within 0.06 degrees.

vec2 foldedOver(vec2 at) {
    return (1.0 - abs(at.yx)) * vec2(at.x < 0.0 ? -1.0 : 1.0, at.y < 0.0 ? -1.0 : 1.0);
}

float packedNormal(vec3 n) {
    vec2 at = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 whole = floor((n.z < 0.0 ? foldedOver(at) : at) * 2047.5 + 2048.0);
    return whole.x * 4096.0 + whole.y + 1.0;
}

vec3 unpackedNormal(float packedOne) {
    float whole = packedOne - 1.0;
    float high = floor(whole / 4096.0);
    vec2 at = vec2(high, whole - 4096.0 * high) / 2047.5 - 1.0;
    float up = 1.0 - abs(at.x) - abs(at.y);
    return normalize(vec3(up < 0.0 ? foldedOver(at) : at, up));
}
