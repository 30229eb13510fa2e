// Lines along the folds of the device's skin. In: place (across the line, strength), ink (linear colour, opacity).
// Out: linear light, or with PROJECTED what a projector sends for it.

in vec3 worldPosition;
uniform vec4 ink;
out vec4 color;

void main() {
#ifdef HOLES
    if (isHole()) discard;
#endif
    float edge = (1.0 - abs(place.x)) / max(fwidth(place.x), 1e-4);
    color = shown(ink.rgb, ink.a * place.y * clamp(edge, 0.0, 1.0));
#ifdef PROJECTED
    color.rgb = sentFor(color.rgb, worldPosition, faceTowards(worldPosition, projectorPosition)).rgb;
#endif
}
