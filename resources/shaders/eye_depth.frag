// Depth alone, for shadow maps: holes and cut-out pictures let light through, what fades does in part. In: see
// eye_holes.glsl.

#ifdef CUTOUT
uniform sampler2D colorPicture;
uniform vec4 colorTurn;
uniform vec2 colorShift;
#endif
#ifdef DITHER
uniform float castShare; // of the light that is held back
#endif

void main() {
#ifdef HOLES
    if (isHole()) discard;
#endif
#ifdef CUTOUT
    if (texture(colorPicture, mat2(colorTurn.xy, colorTurn.zw) * place + colorShift).a < 0.5) discard;
#endif
#ifdef DITHER
    vec2 cell = mod(floor(gl_FragCoord.xy), 4.0);
    float order = fract(dot(cell, vec2(0.5, 0.25)) + dot(floor(cell * 0.5), vec2(0.125, 0.3125)) + 0.03125);
    if (order >= castShare) discard;
#endif
}
