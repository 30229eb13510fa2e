// Shared piece: the way from light to an sRGB-encoded colour.

// Bright tones roll off softly instead of clipping; dark and middle tones stay nearly as they are.
vec3 toneMapped(vec3 light) {
    return light * (1.0 + light / 5.8) / (1.0 + light * 0.55);
}

vec3 encoded(vec3 light) {
    vec3 c = clamp(light, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}

vec3 shown(vec3 light) { return encoded(toneMapped(light)); }
