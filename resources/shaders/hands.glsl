// Shared piece: tracked hands, as capsules between a projector's lens and a place. In: their axes and radii, world
// metres. Out: how far the straight way of light passes them; negative where a hand is in it.

const int kMostCapsules = 8;
uniform int handCapsules;
uniform vec4 handFrom[kMostCapsules]; // one end, and the radius
uniform vec3 handTo[kMostCapsules];

// Between the lines from a to b and from c to d.
float gapBetween(vec3 a, vec3 b, vec3 c, vec3 d) {
    vec3 u = b - a, v = d - c, w = a - c;
    float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    float s = clamp((uv * vw - vv * uw) / max(uu * vv - uv * uv, 1e-9), 0.0, 1.0);
    float t = clamp((uv * s + vw) / max(vv, 1e-9), 0.0, 1.0);
    s = clamp((uv * t - uw) / max(uu, 1e-9), 0.0, 1.0); // where the end of d or c cut it short
    return distance(a + s * u, c + t * v);
}

float clearOfHands(vec3 lens, vec3 place) {
    float clear = 1e3;
    for (int k = 0; k < handCapsules; ++k)
        clear = min(clear, gapBetween(lens, place, handFrom[k].xyz, handTo[k]) - handFrom[k].w);
    return clear;
}
