// Linear light as a picture. Piece before: version.glsl. In: linear light; where ENCODE is defined the framebuffer does
// not encode. Out: sRGB, clipped at white.

uniform sampler2D picture;

out vec4 color;

void main() {
    vec3 value = clamp(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb, 0.0, 1.0);
#ifdef ENCODE
    value = mix(12.92 * value, 1.055 * pow(max(value, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, value));
#endif
    color = vec4(value, 1.0);
}
