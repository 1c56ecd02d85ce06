// The game: a clock that asks for a decision a second, and all that is shown around it, within one shadow root.
// What happens is told to the element around it by events: "shown" (road, drivers or view changed), "theme", "decided"
// (after each decision) and "ended" (a drive is over; its drive in `detail`).

const FIRST_ROAD = 10;
const PATIENCE = 5; // decisions between two sentences for readers who do not see the road
const LOOK = 1500; // ms for a look at how a drive ended
const STEP_PACE = 2.5; // how much faster than real time a single step is shown
const WIDE = 1080, NARROW = 640; // px
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

class Game {
  // ready: see `prepared` in mount.js. options: see `mount`.
  constructor(root, { data, compiled, networks }, options) {
    Object.assign(this, { root, data, compiled, networks, options, host: root.host, stop: new AbortController() });
    this.find = id => root.getElementById(id);
    this.settings = { p: data.p, xi: 0, c: 0 };
    this.failures = this.attempts = 0;
    this.pace = calm.matches ? 0 : 1;
    this.road = new Road(compiled, options.scenario ?? data.scenario);
    this.drivers = makeDrivers(data, networks, this.settings);
    for (const driver of options.drivers) this.drivers[driver.id] = driver;
    this.view = new View(this.find("road"), this.road.scenario);
    this.thoughts = new Thoughts(this.find("thoughts"), data.actions);
    this.controls = new Controls(this.find("pad"), options.keys ?? this.host, this.stop.signal, () => this.pressed(), {
      " ": () => this.go(), r: () => this.again(), n: () => this.another(), f: () => this.find("futures").click(),
      t: () => this.toggleTheme(), Escape: () => this.leave(), v: () => this.find("view").click(), 0: () => this.setPace(0),
      1: () => this.setPace(1), 2: () => this.setPace(2), 5: () => this.setPace(5),
    });
    this.controls.touched = () => { this.dirty = true; }; // a key is seen at once, also where the clock waits
    this.controls.pad.forEach((button, action) => button.setAttribute("aria-label", data.actions[action]));
    makeSliders(this.find, this.settings, name => this.tuned(name));
    if (options.page) this.find("shell").tabIndex = -1; // the keys are the world's wherever the focus is
    this.wire();
    const system = () => this.theme(options.theme ?? (dark.matches ? "dark" : "light"));
    dark.addEventListener("change", system, { signal: this.stop.signal });
    system();
    this.open(options);
    requestAnimationFrame(now => this.frame(now));
  }

  get mine() { return this.drivers[this.driverName]; } // undefined if you drive
  get rivals() { return this.ghostName.split(",").map(name => this.drivers[name]).filter(Boolean); } // the ghosts' drivers
  get drive() { return this.seat.drive; }

  // Offer drivers in both lists, in place of those of the same id: { id, name, label, colour, words, decide }, as in
  // drivers.js. Who is at the wheel or beside you drives on from the next decision.
  offer(...drivers) {
    if (this.stop.signal.aborted) return;
    for (const driver of drivers) this.drivers[driver.id] = driver;
    this.list();
    for (const seat of [this.seat, ...this.ghosts ?? []]) {
      if (seat?.driver.id in this.drivers) Object.assign(seat, { driver: this.drivers[seat.driver.id] }).think();
    }
  }

  list() {
    const entries = Object.values(this.drivers).map(({ id, name }) => [id, name]);
    const several = this.ghostName?.includes(",") ? [[this.ghostName, this.rivals.map(({ name }) => name).join(" and ")]] : [];
    const fill = (id, list) => this.find(id).replaceChildren(...list.map(([value, name]) => new Option(name, value)));
    fill("driver", [["you", "you"], ...entries]);
    fill("ghost", [["none", "nobody"], ...entries, ...several]);
    [this.find("ghost").value, this.find("driver").value] = [this.ghostName ?? "none", this.driverName ?? "you"];
  }

  wire() {
    const { find, stop: { signal } } = this;
    this.find("driver").addEventListener("change", event => this.begin({ driver: event.target.value }));
    this.find("ghost").addEventListener("change", event => this.begin({ ghost: event.target.value }));
    this.find("number").addEventListener("change", event => this.begin({ number: event.target.value }));
    this.find("futures").addEventListener("change", () => {
      this.think();
      this.before = this.futures; // also where the clock stands within a second
      this.dirty = true;
    });
    this.root.addEventListener("change", ({ target }) => { // after a mouse or a finger, the arrow keys drive again
      if (!target.matches(":focus-visible") || target.type === "number") this.focus();
    });
    this.find("go").addEventListener("click", () => this.go());
    for (const id of ["again", "end-again"]) find(id).addEventListener("click", () => this.again());
    for (const id of ["next", "end-next"]) find(id).addEventListener("click", () => this.another());
    this.find("never").addEventListener("click", () => this.neverOut());
    for (const button of this.paces) button.addEventListener("click", () => this.setPace(Number(button.dataset.pace)));
    this.find("view").addEventListener("click", () => this.announce(this.look(!this.inDepth)));
    this.find("road").addEventListener("pointerdown", () => this.focus());
    this.seen = new ResizeObserver(() => this.fit());
    this.seen.observe(this.find("road"));
    this.seen.observe(this.host);
    document.addEventListener("visibilitychange", () => {
      if (document.hidden || this.options.watch) this.run(!document.hidden);
    }, { signal });
  }

  get paces() { return this.root.querySelectorAll("[data-pace]"); }

  focus() { this.find("shell").focus({ preventScroll: true }); }

  // Give the keys back to the notebook around it.
  leave() {
    this.root.activeElement?.blur();
    this.host.closest("[tabindex]")?.focus({ preventScroll: true });
  }

  // Take it out of the page. Whatever is told late, by a clock or an answer out of Python, is told to nobody.
  close() {
    const nobody = document.createElement("template");
    this.stop.abort();
    this.seen.disconnect();
    this.find = () => nobody;
    this.root.replaceChildren();
  }

  event(name, detail) { this.host.dispatchEvent(new CustomEvent(name, { detail })); }

  theme(name) {
    this.host.dataset.theme = name;
    this.fit();
    this.event("theme", name);
  }

  toggleTheme() { this.theme(this.host.dataset.theme === "dark" ? "light" : "dark"); }

  // What is shown, in the words of the options of `mount`.
  get state() {
    return { road: this.number ?? FIRST_ROAD, ghost: this.ghostName ?? "rule", driver: this.driverName ?? "you",
      pace: this.pace, futures: Number(this.find("futures").checked), view: this.inDepth ? "3d" : "above" };
  }

  // Begin with what is given; the rest stays as it is. It may be called late, by a clock or an answer out of Python.
  open(given) {
    if (this.stop.signal.aborted) return "";
    const { road, ghost, driver, pace, futures, view } = { ...this.state, ...given };
    this.setPace(Number(pace));
    this.find("futures").checked = Number(futures) === 1;
    this.begin({ number: road, ghost, driver });
    if (given.run) this.run(true);
    return this.look(view === "3d");
  }

  // From above, or in 3D where the browser can.
  // What the browser cannot is returned as a sentence.
  look(inDepth) {
    let lost = "";
    this.inDepth = inDepth;
    try {
      if (inDepth) this.scene ??= new Scene(this.find("scene"), this.view, this.data.scene, () => this.announce(this.lose()));
    } catch (error) {
      this.inDepth = false;
      lost = `The road stays as seen from above: 3D needs WebGL 2, and this browser says “${error.message}”.`;
    }
    this.find("scene").hidden = !this.inDepth;
    this.find("view").setAttribute("aria-pressed", this.inDepth);
    this.find("road").setAttribute("aria-label", this.inDepth ? "The road in 3D, behind the car" : "The road from above");
    this.fit();
    this.event("shown");
    return lost;
  }

  // The graphics card has given up the picture: what was drawn there is gone, so a new scene begins on a new canvas.
  lose() {
    this.find("scene").replaceWith(this.find("scene").cloneNode());
    this.scene = null;
    this.look(false);
    return "The graphics card gave up the picture in 3D: the road is shown from above. V tries again.";
  }

  fit() {
    const wide = this.host.clientWidth, plain = !this.options.details;
    const size = wide < NARROW ? "small" : wide < WIDE && !plain ? "middle" : "";
    this.find("shell").className = `world ${this.options.watch ? "watch" : `${size} ${plain ? "plain" : ""}`}`;
    this.view.fit();
    if (this.inDepth) this.scene?.fit();
    this.dirty = true;
  }

  // A new drive; whatever is not given stays as it is.
  begin({ number = this.number, ghost = this.ghostName, driver = this.driverName }) {
    const valid = isRoad(number), solved = this.finished && this.drive.outAfter !== null;
    if (solved || this.seat && Number(number) !== this.number) this.attempts = 0;
    if (this.finished && driver === "you" && this.pace > 1) this.setPace(1); // a faster clock is for the way after the traps
    this.number = valid ? Number(number) : this.number ?? FIRST_ROAD;
    [this.ghostName, this.driverName] = [ghost, driver];
    this.begun = (this.begun ?? 0) + 1; // drives, so that two of one road can be told apart
    this.find("number").value = this.number;
    this.list();
    const seat = driver => new Seat(this.road, this.number, driver);
    this.seat = seat(this.mine ?? { decide: () => ({ action: IDLE }) });
    this.ghosts = this.rivals.filter(driver => driver !== this.mine).map(seat); // the same driver would drive the same
    this.shown = this.arrived = 0;
    this.wasAhead = this.finished = false;
    this.controls.forget();
    const held = this.find("end").contains(this.root.activeElement);
    this.find("end").hidden = true;
    if (held) this.focus(); // or the next key would be the notebook's
    this.find("about").textContent = this.rivals.length === 1 ? this.rivals[0].words : "";
    this.run(false);
    this.think();
    const invitation = this.mine ? `Press Start and watch ${this.mine.label} drive.`
      : `${this.options.keys ? "Press" : "Click here, then press"} ↑ ↓ ← → or the pad: your first decision starts the clock.`;
    this.say(valid ? invitation : noRoad(number));
    this.tell(`Road ${this.number}. ${stateInWords(this.drive.cars)}`);
    this.event("shown");
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
    this.host.style.setProperty("--pace", Math.max(this.pace, 1));
    for (const button of this.paces) {
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
    this.find("go").textContent = this.pace === 0 ? "Next" : this.running ? "Pause" : "Start";
  }

  // The Start button and the space bar: start or stop the clock, or make one decision.
  go() {
    if (this.finished) {
      this.again();
      if (!this.mine) return; // your first decision starts the clock
    }
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
    if (this.drive.over || this.waiting || this.shown < this.drive.time - 0.5) return;
    this.shown = this.drive.time;
    this.run(true);
    this.decide();
    if (calm.matches) this.shown = this.drive.end;
  }

  // One decision of all cars.
  decide() {
    const { drive } = this;
    this.arrive();
    if (!this.mine) {
      this.attempts += Number(drive.time === 0);
      this.seat.thought = { action: this.controls.take() };
    }
    for (const seat of [this.seat, ...this.ghosts]) seat.decide();
    this.before = this.futures;
    this.think();
    if (this.pace === 0 || drive.time % PATIENCE === 0) this.tell(`${drive.time} s. ${stateInWords(drive.cars)}`);
    this.event("decided", drive);
  }

  // The picture shows what the last decision led to: what is worth saying about it.
  arrive() {
    const { drive, drive: { cars, time } } = this;
    if (this.arrived === time || drive.over) return;
    this.arrived = time;
    const ahead = cars[X] > row(cars, TRAP_1)[X], justOut = ahead && !this.wasAhead;
    this.wasAhead = ahead;
    if (!this.mine) this.remark(remark(cars, justOut, this.attempts));
    else if (this.options.watch && justOut) this.say(`Ahead of trap 1 after ${time} s.`);
  }

  // What the driver, or the ghost in your place, thinks of the road as it is now.
  think() {
    const { cars } = this.drive, wanted = this.find("futures").checked, details = this.options.details;
    const beside = this.rivals.find(({ id, elsewhere }) => id !== "rule" && !elsewhere) ?? this.drivers.escaping;
    const mind = this.mine ?? beside; // the rule's own thoughts are in the column of π̃ already
    const thought = (this.mine ? this.seat.thought : details && mind.decide(this.road, cars, this.drive)) || {};
    const futures = wanted ? thought.futures ?? this.drivers.lookahead.decide(this.road, cars).futures : null;
    this.futures = this.drive.over ? null : futures;
    if (!details) return;
    const taught = this.road.rule(cars), policy = thought.policy ?? Array.from({ length: ACTIONS }, (_, a) => Number(a === thought.action));
    this.thoughts.show({ policy, action: thought.action }, stochasticRule(taught.action, this.settings.p), mind);
    const base = mind.id === "lookahead" ? " π is PPO’s; the imagined drives choose the action in bold." : "";
    this.find("mind-title").textContent = `What ${mind.label} thinks`;
    const where = this.mine ? "" : "In your place. ";
    this.find("mind-words").textContent = `${where}The rule says: ${this.data.reasons[taught.reason]}.${base}`;
  }

  // A slider moved: the compromise drives on with the new numbers; if nobody drove by it, it becomes the ghost.
  tuned(name) {
    if (name !== "p" && this.driverName !== "soft" && !this.rivals.includes(this.drivers.soft)) this.begin({ ghost: "soft" });
    for (const seat of [this.seat, ...this.ghosts]) if (!seat.driver.elsewhere) seat.think();
    this.think();
  }

  // Once for each picture: let the clock run, and draw.
  frame(now) {
    if (this.stop.signal.aborted) return;
    const waited = this.waited;
    this.waited = this.waiting;
    if (waited && !this.waited) this.think();
    const passed = Math.min((now - (this.last ?? now)) / 1000, 0.1);
    this.last = now;
    if (this.running) this.advance(passed * (this.pace || STEP_PACE));
    if (this.running || this.dirty) this.draw();
    requestAnimationFrame(next => this.frame(next));
  }

  // Whether a driver elsewhere has not answered yet: the clock waits.
  get waiting() { return Boolean(this.mine && this.seat.waiting) || this.ghosts.some(ghost => ghost.waiting); }

  advance(passed) {
    this.shown += passed;
    while (this.pace > 0 && this.shown >= this.drive.time && !this.drive.over && !this.waiting) this.decide();
    const limit = this.drive.over ? this.drive.end : this.drive.time;
    if (this.shown < limit) return;
    this.shown = limit;
    this.arrive();
    if (this.drive.over) this.finish();
    else if (this.pace === 0 && !this.waiting) {
      this.run(false);
      if (!this.mine && this.controls.asked) this.step(); // a key pressed while the last step was shown
    }
  }

  draw() {
    this.dirty = false;
    const cars = this.drive.at(this.shown), coming = this.mine ? this.seat.thought?.action ?? null : this.controls.coming;
    const shown = this.drive.over || (!this.mine && this.controls.idle) ? null : coming;
    const ghosts = this.ghosts.map(({ drive, driver: { colour, label } }) => ({
      state: drive.at(Math.min(this.shown, drive.end)), gone: drive.over && this.shown >= drive.end, colour, name: label }));
    const colour = this.mine?.colour ?? this.view.colour("you");
    const futures = this.shown < this.drive.time ? this.before : this.futures; // those of the decision that is shown
    const wreck = this.drive.accident > 0 && this.shown >= this.drive.end, name = this.options.watch ? this.mine.label : "";
    (this.inDepth ? this.scene : this.view).draw({ cars, ghosts, coming: shown, colour, futures, wreck, name });
    this.controls.mark(shown);
    const earned = this.drive.rewards.slice(0, Math.ceil(this.shown)), lastReward = earned.at(-1) ?? 0;
    this.find("speed").textContent = cars[SPEED].toFixed(1);
    this.find("return").textContent = points(earned.reduce((sum, reward) => sum + reward, 0));
    this.find("earning").textContent = (lastReward < 0 ? "" : "+") + lastReward.toFixed(2).replace("-", "−");
    const where = this.options.watch ? `\nroad ${this.number}` : "";
    this.find("clock").textContent = `${Math.floor(this.shown)} of ${this.road.scenario.decisions} s${where}`;
  }

  async finish() {
    const { find, drive, seat, ghosts } = this, { label, colour } = this.mine ?? { label: "you", colour: "var(--you)" };
    this.finished = true;
    this.run(false);
    this.event("ended", drive);
    this.say(`${title(drive)}.`);
    if (this.options.watch) return setTimeout(() => this.open({ road: this.number + 1, run: true }), LOOK);
    for (const ghost of ghosts) await ghost.finish();
    if (drive.accident && !calm.matches) await new Promise(done => setTimeout(done, LOOK)); // before the card hides it
    if (seat !== this.seat || this.stop.signal.aborted) return; // another drive has begun meanwhile
    const idle = new Drive(this.road, this.number).finish({ decide: () => ({ action: IDLE }) });
    const drives = [...ghosts.map(ghost => ({ drive: ghost.drive, ...ghost.driver, width: 1.8 })), { drive, label, colour, width: 3 }];
    let sentence = verdict(drive, idle, label);
    for (const ghost of ghosts) {
      sentence += ` The ghost, ${ghost.driver.label}: ${title(ghost.drive).toLowerCase()}, return ${points(ghost.drive.total)}.`;
    }
    if (!this.mine) this.failures = drive.outAfter === null ? this.failures + 1 : 0;
    const hint = this.mine ? "" : hintAfter(this.failures);
    const tries = !this.mine && drive.outAfter !== null && this.attempts > 1 ? `, in ${this.attempts} attempts` : "";
    this.find("verdict-title").textContent = title(drive) + tries;
    this.find("verdict").textContent = sentence;
    this.find("hint").textContent = hint;
    this.find("hint").hidden = !hint;
    this.find("end").hidden = false;
    this.find("picture").innerHTML = picture(drives, this.find("picture").clientWidth);
    if (this.options.keys || this.root.activeElement) this.find("end").focus({ preventScroll: true });
    this.say("");
    this.tell(`${title(drive)}. ${sentence} ${hint}`);
    this.dirty = true;
  }

  // A remark stays for a few decisions, so that it can be read; one that asks for an action, while it is right.
  remark({ words, asks }) {
    if (!words && !this.asked && this.drive.time - this.remarkedAt <= 6) return;
    if (words) this.remarkedAt = this.drive.time;
    this.asked = asks;
    this.say(words);
  }

  // A sentence for everybody, if there is one.
  announce(words) {
    if (!words) return;
    this.say(words);
    this.tell(words);
  }

  say(words) { this.find("message").textContent = words; }
  tell(words) { this.find("live").textContent = words; }
}
