// "Learn" beside "Drive": agents that learn in this page, their curves, and the road on which one of them drives now.

const power = (low, high) => ({ // a slider whose steps multiply; its first position is 0
  at: value => (value > 0 ? 1 + 99 * Math.log(value / low) / Math.log(high / low) : 0),
  value: place => (place < 1 ? 0 : Number((low * (high / low) ** ((place - 1) / 99)).toPrecision(2))), low: 0, high: 100, step: 1 });
const even = (low, high, step) => ({ at: value => value, value: place => place, low, high, step });
const plain = value => String(Number(value.toPrecision(3))).replace("-", "−");
const DIALS = [ // name: as in `trap.learn`; setting: the library's name
  { name: "p", symbol: "p", setting: "rule_p", help: "how sure the rule is of its action", scale: even(0.12, 0.999, 0.001), words: plain },
  { name: "xi", symbol: "ξ", setting: "xi_multiplier", help: "pull towards the rule; it fades with α", scale: power(1, 2000), words: value => `${plain(value)} α` },
  { name: "xiFixed", symbol: "ξ", setting: "xi_fixed", help: "pull towards the rule", scale: power(0.001, 10), words: plain },
  { name: "c", symbol: "c", setting: "bonus", help: "bonus for a demonstrated second", scale: even(0, 10, 0.1), words: plain },
  { name: "beta", symbol: "β", setting: "beta_start", help: "demonstrations in a batch, at first", scale: even(0, 0.95, 0.05), words: plain },
  { name: "eta", symbol: "η", setting: "target_entropy", help: "target entropy", scale: even(-1, 2, 0.1), words: plain },
  { name: "gamma", symbol: "γ", setting: "gamma", help: "what a second later counts", scale: even(0.5, 0.99, 0.01), words: plain },
];
const METHOD_WORDS = {
  sac: ["plain SAC", "Learning from reward alone."],
  soft: ["the soft constraint", "The KL pulls the policy towards the rule’s."],
  demos: ["demonstrations", "The rule’s drives are in each batch, with a bonus."],
  bootstrapped: ["both aids, the paper’s method", "The pull and the demonstrations together."],
  margin: ["margin", "Demonstrations with a margin loss in place of the bonus."],
  margin_soft: ["margin and soft constraint", "The pull, and a margin loss in place of the bonus."],
};
const MOST_AGENTS = 10, SHOWN_EVERY = 250, TOLD_EVERY = 10000; // ms between two drawings, and two sentences read aloud

class LearnView {
  // game: the world of the page in which one drives; toDrive(): show it.
  constructor(game, toDrive) {
    const find = id => document.getElementById(id), { data } = game, cores = navigator.hardwareConcurrency || 2;
    Object.assign(this, { game, toDrive, find, data, cores, groups: [], fixed: false, values: {}, loaded: null, drawn: 0, told: 0 });
    this.world = { data, compiled: game.compiled };
    this.charts = new Charts(find("curves"), (learner, episode) => this.point(learner, episode));
    this.level = new Drive(game.road, FIRST_ROAD).finish({ decide: () => ({ action: IDLE }) }).total;
    find("method").append(...Object.entries(METHOD_WORDS).map(([id, [name]]) => new Option(name, id)));
    const counts = Array.from({ length: MOST_AGENTS - 1 }, (_, i) => i + 2);
    find("agents").append(...counts.map(n => new Option(n, n)));
    this.makeDials();
    this.choose({ method: "bootstrapped", agents: Math.min(Math.max(cores, 2), 4), drives: 600, seed: 0 });
    this.wire();
  }

  // Show the road on which the agents drive; it is made when somebody comes to see it.
  show() {
    const { data, game, find } = this, colour = data.colours.bootstrapped;
    const present = { id: "present", name: "the agent that learns", label: "an untrained agent", colour, words: "", plan: [] };
    this.mounting ??= mount(find("watch"), data, { watch: true, driver: "present", ghost: "none", drivers: [present], pace: 2 })
      .then(watch => {
        this.watch = watch;
        watch.theme(game.host.dataset.theme);
        if (this.snapshot) this.seat(this.pointed, this.snapshot);
        watch.run(this.busy);
      });
    this.watch?.run(this.busy);
    this.draw();
  }

  get learners() { return this.groups.flatMap(({ learners }) => learners); }
  get busy() { return this.learners.some(({ state }) => state === "learning"); }
  get paused() { return this.learners.some(({ state }) => state === "paused"); }

  wire() {
    const { find } = this, on = (id, kind, action) => find(id).addEventListener(kind, action);
    on("method", "change", () => this.choose({ method: find("method").value }));
    on("fixed", "change", () => this.fix(find("fixed").checked));
    on("start", "click", () => (this.busy ? this.pause() : this.paused ? this.go() : this.begin()));
    on("anew", "click", () => {
      find("seed").value = Number(find("seed").value) + this.learners.length;
      this.begin();
    });
    on("ablation", "click", () => this.guarded(() => runAblation(this, ABLATION_DRIVES)));
    on("which", "change", () => this.point(this.learners[find("which").value], null));
    on("moment", "input", () => this.point(this.pointed, Number(find("moment").value)));
    on("keep", "click", () => this.keep());
    on("save", "click", () => this.save());
    on("load", "change", () => this.load(find("load").files[0]));
    on("share", "click", () => this.share());
    document.addEventListener("visibilitychange", () => { // a phone's battery
      if (document.hidden && this.busy) {
        this.pause();
        this.slept = true;
      } else if (!document.hidden && this.slept) this.go();
    });
    new ResizeObserver(() => this.draw()).observe(find("curves"));
  }

  // Controls ------------------------------------------------------------------------------------------

  makeDials() {
    for (const dial of DIALS) {
      const [label, slider, output] = ["label", "input", "output"].map(kind => document.createElement(kind));
      label.innerHTML = `${dial.symbol} <small>${dial.help}</small>`;
      label.htmlFor = slider.id = `dial-${dial.name}`;
      const { low, high, step } = dial.scale;
      Object.assign(slider, { type: "range", min: low, max: high, step });
      slider.addEventListener("input", () => this.turn(dial, dial.scale.value(Number(slider.value))));
      slider.addEventListener("change", () => this.act({ [dial.name]: this.values[dial.name] }));
      Object.assign(dial, { label, slider, output });
      this.find("sliders").append(label, output, slider);
    }
  }

  turn(dial, value) {
    this.values[dial.name] = value;
    dial.output.textContent = dial.words(value);
    dial.slider.setAttribute("aria-valuetext", dial.words(value));
  }

  // Choose method, agents, drives, seed and numbers; of another method the numbers are its own.
  choose({ method = this.find("method").value, agents, drives, seed, ...numbers }) {
    const { find } = this, defaults = this.data.learning.methods[method], without = this.data.learning.without[method];
    find("method").value = method;
    find("method-words").textContent = METHOD_WORDS[method][1];
    for (const [id, value] of Object.entries({ agents, drives, seed })) if (value !== undefined) find(id).value = value;
    if ("xiFixed" in numbers) this.fixed = true;
    for (const dial of DIALS) {
      const unused = without.includes(dial.setting) || (dial.name === "c" && without.includes("beta_start")), value = numbers[dial.name] ?? defaults[dial.setting] ?? 2;
      this.turn(dial, unused ? 0 : value);
      dial.slider.value = dial.scale.at(unused ? 0 : value);
      const noRule = dial.name === "p" && without.includes("xi_multiplier") && without.includes("beta_start");
      dial.slider.disabled = unused || noRule;
      dial.slider.title = dial.slider.disabled ? "This method does without it." : "";
    }
    find("fixed").disabled = without.includes("xi_multiplier");
    this.fix(this.fixed && !find("fixed").disabled);
  }

  // ξ is fixed, or a multiple of α, with which it fades.
  fix(fixed) {
    this.fixed = this.find("fixed").checked = fixed;
    for (const { name, label, slider, output } of DIALS) {
      if (name === "xi" || name === "xiFixed") [label, slider, output].forEach(each => { each.hidden = (name === "xi") === fixed; });
    }
    this.act(fixed ? { xiFixed: this.values.xiFixed } : { xiFixed: null, xi: this.values.xi });
  }

  // What is chosen, as `trap.learn` takes it.
  get chosen() {
    const { find, values } = this, method = find("method").value;
    const used = DIALS.filter(({ name, slider }) => !slider.disabled && name !== (this.fixed ? "xi" : "xiFixed"));
    const numbers = Object.fromEntries(used.map(({ name }) => [name, values[name]]));
    return { method, episodes: Number(find("drives").value), seed: Number(find("seed").value), ...numbers };
  }

  // Let a moved slider act on the agents that learn.
  act(changes) {
    this.guarded(() => this.learners.filter(({ state }) => ["learning", "paused"].includes(state)).forEach(each => each.set(changes)));
    this.draw();
  }

  // Do something; what is wrong with it is said, and is no error.
  guarded(action) {
    const fault = this.find("fault");
    fault.hidden = true;
    try {
      return action();
    } catch (error) {
      fault.textContent = error.message;
      fault.hidden = false;
      return null;
    }
  }

  // Learning ------------------------------------------------------------------------------------------

  begin() {
    const { seed, ...asked } = this.chosen, count = Number(this.find("agents").value);
    const agents = Array.from({ length: count }, (_, i) => ({ ...asked, seed: seed + i }));
    this.guarded(() => this.run([{ name: METHOD_WORDS[asked.method][0], method: asked.method, agents }], this.loaded));
  }

  // Train groups of agents, { name, method, agents: [settings] }, some at a time.
  run(groups, from = null, atATime = Infinity) {
    for (const group of groups) group.agents.forEach(asked => settingsOf(this.data.learning, asked)); // all or none
    this.learners.forEach(each => each.stop());
    const on = { curves: () => this.dirty(), agent: (learner, snapshot) => this.learned(learner, snapshot),
      done: () => { this.next(); this.dirty(); }, failed: (_, error) => { this.guarded(() => { throw error; }); this.next(); } };
    this.coming = [];
    this.groups = groups.map(group => ({ ...group, colour: this.data.ablation.colours[group.method], learners: [] }));
    for (const group of this.groups) {
      for (const asked of group.agents) this.coming.push(() => group.learners.push(new Learner(this.world, asked, on, from)));
    }
    this.episodes = groups[0].agents[0].episodes;
    this.loaded = null;
    this.pointed = null;
    this.moment = null;
    this.told = 0;
    for (let i = 0; i < atATime && this.coming.length; i++) this.next();
    this.watch?.run(true);
    this.showState();
  }

  next() {
    this.coming.shift()?.();
    this.find("which").replaceChildren(...this.learners.map((each, i) => new Option(this.nameOf(each), i)));
    this.pointed ??= this.learners[0];
    this.showState();
  }

  nameOf(learner) {
    const several = this.groups.length > 1, group = this.groups.find(({ learners }) => learners.includes(learner));
    return `${several ? `${group.name}, ` : ""}agent ${group.learners.indexOf(learner) + 1} (seed ${learner.begun.seed})`;
  }

  pause() {
    this.learners.forEach(each => each.pause());
    this.watch?.run(false);
    this.showState();
  }

  go() {
    this.slept = false;
    this.learners.forEach(each => each.go());
    this.watch?.run(true);
    this.showState();
  }

  showState() {
    const { find, learners, busy } = this, some = Boolean(this.pointed?.latest);
    find("start").textContent = busy ? "Pause" : this.paused ? "Go on" : "Start";
    find("anew").disabled = !learners.length;
    [find("keep").disabled, find("save").disabled] = [!some, !some || ["stopped", "failed"].includes(this.pointed.state)];
    find("moment").max = this.episodes ?? 1;
  }

  dirty() {
    if (performance.now() - this.drawn > SHOWN_EVERY || !this.busy) this.draw();
  }

  draw() {
    this.drawn = performance.now();
    const pointed = { learner: this.pointed, episode: this.moment };
    this.charts.draw(this.groups, { episodes: this.episodes ?? Number(this.find("drives").value), pointed, level: this.level });
    if (!this.learners.length) return;
    const words = this.groups.length > 1 ? finders(this.groups) : storyOf(this.learners);
    this.find("story").textContent = words;
    if (performance.now() - this.told > TOLD_EVERY || !this.busy) {
      this.told = performance.now();
      this.find("learn-live").textContent = words;
    }
    this.showState();
  }

  // The agent on the road -----------------------------------------------------------------------------

  // A learner has a new snapshot: if it is the one on the road, and in the present, that is who drives now.
  learned(learner, snapshot) {
    if (learner === this.pointed && this.moment === null) this.seat(learner, snapshot);
  }

  // Put the agent of a moment on the road; null: the present one, from now on.
  point(learner, episode) {
    if (!learner) return;
    const present = episode === null || episode >= learner.episode;
    this.pointed = learner;
    this.moment = present ? null : episode;
    this.find("which").value = this.learners.indexOf(learner);
    const snapshot = present ? learner.latest : learner.agents.filter(each => each.episode <= episode).at(-1) ?? learner.agents[0];
    if (snapshot) {
      this.seat(learner, snapshot);
      this.watch?.begin({});
      this.watch?.run(true);
    }
    this.draw();
  }

  driverOf(learner, { episode, layers }, id) {
    const group = this.groups.find(({ learners }) => learners.includes(learner));
    const label = `${this.nameOf(learner)} after ${episode} drives`;
    return { id, name: label, label: `the agent after ${episode} drives`, colour: group.colour, words: `It learned in this page: ${group.name}.`, decide: byNetwork(layers) };
  }

  seat(learner, snapshot) {
    this.snapshot = snapshot;
    this.watch?.offer(this.driverOf(learner, snapshot, "present"));
    this.find("moment").value = this.moment ?? this.find("moment").max;
    this.find("moment-words").textContent = `${snapshot.episode} drives${this.moment === null ? ", now" : ""}`;
    this.showState();
  }

  // Keep the agent on the road as a ghost, and drive against it.
  keep() {
    this.kept = (this.kept ?? 0) + 1;
    const driver = this.driverOf(this.pointed, this.snapshot, `kept-${this.kept}`);
    this.game.offer(driver);
    this.toDrive();
    this.game.begin({ ghost: driver.id, driver: "you" });
  }

  // Files and addresses -------------------------------------------------------------------------------

  async save() {
    const learner = this.pointed, file = await learner.file().catch(error => this.guarded(() => { throw error; }));
    if (!file) return;
    const link = document.createElement("a"), { method, seed } = learner.begun;
    link.href = URL.createObjectURL(new Blob([file], { type: "application/octet-stream" }));
    link.download = `${method}-${seed}.safetensors`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  // An agent from a file: it can drive, and the next agents begin with its networks if the file holds all of them.
  async load(file) {
    if (!file) return;
    const bytes = new Uint8Array(await file.arrayBuffer());
    this.find("load").value = "";
    const run = this.guarded(() => readRun(this.data.learning, bytes));
    if (!run) return;
    this.loaded = run.weights ? run : null;
    const driver = { id: "loaded", name: file.name, label: "the loaded agent", colour: this.data.colours.ppo, words: "It came from a file.", decide: byNetwork(run.layers) };
    this.game.offer(driver);
    this.watch?.offer({ ...driver, id: "present" });
    this.watch?.begin({});
    this.watch?.run(true);
    const next = this.loaded ? " Start lets agents go on learning from it." : "";
    this.find("story").textContent = `${file.name} drives on the road now, and can be chosen in Drive.${next}`;
  }

  // The address of what is chosen.
  get address() {
    const { method, episodes, ...numbers } = this.chosen, agents = this.find("agents").value;
    return `#learn=${method}&${new URLSearchParams({ agents, drives: episodes, ...numbers })}`;
  }

  async share() {
    history.replaceState(null, "", this.address);
    const copied = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
    this.find("share").textContent = copied ? "Copied" : "It is in the address bar";
    setTimeout(() => { this.find("share").textContent = "Copy the address"; }, 2000);
  }

  // Choose what an address asks for, as in "learn=soft&agents=3&xi=200". What is wrong with it is said.
  open(text) {
    const { learn: method, ...given } = Object.fromEntries(new URLSearchParams(text));
    this.guarded(() => {
      if (!METHOD_WORDS[method]) throw new Error(`The address asks for the method “${method}”: it takes ${listed(Object.keys(METHOD_WORDS))}.`);
      const { agents = 3, drives = 600, seed = 0, ...numbers } = Object.fromEntries(Object.entries(given).map(([name, value]) => [name, Number(value)]));
      const known = DIALS.map(({ name }) => name), strange = Object.keys(numbers).find(name => !known.includes(name));
      if (strange) throw new Error(`The address has “${strange}”, which is unknown: it takes ${listed(["learn", "agents", "drives", "seed", ...known])}.`);
      if (!(Number.isInteger(agents) && agents >= 2 && agents <= MOST_AGENTS)) throw new Error(`agents = ${given.agents}: give a whole number from 2 to ${MOST_AGENTS}.`);
      settingsOf(this.data.learning, { method, episodes: drives, seed, ...numbers });
      this.fixed = "xiFixed" in numbers;
      this.choose({ method, agents, drives, seed, ...numbers });
    });
  }
}
