// The room around the table in its own dim light: floor, four walls and ceiling of a box that every ray leaves
// somewhere. Pieces before: version.glsl, noise.glsl. In: the observer as a pinhole (its lens' distortion is far below
// what a plain wall shows), frame size (pixels), half the table's sides. Out: linear radiance.

uniform mat4 worldFromCamera;
uniform vec3 viewerPosition;
uniform vec2 focal;
uniform vec2 principal;
uniform vec2 frameSize;
uniform vec2 tableHalf;
uniform float roomLight;
uniform float wallLamp; // radiance of white that a lamp behind the table gives the walls alone

out vec4 color;

const vec3 kRoomLow = vec3(-2.6, -0.74, -2.2);
const vec3 kRoomHigh = vec3(2.6, 1.9, 2.2);
const float kSkirting = 0.09; // metres

float softly(float distance, float width) { return smoothstep(0.0, width, distance); }

void main() {
    vec2 pixel = vec2(gl_FragCoord.x, frameSize.y - gl_FragCoord.y) - 0.5;
    vec3 way = mat3(worldFromCamera) * vec3((pixel - principal) / focal, 1.0);
    vec3 ends = (mix(kRoomLow, kRoomHigh, step(0.0, way)) - viewerPosition) / (abs(way) + 1e-6) * sign(way + 1e-9);
    float far = min(ends.x, min(ends.y, ends.z));
    vec3 at = viewerPosition + far * way;
    bool isFloor = far == ends.y && way.y < 0.0;

    vec3 albedo = isFloor ? vec3(0.30, 0.25, 0.20) : vec3(0.42, 0.44, 0.47);
    // Light from a lamp that is turned down, above and to the left, and what a wall gives back.
    vec3 lamp = vec3(-0.8, 1.7, 0.6) - at;
    float light = 0.35 + 1.5 / (1.0 + 0.55 * dot(lamp, lamp));
    if (isFloor) {
        // Corners are darker, and it is dark under a table.
        vec2 free = min(at.xz - kRoomLow.xz, kRoomHigh.xz - at.xz);
        light *= 0.55 + 0.45 * softly(min(free.x, free.y), 0.7);
        vec2 beside = abs(at.xz) - tableHalf;
        float from = length(max(beside, 0.0)) + min(max(beside.x, beside.y), 0.0);
        light *= 0.25 + 0.75 * smoothstep(-0.25, 0.55, from);
    } else {
        float height = at.y - kRoomLow.y;
        light *= 0.6 + 0.4 * softly(height, 0.8);
        if (height < kSkirting) albedo = vec3(0.22, 0.2, 0.19);
    }
    vec3 value = roomLight * albedo * light;
    if (!isFloor) value += wallLamp * albedo * (0.45 + 0.55 * softly(at.y - kRoomLow.y, 1.4));
    // Slow gradients in the dark show steps in eight bits: half a step of noise, in the linear light of it.
    float slope = 2.4 / 1.055 * pow(max((pow(max(value.g, 1e-4), 1.0 / 2.4) * 1.055), 0.05) / 1.055, 1.4);
    color = vec4(max(value + (noiseAt(gl_FragCoord.xy) - 0.5) / 255.0 * slope, 0.0), 1.0);
}
