// How much the eye sees of what a pixel of the projector does, for projector_mixed.frag: the area that it lights in the
// eye's picture, times the square of the share of light that comes back. The area goes with the cosine towards the eye
// over that towards the projector, the share with the latter; both with distances. In: where the eye stands, world.

uniform vec3 eyePosition;

// `albedo`: the mean of its square.
float eyeWeightOf(vec3 world, vec3 normal, vec3 projector, float albedo) {
    vec3 toEye = eyePosition - world;
    vec3 toProjector = projector - world;
    vec2 square = vec2(dot(toEye, toEye), dot(toProjector, toProjector));
    vec2 share = vec2(dot(toEye, normal), dot(toProjector, normal)) * inversesqrt(square) / square;
    return max(share.x, 0.0) * max(share.y, 0.0) * albedo;
}
