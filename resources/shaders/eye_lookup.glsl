// The eye's picture at a physical point, where the eye sees it. In: the picture, the depth of the device alone from the
// eye (1 where it is not), and how the eye looks. Out: linear light; alpha is the share to be taken, 0 where the eye
// does not see the point or it lies outside the picture.

struct EyeView {
    mat4 clipFromWorld;
    mat4 clipFromWorldPlane; // the transposed inverse: takes planes to clip space
    vec2 size;               // pixels
    float texel;             // of the picture at distance 1, metres
    float depthSlope;        // change of depth with distance, times the square of the distance
};

const float kFeather = 0.025;   // of the picture's side, over which it fades out at its border
const float kSlack = 0.0004;    // metres between a point and the depth that stands for it
const float kTapSpacing = 1.5;  // texels
const float kMostTaps = 8.0;    // along one side of a footprint

// Weights of the four texels of a bilinear tap, in textureGather's order.
vec4 tapWeights(vec2 fraction) {
    vec2 rest = 1.0 - fraction;
    return vec4(rest.x * fraction.y, fraction.x * fraction.y, fraction.x * rest.y, rest.x * rest.y);
}

// How far each of the tap's four stored depths lies behind the surface's plane (device), or whether it is free of the
// device (table).
vec4 behindPlane(vec4 stored, vec2 uv, vec2 size, vec3 at, vec2 slope) {
#ifdef TABLE
    return vec4(lessThan(stored, vec4(0.9999999))) * -1e9;
#else
    vec2 low = (floor(uv * size - 0.5) + 0.5) / size - at.xy;
    vec2 high = low + 1.0 / size;
    vec4 expected = at.z + slope.x * vec4(low.x, high.x, high.x, low.x) + slope.y * vec4(high.y, high.y, low.y, low.y);
    return stored - expected;
#endif
}

vec4 seenByEye(sampler2D picture, sampler2D deviceDepth, EyeView view, vec3 world, vec3 normal) {
    vec4 clip = view.clipFromWorld * vec4(world, 1.0);
    vec3 at = clip.xyz / clip.w * 0.5 + 0.5;
    vec2 alongX = dFdx(at.xy);
    vec2 alongY = dFdy(at.xy);
    vec2 border = min(at.xy, 1.0 - at.xy);
    float share = clip.w > 0.0 ? clamp(min(border.x, border.y) / kFeather, 0.0, 1.0) : 0.0;
    if (share == 0.0) return vec4(0.0);

    vec2 slope = vec2(0.0);
    float slack = view.depthSlope / (clip.w * clip.w) * (kSlack + 2.0 * view.texel * clip.w);
#ifndef TABLE
    vec4 plane = view.clipFromWorldPlane * vec4(normal, -dot(normal, world));
    slope = -plane.xy / (abs(plane.z) > 1e-12 ? plane.z : 1e-12);
#endif
    vec4 weights = tapWeights(fract(at.xy * view.size - 0.5));
    vec4 behind = behindPlane(textureGather(deviceDepth, at.xy), at.xy, view.size, at, slope);
    if (dot(weights, vec4(greaterThan(behind, vec4(-slack)))) < 0.5) return vec4(0.0);

    // Its own four texels, for points so close to an edge that no whole tap fits.
    weights *= vec4(lessThan(abs(behind), vec4(2.0 * slack)));
    ivec2 corner = ivec2(floor(at.xy * view.size - 0.5));
    vec4 sum = weights.x * vec4(texelFetch(picture, corner + ivec2(0, 1), 0).rgb, 1.0) +
               weights.y * vec4(texelFetch(picture, corner + ivec2(1, 1), 0).rgb, 1.0) +
               weights.z * vec4(texelFetch(picture, corner + ivec2(1, 0), 0).rgb, 1.0) +
               weights.w * vec4(texelFetch(picture, corner, 0).rgb, 1.0);
    sum *= 1e-4;

    vec2 taps = clamp(ceil(vec2(length(alongX * view.size), length(alongY * view.size)) / kTapSpacing), 1.0, kMostTaps);
    for (float j = 0.5; j < taps.y; j += 1.0)
        for (float i = 0.5; i < taps.x; i += 1.0) {
            vec2 uv = at.xy + (i / taps.x - 0.5) * alongX + (j / taps.y - 0.5) * alongY;
            behind = behindPlane(textureGather(deviceDepth, uv), uv, view.size, at, slope);
            float reach = 1.0 + 0.5 * length((uv - at.xy) * view.size);
            if (all(lessThan(abs(behind), vec4(2.0 * slack * reach)))) sum += vec4(textureLod(picture, uv, 0.0).rgb, 1.0);
        }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, share) : vec4(0.0);
}
