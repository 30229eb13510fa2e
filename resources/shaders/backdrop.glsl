// Shared piece: the backdrop's colour at a pixel of the frame, and the last step of every colour.
// In: frameSize and frameOrigin (the whole frame and the drawn piece's lower left corner in it, pixels),
// backdropTop, backdropBottom (sRGB-encoded). Space: frame pixels.

uniform vec2 frameSize;
uniform vec2 frameOrigin;
uniform vec3 backdropTop;
uniform vec3 backdropBottom;

vec3 backdropColor() {
    float height = (gl_FragCoord.y + frameOrigin.y) / frameSize.y;
    return mix(backdropBottom, backdropTop, smoothstep(0.0, 1.0, height));
}

// Half a step of noise, so that slow gradients show no bands in eight bits.
vec3 dithered(vec3 encoded) {
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy + frameOrigin, vec2(0.06711056, 0.00583715))));
    return encoded + (noise - 0.5) / 255.0;
}
