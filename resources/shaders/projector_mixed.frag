// What a projector sends through a pixel that lies on several surfaces. Pieces before: version.glsl, camera.glsl (the
// projector's), projector_eye_weight.glsl, where RESPONSE is defined projector_response.glsl. In: its picture as it would be if each pixel lay on one surface; how much the
// eye sees of what each pixel's light does (0: nothing that was looked up, negative: hidden); where the device lies under
// it; the table. Out: the value.
// A pixel's light falls upon its neighbours' places too. Where they give back different shares g of it and the eye sees
// areas w of them, the squared error of what it sees is least for sum(w g wanted) / sum(w g g), and wanted is g times
// the value that the place alone would have: a mean of these values by w g g.

struct EyeView {
    mat4 clipFromWorld;
};

uniform sampler2D before;
uniform sampler2D eyeWeight;
uniform sampler2D surfacePlace;
uniform vec4 deviceArea; // the part of surfacePlace that is drawn, least and largest pixels
uniform sampler2D deviceViewDepth;
uniform EyeView deviceView;
uniform vec3 projectorPosition;
uniform vec2 tableHalf;    // metres
uniform float tableAlbedo; // mean of its square
#ifdef GAMMA
uniform float gamma;
#endif

layout(location = 0) out vec4 color;

const float kAlike = 0.85; // smaller shares of the largest weight make a pixel mixed
// Of a pixel's light on itself and on the pixel beside it along one axis: its box seen through a tent, the lens.
const float kOwn = 0.75;
const float kBeside = 0.125;

vec3 valueAt(ivec2 pixel) {
    vec3 value = texelFetch(before, pixel, 0).rgb;
#if defined(GAMMA) || defined(RESPONSE)
    value = mix(12.92 * value, 1.055 * pow(max(value, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, value));
#endif
#ifdef GAMMA
    value = pow(max(value, vec3(1e-6)), vec3(gamma));
#endif
#ifdef RESPONSE
    value = lightOfValue(value);
#endif
    return value;
}

bool onDevice(ivec2 pixel) {
    bool drawn = all(greaterThanEqual(pixel, ivec2(deviceArea.xy))) && all(lessThan(pixel, ivec2(deviceArea.zw)));
    return drawn && texelFetch(surfacePlace, pixel, 0).w != 0.0;
}

// Of the table under a pixel; 0 where the ray misses it or the device hides it from the eye.
float tableWeight(ivec2 pixel) {
    vec2 clip = (vec2(pixel) + 0.5) / vec2(textureSize(eyeWeight, 0)) * 2.0 - 1.0;
    vec2 straight = (clip - lens.clip.zw) / lens.clip.xy;
    vec2 at = straight;
    if (lens.limit > 0.0)
        for (int i = 0; i < 4; ++i) at -= distorted(lens, at) - straight;
    vec3 ray = transpose(mat3(lens.cameraFromWorld)) * vec3(at, 1.0);
    if (ray.y * projectorPosition.y >= 0.0) return 0.0;
    vec3 world = projectorPosition - ray * (projectorPosition.y / ray.y);
    if (any(greaterThan(abs(world.xz), tableHalf))) return 0.0;
    vec4 seen = deviceView.clipFromWorld * vec4(world, 1.0);
    vec2 uv = seen.xy / max(seen.w, 1e-6) * 0.5 + 0.5;
    vec4 device = vec4(lessThan(textureGather(deviceViewDepth, uv), vec4(0.9999999)));
    if (dot(device, vec4(1.0)) > 2.0) return 0.0;
    return eyeWeightOf(world, vec3(0.0, sign(projectorPosition.y), 0.0), projectorPosition, tableAlbedo);
}

void main() {
    vec2 size = vec2(textureSize(eyeWeight, 0));
    vec4 below = textureGather(eyeWeight, (gl_FragCoord.xy - 0.5) / size);
    vec4 above = textureGather(eyeWeight, (gl_FragCoord.xy + 0.5) / size);
    vec4 most = max(below, above);
    vec4 least = min(below, above);
    float largest = max(max(most.x, most.y), max(most.z, most.w));
    float smallest = min(min(least.x, least.y), min(least.z, least.w));
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bool mixed = largest > 0.0 && smallest <= kAlike * largest;
    ivec2 last = textureSize(eyeWeight, 0) - 1;
    // Where the table's picture fades out pixel by pixel nothing is mixed: without a hidden place the device is near.
    bool device = smallest < 0.0;
    for (int i = mixed && !device ? 0 : 9; i < 9; ++i) device = device || onDevice(pixel + ivec2(i % 3, i / 3) - 1);
    mixed = mixed && device;
    vec4 sum = vec4(0.0);
    // Software rasterisers skip a loop, never a branch.
    for (int i = mixed ? 0 : 9; i < 9; ++i) {
        ivec2 away = ivec2(i % 3, i / 3) - 1;
        ivec2 there = clamp(pixel + away, ivec2(0), last);
        float weight = texelFetch(eyeWeight, there, 0).r;
        if (weight == 0.0) {
            if (!onDevice(there)) {
                weight = tableWeight(there);
            } else if (i == 4) {
                discard; // it fades into the view-independent look, pixel by pixel
            }
        }
        weight = max(weight, 0.0) * (away.x == 0 ? kOwn : kBeside) * (away.y == 0 ? kOwn : kBeside);
        sum += weight * vec4(valueAt(there), 1.0);
    }
    if (sum.a <= 0.0) discard;
    vec3 value = sum.rgb / sum.a;
#ifdef GAMMA
    value = pow(value, vec3(1.0 / gamma));
#endif
#ifdef RESPONSE
    value = valueOfLight(value);
#endif
    color = vec4(value, 1.0);
}
