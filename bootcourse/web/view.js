// The road from above, up the page: x grows upwards, the left lane is on the left. Draws one frame on a canvas.

const AHEAD = 0.66; // where the ego is, from the top
const UNDER = 100; // pixels at the bottom, beside the road, that belong to speed and return
const LINE = 15; // pixels from one line of a sign to the next
const TRAIL = "#44aa99"; // of the imagined drive that is worth most
const SIGNS = ["↙", "↓", "↘", "←", "•", "→", "↖", "↑", "↗"];

class View {
  constructor(canvas, scenario) {
    Object.assign(this, { canvas, scenario, pen: canvas.getContext("2d") });
  }

  // Fit the canvas to its place on the page, and read the theme's colours.
  fit() {
    const { clientWidth, clientHeight } = this.canvas, zoom = this.canvas.getBoundingClientRect().width / clientWidth || 1;
    const ratio = this.ratio = Math.min(devicePixelRatio * zoom, 2.5);
    [this.width, this.height] = [clientWidth, clientHeight];
    [this.canvas.width, this.canvas.height] = [clientWidth * ratio, clientHeight * ratio];
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.scale = Math.max(Math.min(clientWidth / 24, clientHeight / 54), 6); // px for a metre
    const style = getComputedStyle(this.canvas);
    this.colour = name => style.getPropertyValue(`--${name}`).trim();
  }

  // Where a point of the road is on the canvas.
  spot(x, y) {
    const middle = ((this.scenario.lanes - 1) / 2) * this.scenario.laneWidth;
    return [this.width / 2 + (y - middle) * this.scale, this.height * AHEAD - (x - this.x) * this.scale];
  }

  // The road's right edge on the canvas.
  get right() { return this.spot(0, (this.scenario.lanes - 0.5) * this.scenario.laneWidth)[0]; }

  // name: of the car at the wheel, to be written beside it. wreck: whether its drive ended here, in an accident.
  draw({ cars, ghosts, coming, colour, futures, wreck, name }) {
    this.x = cars[X];
    this.ground();
    if (futures) this.trails(futures);
    for (let car = this.scenario.vehicles - 1; car > EGO; car--) {
      const trap = car < TRAFFIC;
      this.car(row(cars, car), this.colour(trap ? "trap" : "traffic"), { label: trap ? `${car}` : "" });
    }
    this.signs = { above: 0, below: 0, beside: [] }; // of the ghosts: how many beyond the picture, and at which heights
    for (const ghost of ghosts) this.ghost(ghost);
    const before = row(cars, TRAP_1)[X] - cars[X]; // who falls back still sees where the car is that is to be overtaken
    if (before * this.scale > this.height * AHEAD) { // beside the road, where it covers no car
      this.sign(`▲ trap 1, ${before.toFixed(0)} m`, this.right + 8, 76, this.colour("trap"), "left");
    }
    this.car(cars, colour, { label: "" });
    const [px, py] = this.spot(cars[X], cars[Y]);
    if (wreck) this.ring(px, py);
    if (name) this.sign(name, this.right + 8, py + 4, colour, "left");
    if (coming !== null) this.coming(cars, coming, colour);
  }

  ground() {
    const { pen, scenario, width, height, scale } = this;
    const [left] = this.spot(0, -scenario.laneWidth / 2);
    const { right } = this;
    const first = this.x - (height * (1 - AHEAD)) / scale, last = this.x + (height * AHEAD) / scale;
    pen.fillStyle = this.colour("ground");
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = this.colour("tuft");
    for (let x = Math.floor(first / 4) * 4; x < last + 4; x += 4) { // tufts, scattered by their place
      for (const side of [-1, 1]) {
        const chance = Math.abs(Math.sin(x * 12.9898 + side * 78.233) * 43758.5453) % 1;
        const [px, py] = this.spot(x + 3 * chance, 4 + side * (10 + 14 * chance));
        pen.beginPath();
        pen.ellipse(px, py, scale * (0.5 + chance), scale * (0.35 + 0.7 * chance), 0, 0, 7);
        pen.fill();
      }
    }
    pen.fillStyle = this.colour("asphalt");
    pen.fillRect(left, 0, right - left, height);
    pen.strokeStyle = this.colour("edge");
    pen.lineWidth = Math.max(1.5, scale * 0.15);
    pen.beginPath();
    for (const edge of [left, right]) { pen.moveTo(edge, 0); pen.lineTo(edge, height); }
    pen.stroke();
    pen.fillStyle = this.colour("paint");
    for (let lane = 1; lane < scenario.lanes; lane++) {
      for (let x = Math.floor(first / 9) * 9; x < last; x += 9) {
        const [px, py] = this.spot(x + 3, (lane - 0.5) * scenario.laneWidth);
        pen.fillRect(px - 0.08 * scale, py, 0.16 * scale, 3 * scale);
      }
    }
    pen.fillStyle = this.colour("quiet");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "left";
    for (let x = Math.ceil(first / 10) * 10; x < last; x += 10) {
      const [, py] = this.spot(x, 0);
      pen.fillRect(right + 4, py, x % 50 ? 4 : 9, 1);
      if (x % 50 === 0) pen.fillText(`${x} m`, right + 17, py + 4);
    }
  }

  // One car: a body with two windows, brake lights, and indicators while it changes lane.
  car(state, colour, { label, alpha = 1, hollow = false }) {
    const { pen, scale, scenario } = this, [px, py] = this.spot(state[X], state[Y]);
    if (py < -80 || py > this.height + 80) return;
    const long = scenario.length * scale, wide = scenario.width * scale;
    const box = (x, y, w, h, r) => { pen.beginPath(); pen.roundRect(x, y, w, h, r); };
    pen.save();
    pen.translate(px, py);
    pen.rotate(state[HEADING]);
    pen.globalAlpha = alpha;
    if (!hollow) {
      pen.fillStyle = "#0002";
      box(-wide / 2 + 1, -long / 2 + 3, wide + 1, long, wide * 0.3);
      pen.fill();
    }
    box(-wide / 2, -long / 2, wide, long, wide * 0.32);
    pen.fillStyle = pen.strokeStyle = colour;
    pen.lineWidth = 2;
    if (hollow) {
      pen.globalAlpha = alpha * 0.28;
      pen.fill();
      pen.globalAlpha = alpha;
      pen.stroke();
    } else {
      pen.fill();
      pen.fillStyle = this.colour("glass");
      box(-wide * 0.38, -long * 0.24, wide * 0.76, long * 0.15, wide * 0.1);
      pen.fill();
      box(-wide * 0.36, long * 0.24, wide * 0.72, long * 0.1, wide * 0.08);
      pen.fill();
    }
    if (state[ACCELERATION] < -0.3) {
      pen.fillStyle = this.colour("alarm");
      for (const side of [-0.46, 0.18]) pen.fillRect(wide * side, long * 0.46, wide * 0.28, Math.max(2, long * 0.05));
    }
    const turn = state[TARGET_LANE] - state[LANE];
    if (turn && !hollow) {
      pen.fillStyle = "#e69f00";
      const side = turn < 0 ? -wide / 2 : wide * 0.34;
      for (const end of [-0.47, 0.4]) pen.fillRect(side, long * end, wide * 0.16, long * 0.07);
    }
    if (label) {
      pen.fillStyle = "#fff";
      pen.font = `600 ${Math.round(wide * 0.55)}px system-ui, sans-serif`;
      pen.textAlign = "center";
      pen.fillText(label, 0, wide * 0.28);
    }
    pen.restore();
  }

  // The other driver's car, which is on a road of its own; beyond the picture, a sign with its distance.
  ghost({ state, colour, name, gone }) {
    const [, py] = this.spot(state[X], state[Y]);
    this.car(state, colour, { label: "", hollow: true, alpha: gone ? 0.4 : 1 });
    const beyond = py < 10 || py > this.height - 10, [edge] = this.spot(0, -this.scenario.laneWidth / 2);
    const away = state[X] - this.x, words = beyond ? this.away(name, away) : name;
    const lines = this.lines(words, edge - 8, "right").length; // beside the road, where it covers no car
    this.sign(words, edge - 8, this.free(beyond ? (away > 0 ? 76 : this.height) : py + 4, lines), colour, "right");
  }

  // The height of a sign of so many lines beside the road: clear of those that are there already, and of the dials.
  free(y, lines) {
    const lowest = this.height - UNDER - (LINE / 2) * (lines - 1), up = y > lowest;
    y = Math.min(y, lowest);
    for (const other of this.signs.beside) {
      const apart = 24 + (LINE / 2) * (lines + other.lines - 2);
      if (Math.abs(other.y - y) < apart) y = other.y + (up ? -apart : apart);
    }
    this.signs.beside.push({ y, lines });
    return y;
  }

  // Where a car is that is not in the picture.
  away(name, metres) {
    return `${metres > 0 ? "▲" : "▼"} ${name}, ${Math.abs(metres).toFixed(0)} m`;
  }

  // The sign, in 3D, of a car that is not in the picture.
  signAway(name, away, colour) {
    const below = this.width < 480 ? 100 : 18; // on a phone above the dials, which leave no room between them
    const row = 26 * this.signs[away > 0 ? "above" : "below"]++;
    this.sign(this.away(name, away), this.width / 2, away > 0 ? 62 + row : this.height - below - row, colour);
  }

  // Where an accident was.
  ring(x, y) {
    const { pen } = this;
    pen.strokeStyle = this.colour("alarm");
    pen.lineWidth = 4;
    pen.beginPath();
    pen.arc(x, y, 4 * this.scale, 0, 7);
    pen.stroke();
  }

  // Words in a frame, in the middle above (x, y), to its left ("right": that is where they end) or to its right; in
  // several lines where one would not fit.
  sign(words, x, y, colour, align = "center") {
    const { pen } = this, lines = this.lines(words, x, align), first = y - (LINE / 2) * (lines.length - 1);
    const half = Math.max(...lines.map(line => pen.measureText(line).width)) / 2 + 9;
    const wanted = { center: x, right: x - half, left: x + half }[align];
    const middle = Math.min(Math.max(wanted, half + 4), this.width - half - 4);
    pen.fillStyle = this.colour("card");
    pen.globalAlpha = 0.92;
    pen.beginPath();
    pen.roundRect(middle - half, first - 15, 2 * half, 22 + LINE * (lines.length - 1), 11);
    pen.fill();
    pen.globalAlpha = 1;
    pen.strokeStyle = colour;
    pen.lineWidth = 1.5;
    pen.stroke();
    pen.fillStyle = this.colour("ink");
    pen.textAlign = "center";
    lines.forEach((line, i) => pen.fillText(line, middle, first + 0.5 + LINE * i));
  }

  // The lines of a sign at x: as few as fit beside x.
  lines(words, x, align) {
    this.pen.font = "12.5px system-ui, sans-serif";
    const room = { center: this.width, right: x, left: this.width - x }[align] - 22, lines = [];
    for (const word of words.split(" ")) {
      const longer = `${lines.at(-1)} ${word}`;
      if (lines.length && this.pen.measureText(longer).width <= room) lines[lines.length - 1] = longer;
      else lines.push(word);
    }
    return lines;
  }

  // The action of the next decision, as an arrow before the car.
  coming(cars, action, colour) {
    const { pen, scale } = this, side = (action % 3) - 1, push = Math.floor(action / 3) - 1;
    const [px, py] = this.spot(cars[X], cars[Y]);
    pen.save();
    pen.translate(px, py);
    pen.rotate(cars[HEADING]);
    pen.strokeStyle = colour;
    pen.lineWidth = Math.max(2.5, scale * 0.28);
    pen.lineCap = pen.lineJoin = "round";
    const from = -scale * 3.3, reach = scale * (push < 0 ? 1 : push > 0 ? 4 : 2.2), bend = side * scale * 1.5;
    pen.beginPath();
    pen.moveTo(0, from);
    pen.quadraticCurveTo(0, from - reach * 0.6, bend, from - reach);
    pen.stroke();
    if (push < 0) pen.strokeStyle = this.colour("alarm");
    pen.translate(bend, from - reach);
    pen.rotate(side * 0.6);
    pen.beginPath();
    if (push < 0) { pen.moveTo(-scale * 0.8, 0); pen.lineTo(scale * 0.8, 0); }
    else { pen.moveTo(-scale * 0.6, scale * 0.7); pen.lineTo(0, 0); pen.lineTo(scale * 0.6, scale * 0.7); }
    pen.stroke();
    pen.restore();
  }

  // Imagined drives: thin and by what they earn, those that crash in red, the best one bold.
  trails(futures) {
    const { pen } = this;
    for (const { path, share, best, wreck } of ranked(futures)) {
      const worth = `color-mix(in oklab, ${TRAIL} ${100 * share}%, ${this.colour("paint")})`;
      pen.strokeStyle = pen.fillStyle = wreck ? this.colour("alarm") : worth;
      pen.lineWidth = best ? 5 : 1.6;
      pen.globalAlpha = best ? 1 : 0.85;
      pen.lineJoin = "round";
      pen.beginPath();
      path.forEach(([x, y]) => pen.lineTo(...this.spot(x, y)));
      pen.stroke();
      if (best) Object.assign(pen, { lineWidth: 1.5, strokeStyle: this.colour("asphalt") }).stroke(); // double
      const [px, py] = this.spot(...path.at(-1));
      pen.beginPath();
      pen.arc(px, py, wreck || best ? 4.5 : 2.5, 0, 7);
      pen.fill();
    }
    pen.globalAlpha = 1;
  }
}

// Imagined drives in the order in which they are drawn, the best last: each with its path, the share of its colour by
// what it earns (0.2 to 1), whether it is the best, and whether it ends in an accident.
function ranked(futures) {
  const worth = futures.filter(each => !each.accident).map(each => each.value);
  const low = Math.min(...worth), high = Math.max(...worth), best = largest(futures.map(each => each.value));
  return futures.map(({ path, accident, value }, i) => ({
    path, best: i === best, wreck: accident > 0, share: high > low ? 0.2 + (0.8 * (value - low)) / (high - low) : 1,
  })).sort((a, b) => a.best - b.best);
}
