// The game: a clock that asks for a decision a second, and all that is shown around it.

const find = id => document.getElementById(id);
const FIRST_ROAD = 10;
const PATIENCE = 5; // decisions between two sentences for readers who do not see the road
const STEP_PACE = 2.5; // how much faster than real time a single step is shown
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

class Game {
  constructor(data, compiled, networks) {
    this.data = data;
    this.settings = { p: data.p, xi: 0, c: 0 };
    this.failures = 0;
    this.pace = calm.matches ? 0 : 1;
    this.road = new Road(compiled, data.scenario);
    this.drivers = makeDrivers(data, networks, this.settings);
    this.view = new View(find("road"), this.road.scenario);
    this.thoughts = new Thoughts(data.actions);
    this.controls = new Controls(find("pad"), () => this.pressed(), {
      " ": () => this.go(), r: () => this.again(), n: () => this.another(), f: () => find("futures").click(),
      t: () => find("theme").click(), v: () => find("view").click(), 0: () => this.setPace(0), 1: () => this.setPace(1), 2: () => this.setPace(2),
      5: () => this.setPace(5),
    });
    this.controls.pad.forEach((button, action) => button.setAttribute("aria-label", data.actions[action]));
    makeSliders(this.settings, name => this.tuned(name));
    this.wire();
    this.readAddress();
  }

  get mine() { return this.drivers[this.driverName]; } // undefined if you drive
  get rival() { return this.drivers[this.ghostName]; } // undefined without a ghost

  wire() {
    const entries = Object.values(this.drivers).map(({ id, name }) => [id, name]);
    const fill = (select, list) => select.append(...list.map(([id, name]) => new Option(name, id)));
    fill(find("driver"), [["you", "you"], ...entries]);
    fill(find("ghost"), [["none", "nobody"], ...entries]);
    find("driver").addEventListener("change", event => this.begin({ driver: event.target.value }));
    find("ghost").addEventListener("change", event => this.begin({ ghost: event.target.value }));
    find("number").addEventListener("change", event => this.begin({ number: event.target.value }));
    find("futures").addEventListener("change", () => { this.think(); this.dirty = true; });
    document.addEventListener("change", ({ target }) => { // after a mouse or a finger, the arrow keys drive again
      if (!target.matches(":focus-visible") || target.type === "number") target.blur();
    });
    find("go").addEventListener("click", () => this.go());
    for (const id of ["again", "end-again"]) find(id).addEventListener("click", () => this.again());
    for (const id of ["next", "end-next"]) find(id).addEventListener("click", () => this.another());
    find("never").addEventListener("click", () => this.neverOut());
    for (const button of document.querySelectorAll("[data-pace]")) {
      button.addEventListener("click", () => this.setPace(Number(button.dataset.pace)));
    }
    const other = () => (document.documentElement.dataset.theme === "dark" ? "light" : "dark");
    find("theme").addEventListener("click", () => this.theme(other()));
    find("view").addEventListener("click", () => this.announce(this.look(!this.inDepth)));
    dark.addEventListener("change", () => this.theme(dark.matches ? "dark" : "light"));
    this.theme(dark.matches ? "dark" : "light");
    new ResizeObserver(() => this.fit()).observe(find("road"));
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.run(false); });
    window.addEventListener("hashchange", () => this.readAddress());
    this.setPace(this.pace);
  }

  theme(name) {
    document.documentElement.dataset.theme = name;
    this.fit();
  }

  // The address may choose road, ghost, driver, pace, futures and view; what it asks for in vain is answered.
  readAddress() {
    const now = { road: this.number ?? FIRST_ROAD, ghost: this.ghostName ?? "rule", driver: this.driverName ?? "you",
      pace: this.pace, futures: Number(find("futures").checked), view: this.inDepth ? "3d" : "above" };
    const { wanted, faults } = askedFor(location.hash.slice(1), Object.keys(this.drivers), now);
    const { road, ghost, driver, pace, futures, view } = { ...now, ...wanted };
    this.setPace(Number(pace));
    find("futures").checked = Number(futures) === 1;
    this.begin({ number: road, ghost, driver });
    const lost = this.look(view === "3d");
    if (faults.length || lost) this.announce([...faults, lost].join(" "));
  }

  // From above, or in 3D where the browser can.
  // What the browser cannot is returned as a sentence.
  look(inDepth) {
    let lost = "";
    this.inDepth = inDepth;
    try {
      if (inDepth) this.scene ??= new Scene(find("scene"), this.view, this.data.scene, () => this.announce(this.lose()));
    } catch (error) {
      this.inDepth = false;
      lost = `The road stays as seen from above: 3D needs WebGL 2, and this browser says “${error.message}”.`;
    }
    find("scene").hidden = !this.inDepth;
    find("view").setAttribute("aria-pressed", this.inDepth);
    find("road").setAttribute("aria-label", this.inDepth ? "The road in 3D, behind the car" : "The road from above");
    this.remember();
    this.fit();
    return lost;
  }

  // The graphics card has given up the picture: what was drawn there is gone, so a new scene begins on a new canvas.
  lose() {
    find("scene").replaceWith(find("scene").cloneNode());
    this.scene = null;
    this.look(false);
    return "The graphics card gave up the picture in 3D: the road is shown from above. V tries again.";
  }

  fit() {
    this.view.fit();
    if (this.inDepth) this.scene?.fit();
    this.dirty = true;
  }

  // The address says what is shown, so that it can be passed on.
  remember() {
    const driving = this.mine ? `&driver=${this.driverName}` : "", view = this.inDepth ? "&view=3d" : "";
    history.replaceState(null, "", `#road=${this.number}&ghost=${this.ghostName}${driving}${view}`);
  }

  // A new drive; whatever is not given stays as it is.
  begin({ number = this.number, ghost = this.ghostName, driver = this.driverName }) {
    const valid = isRoad(number);
    this.number = valid ? Number(number) : this.number ?? FIRST_ROAD;
    [this.ghostName, this.driverName] = [ghost, driver];
    [find("number").value, find("ghost").value, find("driver").value] = [this.number, this.ghostName, this.driverName];
    this.remember();
    this.drive = new Drive(this.road, this.number);
    this.ghost = this.ghostName === "none" ? null : new Drive(this.road, this.number);
    this.shown = 0;
    this.finished = false;
    this.controls.forget();
    find("end").hidden = true;
    find("about").textContent = this.rival?.words ?? "";
    this.run(false);
    this.think();
    const invitation = this.mine ? `Press Start and watch ${this.mine.label} drive.`
      : "Press ↑ ↓ ← → or the pad: your first decision starts the clock.";
    this.say(valid ? invitation : noRoad(number));
    this.tell(`Road ${this.number}. ${stateInWords(this.drive.cars)}`);
  }

  again() { this.begin({}); }
  another() { this.begin({ number: Math.floor(Math.random() * 10000) }); }

  // A road on which plain SAC is still behind trap 1 at the end, with SAC at the wheel.
  neverOut() {
    let number = Math.floor(Math.random() * 10000);
    while (new Drive(this.road, number).finish(this.drivers.sac).outAfter !== null) number++;
    this.setPace(5);
    this.begin({ number, driver: "sac", ghost: "rule" });
    this.run(true);
  }

  setPace(pace) {
    this.pace = [0, 1, 2, 5].includes(pace) ? pace : 1;
    document.documentElement.style.setProperty("--pace", Math.max(this.pace, 1));
    for (const button of document.querySelectorAll("[data-pace]")) {
      button.setAttribute("aria-pressed", Number(button.dataset.pace) === this.pace);
    }
    this.showClock();
  }

  run(running) {
    this.running = running && !this.finished;
    if (this.running) this.say("");
    this.showClock();
    this.dirty = true;
  }

  showClock() {
    find("go").textContent = this.pace === 0 ? "Next" : this.running ? "Pause" : "Start";
  }

  // The Start button and the space bar: start or stop the clock, or make one decision.
  go() {
    if (this.finished) this.again();
    if (this.pace === 0) this.step();
    else this.run(!this.running);
  }

  // The player has chosen an action: the clock starts, or takes the step that waited for it.
  pressed() {
    this.dirty = true;
    if (this.finished || this.mine) return;
    if (this.pace === 0) this.step();
    else if (!this.running) this.run(true);
  }

  step() {
    if (this.drive.over || this.shown < this.drive.time - 0.5) return;
    this.shown = this.drive.time;
    this.run(true);
    this.decide();
    if (calm.matches) this.shown = this.drive.end;
  }

  // One decision of both cars.
  decide() {
    const { drive, ghost } = this, ahead = () => drive.cars[X] > row(drive.cars, TRAP_1)[X], wasAhead = ahead();
    drive.decide(this.mine ? this.thought.action : this.controls.take());
    if (!this.mine) this.remark(remark(drive.cars, ahead() && !wasAhead));
    if (ghost && !ghost.over) ghost.decide(this.rival.decide(this.road, ghost.cars).action);
    this.before = this.futures;
    this.think();
    if (this.pace === 0 || drive.time % PATIENCE === 0) this.tell(`${drive.time} s. ${stateInWords(drive.cars)}`);
  }

  // What the driver, or the ghost in your place, thinks of the road as it is now.
  think() {
    const beside = this.drivers[this.ghostName === "rule" ? "escaping" : this.ghostName] ?? this.drivers.escaping;
    const mind = this.mine ?? beside; // the rule's own thoughts are in the column of π̃ already
    const { cars } = this.drive, taught = this.road.rule(cars);
    this.thought = mind.decide(this.road, cars);
    const wanted = find("futures").checked;
    const futures = wanted ? this.thought.futures ?? this.drivers.lookahead.decide(this.road, cars).futures : null;
    this.futures = this.drive.over ? null : futures;
    this.thoughts.show(this.thought, stochasticRule(taught.action, this.settings.p), mind);
    const base = mind.id === "lookahead" ? " π is PPO’s; the imagined drives choose the action in bold." : "";
    find("mind-title").textContent = `What ${mind.label} thinks`;
    const where = this.mine ? "" : "In your place. ";
    find("mind-words").textContent = `${where}The rule says: ${this.data.reasons[taught.reason]}.${base}`;
  }

  // A slider moved: the compromise drives on with the new numbers; if nobody drove by it, it becomes the ghost.
  tuned(name) {
    if (name !== "p" && this.driverName !== "soft" && this.ghostName !== "soft") this.begin({ ghost: "soft" });
    this.think();
  }

  // Once for each picture: let the clock run, and draw.
  frame(now) {
    const passed = Math.min((now - (this.last ?? now)) / 1000, 0.1);
    this.last = now;
    if (this.running) this.advance(passed * (this.pace || STEP_PACE));
    if (this.running || this.dirty) this.draw();
    requestAnimationFrame(next => this.frame(next));
  }

  advance(passed) {
    this.shown += passed;
    while (this.pace > 0 && this.shown >= this.drive.time && !this.drive.over) this.decide();
    const limit = this.drive.over ? this.drive.end : this.drive.time;
    if (this.shown < limit) return;
    this.shown = limit;
    if (this.drive.over) this.finish();
    else if (this.pace === 0) this.run(false);
  }

  draw() {
    this.dirty = false;
    const cars = this.drive.at(this.shown), coming = this.mine ? this.thought.action : this.controls.coming;
    const shown = this.drive.over || (!this.mine && this.controls.idle) ? null : coming;
    const ghost = this.ghost && {
      state: this.ghost.at(Math.min(this.shown, this.ghost.end)), gone: this.ghost.over && this.shown >= this.ghost.end,
      colour: this.rival.colour, name: this.rival.label,
    };
    const colour = this.mine?.colour ?? this.view.colour("you");
    const futures = this.shown < this.drive.time ? this.before : this.futures; // those of the decision that is shown
    (this.inDepth ? this.scene : this.view).draw({ cars, ghost, coming: shown, colour, futures });
    this.controls.mark(shown);
    const earned = this.drive.rewards.slice(0, Math.ceil(this.shown)), lastReward = earned.at(-1) ?? 0;
    find("speed").textContent = cars[SPEED].toFixed(1);
    find("return").textContent = points(earned.reduce((sum, reward) => sum + reward, 0));
    find("earning").textContent = (lastReward < 0 ? "" : "+") + lastReward.toFixed(2).replace("-", "−");
    find("clock").textContent = `${Math.floor(this.shown)} of ${this.road.scenario.decisions} s`;
  }

  finish() {
    this.finished = true;
    this.run(false);
    const idle = new Drive(this.road, this.number).finish({ decide: () => ({ action: IDLE }) });
    const { label, colour } = this.mine ?? { label: "you", colour: "var(--you)" };
    const drives = [{ drive: this.drive, label, colour, width: 3 }];
    let sentence = verdict(this.drive, idle, label);
    if (this.ghost) {
      drives.unshift({ drive: this.ghost.finish(this.rival), ...this.rival, width: 1.8 });
      const end = title(this.ghost).toLowerCase();
      sentence += ` The ghost, ${this.rival.label}: ${end}, return ${points(this.ghost.total)}.`;
    }
    if (!this.mine) this.failures = this.drive.outAfter === null ? this.failures + 1 : 0;
    const hint = this.mine ? "" : hintAfter(this.failures);
    find("verdict-title").textContent = title(this.drive);
    find("verdict").textContent = sentence;
    find("hint").textContent = hint;
    find("hint").hidden = !hint;
    find("end").hidden = false;
    find("picture").innerHTML = picture(drives, find("picture").clientWidth);
    find("end").focus({ preventScroll: true });
    this.say("");
    this.tell(`${title(this.drive)}. ${sentence} ${hint}`);
    this.dirty = true;
  }

  // A remark stays for a few decisions, so that it can be read.
  remark(words) {
    if (words) this.remarkedAt = this.drive.time;
    if (words || this.drive.time - this.remarkedAt > 3) this.say(words);
  }

  // A sentence for everybody, if there is one.
  announce(words) {
    if (!words) return;
    this.say(words);
    this.tell(words);
  }

  say(words) { find("message").textContent = words; }
  tell(words) { find("live").textContent = words; }
}

async function open() {
  const data = JSON.parse(find("data").textContent);
  const unpacked = Object.entries(data.networks).map(async ([name, packed]) => [name, await unpackNetwork(packed)]);
  const networks = Object.fromEntries(await Promise.all(unpacked));
  const { corners, faces, parts } = data.scene;
  data.scene.car = { corners: new Int16Array((await unpack(corners)).buffer),
    faces: new Uint16Array((await unpack(faces)).buffer), colours: parts };
  const compiled = await WebAssembly.compile(await unpack(data.module));
  window.trap = { data, compiled, networks, game: new Game(data, compiled, networks),
    learn: (settings, on) => learn({ data, compiled }, settings, on) };
  requestAnimationFrame(now => trap.game.frame(now));
  window.trap.ready = performance.now(); // ms since the page was opened
}

open().catch(error => {
  const old = !globalThis.WebAssembly || !globalThis.DecompressionStream;
  const remedy = old ? "It needs a browser of 2023 or later." : "";
  find("message").textContent = `This page could not start: ${error.message}. ${remedy}`;
  throw error;
});
