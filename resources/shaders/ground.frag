// The ground: the backdrop, a pool of light, the shadows, a grid with its scale bar; follows
// version.glsl, backdrop.glsl and studio_light.glsl. In: worldPosition (world), groundCentre (x, z),
// sceneRadius, gridStep, bar (x, z, length, 1 to show it; metres), lineColor (sRGB-encoded), shade
// (how dark full shadow is), pool (strength of the pool of light), regionSpan (left
// and right edge of this view in frame pixels). Out: color, sRGB-encoded.

in vec3 worldPosition;

uniform vec2 groundCentre;
uniform float sceneRadius;
uniform float gridStep;
uniform vec4 bar;
uniform vec3 lineColor;
uniform float lineStrength;
uniform float shade;
uniform vec3 pool;
uniform vec2 regionSpan;

out vec4 color;

// Coverage of lines of `width` pixels around the whole numbers of `coordinate`.
float lines(vec2 coordinate, float width) {
    vec2 pixel = max(fwidth(coordinate), vec2(1e-6));
    vec2 distance = abs(fract(coordinate - 0.5) - 0.5) / pixel;
    // Lines closer than a few pixels fade out before they turn into a pattern.
    vec2 fade = 1.0 - smoothstep(vec2(0.12), vec2(0.4), pixel);
    vec2 line = fade * (1.0 - smoothstep(vec2(0.5 * width - 0.5), vec2(0.5 * width + 0.5), distance));
    return max(line.x, line.y);
}

float scaleBar(vec2 place) {
    vec2 pixel = max(fwidth(place), vec2(1e-9));
    vec2 p = place - bar.xy;
    float alongEdge = max(max(-p.x, p.x - bar.z), 0.0);
    float body = step(alongEdge, 0.0) * (1.0 - smoothstep(0.9, 1.9, abs(p.y) / pixel.y));
    float end = min(abs(p.x), abs(p.x - bar.z));
    float tick = (1.0 - smoothstep(0.9, 1.9, end / pixel.x)) * step(abs(p.y), 0.3 * gridStep);
    return bar.w * max(body, tick);
}

void main() {
    const vec3 up = vec3(0.0, 1.0, 0.0);
    vec2 place = worldPosition.xz;
    float away = length(place - groundCentre) / sceneRadius;

    float key = keyVisibility(worldPosition, up);
    float sky = skyLight(worldPosition, up);
    float lit = 0.6 * key + 0.4 * sky * sky;
    // Neighbouring views meet in the plain backdrop.
    float edge = min(gl_FragCoord.x - regionSpan.x, regionSpan.y - gl_FragCoord.x) / (regionSpan.y - regionSpan.x);
    float inner = smoothstep(0.0, 0.16, edge);
    vec3 ground = backdropColor() + inner * pool * exp(-0.55 * away * away);
    ground *= mix(1.0 - shade, 1.0, lit);

    float visible = inner - inner * smoothstep(1.1, 2.3, away);
    float grid = max(0.45 * lines(place / gridStep, 1.0), lines(place / (5.0 * gridStep), 1.2));
    ground = mix(ground, lineColor, lineStrength * visible * grid * mix(0.5, 1.0, lit));
    ground = mix(ground, lineColor, 0.85 * scaleBar(place));
    color = vec4(dithered(ground), 1.0);
}
