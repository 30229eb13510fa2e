// Shared piece: where a surface shows what is behind it. In: place (the surface's coordinates), of the device's skin
// restPlace (x, z and y at rest, device metres). Space: as they are.

in vec2 place;

#ifdef SKIN
in vec3 restPlace;
uniform vec4 shrunkOutline; // x, z from and to, outside which the skin is cut off
#if HOLE_COUNT > 0
uniform vec3 holes[HOLE_COUNT]; // x, z, square of the radius
#endif
#endif

#ifdef HOLE_MASK
uniform sampler2D holeMask;
uniform vec4 holeTurn; // texture coordinates are mat2(holeTurn) * place + holeShift
uniform vec2 holeShift;
uniform vec4 holeChannel; // which of the picture's channels it is
uniform float holeThreshold;
#endif

// `onTop`: x and z at rest; `at`: coordinates.
bool isHoleAt(vec2 onTop, vec2 at) {
    bool hole = false;
#ifdef SKIN
    hole = any(lessThan(onTop, shrunkOutline.xy)) || any(greaterThan(onTop, shrunkOutline.zw));
#if HOLE_COUNT > 0
    for (int i = 0; i < HOLE_COUNT; ++i) {
        vec2 away = onTop - holes[i].xy;
        hole = hole || dot(away, away) < holes[i].z;
    }
#endif
#endif
#ifdef HOLE_MASK
    vec4 mask = texture(holeMask, mat2(holeTurn.xy, holeTurn.zw) * at + holeShift);
    hole = hole || dot(mask, holeChannel) < holeThreshold;
#endif
    return hole;
}

bool isHole() {
#ifdef SKIN
    return isHoleAt(restPlace.xy, place);
#else
    return isHoleAt(vec2(0.0), place);
#endif
}

#if defined(SKIN) && defined(HOLES)
uniform mat4 deviceFromWorld;
uniform vec4 insideOutline; // x, z from and to, within which only the top is seen from outside
uniform vec2 insideTop;     // height of the top, and that beneath which it is not the top any more

// What lies beneath the top is not seen where the way to it leads through a hole: nobody looks into the device.
bool isInside(vec3 world, vec3 eye) {
    vec3 from = (deviceFromWorld * vec4(world, 1.0)).xyz;
    vec3 to = (deviceFromWorld * vec4(eye, 1.0)).xyz;
    vec2 crossing = mix(from, to, clamp((insideTop.x - from.y) / max(to.y - from.y, 1e-4), 0.0, 1.0)).xz;
    bool beneath = restPlace.z < insideTop.y && all(greaterThan(crossing, insideOutline.xy)) &&
                   all(lessThan(crossing, insideOutline.zw));
    return beneath && isHoleAt(crossing, crossing);
}
#endif
