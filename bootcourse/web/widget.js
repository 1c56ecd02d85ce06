// A world in a notebook: what widget.py asks for is shown, and what is driven is told to it.

// JupyterLab and Notebook say whether they are light, VS Code and Colab too; else the system's theme is taken.
function notebookTheme() {
  const { body, documentElement: page } = document, light = body.dataset.jpThemeLight;
  if (light) return light === "true" ? "light" : "dark";
  if (/vscode-(dark|high-contrast)/.test(body.className) || page.getAttribute("theme") === "dark") return "dark";
  return /vscode-light/.test(body.className) ? "light" : undefined;
}

// The curves of a training beside the road: see panels/watch.py, which draws them.
function besideCurves(model, el, host) {
  const curves = document.createElement("div"), chart = document.createElement("div"), line = document.createElement("p");
  const stop = document.createElement("button"), words = document.createElement("span");
  el.style.cssText = "display: flex; flex-wrap: wrap; gap: 8px 16px";
  curves.style.cssText = "flex: 1 1 440px; max-width: 600px; cursor: pointer";
  host.style.cssText += "flex: 1 1 360px";
  line.style.cssText = "font: 13px system-ui, sans-serif; margin: 4px 12px";
  stop.textContent = "Stop, and keep what was learned";
  stop.style.marginRight = "12px";
  line.append(stop, words);
  curves.append(line, chart);
  el.prepend(curves);
  const draw = () => {
    chart.innerHTML = model.get("chart");
    chart.firstChild.style.cssText = "width: 100%; height: auto";
    words.textContent = model.get("words");
    stop.hidden = !(model.get("running") && model.get("opens").stop);
  };
  stop.addEventListener("click", () => model.send({ kind: "stop" }));
  chart.addEventListener("click", ({ clientX }) => {
    const { left, width } = chart.firstChild.getBoundingClientRect();
    model.send({ kind: "choose", x: ((clientX - left) * chart.firstChild.viewBox.baseVal.width) / width });
  });
  for (const name of ["chart", "words", "running"]) model.on(`change:${name}`, draw);
  draw();
  return () => { for (const name of ["chart", "words", "running"]) model.off(`change:${name}`, draw); };
}

async function show({ model, el, signal }) {
  const host = document.createElement("div"), waiting = new Map(), own = Math.random().toString(36).slice(2);
  host.setAttribute("data-lm-suppress-shortcuts", "true"); // the notebook's shortcuts rest while the focus is in here
  host.style.setProperty("--high", `${model.get("opens").height}px`);
  el.append(host);
  const unwatched = model.get("opens").watch ? besideCurves(model, el, host) : () => {};

  // A driver in Python: one message a decision.
  const ask = driver => drive => new Promise(answer => {
    const number = `${own} ${waiting.size}`;
    waiting.set(number, answer);
    model.send({ kind: "ask", number, driver, time: drive.time, cars: [...drive.cars] });
  });
  const guests = () => model.get("drivers").map(each => (each.network || each.plan ? each : { ...each, ask: ask(each.id) }));
  const game = await mount(host, DATA, { ...model.get("opens"), drivers: guests(), theme: notebookTheme() });

  const told = over => {
    const { drive: { actions }, driverName: driver = "you", number: road, begun } = game;
    model.send({ kind: "driven", drive: `${own} ${begun}`, road, driver, actions, over });
  };
  if (!model.get("opens").watch) { // a training has other things to do than to follow its agents' drives
    host.addEventListener("decided", () => told(false));
    host.addEventListener("ended", () => told(true));
  }
  const answered = message => {
    if (message.kind !== "answer" || !waiting.has(message.number)) return;
    if (message.thought) return waiting.get(message.number)(message.thought);
    game.run(false);
    game.announce(message.error);
  };
  const offered = async () => game.offer(...await Promise.all(guests().map(guest)));
  const opened = () => { game.open(model.get("opens")); };
  const themed = new MutationObserver(() => game.theme(notebookTheme() ?? host.dataset.theme));
  themed.observe(document.body, { attributes: true, attributeFilter: ["data-jp-theme-light", "class"] });
  model.on("msg:custom", answered);
  model.on("change:drivers", offered);
  model.on("change:opens", opened);
  return () => {
    themed.disconnect();
    unwatched();
    for (const [name, handler] of [["msg:custom", answered], ["change:drivers", offered], ["change:opens", opened]]) {
      model.off(name, handler);
    }
    game.close();
  };
}
