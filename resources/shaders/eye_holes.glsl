// Shared piece: where a surface shows what is behind it. In: place (the surface's coordinates), of the device's skin
// restPlace (x and z at rest, device metres). Space: as they are.

in vec2 place;

#ifdef SKIN
in vec2 restPlace;
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

bool isHole() {
    bool hole = false;
#ifdef SKIN
    hole = any(lessThan(restPlace, shrunkOutline.xy)) || any(greaterThan(restPlace, shrunkOutline.zw));
#if HOLE_COUNT > 0
    for (int i = 0; i < HOLE_COUNT; ++i) {
        vec2 away = restPlace - holes[i].xy;
        hole = hole || dot(away, away) < holes[i].z;
    }
#endif
#endif
#ifdef HOLE_MASK
    vec2 at = mat2(holeTurn.xy, holeTurn.zw) * place + holeShift;
    hole = hole || dot(texture(holeMask, at), holeChannel) < holeThreshold;
#endif
    return hole;
}
