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
#ifndef TABLE
uniform float bounces; // 1: the device's sides get back what the table has of this projector; 0: direct light alone
uniform vec3 tableAlbedo;
uniform vec2 tableHalf;
#endif

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

#ifndef TABLE
// What a side that looks aside or down sees of the lit table, by some places of which a wall of its height sees most. A
// table that is darker than paper gives back less: a third.
vec3 fromTable(vec3 place, vec3 normal) {
    const vec3 kUp = vec3(0.0, 1.0, 0.0);
    const vec2 kPlaces[7] = vec2[](vec2(0.4, 0.0), vec2(0.7, 1.1), vec2(0.7, -1.1), vec2(1.6, 2.4), vec2(1.6, -2.4),
                                   vec2(3.6, 0.9), vec2(3.6, -0.9)); // heights of the place: away from the wall, along it
    const float kGivenBack = 0.33;
    vec2 away = normalize(normal.xz + 1e-6) * max(place.y, 0.006);
    vec3 seen = vec3(0.0);
    for (int k = 0; k < 7; ++k) {
        vec2 flatPlace = place.xz + kPlaces[k].x * away + kPlaces[k].y * vec2(-away.y, away.x);
        if (any(greaterThan(abs(flatPlace), tableHalf))) continue;
        vec3 at = vec3(flatPlace.x, 0.0, flatPlace.y);
        Sight sight = sightOf(at, kUp);
        seen += sight.reached * fullLight(at, kUp) * lightBetween(sight.uv) / 7.0;
    }
    return kGivenBack * 0.5 * (1.0 - normal.y) * tableAlbedo * seen;
}
#endif

void main() {
    vec3 normal = faceTowards(worldPosition, viewerPosition);
    Sight sight = sightOf(worldPosition, normal);
    vec3 light = fullLight(worldPosition, normal);
    float reached = sight.reached * step(0.0, clearOfHands(projectorPosition, worldPosition));
#ifdef MASK
    color = vec4(reached > 0.5 && light.g > 0.0 ? 1.0 : 0.0);
#else
    vec3 arrives = light * reached * lightBetween(sight.uv);
#ifndef TABLE
    const float kFlat = 0.97; // cosine of what sees no table
    if (bounces > 0.0 && normal.y < kFlat) arrives += fromTable(worldPosition, normal);
#endif
    color = vec4(surfaceAlbedo * arrives, 1.0);
#endif
}
