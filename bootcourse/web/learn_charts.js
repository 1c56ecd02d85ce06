// Curves that grow: small charts of the agents' drives, each agent a thin line, dashed for the one on the road, and their
// mean a thick one.

const POINTS = 140; // of a line, at most
const PLOT = { left: 56, right: 10, top: 28, bottom: 24 }; // px
const MEASURES = {
  success: { title: "gets out of the trap, %", factor: 100, range: [0, 100], mean: true, marks: [0, 50, 100] },
  return: { title: "return of a drive", factor: 1, mean: true },
  accident: { title: "accidents, %", factor: 100, range: [0, 100], mean: true, marks: [0, 50, 100], of: value => Number(value > 0) },
  entropy: { title: "entropy, nats", factor: 1, range: [0, 2.2], marks: [0, 1, 2] },
  xi: { title: "ξ (logarithmic)", factor: 1, log: true },
};

// The points of an agent's line, [[episode, value]]: means of the last 50 drives, or single values.
function line({ curves }, name) {
  const { mean, factor, of = value => value } = MEASURES[name], values = curves[name], last = values.length;
  const step = Math.max(1, Math.ceil(last / POINTS)), spots = [];
  let sum = 0;
  for (let i = 0; i < last; i++) {
    sum += of(values[i]) - (i >= WINDOW ? of(values[i - WINDOW]) : 0);
    if ((i + 1) % step && i + 1 < last) continue;
    spots.push([i + 1, factor * (mean ? sum / Math.min(i + 1, WINDOW) : of(values[i]))]);
  }
  return spots;
}

// The mean of some agents' lines, as far as each of them has come.
function meanLine(learners, name) {
  const last = Math.min(...learners.map(({ curves }) => curves[name].length));
  const short = learners.map(({ curves }) => ({ curves: { [name]: curves[name].slice(0, last) } }));
  const lines = short.map(each => line(each, name));
  return lines[0].map(([episode], i) => [episode, lines.reduce((sum, each) => sum + each[i][1], 0) / lines.length]);
}

class Charts {
  // chosen(learner, episode): somebody clicked on a line.
  constructor(element, chosen) {
    Object.assign(this, { element, chosen, scales: {} });
    for (const name of Object.keys(MEASURES)) {
      const figure = document.createElement("figure");
      figure.dataset.measure = name;
      figure.addEventListener("click", event => this.click(name, event));
      element.append(figure);
    }
    this.draw([], { episodes: 100 });
  }

  // groups: [{ name, colour, learners }]; episodes: of each agent; pointed: { learner, episode } of the agent on the road;
  // level: the return of somebody who follows the slow cars.
  draw(groups, { episodes, pointed = {}, level = null }) {
    this.episodes = episodes;
    for (const figure of this.element.children) figure.innerHTML = this.chart(figure, groups, pointed, level);
  }

  chart(figure, groups, pointed, level) {
    const name = figure.dataset.measure, { title, range, marks, log } = MEASURES[name];
    const wide = Math.max(figure.clientWidth, 200), high = name === "success" ? 170 : 118;
    const lines = groups.flatMap(({ colour, learners }) => learners.map(learner => ({ colour, learner, spots: line(learner, name) })));
    const values = lines.flatMap(({ spots }) => spots.map(([, value]) => value)).filter(value => !log || value > 0);
    const [low, top] = range ?? (log ? logRange(values) : [Math.min(0, ...values), Math.max(30, ...values)]);
    const across = episode => PLOT.left + ((wide - PLOT.left - PLOT.right) * episode) / this.episodes;
    const part = log ? value => Math.log(Math.max(value, low) / low) / Math.log(top / low) : value => (value - low) / (top - low);
    const down = value => PLOT.top + high * (1 - part(value));
    this.scales[name] = { across, down, lines, wide };
    const ticks = marks ?? (log ? [low, top] : [Math.round(low), 0, Math.round(top)].filter((value, i, all) => all.indexOf(value) === i));
    const grid = ticks.map(value => `<path d="M${PLOT.left} ${down(value)}H${wide - PLOT.right}" stroke="var(--line)"/>`
      + `<text x="${PLOT.left - 6}" y="${down(value) + 4}" text-anchor="end">${signed(value)}</text>`).join("");
    const path = spots => spots.map(([episode, value]) => `${across(episode).toFixed(1)},${down(value).toFixed(1)}`).join(" ");
    const thin = lines.map(({ colour, learner, spots }) => (`<polyline points="${path(spots)}" fill="none" stroke="${colour}" `
      + (learner === pointed.learner ? 'stroke-width="1.8" stroke-dasharray="5 3"/>' : 'stroke-width="0.9" opacity="0.65"/>'))).join("");
    const thick = groups.filter(({ learners }) => learners.length > 1 && learners.every(({ curves }) => curves[name].length))
      .map(({ colour, learners }) => `<polyline points="${path(meanLine(learners, name))}" fill="none" stroke="${colour}" stroke-width="2.6"/>`);
    const changed = (pointed.learner?.marks ?? []).map(({ episode, changes }) => {
      const x = across(Math.min(episode, this.episodes)), words = name === "success" ? inSymbols(changes) : "";
      return `<path d="M${x} ${PLOT.top}v${high}" stroke="var(--edge)" stroke-dasharray="3 3"/><text x="${x + 3}" y="${PLOT.top + 11}">${words}</text>`;
    }).join("");
    const moment = pointed.episode ? `<path d="M${across(pointed.episode)} ${PLOT.top}v${high}" stroke="var(--you)" stroke-width="1.5"/>` : "";
    const staying = name === "return" && level !== null
      ? `<path d="M${PLOT.left} ${down(level)}H${wide - PLOT.right}" stroke="var(--trap)" stroke-dasharray="5 4"/>`
        + `<text x="${wide - PLOT.right}" y="${down(level) - 4}" text-anchor="end">follows the slow cars</text>` : "";
    const ends = [0, this.episodes].map(episode => (
      `<text x="${across(episode)}" y="${PLOT.top + high + 16}" text-anchor="${episode ? "end" : "start"}">${episode ? `${episode} drives` : 0}</text>`));
    const said = lines.map(({ spots }) => (spots.length ? `${spots.at(-1)[1].toPrecision(3)}` : "nothing yet")).join(", ");
    return `<svg viewBox="0 0 ${wide} ${PLOT.top + high + PLOT.bottom}" role="img" aria-label="${title}, now: ${said || "nothing yet"}">`
      + `<text class="title" x="0" y="12">${title}</text>${grid}${staying}${thin}${thick.join("")}${changed}${moment}${ends.join("")}</svg>`;
  }

  // The line nearest to a click.
  click(name, { clientX, clientY, currentTarget }) {
    const box = currentTarget.getBoundingClientRect(), { across, down, lines, wide } = this.scales[name];
    const scale = box.width / wide, x = (clientX - box.left) / scale, y = (clientY - box.top) / scale;
    const nearest = lines.filter(({ spots }) => spots.length).map(({ learner, spots }) => {
      const spot = spots.reduce((best, each) => (Math.abs(across(each[0]) - x) < Math.abs(across(best[0]) - x) ? each : best));
      return { learner, episode: spot[0], far: Math.abs(down(spot[1]) - y) + Math.abs(across(spot[0]) - x) };
    }).sort((a, b) => a.far - b.far)[0];
    if (nearest) this.chosen(nearest.learner, nearest.episode);
  }
}

const signed = value => (Math.abs(value) >= 1 || value === 0 ? String(value) : value.toPrecision(1)).replace("-", "−");

// The powers of ten around some values.
function logRange(values) {
  const low = Math.min(0.01, ...values), high = Math.max(1, ...values);
  return [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high))];
}

// Changed settings, as in "ξ = 0 α, p = 0.5".
function inSymbols(changes) {
  return Object.entries(changes).filter(([, value]) => value !== null).map(([name, value]) => {
    const dial = DIALS.find(({ setting }) => setting === name);
    return `${dial?.symbol ?? name} = ${dial ? dial.words(value) : value}`;
  }).join(", ");
}
