// What the graphics card computes for the picture in 3D (scene.js), in its language: for each corner, and for each pixel.

const SIGHT = 420, NEAREST = 0.5; // m: beyond the fog nothing is drawn, nor closer than this

const VIEW = `#version 300 es
precision highp float; precision highp int;
uniform vec3 eye, right, up, ahead; uniform vec2 lens; // the camera; tangents of half the picture's angles
uniform vec3 sky, horizon; uniform float night, along; // along: the ego's place on the road, m
vec4 project(vec3 p) {
  vec3 q = p - eye; float w = dot(q, ahead), near = ${NEAREST.toFixed(1)}, far = ${2 * SIGHT}.0;
  return vec4(dot(q, right) / lens.x, dot(q, up) / lens.y, (w * (far + near) - 2.0 * far * near) / (far - near), w);
}
vec3 skyAt(vec3 ray) { return mix(horizon, sky, smoothstep(0.0, 0.4, ray.z)); }
vec3 fog(vec3 colour, float away) { return mix(horizon, colour, exp(-away * away / 60000.0)); }
float chance(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }`;

const GROUND = [`${VIEW}
out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0;
  ray = ahead + right * corner.x * lens.x + up * corner.y * lens.y;
  gl_Position = vec4(corner, 0.0, 1.0);
}`, `${VIEW}
uniform vec3 ground, asphalt, line, ego; uniform vec4 road, paint; // road: left edge, right edge, lane, shoulder
in vec3 ray; out vec4 colour; // paint: length, period and width of a dash, m
float noise(vec2 p) {
  vec2 cell = floor(p), t = fract(p); t = t * t * (3.0 - 2.0 * t);
  return mix(mix(chance(cell), chance(cell + vec2(1, 0)), t.x),
    mix(chance(cell + vec2(0, 1)), chance(cell + vec2(1, 1)), t.x), t.y);
}
float band(float d, float half_, float pixel) { // how much of a pixel lies within half_ of a line's middle
  return clamp((d + half_) / pixel + 0.5, 0.0, 1.0) - clamp((d - half_) / pixel + 0.5, 0.0, 1.0);
}
void main() {
  vec3 to = normalize(ray);
  vec2 p = eye.xy + to.xy * eye.z / max(-to.z, 1e-4), pixel = max(fwidth(p), 1e-4), place = p + vec2(along, 0);
  float away = length(p - eye.xy), side = atan(to.y, to.x);
  vec3 over = skyAt(to);
  float hill = 0.022 + 0.013 * sin(side * 5.0 + 1.0) + 0.008 * sin(side * 13.0) + 0.004 * sin(side * 31.0);
  over = mix(mix(horizon, ground, 0.3 * smoothstep(-0.02, 0.03, to.z)), over,
    smoothstep(-0.001, 0.001, to.z - hill));
  vec2 star = floor(vec2(side, to.z) * 420.0);
  over += night * step(0.9975, chance(star)) * smoothstep(0.08, 0.3, to.z) * 0.5;
  vec3 grass = ground * (0.86 + 0.2 * noise(place * 0.07) + 0.1 * noise(place * 0.6) * exp(-away / 60.0));
  float outside = max(p.y - road.x, road.y - p.y), lane = road.z;
  vec3 tar = asphalt * (0.96 + 0.05 * noise(place * vec2(0.5, 3.0)) * exp(-away / 40.0)
    - 0.03 * cos(p.y / lane * 12.566)); // darker where the wheels run
  float divider = abs(mod(p.y, lane) - lane / 2.0), dash = mod(place.x - paint.x / 2.0 + paint.y / 2.0, paint.y);
  float dashes = mix(band(dash - paint.y / 2.0, paint.x / 2.0, pixel.x), paint.x / paint.y,
    smoothstep(0.3, 1.0, pixel.x / paint.y));
  float marks = max(band(outside, paint.z / 2.0, pixel.y),
    outside < -lane / 2.0 ? band(divider, paint.z / 2.0, pixel.y) * dashes : 0.0);
  vec3 surface = mix(grass, mix(tar, line, 0.9 * marks), clamp(0.5 - (outside - road.w) / pixel.y, 0.0, 1.0));
  vec2 q = mat2(cos(ego.z), -sin(ego.z), sin(ego.z), cos(ego.z)) * (p - ego.xy);
  float beam = smoothstep(1.5, 7.0, q.x) * exp(-q.x / 22.0) * smoothstep(1.0, 0.1, abs(q.y) / (1.6 + 0.32 * q.x));
  surface *= 1.0 + night * 1.9 * max(beam, 0.0);
  colour = vec4(to.z < 0.0 ? fog(surface, away) : over, 1);
}`];

const FLAT = [`${VIEW}
in vec2 place, edge; in vec4 tint; out vec2 rim; out vec4 shade;
void main() { rim = edge; shade = tint; gl_Position = project(vec3(place, 0.03)); }`, `${VIEW}
in vec2 rim; in vec4 shade; out vec4 colour;
void main() { colour = vec4(shade.rgb, shade.a * pow(max(1.0 - dot(rim * rim, rim * rim), 0.0), 1.5)); }`];

const SOLID = [`${VIEW}
uniform vec3 place, size; in vec4 corner; flat out int part; out vec3 spot, own; // place: x, y, yaw
void main() {
  part = int(corner.w); own = corner.xyz / 1000.0; vec3 p = own * size;
  float c = cos(place.z), s = sin(place.z);
  spot = vec3(c * p.x - s * p.y + place.x, s * p.x + c * p.y + place.y, p.z);
  gl_Position = project(spot);
}`, `${VIEW}
uniform vec3 tint[4]; uniform float opacity, turn, brake; // turn: 1 to the left, -1 to the right
flat in int part; in vec3 spot, own; out vec4 colour;
void main() {
  vec3 normal = normalize(cross(dFdx(spot), dFdy(spot))), to = normalize(spot - eye);
  vec3 base = tint[part], sun = normalize(vec3(-0.5, 0.55, 0.8)), back = reflect(to, normal);
  float day = 1.0 - night, lit = max(dot(normal, sun), 0.0), facing = 1.0 + dot(to, normal);
  vec3 light = mix(vec3(0.6), vec3(0.95), normal.z * 0.5 + 0.5) * mix(0.62, 0.72, day) + lit * 0.4 * mix(0.3, 1.0, day);
  vec3 shown = base * light;
  bool glass = part == 1 && own.z > 0.9, coat = part == 0 && opacity < 2.0;
  if (glass || coat) shown = mix(shown, skyAt(normalize(back + vec3(0, 0, 0.2))), (glass ? 0.18 : 0.05) + 0.4 * pow(facing, 4.0));
  if (coat) shown += mix(0.12, 0.4, day) * pow(max(dot(back, sun), 0.0), 24.0);
  if (part == 3) shown = mix(base * 0.4, base, max(brake, 0.4 * night)) + vec3(0.2, 0.05, 0.05) * brake;
  if (part == 2 && own.x > 2.2) shown = mix(shown, vec3(1, 0.98, 0.9), night);
  if (part >= 2 && abs(own.x) > 2.2 && own.y * turn > 0.46) shown = vec3(1.0, 0.66, 0.05);
  colour = vec4(fog(shown, length(spot - eye)), min(opacity, 1.0));
}`];
