// Shared piece: the backdrop's colour at a pixel of the frame, and the last step of every colour. Piece before:
// noise.glsl. In: frameSize and frameOrigin (the whole frame and the drawn piece's lower left corner in it, pixels),
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
    return encoded + (noiseAt(gl_FragCoord.xy + frameOrigin) - 0.5) / 255.0;
}
