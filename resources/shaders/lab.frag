// A projector's light on device and table, which are diffuse, seen by any observer. Pieces before: version.glsl,
// camera.glsl, physical_normal.glsl, projector_light.glsl, projector_sight.glsl, hands.glsl, where RESPONSE is defined
// projector_response.glsl. In: what the projector sends out and, without RESPONSE, its gamma (0: sRGB), and the colour of
// the bare surface. Out: linear radiance, to be added up; white where the
// projector reaches when MASK is defined.

in vec3 worldPosition;
uniform vec3 viewerPosition;
uniform sampler2D sent;
#ifndef RESPONSE
uniform float gamma;
#endif
uniform vec3 surfaceAlbedo; // linear

out vec4 color;

vec3 encoded(vec3 value) {
    return mix(12.92 * value, 1.055 * pow(max(value, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, value));
}

vec3 lightAt(ivec2 pixel) {
    vec3 value = texelFetch(sent, clamp(pixel, ivec2(0), textureSize(sent, 0) - 1), 0).rgb;
#ifdef RESPONSE
    return mix(projectorBlack, vec3(1.0), lightOfValue(encoded(value)));
#else
    return gamma > 0.0 ? pow(max(encoded(value), vec3(1e-6)), vec3(gamma)) : value;
#endif
}

vec3 lightBetween(vec2 uv) {
    vec2 at = uv * vec2(textureSize(sent, 0)) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 part = at - vec2(low);
    return mix(mix(lightAt(low), lightAt(low + ivec2(1, 0)), part.x),
               mix(lightAt(low + ivec2(0, 1)), lightAt(low + ivec2(1, 1)), part.x), part.y);
}

void main() {
    vec3 normal = faceTowards(worldPosition, viewerPosition);
    Sight sight = sightOf(worldPosition, normal);
    vec3 light = fullLight(worldPosition, normal);
    float reached = sight.reached * step(0.0, clearOfHands(projectorPosition, worldPosition));
#ifdef MASK
    color = vec4(reached > 0.5 && light.g > 0.0 ? 1.0 : 0.0);
#else
    color = vec4(surfaceAlbedo * light * reached * lightBetween(sight.uv), 1.0);
#endif
}
