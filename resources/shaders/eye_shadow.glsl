// Shared piece: the share of the first light that reaches a surface. In: shadowPlace and shadowSlope from the vertex
// stage. Most places are told lit or dark by the tile of the map they fall into. Elsewhere blockers are looked for; only
// where there are both some and none lies an edge, and the light's size over their distance gives its width. Software GL
// walks through both sides of a branch, and once through a loop that does not run: so the loops have one tap a turn, and
// a tap is one texel; many of them make an edge as smooth as a few that are filtered.

in vec4 shadowPlace;
in vec2 shadowSlope;
uniform sampler2D shadowDepth;     // the map
uniform sampler2D shadowTiles;     // least and greatest depth within reach of a place
uniform vec2 shadowReach;          // radius of the search, and least radius of an edge, map units
uniform float shadowSpread;        // radius of an edge, map units, for each unit of depth from blocker to surface

const int kSearchTaps = 8;
const int kEdgeTaps = 32;
#ifdef HOLES_BELOW
uniform mat4 shadowFromWorld;
uniform mat4 worldFromDevice;
uniform mat4 deviceFromWorld;
uniform vec4 deviceOutline; // x, z from and to, of the device's top as it appears
uniform float deviceTop;
const float kClearance = 0.002; // metres above the top, so that it casts no shadow on its own holes
const float kRim = 0.008; // metres over which the light of a hole becomes that beside the device

// Through holes a viewer shall see the table, not the dark inside of a box: there it has the light of the place on the
// device's top that the eye looks through, as if the device were thin.
vec4 placeThroughHoles(vec3 world, vec3 eye) {
    vec3 from = (deviceFromWorld * vec4(world, 1.0)).xyz;
    vec3 to = (deviceFromWorld * vec4(eye, 1.0)).xyz;
    vec3 crossing = mix(from, to, clamp((deviceTop - from.y) / max(to.y - from.y, 1e-4), 0.0, 1.0));
    vec2 inside = min(crossing.xz - deviceOutline.xy, deviceOutline.zw - crossing.xz);
    crossing.y += kClearance;
    float share = smoothstep(kClearance, kRim, min(inside.x, inside.y));
    return mix(shadowPlace, shadowFromWorld * (worldFromDevice * vec4(crossing, 1.0)), share);
}
#endif

// Taps in sunflower order: each is turned by the golden angle against the one before.
const mat2 kGoldenTurn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

// How many of the taps around a place are blocked, and by how much depth on average.
vec2 shadowBlockers(vec3 at, int taps) {
    vec2 found = vec2(0.0);
    vec2 around = vec2(shadowReach.x, 0.0);
    for (int i = 0; i < taps; ++i) {
        vec2 away = sqrt((float(i) + 0.5) / float(kSearchTaps)) * around;
        float gap = min(at.z + dot(shadowSlope, away), 1.0) - textureLod(shadowDepth, at.xy + away, 0.0).r;
        found += gap > 0.0 ? vec2(1.0, gap) : vec2(0.0);
        around = kGoldenTurn * around;
    }
    return vec2(found.x, found.y / max(found.x, 1.0));
}

float shadowLit(vec3 at, float radius, int taps) {
    float lit = 0.0;
    vec2 around = vec2(radius, 0.0);
    for (int i = 0; i < taps; ++i) {
        vec2 away = sqrt((float(i) + 0.5) / float(kEdgeTaps)) * around;
        float stored = textureLod(shadowDepth, at.xy + away, 0.0).r;
        lit += min(at.z + dot(shadowSlope, away), 1.0) <= stored ? 1.0 : 0.0;
        around = kGoldenTurn * around;
    }
    return lit / float(kEdgeTaps);
}

// `facing`: whether the surface looks at the light at all. `place`: its shadowPlace.
float shadowVisibility(bool facing, vec4 place) {
#ifdef LAMP
    vec3 at = place.xyz / place.w;
    facing = facing && place.w > 0.0;
#else
    vec3 at = place.xyz;
#endif
    at.z = min(at.z, 1.0); // what lies beyond the map's far plane counts as on it, and so do the taps around it
    vec2 tile = textureLod(shadowTiles, at.xy, 0.0).rg;
    float margin = shadowReach.x * length(shadowSlope);
    bool dark = at.z - margin > tile.y;
    bool open = min(at.z + margin, 1.0) <= tile.x || !facing;
    vec2 blockers = shadowBlockers(at, dark || open ? 0 : kSearchTaps);
    bool edge = blockers.x > 0.0 && blockers.x < float(kSearchTaps);
    float radius = clamp(shadowSpread * blockers.y, shadowReach.y, shadowReach.x);
    float lit = shadowLit(at, radius, edge ? kEdgeTaps : 0);
    return edge ? lit : (dark || blockers.x > 0.0 ? 0.0 : 1.0);
}
