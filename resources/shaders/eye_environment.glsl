// Shared piece: the world around a surface, for mirrors and clear things: the table and a soft sky. In: the table's
// picture, colour and light; sky (linear). Space: world, metres.

uniform sampler2D tablePicture;
uniform vec4 tableTurn; // texture coordinates are mat2(tableTurn) * (x, z) + tableShift
uniform vec2 tableShift;
uniform vec3 tableColor;
uniform vec3 tableLight; // that falls on it
uniform vec2 tableHalf;  // half its size, metres
uniform vec3 sky;

vec3 tableAt(vec2 at, float blur) {
    vec3 picture = texture(tablePicture, mat2(tableTurn.xy, tableTurn.zw) * at + tableShift, blur).rgb;
    vec2 beyond = max(abs(at) - tableHalf, 0.0);
    return tableColor * picture * tableLight / (1.0 + 40.0 * dot(beyond, beyond));
}

const vec3 kSkyTint = vec3(0.86, 0.98, 1.16);

// A room at daylight: bright above the horizon, with a soft window overhead to one side.
vec3 skyAt(vec3 direction) {
    float rise = clamp(direction.y, 0.0, 1.0);
    float window = clamp(dot(direction, vec3(-0.41, 0.78, -0.47)), 0.0, 1.0);
    window *= window;
    window *= window;
    return sky * kSkyTint * (0.6 + 1.3 * (1.0 - rise) * (1.0 - rise) + 2.6 * window * window);
}

// What ripples mirror of the table near the horizon fades into the sky: hard edges would look like stains.
vec3 environmentAt(vec3 from, vec3 direction, float blur) {
    float down = max(-direction.y, 1e-3);
    float way = max(from.y, 0.0) / down;
    vec3 table = tableAt(from.xz + min(way, 4.0) * direction.xz, blur);
    return mix(skyAt(direction), table, 0.7 * smoothstep(0.05, 0.8, -direction.y));
}
