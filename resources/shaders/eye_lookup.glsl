// The eye's picture at a physical point, where the eye sees it. In: the picture, the depth of the device alone from the
// eye (1 where it is not), how the eye looks, and the pixel's footprint in its picture (footprintOf, where there are
// derivatives); on the table the area where its picture differs from the view-independent one. Out: linear light; alpha
// is the share to be taken, 0 where the eye does not see the point or it lies outside the picture. Where the device hides
// itself the light is that of what hides it, and alpha is negative.
// Software rasterisers run all lanes through every branch, so there are few of them.

struct EyeView {
    mat4 clipFromWorld;
    mat4 clipFromWorldPlane; // the transposed inverse: takes planes to clip space
    vec2 size;               // pixels
    float texel;             // of the picture at distance 1, metres
    float depthSlope;        // change of depth with distance, times the square of the distance
};

#ifdef TABLE
uniform vec4 lookupArea; // least and largest x, z, metres
#endif

const float kFeather = 0.025; // of the picture's side, over which it fades out at its border
const float kAreaFade = 0.008; // metres, over which it fades out around the area of the table
const float kSlack = 0.0004;  // metres between a point and the depth that stands for it
const float kTapSpacing = 0.7; // texels; by 1 a pixel about as large as a texel has one tap, which is no mean of what it covers
const float kMostTaps = 8.0;  // along one side of a footprint

// Weights of the four texels of a bilinear tap, in textureGather's order.
vec4 tapWeights(vec2 fraction) {
    vec2 rest = 1.0 - fraction;
    return vec4(rest.x * fraction.y, fraction.x * fraction.y, fraction.x * rest.y, rest.x * rest.y);
}

// How far each of the tap's four stored depths lies behind the surface's plane (device), or 0 where the device does not
// hide the table.
vec4 behindPlane(vec4 stored, vec2 uv, vec2 size, vec3 at, vec2 slope) {
#ifdef TABLE
    return vec4(lessThan(stored, vec4(0.9999999))) * -1e9;
#else
    vec2 low = (floor(uv * size - 0.5) + 0.5) / size - at.xy;
    vec2 high = low + 1.0 / size;
    return stored - at.z - slope.x * vec4(low.x, high.x, high.x, low.x) - slope.y * vec4(high.y, high.y, low.y, low.y);
#endif
}

float shareAt(vec2 uv, vec3 world) {
    vec2 border = min(uv, 1.0 - uv) / kFeather;
    float share = min(border.x, border.y);
#ifdef TABLE
    vec2 beyond = max(lookupArea.xy - world.xz, world.xz - lookupArea.zw) / kAreaFade;
    share = min(share, 1.0 - max(beyond.x, beyond.y));
#endif
    return clamp(share, 0.0, 1.0);
}

// How a place moves in the eye's picture (0 to 1) from this pixel to the next: to the right, and up.
vec4 footprintOf(EyeView view, vec3 world) {
    vec4 clip = view.clipFromWorld * vec4(world, 1.0);
    vec2 at = clip.xy / max(clip.w, 1e-6) * 0.5;
    return vec4(dFdx(at), dFdy(at));
}

vec4 seenByEye(sampler2D picture, sampler2D deviceDepth, EyeView view, vec3 world, vec3 normal, vec4 footprint) {
    vec4 clip = view.clipFromWorld * vec4(world, 1.0);
    float distance = max(clip.w, 1e-6);
    vec3 at = clip.xyz / distance * 0.5 + 0.5;
    vec2 alongX = footprint.xy;
    vec2 alongY = footprint.zw;
    float share = clip.w > 0.0 ? shareAt(at.xy, world) : 0.0;

    vec2 slope = vec2(0.0);
    float slack = view.depthSlope / (distance * distance) * (kSlack + 2.0 * view.texel * distance);
#ifndef TABLE
    vec4 plane = view.clipFromWorldPlane * vec4(normal, -dot(normal, world));
    slope = -plane.xy / (abs(plane.z) > 1e-12 ? plane.z : 1e-12);
#endif
    vec2 place = at.xy * view.size - 0.5;
    vec4 weights = tapWeights(fract(place));
    vec4 stored = textureGather(deviceDepth, at.xy);
    vec4 behind = behindPlane(stored, at.xy, view.size, at, slope);
    vec4 clear = behind;
#ifndef TABLE
    // What lies in front of the plane drawn on beyond its rim but behind the point itself, hides nothing.
    clear = max(behind, stored - at.z);
#endif
    bool hidden = dot(weights, vec4(greaterThan(clear, vec4(-slack)))) < 0.5;

    // The nearest of its own texels, for points so close to an edge that no whole tap fits; hidden ones have none.
    vec4 own = weights * vec4(lessThan(abs(behind), vec4(2.0 * slack)));
#ifdef TABLE
    share *= hidden ? 0.0 : 1.0;
    weights = own;
#else
    bool lost = max(max(own.x, own.y), max(own.z, own.w)) == 0.0;
    share *= hidden || lost ? -1.0 : 1.0;
    weights = lost ? weights * vec4(lessThan(stored, vec4(0.9999999))) : own;
#endif
    vec2 most = max(weights.xy, weights.wz);
    ivec2 nearest = ivec2(most.y > most.x ? 1 : 0, max(weights.x, weights.y) > max(weights.z, weights.w) ? 1 : 0);
    float found = max(most.x, most.y) > 0.0 ? 1e-4 : 0.0;
    vec4 sum = found * vec4(texelFetch(picture, ivec2(floor(place)) + nearest, 0).rgb, 1.0);

    vec2 taps = clamp(ceil(vec2(length(alongX * view.size), length(alongY * view.size)) / kTapSpacing), 1.0, kMostTaps);
    if (share <= 0.0) taps = vec2(1.0);
    vec2 tap = vec2(0.5);
    do {
        vec2 along = tap / taps - 0.5;
        vec2 uv = at.xy + along.x * alongX + along.y * alongY;
        behind = behindPlane(textureGather(deviceDepth, uv), uv, view.size, at, slope);
        float reach = 2.0 * slack + slack * length((uv - at.xy) * view.size);
        bool whole = all(lessThan(abs(behind), vec4(reach)));
        sum += whole ? vec4(textureLod(picture, uv, 0.0).rgb, 1.0) : vec4(0.0);
        tap.x += 1.0;
        if (tap.x > taps.x) tap = vec2(0.5, tap.y + 1.0);
    } while (tap.y < taps.y);
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, share) : vec4(0.0);
}
