// An agent that learned in the page as one file: safetensors with the actor, critics, targets, log α and curves, and with
// its settings as text. Python reads it by `load_run`: see bootcourse/storage/page_run.py.

const RUN_FORMAT = "bootcourse page run 1";

// shapes and numbers of all tensors, in the library's layout: networks.py.
function tensorsOf(learner, { networks, log_alpha }) {
  const { layers } = learner.learning, tensors = {};
  for (const [name, members] of [["actor", ["actor"]], ["critics", ["critic_1", "critic_2"]],
    ["targets", ["target_1", "target_2"]]]) {
    layers.forEach(({ inputs, outputs }, layer) => [inputs, 1].forEach((rows, part) => {
      const values = members.flatMap(member => networks[member][2 * layer + part]);
      tensors[`${name}.${2 * layer + part}`] = { shape: [members.length, rows, outputs], values };
    }));
  }
  tensors.log_alpha = { shape: [1], values: [log_alpha] };
  for (const [name, values] of Object.entries(learner.curves)) {
    tensors[`curves.${name}`] = { shape: [values.length], values };
  }
  return tensors;
}

function runFile(learner, weights) {
  if (learner.episode === 0) throw new Error("No episode has ended yet: let the agent learn first.");
  const { episodes, ...settings } = learner.begun, { learning, marks, progress } = learner;
  const config = { format: "bootcourse run 1", settings, scenario: learning.scenario, episodes: learner.episode,
    alpha: Math.exp(weights.log_alpha), environment: learning.environment };
  const provenance = { seed: settings.seed, seconds: progress.seconds ?? 0, updates: progress.updates ?? 0, marks,
    browser: navigator.userAgent, created: new Date().toISOString() };
  const metadata = { format: RUN_FORMAT, config: JSON.stringify(config), provenance: JSON.stringify(provenance) };
  return writeSafetensors(tensorsOf(learner, weights), metadata);
}

// https://github.com/huggingface/safetensors: the header's length in eight bytes, a header of JSON, the numbers.
function writeSafetensors(tensors, metadata) {
  let end = 0;
  const entries = Object.entries(tensors).map(([name, { shape, values }]) => (
    [name, { dtype: "F32", shape, data_offsets: [end, (end += 4 * values.length)] }]));
  const plain = JSON.stringify({ __metadata__: metadata, ...Object.fromEntries(entries) });
  const encoded = new TextEncoder().encode(plain);
  const header = new Uint8Array(Math.ceil(encoded.length / 8) * 8).fill(32); // padded with spaces
  header.set(encoded);
  const file = new Uint8Array(8 + header.length + end), view = new DataView(file.buffer);
  view.setBigUint64(0, BigInt(header.length), true);
  file.set(header, 8);
  let place = 8 + header.length;
  for (const { values } of Object.values(tensors)) {
    for (const value of values) {
      view.setFloat32(place, value, true);
      place += 4;
    }
  }
  return file;
}

// The tensors and the metadata of a file of float32. Throws an Error if it is none.
function readSafetensors(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = bytes.length > 8 ? Number(view.getBigUint64(0, true)) : Infinity;
  if (length > bytes.length - 8) throw new Error("This is not a file of safetensors, or it is cut off.");
  const { __metadata__: metadata = {}, ...entries } = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
  const tensors = Object.fromEntries(Object.entries(entries).map(([name, { dtype, shape, data_offsets: [from, to] }]) => {
    const size = shape.reduce((product, side) => product * side, 1);
    if (dtype !== "F32" || to - from !== 4 * size || 8 + length + to > bytes.length) {
      throw new Error(`The tensor “${name}” is damaged, or not of float32.`);
    }
    const start = 8 + length + from, number = (_, i) => view.getFloat32(start + 4 * i, true);
    return [name, { shape, values: Float32Array.from({ length: size }, number) }];
  }));
  return { tensors, metadata };
}

// What a file of this page holds: { settings, episodes, layers, weights, curves, provenance }. layers drive (see `forward`
// in minds.js), weights begin a `Learner`. Of the library's own weights.safetensors it holds { layers } alone.
// Throws an Error with a sentence for another file.
function readRun(learning, bytes) {
  const { tensors, metadata } = readSafetensors(bytes);
  const part = (name, member, rows, outputs) => {
    const tensor = tensors[name], size = rows * outputs;
    if (!tensor || tensor.shape.slice(1).join() !== `${rows},${outputs}` || tensor.values.length < (member + 1) * size) {
      throw new Error(`The file has no ${name} of this page’s shape: it is of another kind of agent.`);
    }
    return tensor.values.slice(member * size, (member + 1) * size);
  };
  const parts = (name, member) => learning.layers.flatMap(({ inputs, outputs }, layer) => (
    [inputs, 1].map((rows, k) => part(`${name}.${2 * layer + k}`, member, rows, outputs))));
  const actor = parts("actor", 0), layers = layersOf(learning, Float32Array.from(actor.flatMap(part => [...part])));
  if (metadata.format !== RUN_FORMAT) return { layers };
  const [critic_1, critic_2, target_1, target_2] = [0, 1, 2, 3].map(k => parts(k < 2 ? "critics" : "targets", k % 2));
  const curves = Object.fromEntries(learning.names.map(name => [name, [...(tensors[`curves.${name}`]?.values ?? [])]]));
  const { settings, episodes } = JSON.parse(metadata.config);
  const weights = { networks: { actor, critic_1, critic_2, target_1, target_2 }, log_alpha: tensors.log_alpha.values[0] };
  return { settings, episodes, layers, weights, curves, provenance: JSON.parse(metadata.provenance) };
}
