// Fragment stage of the eye pass: light from a surface to the eye, linear, tone mapped to [0, 1]; where PROJECTED is
// defined, what a projector sends for it. In: the world's place and normal, the surface's coordinates; material and
// lights. Space: world, metres.

in vec3 worldPosition;
in vec3 worldNormal;
out vec4 color;

uniform vec3 eyePosition;
uniform vec4 baseColor; // linear, opacity
uniform vec3 emitted;
uniform vec3 skyLight;    // on a surface that looks up
uniform vec3 bounceLight; // on one that looks down
#ifdef COLOR_TEXTURE
uniform sampler2D colorPicture;
uniform vec4 colorTurn; // texture coordinates are mat2(colorTurn) * place + colorShift
uniform vec2 colorShift;
#endif
#ifdef NORMAL_A
uniform sampler2D normalPictureA;
uniform vec4 normalTurnA;
uniform vec2 normalShiftA;
uniform vec4 normalBendA; // from the picture's axes to the coordinates', times the strength
#endif
#ifdef NORMAL_B
uniform sampler2D normalPictureB;
uniform vec4 normalTurnB;
uniform vec2 normalShiftB;
uniform vec4 normalBendB;
#endif
#if LIGHTS > 0
uniform vec4 lightPlaces[LIGHTS]; // towards it and 0, or where it stands and 1
uniform vec3 lightRadiances[LIGHTS];
#endif
#ifdef SPECULAR
uniform vec2 gloss; // roughness to the 4th power, roughness + 0.5
uniform float metal;
#endif
#if defined(REFLECTION) && !defined(SPECULAR)
const float metal = 0.0;
#endif
#if defined(REFLECTION) || defined(REFRACTION)
uniform vec4 optics; // reflection, refraction, 1 / refractive index, blur of pictures seen through it
#endif
#if defined(COLOR_TEXTURE) && defined(REFRACTION)
uniform float onFloor; // 1: the picture lies on the ground that is seen through the surface; 0: on the surface itself
uniform mat4 worldFromSurface;

const float kLoss = 8.0; // 1 / m: after an eighth of a metre the ground is seen in the surface's colour

// What lies where the refracted ray ends, `way` metres on.
vec3 floorAt(vec3 inward, float way) {
    vec2 there = place + way * (transpose(mat3(worldFromSurface)) * inward).xz;
    return texture(colorPicture, mat2(colorTurn.xy, colorTurn.zw) * there + colorShift).rgb;
}
#endif

#if defined(NORMAL_A) || defined(NORMAL_B)
// The slopes of a normal map along the surface's coordinates (right, and up on the page).
vec2 slopesOf(sampler2D picture, vec2 at, vec4 bend) {
    vec3 n = texture(picture, at).rgb * 2.0 - 1.0;
    return mat2(bend.xy, bend.zw) * (n.xy / max(n.z, 0.1));
}

vec3 bentNormal(vec3 n) {
    vec2 slopes = vec2(0.0);
#ifdef NORMAL_A
    slopes += slopesOf(normalPictureA, mat2(normalTurnA.xy, normalTurnA.zw) * place + normalShiftA, normalBendA);
#endif
#ifdef NORMAL_B
    slopes += slopesOf(normalPictureB, mat2(normalTurnB.xy, normalTurnB.zw) * place + normalShiftB, normalBendB);
#endif
#ifdef TABLE
    return normalize(n + vec3(slopes.x, 0.0, -slopes.y));
#else
    // The directions in which the coordinates grow, within the plane of the surface.
    vec3 px = dFdx(worldPosition), py = dFdy(worldPosition);
    vec2 cx = dFdx(place), cy = dFdy(place);
    float turn = cx.x * cy.y - cx.y * cy.x;
    vec3 right = px * cy.y - py * cx.y;
    vec3 down = py * cx.x - px * cy.x;
    right = (right - n * dot(n, right)) * sign(turn);
    down = (down - n * dot(n, down)) * sign(turn);
    right *= inversesqrt(max(dot(right, right), 1e-24));
    down *= inversesqrt(max(dot(down, down), 1e-24));
    return normalize(n + slopes.x * right - slopes.y * down);
#endif
}
#endif

void main() {
#ifdef HOLES
    if (isHole()) discard;
#ifdef SKIN
    if (isInside(worldPosition, eyePosition)) discard;
#endif
#endif
    vec4 base = baseColor;
#ifdef COLOR_TEXTURE
    vec4 picture = texture(colorPicture, mat2(colorTurn.xy, colorTurn.zw) * place + colorShift);
#ifdef REFRACTION
    picture = mix(picture, vec4(1.0), onFloor);
#endif
    base *= picture;
#endif
#ifdef CUTOUT
    if (base.a < 0.5) discard;
    base.a = baseColor.a;
#endif
#ifndef BLEND
    base.a = 1.0;
#endif
#ifdef UNLIT
    vec3 light = base.rgb + emitted;
#else
    vec3 smoothNormal = worldNormal * inversesqrt(max(dot(worldNormal, worldNormal), 1e-24));
#ifdef TWO_SIDED
    smoothNormal = gl_FrontFacing ? smoothNormal : -smoothNormal;
#endif
    vec3 n = smoothNormal;
#if defined(NORMAL_A) || defined(NORMAL_B)
    n = bentNormal(n);
#endif
    vec3 view = normalize(eyePosition - worldPosition);
    vec3 diffuse = mix(bounceLight, skyLight, 0.5 + 0.5 * n.y);
    vec3 shine = vec3(0.0);
#if LIGHTS > 0
    for (int i = 0; i < LIGHTS; ++i) {
        vec3 towards = lightPlaces[i].xyz - lightPlaces[i].w * worldPosition;
        float square = dot(towards, towards);
        float fall = lightPlaces[i].w > 0.5 ? 0.25 / max(square, 1e-4) : 1.0;
        towards *= inversesqrt(max(square, 1e-12));
        float facing = max(dot(n, towards), 0.0);
#ifdef SHADOW
#ifdef HOLES_BELOW
        vec4 at = placeThroughHoles(worldPosition, eyePosition);
#else
        vec4 at = shadowPlace;
#endif
        if (i == 0) facing *= shadowVisibility(dot(smoothNormal, towards) > 0.0 && facing > 0.0, at);
#endif
        vec3 arriving = lightRadiances[i] * (fall * facing);
        diffuse += arriving;
#ifdef SPECULAR
        vec3 halfway = normalize(towards + view);
        float nh = max(dot(n, halfway), 0.0);
        float lh = max(dot(towards, halfway), 0.0);
        float d = nh * nh * (gloss.x - 1.0) + 1.00001;
        shine += arriving * (gloss.x / (d * d * max(0.1, lh * lh) * gloss.y * 4.0));
#endif
    }
#endif
    vec3 light = base.rgb * diffuse;
#ifdef SPECULAR
    light *= 1.0 - 0.6 * metal;
#endif
#ifdef REFRACTION
    vec3 inward = refract(-view, n, optics.z);
    float way = max(worldPosition.y, 0.0) / max(-inward.y, 0.2);
    vec3 bed = tableAt(worldPosition.xz + way * inward.xz, optics.w);
    vec3 through = bed * mix(vec3(1.0), base.rgb, clamp(30.0 * way, 0.0, 1.0));
#ifdef COLOR_TEXTURE
    // Of each colour a share is lost with every metre: turquoise where it is shallow, dark where it is deep.
    vec3 kept = pow(max(base.rgb, 1e-4), vec3(kLoss * way));
    vec3 deep = mix(base.rgb * diffuse, floorAt(inward, way) * diffuse, kept);
    light = mix(mix(light, through, optics.y), mix(light, deep, optics.y), onFloor);
#else
    light = mix(light, through, optics.y);
#endif
#endif
#ifdef REFLECTION
    float grazing = 1.0 - clamp(dot(n, view), 0.0, 1.0);
    float square = grazing * grazing;
    // More than clear water mirrors from above, because a viewer takes it for water by its mirror.
    float share = optics.x * mix(0.15 + 0.85 * square * square * grazing, 1.0, metal);
    vec3 mirrored = environmentAt(worldPosition, reflect(-view, n), optics.w);
    light = mix(light, mirrored * mix(vec3(1.0), base.rgb, metal), share);
#endif
#ifdef SPECULAR
    light += shine * mix(vec3(0.04), base.rgb, metal);
#endif
    light += emitted;
#endif
#ifdef FOG
    light = fogged(light, worldPosition, eyePosition);
#endif
    color = shown(light, base.a);
#ifdef PROJECTED
    color = sentFor(color.rgb, worldPosition, faceTowards(worldPosition, projectorPosition));
#endif
}
