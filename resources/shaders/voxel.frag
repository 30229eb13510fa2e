// A face of a voxel: even, with a seam towards the next cube and a darker foot in concave edges; follows
// version.glsl. In: faceColor (sRGB-encoded), facePlace (voxels from the middle of the face), sides
// (0 free, 1 the body goes on, 2 concave; two bits each for left, right, lower, upper), inset (half the
// gap between two cubes, voxels), opacity. Out: color, sRGB-encoded.

in vec3 faceColor;
in vec2 facePlace;
flat in uint sides;

uniform float inset;
uniform float opacity;

out vec4 color;

void main() {
    uvec4 state = (uvec4(sides) >> uvec4(0u, 2u, 4u, 6u)) & 3u;
    vec4 goesOn = vec4(equal(state, uvec4(1u)));
    vec4 concave = vec4(equal(state, uvec4(2u)));
    vec4 toSide = 0.5 + vec4(facePlace.x, -facePlace.x, facePlace.y, -facePlace.y);
    vec2 pixel = fwidth(facePlace);
    vec4 width = vec4(pixel.xx, pixel.yy);
    // A seam narrower than a pixel keeps its share of the light.
    vec4 seam = goesOn * clamp((inset - toSide) / width + 0.5, 0.0, 1.0) * clamp(4.0 * inset / width, 0.0, 1.0);
    vec4 foot = concave * clamp(1.0 - 1.6 * toSide, 0.0, 1.0);
    float dark = 0.38 * max(max(seam.x, seam.y), max(seam.z, seam.w));
    dark = max(dark, 0.30 * max(max(foot.x, foot.y), max(foot.z, foot.w)));
    color = vec4(faceColor * (1.0 - dark), opacity);
}
