// The weight of one projector (its sight and its light) at what another one shows, to be added up over all. Pieces
// before: version.glsl, camera.glsl, physical_normal.glsl, projector_light.glsl, projector_sight.glsl, hands.glsl. In: where the
// projector that shows it stands; the distance from depth edges in the image of the one that is weighed (0 to 1); `own`
// is 1 where they are the same; where BLACK is defined the light of its black, where its white is 1, and whether
// incidence and distance are made up for. Out: its weight where they are the same, and its weight; with BLACK what its
// black makes of white there.

in vec3 worldPosition;
uniform vec3 viewerPosition;
uniform sampler2D openness;
uniform float own;
#ifdef BLACK
uniform vec3 weighedBlack;
uniform float compensation;
#endif

const float kBorder = 0.08; // of the image's shorter side, over which a projector fades out
const float kHandRim = 0.015;   // metres beside a hand over which a projector fades out: it is not known better
const float kShadowed = 1e-3;   // so that a place in the shadow of all is left as it is
const float kLeast = 0.01;  // so that a point which only one projector reaches still gets its light

layout(location = 0) out vec2 weight;
#ifdef BLACK
layout(location = 1) out vec4 black;
#endif

void main() {
    vec3 normal = faceTowards(worldPosition, viewerPosition);
    Sight sight = sightOf(worldPosition, normal);
    vec3 light = fullLight(worldPosition, normal);
    float strength = max(light.r, max(light.g, light.b));
    vec2 border = min(sight.uv, 1.0 - sight.uv) * sightSize / (kBorder * min(sightSize.x, sightSize.y));
    float fade = smoothstep(0.0, 1.0, border.x) * smoothstep(0.0, 1.0, border.y) *
                 smoothstep(0.25, 1.0, textureLod(openness, sight.uv, 0.0).r);
    float reached = max(sight.reached, own);
    reached *= mix(kShadowed, 1.0, smoothstep(0.0, kHandRim, clearOfHands(projectorPosition, worldPosition)));
    float value = strength * strength * (kLeast + fade) * reached;
    weight = vec2(own * value, value);
#ifdef BLACK
    // Unlike what it sends, its black does not fade towards the borders of its picture.
    black = vec4(weighedBlack * mix(projectorPeak, light, compensation) * reached, 1.0);
#endif
}
