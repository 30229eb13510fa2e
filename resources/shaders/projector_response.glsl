// Shared piece: a projector's measured response. In: its table, of which the lower row holds values by the root of the
// light above black, the upper row light above black by values; the light of each channel's black, where white is 1.

uniform sampler2D response;
uniform vec3 projectorBlack;

vec3 inResponse(vec3 along, float row) {
    float steps = float(textureSize(response, 0).x);
    vec3 at = (clamp(along, 0.0, 1.0) * (steps - 1.0) + 0.5) / steps;
    return vec3(textureLod(response, vec2(at.r, row), 0.0).r, textureLod(response, vec2(at.g, row), 0.0).g,
                textureLod(response, vec2(at.b, row), 0.0).b);
}

// The value that makes so much light above black; both in [0, 1].
vec3 valueOfLight(vec3 light) {
    return inResponse(sqrt(clamp(light, 0.0, 1.0)), 0.25);
}

// The light above black that a value makes.
vec3 lightOfValue(vec3 value) {
    return inResponse(value, 0.75);
}
