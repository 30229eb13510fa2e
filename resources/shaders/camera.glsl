// A calibrated camera or projector (pinhole with Brown distortion), set by setCamera. In: a position in the world,
// metres. Out: clip space, lens distortion included, with the image's row 0 at the top of the viewport.

uniform mat4 lensCameraFromWorld; // +X right, +Y down, +Z forward
uniform vec4 lensClip;            // clip = lensClip.xy * at + lensClip.zw, `at` on the plane at distance 1
uniform vec2 lensDepth;           // clip depth = lensDepth.x * distance + lensDepth.y
uniform vec3 lensRadial;          // k1, k2, k3
uniform vec2 lensTangential;      // p1, p2
uniform float lensLimit;          // square of the radius up to which it is monotonic; 0: there is no distortion

vec2 lensDistorted(vec2 at) {
    float r2 = dot(at, at);
    float radial = 1.0 + r2 * (lensRadial.x + r2 * (lensRadial.y + r2 * lensRadial.z));
    float crossed = 2.0 * at.x * at.y;
    return at * radial + vec2(lensTangential.x * crossed + lensTangential.y * (r2 + 2.0 * at.x * at.x),
                              lensTangential.x * (r2 + 2.0 * at.y * at.y) + lensTangential.y * crossed);
}

vec4 clipOf(vec3 world) {
    vec3 local = (lensCameraFromWorld * vec4(world, 1.0)).xyz;
    vec2 scaled = local.xy;
    float depth = lensDepth.x * local.z + lensDepth.y;
    if (lensLimit > 0.0 && local.z > 0.0) {
        vec2 at = local.xy / local.z;
        float r2 = dot(at, at);
        // Beyond the limit the image would fold back. It goes on straight instead, and out through the far plane.
        float share = r2 > lensLimit ? sqrt(lensLimit / r2) : 1.0;
        scaled = local.z * (lensDistorted(at * share) + at * (1.0 - share));
        if (share < 1.0) depth = 2.0 * local.z;
    }
    return vec4(lensClip.xy * scaled + lensClip.zw * local.z, depth, local.z);
}
