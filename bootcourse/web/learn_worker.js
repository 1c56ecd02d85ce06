// A worker in which one agent learns: the compiled training of bootcourse/learn/compiled_training.py in WebAssembly.
// No equation stands here: this script gives the training its records, lets it run, and says what came of it.
//
// learner.js sends { start }, { set }, { pause }, { go }, { ask: "agent" or "weights" }. It is sent { curves, ... },
// { agent, ... }, { weights, ... }, { done } and { failed }.

const TURN = 25; // ms of learning between two looks for messages
const REPORT = 100; // ms between two reports of curves
const KINDS = { f4: Float32Array, f8: Float64Array, i8: BigInt64Array, u8: BigUint64Array };

// The records of one training in a memory of their own, with the compiled functions that work on them.
class Trainer {
  constructor({ compiled, scenario, learning, settings, weights }) {
    Object.assign(this, { learning, settings });
    const constants = Uint8Array.from(atob(scenario.record), letter => letter.charCodeAt(0));
    const sizes = { ...learning.sizes, constants: constants.length, result: 32 };
    let end = scenario.free;
    this.at = Object.fromEntries(Object.entries(sizes).map(([name, size]) => {
      const place = end;
      end += Math.ceil(size / 16) * 16;
      return [name, place];
    }));
    this.memory = new WebAssembly.Memory({ initial: Math.ceil(end / 65536) });
    this.code = new WebAssembly.Instance(compiled, importsOf(this.memory, scenario.free)).exports;
    new Uint8Array(this.memory.buffer, this.at.constants).set(constants);
    this.write("agent", "log_alpha", Math.log(settings.alpha_init));
    this.set(settings);
    this.call("begin", "agent", "plan", "run", BigInt(settings.seed), "constants");
    if (weights) this.take(weights);
  }

  // A view of a record's field.
  field(record, name) {
    const [offset, kind, count] = this.learning.fields[record][name];
    return new KINDS[kind](this.memory.buffer, this.at[record] + offset, count);
  }

  read(record, name) { return Number(this.field(record, name)[0]); }

  write(record, name, value) {
    const field = this.field(record, name);
    field[0] = field instanceof BigInt64Array ? BigInt(value) : value;
  }

  // Arguments: records by name, and numbers.
  call(name, ...given) {
    const places = given.map(each => this.at[each] ?? each), { result } = this.at;
    const status = this.code[name](result, result + 16, ...places);
    if (status !== 0) throw new Error(`The compiled function ${name} failed with status ${status}.`);
  }

  // Set the numbers of the update and of the training: also while it runs, from the next decision on.
  set(settings) {
    Object.assign(this.settings, settings);
    const { rule_p: p, xi_fixed, beta_episodes, ...others } = this.settings;
    const given = { ...others, xi_fixed: xi_fixed ?? NaN, beta_episodes: beta_episodes ?? Infinity,
      log_p: Math.log(p), log_others: Math.log((1 - p) / (this.learning.actions - 1)) };
    for (const record of ["coefficients", "plan"]) {
      for (const name of Object.keys(this.learning.fields[record])) this.write(record, name, Number(given[name]));
    }
  }

  // Learn for about so many milliseconds. First come the demonstrations.
  learn(time) {
    const until = performance.now() + time;
    while (!this.done && performance.now() < until) {
      if (this.demonstrating) this.call("demonstrate", "run", "memory", "coefficients", "plan", "constants", 5n);
      else this.call("advance", "agent", "batch", "coefficients", "work", "plan", "run", "memory", "curves", "constants", 8n);
    }
  }

  get demonstrating() {
    const { beta_start, demonstration_episodes } = this.settings;
    return beta_start > 0 && this.read("run", "demonstrated") < demonstration_episodes;
  }

  get episodes() { return Math.min(this.read("run", "finished"), this.settings.episodes); }
  get done() { return this.episodes >= this.settings.episodes; }

  // Rows of the curves from an episode on: a Float32Array, episodes x names.
  rows(from) {
    const width = this.learning.names.length;
    return this.field("curves", "values").slice(from * width, this.episodes * width);
  }

  // A network's weights and biases one after the other, (inputs, outputs) and (outputs) of each layer, without padding.
  network(name) {
    const place = this.at.agent + this.learning.networks[name];
    return this.learning.layers.flatMap(({ inputs, outputs, weights, padded, biases }) => {
      const matrix = new Float32Array(this.memory.buffer, place + weights, outputs * padded);
      const turned = Array.from({ length: inputs * outputs }, (_, k) => (
        matrix[(k % outputs) * padded + Math.floor(k / outputs)]));
      return [turned, Array.from(new Float32Array(this.memory.buffer, place + biases, outputs))];
    });
  }

  setNetwork(name, parts) {
    const place = this.at.agent + this.learning.networks[name];
    this.learning.layers.forEach(({ inputs, outputs, weights, padded, biases }, layer) => {
      const matrix = new Float32Array(this.memory.buffer, place + weights, outputs * padded);
      for (let k = 0; k < inputs * outputs; k++) {
        matrix[(k % outputs) * padded + Math.floor(k / outputs)] = parts[2 * layer][k];
      }
      new Float32Array(this.memory.buffer, place + biases, outputs).set(parts[2 * layer + 1]);
    });
  }

  // All that `take` needs to begin with these networks.
  give() {
    const networks = Object.keys(this.learning.networks).map(name => [name, this.network(name)]);
    return { networks: Object.fromEntries(networks), log_alpha: this.read("agent", "log_alpha") };
  }

  take({ networks, log_alpha }) {
    for (const [name, parts] of Object.entries(networks)) this.setNetwork(name, parts);
    this.write("agent", "log_alpha", log_alpha);
  }

  // The actor as one row of numbers, as `layersOf` in learner.js takes it.
  actor() { return Float32Array.from(this.network("actor").flat()); }
}

// The worker's own loop.
function serve(port) {
  let trainer, running = false, every = 0, said = 0, shown = -1, reported = 0, seconds = 0;
  const wake = new MessageChannel(); // unlike a timer, it wakes at once
  const say = (kind, more, moved = []) => port.postMessage({ kind, episode: trainer?.episodes, ...more }, moved);

  const report = () => {
    const rows = trainer.rows(said);
    say("curves", { from: said, rows, demonstrated: trainer.read("run", "demonstrated"),
      updates: trainer.read("run", "updates"), decisions: trainer.read("run", "decisions"), seconds }, [rows.buffer]);
    said = trainer.episodes;
    reported = performance.now();
  };
  const show = () => {
    const weights = trainer.actor();
    say("agent", { weights }, [weights.buffer]);
    shown = trainer.episodes;
  };
  const turn = () => {
    if (!running) return;
    const started = performance.now();
    trainer.learn(TURN);
    seconds += (performance.now() - started) / 1000;
    if (!trainer.demonstrating && trainer.episodes >= shown + every) show();
    if (trainer.done || performance.now() > reported + REPORT) report();
    if (trainer.done) {
      if (shown < trainer.episodes) show();
      running = false;
      say("done", { seconds });
    } else wake.port2.postMessage(0);
  };
  const guarded = action => (...given) => {
    try {
      action(...given);
    } catch (error) {
      running = false;
      say("failed", { message: error.message });
    }
  };
  const go = () => {
    if (running) return;
    running = true;
    wake.port2.postMessage(0);
  };
  wake.port1.onmessage = guarded(turn);
  port.onmessage = guarded(({ data: { kind, ...given } }) => {
    if (kind === "start") {
      trainer = new Trainer(given);
      every = given.every;
      go();
    } else if (kind === "set") {
      trainer.set(given.changes);
      say("changed", given);
    } else if (kind === "pause") {
      running = false;
      report();
    } else if (kind === "go" && !trainer.done) go();
    else if (kind === "ask agent") show();
    else if (kind === "ask weights") {
      report();
      say("weights", { weights: trainer.give() });
    }
  });
}

if (typeof DedicatedWorkerGlobalScope !== "undefined") serve(self);
