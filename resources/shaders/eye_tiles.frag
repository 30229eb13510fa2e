// Least and greatest depth of a shadow map. First over the pixels of each tile, then over the tiles within reach along
// one axis and the other. In: the map, or the tiles so far. Out: least and greatest depth.

#ifdef GATHER
uniform sampler2D depth;
const int kTile = 8; // pixels a side
#else
uniform sampler2D tiles;
uniform vec2 axis;
uniform int reach; // tiles
#endif
out vec2 range;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 found = vec2(1e9, -1e9);
#ifdef GATHER
    vec2 pixel = 1.0 / vec2(textureSize(depth, 0));
    for (int y = 1; y < kTile; y += 2)
        for (int x = 1; x < kTile; x += 2) {
            vec4 d = textureGather(depth, vec2(at * kTile + ivec2(x, y)) * pixel);
            found.x = min(found.x, min(min(d.x, d.y), min(d.z, d.w)));
            found.y = max(found.y, max(max(d.x, d.y), max(d.z, d.w)));
        }
#else
    ivec2 last = textureSize(tiles, 0) - 1;
    for (int i = -reach; i <= reach; ++i) {
        ivec2 place = at + i * ivec2(axis);
        // Beyond the map's border there is nothing.
        vec2 there = place == clamp(place, ivec2(0), last) ? texelFetch(tiles, place, 0).rg : vec2(1.0);
        found = vec2(min(found.x, there.x), max(found.y, there.y));
    }
#endif
    range = found;
}
