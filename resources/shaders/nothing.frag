// Depth alone. Piece before: version.glsl.

void main() {}
