// The ground of a viewport: the backdrop, a pool of light, shadows and a grid; follows version.glsl,
// backdrop.glsl and a light. In: worldPosition (world), groundCentre (x, z) and gridReach around
// it (where the grid has faded), gridStep (metres), gridStrength, lineColor (sRGB-encoded), shade (how
// dark full shadow is), pool (strength of the pool of light) with poolCentre (x, z) and poolRadius, below
// (1: seen from underneath, only the grid is drawn). Out: color, sRGB-encoded.

in vec3 worldPosition;

uniform vec2 groundCentre;
uniform vec2 poolCentre;
uniform float poolRadius;
uniform float gridReach;
uniform float gridStep;
uniform float gridStrength;
uniform vec3 lineColor;
uniform float shade;
uniform vec3 pool;
uniform float below;

out vec4 color;

// Coverage of lines of `width` pixels around the whole numbers of `coordinate`, per axis; `pixel` is
// what a pixel spans. Lines closer than a few pixels fade out before they turn into a pattern.
vec2 lines(vec2 coordinate, vec2 pixel, float width) {
    vec2 distance = abs(fract(coordinate - 0.5) - 0.5) / pixel;
    vec2 fade = clamp((0.28 - pixel) * 5.0, 0.0, 1.0);
    return fade * clamp(0.5 * width + 0.5 - distance, 0.0, 1.0);
}

void main() {
    const vec3 up = vec3(0.0, 1.0, 0.0);
    vec2 place = worldPosition.xz;
    vec2 fromScene = (place - poolCentre) / poolRadius;
    float key = keyVisibility(worldPosition, up);
    float sky = skyLight(worldPosition, up);
    float lit = 0.6 * key + 0.4 * sky * sky;
    float glow = 1.0 / (1.0 + 0.3 * dot(fromScene, fromScene));
    vec3 ground = (backdropColor() + pool * glow * glow) * mix(1.0 - shade, 1.0, lit);

    vec2 cell = place / gridStep;
    vec2 pixel = max(fwidth(cell), vec2(1e-6));
    vec2 fine = lines(cell, pixel, 1.0);
    vec2 strong = lines(0.1 * cell, 0.1 * pixel, 1.3);
    // The lines through the origin: along x reddish, along z bluish.
    vec2 axis = clamp(1.25 - abs(cell) / pixel, 0.0, 1.0);
    vec3 ink = mix(lineColor, vec3(0.86, 0.30, 0.30), 0.75 * axis.y);
    ink = mix(ink, vec3(0.30, 0.48, 0.92), 0.75 * axis.x);
    float grid = max(max(0.42 * max(fine.x, fine.y), max(strong.x, strong.y)), 1.5 * max(axis.x, axis.y));
    vec2 away = (place - groundCentre) / gridReach;
    float fade = clamp(1.0 - dot(away, away), 0.0, 1.0);
    float strength = gridStrength * grid * fade * fade * (0.5 + 0.5 * lit);
    color = below > 0.5 ? vec4(ink, strength) : vec4(dithered(mix(ground, ink, strength)), 1.0);
}
