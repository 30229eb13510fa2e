// Shared piece: the room's own light, half of it from everywhere and half from a low lamp on the left, so low that
// slopes of a few degrees differ.

float fromAround(vec3 normal) { return 0.36 + 0.16 * normal.y; }

float fromLamp(vec3 normal) { return 0.96 * max(dot(normal, vec3(-0.79, 0.5, 0.35)), 0.0); }
