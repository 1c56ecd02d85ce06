// A world in a notebook: what widget.py asks for is shown, and what is driven is told to it.

// JupyterLab and Notebook say whether they are light, VS Code and Colab too; else the system's theme is taken.
function notebookTheme() {
  const { body, documentElement: page } = document, light = body.dataset.jpThemeLight;
  if (light) return light === "true" ? "light" : "dark";
  if (/vscode-(dark|high-contrast)/.test(body.className) || page.getAttribute("theme") === "dark") return "dark";
  return /vscode-light/.test(body.className) ? "light" : undefined;
}

const seen = new Set(); // trainings whose card has been brought onto the screen

async function show({ model, el, signal }) {
  const host = document.createElement("div"), waiting = new Map(), own = Math.random().toString(36).slice(2);
  host.setAttribute("data-lm-suppress-shortcuts", "true"); // the notebook's shortcuts rest while the focus is in here
  host.style.setProperty("--high", `${model.get("opens").height}px`);
  el.append(host);
  const watched = model.get("opens").watch && new Watched(model, el, host);

  // A driver in Python: one message a decision.
  const ask = driver => drive => new Promise(answer => {
    const number = `${own} ${waiting.size}`;
    waiting.set(number, answer);
    model.send({ kind: "ask", number, driver, time: drive.time, cars: [...drive.cars] });
  });
  if (watched && model.get("running") && !seen.has(watched.id)) { // what is worth a look may begin below the screen
    seen.add(watched.id);
    setTimeout(() => {
      const whole = el.closest(".bc-panel") ?? el, screen = el.closest(".jp-WindowedPanel-outer")?.clientHeight ?? innerHeight;
      if (whole === el || whole.offsetHeight <= screen) whole.scrollIntoView({ block: "nearest" }); // with its sliders
    }, 500);
  }
  const drivers = () => (watched ? watched.pair : model.get("drivers"));
  const guests = () => drivers().map(each => (each.network || each.plan ? each : { ...each, ask: ask(each.id) }));
  const game = await mount(host, DATA, { ...model.get("opens"), drivers: guests(), theme: notebookTheme() });

  const told = over => {
    const { drive: { actions }, driverName: driver = "you", number: road, begun } = game;
    model.send({ kind: "driven", drive: `${own} ${begun}`, road, driver, actions, over });
  };
  if (!watched) { // a training has other things to do than to follow its agents' drives
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
  if (watched) watched.chosen = async () => { // who was clicked drives from the start, each on the same road
    await offered();
    game.open({ road: model.get("opens").road, run: true });
  };
  const opened = () => { game.open(model.get("opens")); };
  const themed = new MutationObserver(() => game.theme(notebookTheme() ?? host.dataset.theme));
  themed.observe(document.body, { attributes: true, attributeFilter: ["data-jp-theme-light", "class"] });
  model.on("msg:custom", answered);
  model.on("change:drivers", offered);
  model.on("change:opens", opened);
  return () => {
    themed.disconnect();
    if (watched) watched.close();
    for (const [name, handler] of [["msg:custom", answered], ["change:drivers", offered], ["change:opens", opened]]) {
      model.off(name, handler);
    }
    game.close();
  };
}
