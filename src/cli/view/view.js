// The motion of spheres, drawn by WebGL 2: each sphere is a square that a ray is followed
// through, pixel by pixel.
"use strict";

const header = JSON.parse(document.getElementById("header").textContent);
const element = (id) => document.getElementById(id);

// ---- The data: columns of little-endian numbers, as base64. ----

function column(id, Type) {
  const text = atob(element(id).textContent);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  element(id).remove();
  return new Type(bytes.buffer);
}

// Where the bodies of each frame begin.
const starts = [0];
for (const count of header.counts) starts.push(starts[starts.length - 1] + count);
const frames = header.counts.length;

// ---- Vectors and the camera. ----

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const l = Math.hypot(...a); return a.map((c) => c / l); };

const [lower, upper] = header.bounds;
const size = Math.hypot(...add(upper, lower, -1)) || 1;
const up = header.up;
const front = unit(cross(Math.abs(up[1]) < 0.7 ? cross([0, 1, 0], up) : cross([0, 0, -1], up), up));
const side = cross(front, up);
const ANGLE = 0.6; // of view, rad

let camera;
function reset() {
  const middle = add(lower, upper).map((c) => c / 2);
  camera = { target: middle, turn: 0.46, rise: 0.36, away: (0.56 * size) / Math.sin(ANGLE / 2) };
}

// Unit vectors to the right, up and to the viewer.
function axes() {
  const { turn, rise } = camera;
  const flat = add(front.map((c) => c * Math.cos(turn)), side, Math.sin(turn));
  const back = add(flat.map((c) => c * Math.cos(rise)), up, Math.sin(rise));
  const right = unit(cross(up, flat));
  return [right, cross(back, right), back];
}

// ---- The programs of the graphics processor. ----

const SPHERE_VERTEX = `#version 300 es
precision highp float;
uniform mat4 view, projection;
uniform vec3 sides;       // of a periodic box, or zeros
uniform float part;       // of the way from a frame to the next
uniform int coloring;
uniform vec3 kinds[7];
uniform vec3 palette[5];
in vec2 corner;
in vec3 here, next;
in vec4 turnedHere, turnedNext;
in float radius, kind, speedHere, speedNext;
out vec3 place;
flat out vec3 center;
flat out float size;
flat out vec4 turned;
flat out vec3 color;
void main() {
  vec3 way = next - here;
  if (sides.x > 0.0) way -= sides * round(way / sides);
  center = (view * vec4(here + part * way, 1.0)).xyz;
  size = radius;
  float around = dot(turnedHere, turnedNext) < 0.0 ? -1.0 : 1.0;
  turned = normalize(mix(turnedHere, around * turnedNext, part));
  if (coloring == 0) {
    color = kinds[int(kind + 0.5) % 7];
  } else {
    float at = 4.0 * mix(speedHere, speedNext, part);
    int below = min(int(at), 3);
    color = mix(palette[below], palette[below + 1], at - float(below));
  }
  float away = length(center);
  vec3 sight = center / away;
  vec3 across = normalize(cross(sight, abs(sight.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  vec3 upward = cross(across, sight);
  // A little more than the outline, for its smooth edge.
  float reach = 1.04 * radius / sqrt(max(1.0 - radius * radius / (away * away), 0.01));
  place = center + reach * (corner.x * across + corner.y * upward);
  gl_Position = projection * vec4(place, 1.0);
}`;

const SPHERE_FRAGMENT = `#version 300 es
precision highp float;
uniform mat4 projection;
uniform bool marked;
in vec3 place;
flat in vec3 center;
flat in float size;
flat in vec4 turned;
flat in vec3 color;
uniform mat3 toWorld;
out vec4 pixel;
void main() {
  vec3 sight = normalize(place);
  float along = dot(sight, center);
  // How far the ray passes by the center.
  float aside = length(center - along * sight);
  float smoothly = fwidth(aside);
  float cover = clamp((size - aside) / max(smoothly, 1e-20) + 0.5, 0.0, 1.0);
  float half_ = sqrt(max(size * size - aside * aside, 0.0));
  vec3 point = (along - half_) * sight;
  vec3 normal = normalize(point - center);
  vec3 own = color;
  if (marked) {
    // Eight parts in two shades, turned with the body.
    vec3 n = toWorld * normal;
    vec3 t = 2.0 * cross(-turned.xyz, n);
    vec3 body = n + turned.w * t + cross(-turned.xyz, t);
    vec3 edge = clamp(body / max(fwidth(body), vec3(1e-4)), -1.0, 1.0);
    own *= 0.82 + 0.18 * edge.x * edge.y * edge.z;
  }
  if (cover <= 0.0) discard;
  vec3 light = normalize(vec3(-0.42, 0.62, 0.66));
  float lit = max(dot(normal, light), 0.0);
  float shine = pow(max(dot(reflect(sight, normal), light), 0.0), 40.0);
  pixel = vec4(own * (0.48 + 0.62 * lit) + 0.22 * shine, cover);
  vec4 seen = projection * vec4(point, 1.0);
  gl_FragDepth = clamp(0.5 * seen.z / seen.w + 0.5, 0.0, 1.0);
}`;

const PART_VERTEX = `#version 300 es
precision highp float;
uniform mat4 view, projection;
in vec3 here;
out vec3 place;
void main() {
  vec4 seen = view * vec4(here, 1.0);
  place = seen.xyz;
  gl_Position = projection * seen;
}`;

const PART_FRAGMENT = `#version 300 es
precision highp float;
uniform vec4 color;
uniform bool shaded;
in vec3 place;
out vec4 pixel;
void main() {
  float lit = 1.0;
  if (shaded) {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    lit = 0.78 + 0.22 * max(dot(normal, normalize(vec3(-0.42, 0.62, 0.66))), 0.0);
  }
  pixel = vec4(color.rgb * lit * color.a, color.a);
}`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(made));
  const places = {};
  return {
    use: () => gl.useProgram(made),
    attribute: (name) => gl.getAttribLocation(made, name),
    uniform: (name) => (places[name] ??= gl.getUniformLocation(made, name)),
  };
}

// ---- The scene in the memory of the graphics processor. ----

function buffer(gl, data) {
  const made = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, made);
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  return made;
}

function load(gl, data) {
  return {
    spheres: program(gl, SPHERE_VERTEX, SPHERE_FRAGMENT),
    parts: program(gl, PART_VERTEX, PART_FRAGMENT),
    corners: buffer(gl, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])),
    positions: buffer(gl, data.positions),
    turns: header.turns ? buffer(gl, data.turns) : null,
    speeds: buffer(gl, data.speeds),
    radii: buffer(gl, data.radii),
    kinds: buffer(gl, data.kinds),
    faces: buffer(gl, data.faces),
    edges: buffer(gl, data.edges),
  };
}

const hex = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16) / 255);
const dark = matchMedia("(prefers-color-scheme: dark)");
const KINDS = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#777777"].flatMap(hex),
  dark: ["#5aaaeb", "#f0823c", "#32be91", "#de96be", "#f0b93c", "#96d7fa", "#9a9a9a"].flatMap(hex),
};
const PALETTE = {
  light: ["#440154", "#3b528b", "#21918c", "#5ec962", "#f0dc28"].flatMap(hex),
  dark: ["#3a4aa0", "#8046aa", "#da4c78", "#fa924a", "#ffe282"].flatMap(hex),
};

let at = 0; // frames
let isPlaying = false;
let showsParts = true;
let isStale = true;

function draw(gl, scene) {
  const canvas = gl.canvas;
  const fine = Math.min(devicePixelRatio || 1, 2);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((c) => Math.max(1, Math.round(c * fine)));
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  gl.viewport(0, 0, width, height);
  const theme = dark.matches ? "dark" : "light";
  const ground = hex(dark.matches ? "#121418" : "#ffffff");
  gl.clearColor(...ground, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);

  const [right, above, back] = axes();
  const eye = add(camera.target, back, camera.away);
  const view = new Float32Array([
    right[0], above[0], back[0], 0, right[1], above[1], back[1], 0, right[2], above[2], back[2], 0,
    -dot(right, eye), -dot(above, eye), -dot(back, eye), 1,
  ]);
  const far = camera.away + 1.5 * size;
  const near = Math.max(camera.away - 1.5 * size, far / 2000);
  // The lesser of the two sides has the angle of view.
  const zoom = 1 / Math.tan(ANGLE / 2);
  const [across, upward] = width < height ? [zoom, (zoom * width) / height] : [(zoom * height) / width, zoom];
  const projection = new Float32Array([
    across, 0, 0, 0, 0, upward, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0,
  ]);

  if (showsParts) drawWalls(gl, scene, view, projection, theme);
  drawSpheres(gl, scene, view, projection, theme, new Float32Array([...right, ...above, ...back]));
  if (showsParts) drawLines(gl, scene, view, projection, theme);
}

function usePart(gl, scene, view, projection, points) {
  const { parts } = scene;
  parts.use();
  gl.uniformMatrix4fv(parts.uniform("view"), false, view);
  gl.uniformMatrix4fv(parts.uniform("projection"), false, projection);
  const here = parts.attribute("here");
  gl.bindBuffer(gl.ARRAY_BUFFER, points);
  gl.enableVertexAttribArray(here);
  gl.vertexAttribPointer(here, 3, gl.FLOAT, false, 0, 0);
  gl.vertexAttribDivisor(here, 0);
  return (color, isShaded) => {
    gl.uniform4fv(parts.uniform("color"), color);
    gl.uniform1i(parts.uniform("shaded"), isShaded ? 1 : 0);
  };
}

// What has one side, seen from that: a wall between the viewer and the spheres is not drawn.
function drawWalls(gl, scene, view, projection, theme) {
  const [walls, solids] = header.faces;
  const paint = usePart(gl, scene, view, projection, scene.faces);
  gl.enable(gl.CULL_FACE);
  // Behind the lines that are its edges.
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1, 1);
  paint(theme === "dark" ? [0.19, 0.2, 0.23, 1] : [0.93, 0.94, 0.95, 1], true);
  gl.drawArrays(gl.TRIANGLES, 0, 3 * walls);
  paint(theme === "dark" ? [0.42, 0.43, 0.47, 1] : [0.68, 0.7, 0.73, 1], true);
  gl.drawArrays(gl.TRIANGLES, 3 * walls, 3 * solids);
  gl.disable(gl.POLYGON_OFFSET_FILL);
  gl.disable(gl.CULL_FACE);
}

// Edges, and what is seen through: thin parts and sensors.
function drawLines(gl, scene, view, projection, theme) {
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(false);
  let paint = usePart(gl, scene, view, projection, scene.edges);
  paint(theme === "dark" ? [0.85, 0.87, 0.9, 0.5] : [0.1, 0.12, 0.15, 0.5], false);
  gl.drawArrays(gl.LINES, 0, 2 * header.edges);
  const [walls, solids, thin, sensors] = header.faces;
  paint = usePart(gl, scene, view, projection, scene.faces);
  paint(theme === "dark" ? [0.8, 0.82, 0.86, 0.2] : [0.35, 0.38, 0.42, 0.22], true);
  gl.drawArrays(gl.TRIANGLES, 3 * (walls + solids), 3 * thin);
  paint(theme === "dark" ? [0.35, 0.67, 0.92, 0.2] : [0.0, 0.45, 0.7, 0.2], true);
  gl.drawArrays(gl.TRIANGLES, 3 * (walls + solids + thin), 3 * sensors);
  gl.depthMask(true);
  gl.disable(gl.BLEND);
}

function drawSpheres(gl, scene, view, projection, theme, toWorld) {
  const { spheres } = scene;
  const frame = Math.min(Math.floor(at), frames - 1);
  const next = header.varies ? frame : Math.min(frame + 1, frames - 1);
  const count = header.counts[frame];
  spheres.use();
  gl.uniformMatrix4fv(spheres.uniform("view"), false, view);
  gl.uniformMatrix4fv(spheres.uniform("projection"), false, projection);
  gl.uniformMatrix3fv(spheres.uniform("toWorld"), false, toWorld);
  gl.uniform3fv(spheres.uniform("sides"), header.box ? add(header.box[1], header.box[0], -1) : [0, 0, 0]);
  gl.uniform1f(spheres.uniform("part"), at - frame);
  gl.uniform1i(spheres.uniform("coloring"), Number(element("colors").value));
  gl.uniform1i(spheres.uniform("marked"), header.turns ? 1 : 0);
  gl.uniform3fv(spheres.uniform("kinds"), KINDS[theme]);
  gl.uniform3fv(spheres.uniform("palette"), PALETTE[theme]);
  const used = [];
  const attribute = (name, data, numbers, kind, isPart, bytes, each) => {
    const place = spheres.attribute(name);
    if (place < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, data);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, numbers, kind, isPart, 0, bytes);
    gl.vertexAttribDivisor(place, each);
    used.push(place);
  };
  // Of what stays the same there is one frame.
  const own = header.varies ? starts[frame] : 0;
  attribute("corner", scene.corners, 2, gl.FLOAT, false, 0, 0);
  attribute("here", scene.positions, 3, gl.FLOAT, false, 12 * starts[frame], 1);
  attribute("next", scene.positions, 3, gl.FLOAT, false, 12 * starts[next], 1);
  attribute("speedHere", scene.speeds, 1, gl.UNSIGNED_BYTE, true, starts[frame], 1);
  attribute("speedNext", scene.speeds, 1, gl.UNSIGNED_BYTE, true, starts[next], 1);
  attribute("radius", scene.radii, 1, gl.FLOAT, false, 4 * own, 1);
  attribute("kind", scene.kinds, 1, gl.UNSIGNED_BYTE, false, own, 1);
  if (scene.turns) {
    attribute("turnedHere", scene.turns, 4, gl.SHORT, true, 8 * starts[frame], 1);
    attribute("turnedNext", scene.turns, 4, gl.SHORT, true, 8 * starts[next], 1);
  } else {
    for (const name of ["turnedHere", "turnedNext"]) {
      if (spheres.attribute(name) >= 0) gl.vertexAttrib4f(spheres.attribute(name), 0, 0, 0, 1);
    }
  }
  gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  if (count > 0) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  for (const place of used) {
    gl.vertexAttribDivisor(place, 0);
    gl.disableVertexAttribArray(place);
  }
}

// ---- What is said, and what is asked. ----

const short = (value) => Number(value.toPrecision(5)).toString();

function say() {
  const frame = Math.min(Math.floor(at), frames - 1);
  const part = at - frame;
  const times = header.times;
  const time = times
    ? `time ${short(times[frame] + part * ((times[frame + 1] ?? times[frame]) - times[frame]))} of ${short(times[frames - 1])}`
    : `frame ${Math.round(at) + 1} of ${frames}`;
  const lines = [document.createElement("b"), `${header.counts[frame].toLocaleString("en")} ${header.counts[frame] === 1 ? "sphere" : "spheres"}`, time];
  lines[0].textContent = header.name;
  element("words").replaceChildren(...lines.flatMap((line) => [line, document.createElement("br")]));
  element("place").value = at;
  element("place").setAttribute("aria-valuetext", time);
  element("play").textContent = isPlaying ? "❚❚" : "▶";
  element("play").setAttribute("aria-label", isPlaying ? "Pause" : "Play");
}

function seek(frame) {
  at = Math.max(0, Math.min(frames - 1, frame));
  isStale = true;
}

function play(plays) {
  isPlaying = plays && frames > 1;
  if (isPlaying && at >= frames - 1) seek(0);
  isStale = true;
}

function choose(select, step) {
  const list = element(select);
  const count = list.options.length;
  list.selectedIndex = step === 0 ? (list.selectedIndex + 1) % count : Math.max(0, Math.min(count - 1, list.selectedIndex + step));
  isStale = true;
}

const zoom = (factor) => {
  camera.away = Math.max(0.02 * size, Math.min(20 * size, camera.away * factor));
  isStale = true;
};

function turn(x, y) {
  camera.turn += -0.008 * x;
  camera.rise = Math.max(-1.55, Math.min(1.55, camera.rise + 0.008 * y));
  isStale = true;
}

function move(x, y) {
  const [right, above] = axes();
  const length = (2 * camera.away * Math.tan(ANGLE / 2)) / Math.min(innerWidth, innerHeight);
  camera.target = add(add(camera.target, right, -x * length), above, y * length);
  isStale = true;
}

const KEYS = {
  " ": () => play(!isPlaying),
  ArrowLeft: () => { play(false); seek(Math.ceil(at) - 1); },
  ArrowRight: () => { play(false); seek(Math.floor(at) + 1); },
  Home: () => seek(0),
  End: () => seek(frames - 1),
  "[": () => choose("speed", -1),
  "]": () => choose("speed", 1),
  "+": () => zoom(0.9),
  "=": () => zoom(0.9),
  "-": () => zoom(1.1),
  c: () => choose("colors", 0),
  p: () => { showsParts = !showsParts; isStale = true; },
  r: () => { reset(); isStale = true; },
};

function listen(canvas) {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
    const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act();
  });
  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [x, y] = [event.clientX - before[0], event.clientY - before[1]];
    if (fingers.size === 2) {
      const old = spread();
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      const now = spread();
      zoom(old.apart / now.apart);
      move(now.x - old.x, now.y - old.y);
      return;
    }
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (event.shiftKey || event.buttons & 6) move(x, y);
    else turn(x, y);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(0.0012 * event.deltaY)); }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  element("play").addEventListener("click", () => play(!isPlaying));
  element("place").addEventListener("input", (event) => { play(false); seek(Number(event.target.value)); });
  element("colors").addEventListener("change", () => { isStale = true; });
  addEventListener("resize", () => { isStale = true; });
  dark.addEventListener("change", () => { isStale = true; });
}

// ---- The whole. ----

function main() {
  const canvas = element("picture");
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
  if (!gl) throw new Error("this browser has no WebGL 2, by which the spheres are drawn");
  const data = {
    positions: column("positions", Float32Array),
    turns: header.turns ? column("turns", Int16Array) : null,
    speeds: column("speeds", Uint8Array),
    radii: column("radii", Float32Array),
    kinds: column("kinds", Uint8Array),
    faces: column("faces", Float32Array),
    edges: column("edges", Float32Array),
  };
  gl.enable(gl.DEPTH_TEST);
  let scene = load(gl, data);
  // A computer that has slept may have forgotten all of it.
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { gl.enable(gl.DEPTH_TEST); scene = load(gl, data); isStale = true; });
  reset();
  listen(canvas);
  element("place").max = frames - 1;
  element("controls").hidden = frames < 2;
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  const RATE = Math.max(10, Math.min(30, frames / 8)); // frames a second
  let before = 0;
  const tick = (now) => {
    const seconds = Math.min((now - before) / 1000, 0.1);
    before = now;
    if (isPlaying) {
      seek(at + seconds * RATE * Number(element("speed").value));
      if (at >= frames - 1) isPlaying = false;
    }
    if (isStale) {
      isStale = false;
      draw(gl, scene);
      say();
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

try {
  main();
} catch (error) {
  element("failure").hidden = false;
  element("failure").textContent = `The motion cannot be shown: ${error.message}`;
}
