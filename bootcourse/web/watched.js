// A training that is watched in a notebook: its curves, which Python draws (panels/watch.py), beside the road on which
// the present agent drives. All agents that came so far are kept here, so a click on the curves finds the one of that
// moment, also while Python is busy.

const histories = new Map(); // of each training: [what Python told of the watched agent, ...], the oldest first
const MOST = 400; // agents of a training that are kept: of more, every second one goes
const BEFORE = 500; // updates between the agent at the wheel and its older self

class Watched {
  // chosen(): called when somebody has clicked on an agent; set it.
  constructor(model, el, host) {
    Object.assign(this, { model, wheel: null, chosen: () => {}, id: model.get("opens").training });
    const make = (kind, style, ...inside) => {
      const made = document.createElement(kind);
      made.style.cssText = style;
      made.append(...inside);
      return made;
    };
    this.stop = make("button", "margin-right: 12px; padding: 4px 10px; cursor: pointer", "Stop, and keep what was learned");
    this.words = make("span", "");
    this.chart = make("div", "cursor: pointer");
    host.style.cssText += "flex: 1 1 360px; min-width: 0";
    const line = make("p", "font: 13px system-ui, sans-serif; margin: 4px 12px", this.stop, this.words);
    const curves = make("div", "flex: 1 1 440px; max-width: 600px", line, this.chart);
    el.append(make("div", "display: flex; flex-flow: row wrap; gap: 8px 16px", curves, host)); // a box takes el's own style
    // The kernel is busy with the training and hears no message, but it can be interrupted: the training ends early.
    this.stop.addEventListener("click", () => { model.send({ kind: "stop" }); model.widget_manager.kernel?.interrupt?.(); });
    this.chart.addEventListener("click", event => this.choose(event));
    this.draw = () => this.show();
    this.names.forEach(name => model.on(`change:${name}`, this.draw));
    this.show();
  }

  get names() { return ["chart", "words", "running", "drivers", "reach"]; }

  close() { this.names.forEach(name => this.model.off(`change:${name}`, this.draw)); }

  show() {
    const { model, chart, words, stop } = this;
    chart.innerHTML = model.get("chart");
    chart.firstChild.style.cssText = "width: 100%; height: auto";
    const chosen = this.wheel && `At the wheel, and marked: the agent after ${this.wheel.updates.toLocaleString("en")} updates.`;
    words.textContent = [model.get("words"), chosen].filter(Boolean).join(" · ");
    this.mark();
    stop.hidden = !(model.get("running") && model.get("opens").button);
  }

  // The agents so far, the present one last.
  get history() {
    const [now] = this.model.get("drivers"), agents = histories.get(this.id) ?? [];
    if (agents.at(-1)?.updates !== now.updates) agents.push(now);
    histories.set(this.id, agents.length > MOST ? agents.filter((_, i) => i % 2 === 0 || i === agents.length - 1) : agents);
    return histories.get(this.id);
  }

  // At the wheel the present agent, or the one that was clicked; as the ghost its older self.
  get pair() {
    const agents = this.history, wheel = this.wheel ?? agents.at(-1);
    const before = agents.findLast(({ updates }) => updates <= wheel.updates - BEFORE) ?? agents[0];
    if (!wheel.network) return [{ ...wheel, id: "now" }]; // it decides in Python, and only as it is now
    const after = ({ updates }) => `after ${updates.toLocaleString("en")} updates`;
    const called = (agent, id, name) => ({ ...agent, id, name, label: name });
    return [called(wheel, "now", this.wheel ? after(wheel) : `now, ${after(wheel)}`), called(before, "before", after(before))];
  }

  // A click left of the curves' end puts the agent of that episode at the wheel, one right of it the present agent.
  choose({ clientX }) {
    const { left, width } = this.chart.firstChild.getBoundingClientRect(), agents = this.history;
    const { first, across, wide } = this.model.get("opens").axis, episodes = this.model.get("reach");
    const x = ((clientX - left) * this.chart.firstChild.viewBox.baseVal.width) / width;
    const episode = ((x - first) % across) / wide * episodes;
    const apart = agent => Math.abs(agent.episodes - episode);
    const nearest = agents.reduce((best, agent) => (apart(agent) < apart(best) ? agent : best));
    this.wheel = episode > agents.at(-1).episodes ? null : nearest;
    this.show();
    this.chosen();
  }

  // A line at the chosen agent's episode, in each of the four charts.
  mark() {
    if (!this.wheel) return;
    const { first, across, wide, top, down, high } = this.model.get("opens").axis, svg = this.chart.firstChild;
    for (const [column, row] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
      const x = first + column * across + wide * this.wheel.episodes / this.model.get("reach"), y = top + row * down;
      const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
      for (const [name, value] of Object.entries({ x1: x, x2: x, y1: y, y2: y + high, stroke: "currentColor" })) {
        line.setAttribute(name, value);
      }
      svg.append(line);
    }
  }
}
