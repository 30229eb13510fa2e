// Calibrated cameras and projectors (pinhole with Brown distortion), set by setCamera. In: a position in the world,
// metres. Out: clip space, lens distortion included, with the image's row 0 at the top of the viewport.

struct Lens {
    mat4 cameraFromWorld; // +X right, +Y down, +Z forward
    vec4 clip;            // clip = clip.xy * at + clip.zw, `at` on the plane at distance 1
    vec2 depth;           // clip depth = depth.x * distance + depth.y
    vec3 radial;          // k1, k2, k3
    vec2 tangential;      // p1, p2
    float limit;          // square of the radius up to which it is monotonic; 0: there is no distortion
};

uniform Lens lens;

vec2 distorted(Lens camera, vec2 at) {
    float r2 = dot(at, at);
    float radial = 1.0 + r2 * (camera.radial.x + r2 * (camera.radial.y + r2 * camera.radial.z));
    float crossed = 2.0 * at.x * at.y;
    vec2 p = camera.tangential;
    return at * radial + vec2(p.x * crossed + p.y * (r2 + 2.0 * at.x * at.x),
                              p.x * (r2 + 2.0 * at.y * at.y) + p.y * crossed);
}

vec4 clipThrough(Lens camera, vec3 world) {
    vec3 local = (camera.cameraFromWorld * vec4(world, 1.0)).xyz;
    vec2 scaled = local.xy;
    float depth = camera.depth.x * local.z + camera.depth.y;
    if (camera.limit > 0.0 && local.z > 0.0) {
        vec2 at = local.xy / local.z;
        float r2 = dot(at, at);
        // Beyond the limit the image would fold back. It goes on straight instead, and out through the far plane.
        float share = r2 > camera.limit ? sqrt(camera.limit / r2) : 1.0;
        scaled = local.z * (distorted(camera, at * share) + at * (1.0 - share));
        if (share < 1.0) depth = 2.0 * local.z;
    }
    return vec4(camera.clip.xy * scaled + camera.clip.zw * local.z, depth, local.z);
}

vec4 clipOf(vec3 world) {
    return clipThrough(lens, world);
}
