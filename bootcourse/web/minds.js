// What a driver computes before it acts: networks, probabilities, and the soft constraint's formulas. In Python they
// stand in bootcourse/learn/networks.py, rule.py and learn/bootstrap.py.

// Compressed text to bytes: see `packed` in build.py.
async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The layers of a network, [{ inputs, outputs, weights, biases }]; the numbers come sorted by bytes, the last byte first.
async function unpackNetwork({ sizes, weights }) {
  const planes = await unpack(weights);
  const count = sizes.slice(1).reduce((sum, outputs, i) => sum + (sizes[i] + 1) * outputs, 0);
  const kept = planes.length / count, bytes = new Uint8Array(4 * count);
  for (let k = 0; k < kept; k++)
    for (let i = 0; i < count; i++) bytes[4 * i + 4 - kept + k] = planes[k * count + i];
  const numbers = new Float32Array(bytes.buffer);
  let place = 0;
  const take = size => numbers.subarray(place, (place += size));
  return sizes.slice(1).map((outputs, i) => (
    { inputs: sizes[i], outputs, weights: take(sizes[i] * outputs), biases: take(outputs) }));
}

// The outputs of a network, with ReLU between the layers.
function forward(layers, input) {
  let values = input;
  layers.forEach(({ inputs, outputs, weights, biases }, layer) => {
    const sums = Float64Array.from(biases);
    for (let i = 0; i < inputs; i++) {
      const value = values[i];
      if (value !== 0) for (let k = 0; k < outputs; k++) sums[k] += value * weights[i * outputs + k];
    }
    values = layer < layers.length - 1 ? sums.map(value => Math.max(value, 0)) : sums;
  });
  return values;
}

function softmax(values) {
  const highest = Math.max(...values), powers = Array.from(values, value => Math.exp(value - highest));
  const total = powers.reduce((sum, value) => sum + value, 0);
  return powers.map(value => value / total);
}

const largest = values => values.indexOf(Math.max(...values));

// π̃(a|s), Equation 16: p for the rule's action, (1 - p) / 8 for each other.
const stochasticRule = (action, p) =>
  Array.from({ length: ACTIONS }, (_, a) => (a === action ? p : (1 - p) / (ACTIONS - 1)));

// What each action adds to KL(π ‖ π̃), Equation 15, in nats.
const klShares = (policy, rule) => policy.map((pi, a) => (pi > 0 ? pi * Math.log(pi / rule[a]) : 0));

// softmax((Q + ξ log π̃) / (α + ξ)): the policy that is best for Q, the entropy and the KL together.
const regularisedPolicy = (q, rule, alpha, xi) =>
  softmax(q.map((value, a) => (value + xi * Math.log(rule[a])) / (alpha + xi)));
