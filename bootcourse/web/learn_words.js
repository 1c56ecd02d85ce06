// What the curves of agents that learn say, in words for somebody who has not heard of reinforcement learning.

const WINDOW = 50; // drives, over which the curves are means
const NUMBERS = ["none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
const GETTING_OUT = `got out on more than half of ${WINDOW} drives`;

// What an agent has come to: { drives, found, recent, lost }. found: the drive that ends the first 50 in a row of which
// more than half got out, or null; recent: how many of its last 50 drives got out; lost: whether these are no longer
// more than half, all of them after it had found a way out.
function progressOf({ curves }) {
  const { success } = curves, drives = success.length;
  let found = null, sum = 0;
  success.forEach((out, i) => {
    sum += out - (i >= WINDOW ? success[i - WINDOW] : 0);
    if (found === null && i >= WINDOW - 1 && sum > WINDOW / 2) found = i + 1;
  });
  const lost = found !== null && drives - found >= WINDOW && sum <= WINDOW / 2;
  return { drives, found, recent: sum, lost };
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
  const recents = some => listed(some.map(({ recent }) => String(recent)), "and");
  if (!finders.length) {
    const some = all.some(({ recent }) => recent > 0);
    return `After ${driven} drives ${counted(0, n)} agents has ${GETTING_OUT} yet. `
      + (some ? `In their last ${WINDOW} they got out ${recents(all)} times.` : "They stay behind the slow cars, or have an accident.");
  }
  const [kept, lost] = [false, true].map(is => finders.filter(each => each.lost === is)), one = finders.length === 1;
  const who = some => (some.length < finders.length ? `${capital(inWords(some.length))} of these` : one ? "It" : "They");
  const first = Math.min(...finders.map(({ found }) => found));
  return `${capital(counted(finders.length, n))} agents ${one ? "has" : "have"} ${GETTING_OUT}, ${one ? "" : "the first "}after ${first} drives. `
    + (kept.length ? `${who(kept)} got out on ${recents(kept)} of the last ${WINDOW}. ` : "")
    + (lost.length ? `${who(lost)} no longer ${lost.length === 1 ? "does" : "do"}: ${recents(lost)} of the last ${WINDOW}.` : "");
}

// Of several methods, how many agents of each have got out so often.
function finders(groups) {
  const each = groups.map(({ name, agents, learners }) => {
    const k = learners.filter(learner => progressOf(learner).found !== null).length;
    return `${name}: ${inWords(k)} of ${inWords(agents.length)}`;
  });
  return `Agents that have ${GETTING_OUT} so far. ${capital(each.join("; "))}.`;
}
