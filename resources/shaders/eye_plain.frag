// The plain program that stands in for one the driver refuses: colour in soft light from above. Linear.

in vec3 worldNormal;
uniform vec4 baseColor;
out vec4 color;

void main() { color = vec4(baseColor.rgb * (0.65 + 0.35 * normalize(worldNormal).y), 1.0); }
