// Shared piece: even noise in [0, 1) of a pixel, in which neighbours differ much (interleaved gradient noise, Jimenez
// 2014). Space: pixels.

float noiseAt(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }
