#version 410 core
// A surface of a viewport in motion. In: see moving_surface.vert; keyShadow (depth map, 1 is lit),
// keepAlpha (0 marks outlined surfaces). Out: color, sRGB-encoded.

in vec3 mapPlace;
in vec3 litColor;
in vec3 shadedColor;
in float alpha;

uniform sampler2DArrayShadow keyShadow;
uniform float keepAlpha;

out vec4 color;

void main() {
    float key = texture(keyShadow, vec4(mapPlace.xy, 0.0, mapPlace.z));
    color = vec4(mix(shadedColor, litColor, key), keepAlpha * alpha);
}
