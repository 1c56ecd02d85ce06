// The paper's ablation, live: four methods with three seeds each, and its table beside ours and the paper's.

const FOUR = ["sac", "soft", "demos", "bootstrapped"], SEEDS = 3, ABLATION_DRIVES = 600;
const TESTED = 100; // roads on which each is tested

// The exact 95 % interval (Clopper and Pearson's) of k of n.
function exactInterval(k, n) {
  const choose = j => Array.from({ length: j }, (_, i) => (n - i) / (i + 1)).reduce((product, each) => product * each, 1);
  const atLeast = p => Array.from({ length: n + 1 }, (_, j) => (j >= k ? choose(j) * p ** j * (1 - p) ** (n - j) : 0))
    .reduce((sum, each) => sum + each, 0);
  const atMost = p => 1 - atLeast(p) + choose(k) * p ** k * (1 - p) ** (n - k);
  const solve = grows => { // the p at which a growing function is 0
    let [low, high] = [0, 1];
    for (let i = 0; i < 50; i++) {
      const middle = (low + high) / 2;
      [low, high] = grows(middle) < 0 ? [middle, high] : [low, middle];
    }
    return low;
  };
  return [k === 0 ? 0 : solve(p => atLeast(p) - 0.025), k === n ? 1 : solve(p => 0.025 - atMost(p))];
}

// An agent's drives on roads that it has not trained on, from the road `first` on, by its most probable actions: { success, total }, means.
async function tested(road, first, layers) {
  const driver = { decide: byNetwork(layers) };
  let [out, total] = [0, 0];
  for (let i = 0; i < TESTED; i++) {
    const drive = new Drive(road, first + i).finish(driver);
    out += Number(drive.outAfter !== null);
    total += drive.total;
    if (i % 4 === 3) await new Promise(go => setTimeout(go)); // the picture goes on
  }
  return { success: out / TESTED, total: total / TESTED };
}

// Train and test them, and show the table while it fills. drives: of each agent in training.
function runAblation(view, drives) {
  const { find, data } = view, groups = FOUR.map(method => ({ name: METHOD_WORDS[method][0].split(",")[0], method,
    agents: Array.from({ length: SEEDS }, (_, seed) => ({ method, seed, episodes: drives })) }));
  // One agent of each method first, then the second ones: no method waits for another.
  view.run(groups, null, 0);
  const starts = view.coming, order = Array.from({ length: SEEDS }, (_, seed) => FOUR.map((_, m) => starts[m * SEEDS + seed])).flat();
  view.coming = order;
  for (let i = 0; i < Math.max(1, view.cores); i++) view.next();
  const began = performance.now(), results = new Map(), mine = view.groups;
  const tests = () => [...results.values()].filter(Boolean).length; // those that have ended
  const show = () => {
    find("table").innerHTML = tableOf(data.ablation, drives, mine, results);
    const done = tests(), all = FOUR.length * SEEDS, time = ((performance.now() - began) / 1000).toFixed(0);
    find("ablation-words").textContent = done < all ? `${done} of ${all} agents are trained and tested (${time} s).`
      : `Done in ${time} s. An agent escapes if it gets out on ${100 * data.ablation.escapes} of ${TESTED} roads that it has not seen.`;
    if (done === all) find("learn-live").textContent = find("ablation-words").textContent;
  };
  const look = async () => {
    if (view.groups !== mine) return; // another training has begun
    for (const learner of mine.flatMap(({ learners }) => learners)) {
      if (learner.state !== "done" || results.has(learner)) continue;
      results.set(learner, null);
      results.set(learner, await tested(view.game.road, data.ablation.heldOut, learner.latest.layers));
      learner.stop(); // its memory is free again; it has learned what it is to learn
    }
    show();
    if (tests() < FOUR.length * SEEDS) setTimeout(look, 300);
  };
  show();
  look();
}

const bracket = ([low, high]) => `<small>${(100 * low).toFixed(0)} to ${(100 * high).toFixed(0)} %</small>`;
const ofAll = (k, n) => `${k} of ${n} ${bracket(exactInterval(k, n))}`;

// numbers: { escapes, methods: { method: { ours: { escaped, agents, returns }, paper: { success, returns } } } }.
function tableOf(numbers, drives, groups, results) {
  const rows = groups.map(({ name, method, colour, learners }) => {
    const found = learners.map(learner => results.get(learner)).filter(Boolean), { ours, paper } = numbers.methods[method];
    const mean = found.reduce((sum, { total }) => sum + total, 0) / found.length;
    const mine = !found.length ? ["…", "", ""] : [ofAll(found.filter(({ success }) => success >= numbers.escapes).length, found.length),
      found.map(({ success }) => Math.round(TESTED * success)).join(", "), points(mean)];
    const cells = [...mine, ofAll(ours.escaped, ours.agents), points(ours.returns), `${paper.success} %`, points(paper.returns)];
    return `<tr><th scope="row"><i class="swatch" style="background:${colour}"></i>${name}</th>${cells.map(cell => `<td>${cell}</td>`).join("")}</tr>`;
  });
  const above = [["", 1], [`yours: three, ${drives} drives`, 3], ["ours: ten, 2,000 drives", 2], ["the paper", 2]];
  const heads = ["", "escape (95 %)", `of ${TESTED} roads`, "return", "escape (95 %)", "return", "success", "return"];
  return `<thead><tr>${above.map(([head, wide]) => `<th scope="colgroup" colspan="${wide}">${head}</th>`).join("")}</tr>`
    + `<tr>${heads.map(head => `<th scope="col">${head}</th>`).join("")}</tr></thead><tbody>${rows.join("")}</tbody>`;
}
