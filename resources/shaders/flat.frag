// One colour. Piece before: version.glsl. In: flatColor, linear.

uniform vec3 flatColor;

out vec4 color;

void main() {
    color = vec4(flatColor, 1.0);
}
