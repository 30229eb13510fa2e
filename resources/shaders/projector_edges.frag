// Where a projector's image has an edge in depth: 0 there, 1 elsewhere, one pixel for `block` x `block` of its image.
// Piece before: version.glsl. In: its depth map (along a plane depth is linear in the image) and the map's constants.

uniform sampler2D depthMap;
uniform int block;
uniform float depthFar;   // depth at infinity
uniform float depthSlope; // change of depth with distance, times the square of the distance
uniform float focal;      // pixels

const float kSteepest = 1.5; // metres of depth a metre across, steeper is an edge

out vec4 color;

float depthAt(ivec2 pixel) {
    return texelFetch(depthMap, clamp(pixel, ivec2(0), textureSize(depthMap, 0) - 1), 0).r;
}

bool edgeAt(ivec2 pixel, int stride) {
    float here = depthAt(pixel);
    float bendX = depthAt(pixel - ivec2(stride, 0)) - 2.0 * here + depthAt(pixel + ivec2(stride, 0));
    float bendY = depthAt(pixel - ivec2(0, stride)) - 2.0 * here + depthAt(pixel + ivec2(0, stride));
    float distance = depthSlope / max(depthFar - here, 1e-9);
    return max(abs(bendX), abs(bendY)) > depthSlope * kSteepest * float(stride) / (focal * distance);
}

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * block;
    int stride = max(block / 2, 1);
    bool edge = false;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) edge = edge || edgeAt(corner + stride / 2 + stride * ivec2(i, j), stride);
    color = vec4(edge ? 0.0 : 1.0);
}
