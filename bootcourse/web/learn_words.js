// What the curves of agents that learn say, in words for somebody who has not heard of reinforcement learning.

const RECENT = 100, WINDOW = 50; // drives
const NUMBERS = ["none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];

const share = (values, from, to) => values.slice(from, to).reduce((sum, value) => sum + value, 0) / Math.max(to - from, 1);

// What an agent has come to: { found, recent, driven, drives }. found: the drive that ends the first 50 in a row of which
// more than half got out, or null; recent: how many of its last 100 drives got out; driven: of how many, if it has fewer.
function progressOf({ curves }) {
  const { success } = curves, drives = success.length, driven = Math.min(drives, RECENT);
  let found = null, sum = 0;
  success.forEach((out, i) => {
    sum += out - (i >= WINDOW ? success[i - WINDOW] : 0);
    if (found === null && i >= WINDOW - 1 && sum > WINDOW / 2) found = i + 1;
  });
  return { found, driven, drives, recent: Math.round(share(success, drives - driven, drives) * driven) };
}

const inWords = n => NUMBERS[n] ?? String(n);
const counted = (n, of) => (n === of && n === 2 ? "both" : n === of && n > 2 ? `all ${inWords(n)}` : `${inWords(n)} of ${inWords(of)}`);

// One or two sentences about some agents.
function storyOf(learners) {
  const all = learners.map(progressOf), n = all.length, driven = Math.max(...all.map(({ drives }) => drives));
  const showing = learners.find(({ progress, settings }) => settings.beta_start > 0
    && (progress.demonstrated ?? 0) < settings.demonstration_episodes);
  if (driven === 0 && showing) {
    return `The rule drives first, to show how: ${showing.progress.demonstrated ?? 0} of ${showing.settings.demonstration_episodes} drives.`;
  }
  if (driven < WINDOW) return `Their first drives: they try actions at random, and most drives end in an accident.`;
  const finders = all.filter(({ found }) => found !== null);
  const recents = each => listed(each.map(({ recent }) => String(recent)), "and");
  const last = Math.min(...all.map(({ driven: last }) => last));
  if (!finders.length) {
    const some = all.some(({ recent }) => recent > 0);
    return `After ${driven} drives ${counted(0, n)} agents has found a way out. `
      + (some ? `In their last ${last} drives they got out ${recents(all)} times.` : "They stay behind the slow cars, or have an accident.");
  }
  const lost = finders.filter(({ recent, driven: of }) => recent < of / 2), kept = finders.length - lost.length;
  const first = Math.min(...finders.map(({ found }) => found));
  const beginning = `${capital(counted(finders.length, n))} agents ${finders.length === 1 ? "has" : "have"} found a way out, `
    + `${finders.length === 1 ? "" : "the first "}after ${first} drives. `;
  const holding = kept ? `${lost.length ? `${capital(inWords(kept))} of these` : finders.length === 1 ? "It" : "They"} `
    + `got out on ${recents(finders.filter(each => !lost.includes(each)))} of the last ${RECENT} roads. ` : "";
  const losing = lost.length ? `${lost.length === 1 ? "One forgets" : `${capital(inWords(lost.length))} forget`} it again: `
    + `${recents(lost)} of the last ${RECENT}.` : "";
  return beginning + holding + losing;
}

// Of several methods, how many agents of each have found a way out.
function finders(groups) {
  const each = groups.map(({ name, agents, learners }) => {
    const k = learners.filter(learner => progressOf(learner).found !== null).length;
    return `${name}: ${inWords(k)} of ${inWords(agents.length)}`;
  });
  return `Agents that have found a way out so far. ${capital(each.join("; "))}.`;
}
