// The road in 3D, behind the car: WebGL 2, without a library. It draws in five steps: sky, ground and road in one pass,
// for each pixel where its line of sight ends; shadows, trails and arrows flat on the road; trees and posts; the cars;
// and the ghost, through which one sees. Cars, camera and colours are those of bootcourse/replay3d, by build.py.
// The world is right-handed, in metres: x along the road from the ego on, y to the left, z up.

const GHOST = 0.5; // opacity
const TREES_EVERY = 9, POSTS_EVERY = 25; // m

class Scene {
  // The picture is drawn on `canvas`, the words on the canvas of the view from above, which lies over it.
  // Throws an Error if the browser has no WebGL 2. lost(): called if the graphics card gives up.
  constructor(canvas, view, data, lost) {
    Object.assign(this, { canvas, view, data, scenario: view.scenario });
    const gl = this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("no WebGL 2");
    canvas.addEventListener("webglcontextlost", lost);
    [this.ground, this.flat, this.solid] = [GROUND, FLAT, SOLID].map(shaders => program(gl, shaders));
    this.car = mesh(gl, this.solid, data.car.corners, data.car.faces);
    this.tree = mesh(gl, this.solid, ...cone());
    this.post = mesh(gl, this.solid, ...block());
    this.empty = gl.createVertexArray();
    this.layer = layer(gl, this.flat);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  // Fit the picture to its place on the page, and read the theme's colours.
  fit() {
    const { canvas, view } = this, ratio = Math.min(view.ratio, 2);
    [canvas.width, canvas.height] = [view.width * ratio, view.height * ratio];
    this.gl.viewport(0, 0, canvas.width, canvas.height);
    const dark = canvas.getRootNode().host.dataset.theme === "dark";
    this.theme = Object.fromEntries(Object.entries(this.data[dark ? "dark" : "light"]).map(([k, v]) => [k, rgb(v)]));
    this.night = dark ? 1 : 0;
  }

  draw({ cars, ghosts, coming, colour, futures }) {
    const { gl, view } = this;
    this.x = cars[X];
    this.aim(cars);
    this.start(this.ground);
    const { lanes, laneWidth } = this.scenario, { dash, period, line, shoulder } = this.data.road;
    this.set({ ...this.theme, road: [laneWidth / 2, (0.5 - lanes) * laneWidth, laneWidth, shoulder],
      paint: [dash, period, line, 0], ego: this.pose(cars) });
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.BLEND);
    this.marks({ cars, ghosts, coming, colour, futures });
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.start(this.solid);
    this.scenery();
    for (let car = 1; car < this.scenario.vehicles; car++) {
      this.drive(row(cars, car), view.colour(car < TRAFFIC ? "trap" : "traffic"));
    }
    this.drive(cars, colour);
    for (const ghost of ghosts) this.through(ghost, cars);
    this.words(cars, ghosts);
  }

  // The camera: behind the ego; it goes along with some of the way to the side, and turns a little with the car.
  aim(cars) {
    const { from, to, angle } = this.data.camera, middle = (-(this.scenario.lanes - 1) / 2) * this.scenario.laneWidth;
    const y = middle + 0.7 * (-cars[Y] - middle), yaw = calm.matches ? 0 : -0.3 * cars[HEADING];
    const turned = ([px, py, pz]) => [px * Math.cos(yaw), y + py + px * Math.sin(yaw), pz];
    this.eye = turned(from);
    this.ahead = unit(minus(turned(to), this.eye));
    this.right = unit([this.ahead[1], -this.ahead[0], 0]);
    this.up = cross(this.right, this.ahead);
    const high = Math.tan(angle / 2);
    this.lens = [(high * this.view.width) / this.view.height, high];
  }

  start(program) {
    this.program = program;
    this.gl.useProgram(program.code);
    const { eye, right, up, ahead, lens, night, theme: { sky, horizon } } = this;
    this.set({ eye, right, up, ahead, lens, sky, horizon, night, along: this.x });
  }

  // Give the program in use its numbers; a name that it does not have is passed over.
  set(values) {
    for (const [name, value] of Object.entries(values)) {
      const at = this.program.places[name], list = [value].flat(2);
      if (at) this.gl[name === "tint" ? "uniform3fv" : `uniform${list.length}fv`](at, list);
    }
  }

  // Where a car is in the world, and how it is turned: [x, y, yaw].
  pose(state) { return [state[X] - this.x, -state[Y], -state[HEADING]]; }

  drive(state, colour, opacity = 1) {
    const place = this.pose(state), { length, width } = this.scenario;
    if (place[0] < -40 || place[0] > SIGHT) return;
    const [dark, light, lamps] = this.data.car.colours.map(rgb);
    this.set({ place, size: [length / 5, width / 2, width / 2], tint: [rgb(colour), dark, light, lamps], opacity,
      turn: Math.sign(state[LANE] - state[TARGET_LANE]), brake: state[ACCELERATION] < -0.3 ? 1 : 0 });
    this.car();
  }

  // A car through which one sees: first its depth alone, so that its own far side does not shine through. Where it
  // covers the ego it fades, so that the ego has its own colour.
  through({ state, colour, gone }, ego) {
    const { gl } = this, apart = Math.hypot(state[X] - ego[X], state[Y] - ego[Y]);
    const opacity = GHOST * (gone ? 0.5 : 1) * Math.min(Math.max((apart - 0.3) / 2, 0), 1);
    if (opacity === 0) return;
    gl.colorMask(false, false, false, false);
    this.drive(state, colour);
    gl.colorMask(true, true, true, true);
    gl.enable(gl.BLEND);
    gl.depthFunc(gl.EQUAL);
    this.drive(state, colour, opacity);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
  }

  // Trees by chance and posts at equal distances: they show how fast the car is.
  scenery() {
    const { ground, post } = this.theme, { lanes, laneWidth } = this.scenario, { shoulder } = this.data.road;
    const green = this.night ? [0.1, 0.17, 0.15] : [0.3, 0.44, 0.28], trunk = green.map(part => part * 0.7);
    const edges = [laneWidth / 2 + shoulder, (0.5 - lanes) * laneWidth - shoulder];
    this.set({ opacity: 2, turn: 0, brake: 0, tint: [green, trunk, ground, post] });
    const each = (every, act) => {
      for (let x = Math.ceil((this.x - 30) / every) * every; x < this.x + SIGHT; x += every) [0, 1].forEach(s => act(x, s));
    };
    each(TREES_EVERY, (x, side) => {
      const [one, two, three] = [1, 2, 3].map(k => Math.abs(Math.sin(x * 12.9898 * k + side * 78.233) * 43758.5453) % 1);
      if (three < 0.35) return;
      const y = edges[side] + (side ? -1 : 1) * (7 + 55 * one * one), tall = 0.7 + 0.9 * two;
      this.set({ place: [x - this.x + 6 * two, y, 6 * one], size: [tall, tall, tall * (0.9 + 0.5 * three)] });
      this.tree();
    });
    this.set({ tint: [post, post, post, post] });
    each(POSTS_EVERY, (x, side) => {
      this.set({ place: [x - this.x, edges[side] + (side ? -0.6 : 0.6), 0], size: [0.13, 0.16, 0.9] });
      this.post();
    });
  }

  // All that lies flat on the road: shadows, imagined drives, and the action of the next decision.
  marks({ cars, ghosts, coming, colour, futures }) {
    const { gl, layer, scenario } = this, corners = [];
    const triangle = (points, tint, rims) => points.forEach((p, i) => corners.push(...p, ...(rims?.[i] ?? [0, 0]), ...tint));
    const quad = (p, tint, rims) => [[0, 1, 2], [0, 2, 3]].forEach(
      part => triangle(part.map(i => p[i]), tint, rims && part.map(i => rims[i])));
    const shadow = (state, strength) => {
      const [x, y, yaw] = this.pose(state), c = Math.cos(yaw), s = Math.sin(yaw);
      const rims = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
      const long = scenario.length * 0.62, wide = scenario.width * 0.78;
      quad(rims.map(([u, v]) => [x + c * u * long - s * v * wide, y + s * u * long + c * v * wide - 0.15]),
        [0, 0, 0, strength], rims);
    };
    const ribbon = (path, wide, tint) => path.slice(1).forEach((to, i) => {
      const from = path[i], [dx, dy] = [to[0] - from[0], to[1] - from[1]], long = Math.hypot(dx, dy);
      if (long < 1e-6) return;
      const [nx, ny] = [(-dy / long) * wide / 2, (dx / long) * wide / 2];
      quad([[from[0] - nx, from[1] - ny], [to[0] - nx, to[1] - ny], [to[0] + nx, to[1] + ny], [from[0] + nx, from[1] + ny]],
        tint);
    });
    for (const { path, share, best, wreck } of futures ? ranked(futures) : []) {
      const way = path.map(([x, y]) => [x - this.x, -y]).filter(([x]) => x > -15);
      const shade = wreck ? rgb(this.view.colour("alarm")) : mixed(rgb(TRAIL), this.theme.line, share);
      ribbon(way, best ? 0.75 : 0.16, [...shade, best ? 0.95 : 0.8]);
      if (best) ribbon(way, 0.3, [...this.theme.asphalt, 1]);
      const [x, y] = way.at(-1) ?? [0, 0], r = wreck || best ? 0.6 : 0.3;
      quad([[x - r, y], [x, y - r], [x + r, y], [x, y + r]], [...shade, 1]);
    }
    for (let car = 1; car < scenario.vehicles; car++) shadow(row(cars, car), 0.42);
    for (const ghost of ghosts) shadow(ghost.state, 0.16);
    shadow(cars, 0.5);
    if (coming !== null) {
      const side = 1 - (coming % 3), push = Math.floor(coming / 3) - 1, [x, y, yaw] = this.pose(cars);
      const turned = ([u, v]) => [x + u * Math.cos(yaw) - v * Math.sin(yaw), y + u * Math.sin(yaw) + v * Math.cos(yaw)];
      const reach = [2, 4, 7][push + 1], bend = side * reach * 0.36, slant = Math.atan2(2 * bend, reach);
      const way = Array.from({ length: 9 }, (_, k) => [3.2 + (reach * k) / 8, bend * (k / 8) ** 2]);
      const tint = [...(push < 0 ? rgb(this.view.colour("alarm")) : rgb(colour)), 0.95], [u, v] = way.at(-1);
      const at = (far, wide) => turned([u + far * Math.cos(slant) - wide * Math.sin(slant),
        v + far * Math.sin(slant) + wide * Math.cos(slant)]);
      ribbon(way.map(turned), 0.45, tint);
      if (push < 0) quad([at(0, -1), at(0.6, -1), at(0.6, 1), at(0, 1)], tint);
      else triangle([at(-0.2, -0.9), at(1.7, 0), at(-0.2, 0.9)], tint);
    }
    this.start(this.flat);
    layer(corners);
  }

  // Where a point of the world is on the page, and how far it is away (m); null behind the camera.
  spot(point) {
    const q = minus(point, this.eye), w = dot(q, this.ahead);
    if (w < 2) return null;
    const { width, height } = this.view;
    return [(width / 2) * (1 + dot(q, this.right) / this.lens[0] / w),
      (height / 2) * (1 - dot(q, this.up) / this.lens[1] / w), w];
  }

  // The traps' numbers, the ghost's name, and how far it is where it is not in the picture.
  words(cars, ghosts) {
    const { view } = this;
    view.pen.clearRect(0, 0, view.width, view.height);
    for (const car of [TRAP_2, TRAP_1]) {
      const [x, y] = this.pose(row(cars, car)), at = this.spot([x, y, 2.1]);
      if (at && at[2] < 160 && at[1] > 20) view.sign(`trap ${car}`, at[0], at[1] - 8, view.colour("trap"));
    }
    view.signs = { above: 0, below: 0 };
    for (const ghost of ghosts) {
      const [x, y] = this.pose(ghost.state), at = this.spot([x, y, 2.1]);
      const inside = at && at[2] < 160 && at[0] > 30 && at[0] < view.width - 30 && at[1] < view.height - 20;
      if (inside) view.sign(ghost.name, at[0], at[1] - 8 - (Math.abs(x) < 4 && Math.abs(y + cars[Y]) < 1.5 ? 26 : 0), ghost.colour);
      else view.signAway(ghost.name, x, ghost.colour);
    }
  }
}

const rgb = colour => [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16) / 255); // "#rrggbb"
const mixed = (one, other, share) => one.map((part, i) => part * share + other[i] * (1 - share));
const minus = (a, b) => a.map((value, i) => value - b[i]);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = a => a.map(value => value / Math.hypot(...a));
