// The backdrop; follows version.glsl and backdrop.glsl. In: see there. Out: color, sRGB-encoded.

out vec4 color;

void main() { color = vec4(dithered(backdropColor()), 1.0); }
