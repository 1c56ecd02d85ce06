// Who can drive. Each driver has a name, a colour, a sentence, and decide(road, cars, drive) -> { action, policy, q }.

function makeDrivers(data, networks, settings) {
  const agent = name => byNetwork(networks[name]);
  const rule = (road, cars) => {
    const { action } = road.rule(cars);
    return { action, policy: stochasticRule(action, settings.p) };
  };
  const compromise = (road, cars) => {
    const taught = road.rule(cars).action, seen = road.observe(cars).slice();
    const [one, other] = [forward(networks["critic 0"], seen), forward(networks["critic 1"], seen)];
    const q = Array.from(one, (value, a) => Math.min(value, other[a]) + (a === taught ? settings.c : 0));
    const policy = regularisedPolicy(q, stochasticRule(taught, settings.p), data.alpha, settings.xi);
    return { action: largest(policy), policy, q };
  };
  const lookAhead = (road, cars) => {
    const futures = imagine(road, cars, agent("ppo"), data.worth);
    const q = futures.map(future => future.value), action = largest(q);
    return { action, policy: agent("ppo")(road, cars).policy, q, futures };
  };
  const { roads } = data.results;
  const result = name => {
    const { out, accidents, mean } = data.results[name];
    return `On roads 0 to ${roads - 1} it gets out ${out} times and has ${accidents} accidents; it earns ${points(mean)}.`;
  };
  // name: in the lists; label: in pictures and sentences; measured: its name in build.py
  const driver = (name, label, colour, words, decide, measured) => ({
    name, label, colour: data.colours[colour], words: measured ? `${words} ${result(measured)}` : words, decide });
  const drivers = {
    rule: driver("the rule", "the rule", "rule", "Written by hand, in one page of code.", rule, "rule"),
    sac: driver("plain SAC", "plain SAC", "sac", "Learned from reward alone.", agent("sac"), "sac"),
    escaping: driver("bootstrapped, gets out", "the bootstrapped agent", "bootstrapped",
      "SAC with the rule’s help: the paper’s method.", agent("bootstrapped"), "bootstrapped"),
    crashing: driver("bootstrapped, crashes", "the other bootstrapped agent", "bootstrapped",
      "The same method with another seed.", agent("crashing"), "crashing"),
    ppo: driver("PPO after cloning", "PPO", "ppo", "It imitated the rule, and then learned by PPO.", agent("ppo"), "ppo"),
    lookahead: driver("look-ahead", "the look-ahead", "ppo",
      "At each decision it imagines nine drives of ten seconds by PPO, and takes the best.", lookAhead),
    soft: driver("the compromise", "the compromise", "soft",
      "It drives by plain SAC’s Q and the rule, with your p, ξ and c: see the sliders.", compromise),
  };
  for (const [id, each] of Object.entries(drivers)) each.id = id;
  return drivers;
}

// An agent: it does what its network finds most probable.
const byNetwork = layers => (road, cars) => {
  const policy = softmax(forward(layers, road.observe(cars)));
  return { action: largest(policy), policy };
};

// A driver that comes from elsewhere, { id, name, label, colour, words } with one of: network, as `packed_network` in
// build.py makes it; plan, its actions; ask(drive), which promises { action, policy, q } for the drive as it is.
async function guest({ network, plan, ask, ...driver }) {
  if (network) return { ...driver, decide: byNetwork(await unpackNetwork(network)) };
  if (plan) return { ...driver, elsewhere: true, decide: (road, cars, drive) => ({ action: plan[drive.time] ?? IDLE }) };
  return { ...driver, elsewhere: true, decide: (road, cars, drive) => ask(drive) };
}

// Nine imagined drives: each action, then a base policy. As in bootcourse/episodes/lookahead.py, the value is what the
// drive earns, and without an accident the worth of an empty road at its last speed.
function imagine(road, cars, base, worth, horizon = HORIZON) {
  return Array.from({ length: ACTIONS }, (_, first) => {
    const state = cars.slice(), path = [[state[X], state[Y]]];
    let earned = 0, accident = 0;
    for (let k = 0; k < horizon && !accident; k++) {
      const outcome = road.decide(state, k ? base(road, state).action : first);
      for (let i = 0; i < road.trace.length; i += state.length) path.push([road.trace[i + X], road.trace[i + Y]]);
      earned += outcome.reward;
      accident = outcome.accident;
    }
    return { path, earned, accident, value: earned + (accident ? 0 : worthOf(state[SPEED], worth)) };
  });
}

function worthOf(speed, { speed: grid, values }) {
  const place = Math.min(Math.max(speed / grid, 0), values.length - 1);
  const k = Math.min(Math.floor(place), values.length - 2);
  return values[k] + (values[k + 1] - values[k]) * (place - k);
}
