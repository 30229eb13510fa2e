// Whether a projector reaches a physical point. Pieces before: camera.glsl. In: its lens and its depth map. Out: the
// share of a bilinear tap that is not in shadow, and the place in its image (0 to 1, row 0 at the top of the texture).

uniform Lens sightLens;
uniform mat4 sightPlane;       // the transposed inverse of its (undistorted) clipFromWorld: takes planes to clip space
uniform sampler2D sightDepth;
uniform vec2 sightSize;        // pixels
uniform float sightTexel;      // of its image at distance 1, metres
uniform float sightDepthSlope; // change of depth with distance, times the square of the distance

const float kSightSlack = 0.0008; // metres between a point and the depth that stands for it

struct Sight {
    vec2 uv;
    float reached;
};

Sight sightOf(vec3 world, vec3 normal) {
    vec4 clip = clipThrough(sightLens, world);
    vec3 at = clip.xyz / clip.w * 0.5 + 0.5;
    bool inside = clip.w > 0.0 && all(greaterThan(at, vec3(0.0))) && all(lessThan(at, vec3(1.0)));
    if (!inside) return Sight(vec2(0.5), 0.0);

    vec4 plane = sightPlane * vec4(normal, -dot(normal, world));
    vec2 slope = -plane.xy / (abs(plane.z) > 1e-12 ? plane.z : 1e-12);
    vec2 low = (floor(at.xy * sightSize - 0.5) + 0.5) / sightSize - at.xy;
    vec2 high = low + 1.0 / sightSize;
    vec4 expected = at.z + slope.x * vec4(low.x, high.x, high.x, low.x) + slope.y * vec4(high.y, high.y, low.y, low.y);
    float slack = sightDepthSlope / (clip.w * clip.w) * (kSightSlack + 2.0 * sightTexel * clip.w);
    // What lies in front of the plane drawn on beyond its rim but behind the point itself, shadows nothing.
    vec4 lit = vec4(greaterThan(textureGather(sightDepth, at.xy), min(expected, at.z) - slack));
    vec2 part = fract(at.xy * sightSize - 0.5);
    float reached = mix(mix(lit.w, lit.z, part.x), mix(lit.x, lit.y, part.x), part.y);
    return Sight(at.xy, reached);
}
