// Shared piece: the share of the first light that reaches a surface. In: shadowPlace and shadowSlope from the vertex
// stage. Blockers are looked for around the place; only where there are both some and none lies an edge, and the light's
// size over their distance gives its width. Loops that do not run cost nothing, which branches do not promise.

in vec4 shadowPlace;
in vec2 shadowSlope;
uniform sampler2DShadow shadowMap; // 1 is lit
uniform sampler2D shadowDepth;     // the same map as plain depth
uniform vec2 shadowReach;          // radius of the search, and least radius of an edge, map units
uniform float shadowSpread;        // radius of an edge, map units, for each unit of depth from blocker to surface

const int kSearchTaps = 8;
const int kEdgeTaps = 16;
const mat2 kGoldenTurn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

// How many of the taps around a place are blocked, and by how much depth on average.
vec2 shadowBlockers(vec3 at, int taps) {
    vec2 found = vec2(0.0);
    vec2 around = vec2(0.9, 0.43588989);
    for (int i = 0; i < taps; ++i) {
        vec2 away = shadowReach.x * sqrt((float(i) + 0.5) / float(kSearchTaps)) * around;
        float gap = at.z + dot(shadowSlope, away) - textureLod(shadowDepth, at.xy + away, 0.0).r;
        found += gap > 0.0 ? vec2(1.0, gap) : vec2(0.0);
        around = kGoldenTurn * around;
    }
    return vec2(found.x, found.y / max(found.x, 1.0));
}

float shadowLit(vec3 at, float radius, int taps) {
    float lit = 0.0;
    vec2 around = vec2(1.0, 0.0);
    for (int i = 0; i < taps; ++i) {
        vec2 away = radius * sqrt((float(i) + 0.5) / float(kEdgeTaps)) * around;
        lit += textureLod(shadowMap, vec3(at.xy + away, at.z + dot(shadowSlope, away)), 0.0);
        around = kGoldenTurn * around;
    }
    return lit / float(kEdgeTaps);
}

// `facing`: whether the surface looks at the light at all.
float shadowVisibility(bool facing) {
    vec3 at = shadowPlace.xyz / shadowPlace.w;
    at.z = min(at.z, 1.0);
    bool covered = facing && all(lessThan(abs(at.xy - 0.5), vec2(0.5 + shadowReach.x))) && shadowPlace.w > 0.0;
    vec2 blockers = shadowBlockers(at, covered ? kSearchTaps : 0);
    bool edge = blockers.x > 0.0 && blockers.x < float(kSearchTaps);
    float radius = clamp(shadowSpread * blockers.y, shadowReach.y, shadowReach.x);
    float lit = shadowLit(at, radius, edge ? kEdgeTaps : 0);
    return edge ? lit : (blockers.x > 0.0 ? 0.0 : 1.0);
}
