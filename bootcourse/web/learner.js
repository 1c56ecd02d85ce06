// Agents that learn in the page, each in a worker of its own: see learn_worker.js.
//
//     const learner = new Learner(world, { method: "bootstrapped", seed: 0, episodes: 600 }, { curves: draw });
//     learner.set({ p: 0.8 });  learner.pause();  learner.go();  learner.stop();
//     const curves = await learner.finished;
//
// world: { compiled, data }, the module and the page's data. Settings have the names of the library's (`Settings` in
// bootcourse/learn/settings.py), or those of the page:

const SHORT = { p: "rule_p", xi: "xi_multiplier", xiFixed: "xi_fixed", c: "bonus", beta: "beta_start",
  betaEpisodes: "beta_episodes", eta: "target_entropy", alpha: "alpha_init", roads: "envs_per_agent" };
const READABLE = { success: "escaped", return: "returns", speed: "speeds", distance: "distances", accident: "accidents",
  entropy: "entropies", decisions: "lengths" }; // what `trap.learn` returns
const AT_START = ["seed", "alpha_init", "envs_per_agent", "buffer_size", "learning_starts", "demonstration_episodes",
  "stochastic_demonstrations"]; // settings that cannot change while an agent learns
const EVERY = 20; // episodes between two snapshots of the agent

// The library's settings of an agent, out of what was asked for. Throws an Error whose message says what is wrong.
function settingsOf(learning, { method = "bootstrapped", episodes = 1000, ...asked }) {
  const known = learning.methods[method];
  const methods = Object.keys(learning.methods).join(", ");
  if (!known) throw new Error(`“${method}” is not a method of this page: choose ${methods}.`);
  const changes = changesOf(learning, asked), settings = { ...known, ...changes, episodes };
  for (const name of learning.without[method]) {
    if (changes[name] > 0) throw new Error(`${name} = ${changes[name]}, but method “${method}” is defined by doing without.`);
  }
  if (!Number.isInteger(episodes) || episodes < 1 || episodes > learning.episodes) {
    throw new Error(`episodes = ${episodes}: give a whole number from 1 to ${learning.episodes}.`);
  }
  return settings;
}

// Some settings by the library's names, checked as the library does.
function changesOf(learning, asked) {
  return Object.fromEntries(Object.entries(asked).map(([given, value]) => {
    const name = SHORT[given] ?? given, limits = learning.limits[name];
    const names = [...Object.keys(SHORT), ...Object.keys(learning.limits)].join(", ");
    if (!limits) throw new Error(`“${given}” is not a setting: choose ${names}.`);
    const { low, high, above, whole, empty } = limits;
    const fits = value === null ? empty : typeof value === "boolean" ? limits.truth : !limits.truth
      && Number.isFinite(value) && (low === null || value >= low) && (high === null || value <= high)
      && (above === null || value > above) && (!whole || Number.isInteger(value));
    if (!fits) throw new Error(`${given} = ${value}: give ${limits.words}.`);
    return [name, value];
  }));
}

// A network for `forward` in minds.js out of the row of numbers that the worker sends.
function layersOf(learning, row) {
  let place = 0;
  const take = size => row.subarray(place, (place += size));
  return learning.layers.map(({ inputs, outputs }) => (
    { inputs, outputs, weights: take(inputs * outputs), biases: take(outputs) }));
}

class Learner {
  // on: { curves(learner), agent(learner, snapshot), done(learner), failed(learner, error) }, all optional.
  // from: what `readRun` found in a file, whose networks it begins with. Throws an Error for settings that are not right.
  constructor(world, asked, on = {}, from = null) {
    const { learning, scenario } = world.data;
    this.settings = settingsOf(learning, asked);
    this.begun = { ...this.settings };
    this.curves = Object.fromEntries(learning.names.map(name => [name, []]));
    Object.assign(this, { learning, on, agents: [], marks: [], waiting: [], progress: {}, state: "learning" });
    this.finished = new Promise((resolve, reject) => Object.assign(this, { resolve, reject }));
    this.finished.catch(() => {}); // whoever does not wait for it hears of a failure by `on.failed`
    const address = URL.createObjectURL(new Blob([LEARN_WORKER], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = event => this.fail(new Error(event.message ?? "The browser did not start the worker."));
    this.worker.postMessage({ kind: "start", compiled: world.compiled, scenario, learning, settings: this.settings,
      weights: from?.weights, every: EVERY });
  }

  get episode() { return this.curves.return.length; }
  get latest() { return this.agents.at(-1); } // { episode, layers }, undefined before the first

  // The snapshot nearest to an episode, { episode, layers }; undefined before the first.
  agentAt(episode) {
    const away = snapshot => Math.abs(snapshot.episode - episode);
    return this.agents.reduce((best, each) => (best && away(best) <= away(each) ? best : each), undefined);
  }

  hear({ kind, episode, ...said }) {
    if (this.state === "stopped") return;
    if (kind === "curves") {
      const { names } = this.learning, { rows, ...progress } = said;
      rows.forEach((value, i) => this.curves[names[i % names.length]].push(value));
      this.progress = progress; // { demonstrated, updates, decisions, seconds }
      this.on.curves?.(this);
    } else if (kind === "agent") {
      const snapshot = { episode, layers: layersOf(this.learning, said.weights) };
      if (this.latest?.episode === episode) this.agents.pop();
      this.agents.push(snapshot);
      this.answer("agent", snapshot);
      this.on.agent?.(this, snapshot);
    } else if (kind === "changed") {
      this.marks.push({ episode, ...said });
      this.on.curves?.(this);
    } else if (kind === "weights") this.answer("weights", said.weights);
    else if (kind === "failed") this.fail(new Error(said.message));
    else if (kind === "done") {
      this.state = "done";
      this.resolve(this.readable());
      this.on.done?.(this);
    }
  }

  answer(kind, value) {
    this.waiting.filter(each => each.kind === kind).forEach(({ resolve }) => resolve(value));
    this.waiting = this.waiting.filter(each => each.kind !== kind);
  }

  fail(error) {
    this.stop("failed");
    this.reject(error);
    this.waiting.forEach(({ reject }) => reject(error));
    this.on.failed?.(this, error);
  }

  // Change p, xi, xiFixed, c, beta, betaEpisodes, eta, gamma ... from now on; `marks` keeps what was changed when,
  // as the worker tells it: it may be some episodes ahead of what this thread has heard.
  // Throws an Error for a value that is not right, and for a setting that is one of the start alone.
  set(asked) {
    const changes = changesOf(this.learning, asked), late = Object.keys(changes).find(name => AT_START.includes(name));
    if (late) throw new Error(`${late} is set when an agent begins: start another one.`);
    Object.assign(this.settings, changes);
    this.worker.postMessage({ kind: "set", changes });
  }

  pause() {
    if (this.state !== "learning") return;
    this.state = "paused";
    this.worker.postMessage({ kind: "pause" });
  }

  go() {
    if (this.state !== "paused") return;
    this.state = "learning";
    this.worker.postMessage({ kind: "go" });
  }

  // End it for good and free its memory; its curves and snapshots stay.
  stop(state = "stopped") {
    this.state = state;
    this.worker.terminate();
  }

  // The agent of this moment, { episode, layers }.
  agent() { return this.ask("agent"); }

  ask(kind) {
    if (["stopped", "failed"].includes(this.state)) return Promise.reject(new Error("This agent has stopped learning."));
    return new Promise((resolve, reject) => {
      this.waiting.push({ kind, resolve, reject });
      this.worker.postMessage({ kind: `ask ${kind}` });
    });
  }

  // The curves under readable names: escaped, returns, speeds, ..., each a list with a number for each episode.
  readable() {
    return Object.fromEntries(Object.entries(this.curves).map(([name, values]) => [READABLE[name] ?? name, values]));
  }

  // All weights and the curves as one file of safetensors, a Uint8Array, which Python's `load_run` and `readRun` read.
  async file() {
    return runFile(this, await this.ask("weights"));
  }
}

// `trap.learn` of the page's console: the curves of one training that runs as the button's does.
const learn = (world, asked = {}, on = {}) => new Learner(world, asked, on).finished;
