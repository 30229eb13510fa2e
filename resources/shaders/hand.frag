// Tracked hands in the room's own light, as smooth bodies around their capsules. Pieces before: version.glsl,
// camera.glsl, hands.glsl, room_lamp.glsl. In: the observer as a pinhole, as in room.frag, and its lens for the depth.
// Out: linear radiance, and depth.

uniform mat4 worldFromCamera;
uniform vec3 viewerPosition;
uniform vec2 focal;
uniform vec2 principal;
uniform vec2 frameSize;
uniform float roomLight;

out vec4 color;

const float kFar = 10.0;        // metres
const float kRound = 0.03;      // over which capsules go into one another, metres
const float kNear = 2e-4;       // metres, at which a ray has come to the surface
const vec3 kAlbedo = vec3(0.5); // of a hand in a grey glove

float distanceToHands(vec3 at) {
    float least = kFar;
    for (int k = 0; k < handCapsules; ++k) {
        vec3 axis = handTo[k] - handFrom[k].xyz;
        float along = clamp(dot(at - handFrom[k].xyz, axis) / max(dot(axis, axis), 1e-9), 0.0, 1.0);
        float one = distance(at, handFrom[k].xyz + along * axis) - handFrom[k].w;
        float share = max(kRound - abs(one - least), 0.0) / kRound;
        least = min(one, least) - 0.25 * kRound * share * share;
    }
    return least;
}

void main() {
    vec2 pixel = vec2(gl_FragCoord.x, frameSize.y - gl_FragCoord.y) - 0.5;
    vec3 way = normalize(mat3(worldFromCamera) * vec3((pixel - principal) / focal, 1.0));
    if (clearOfHands(viewerPosition, viewerPosition + kFar * way) > kRound) discard;
    float gone = 0.0;
    float left = kFar;
    for (int step = 0; step < 80 && left > kNear && gone < kFar; ++step) {
        left = distanceToHands(viewerPosition + gone * way);
        gone += left;
    }
    if (left > kNear) discard;
    vec3 at = viewerPosition + gone * way;
    const vec2 e = vec2(1e-3, -1e-3);
    vec3 normal = normalize(e.xyy * distanceToHands(at + e.xyy) + e.yyx * distanceToHands(at + e.yyx) +
                            e.yxy * distanceToHands(at + e.yxy) + e.xxx * distanceToHands(at + e.xxx));
    vec4 clip = clipOf(at);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    color = vec4(roomLight * (fromAround(normal) + fromLamp(normal)) * kAlbedo, 1.0);
}
