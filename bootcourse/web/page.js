// The page that shows a world, and beside it agents that learn: its address, its theme, and `window.trap` for tests.

const element = document.getElementById("world"), data = JSON.parse(document.getElementById("data").textContent);
const LEADS = { drive: document.getElementById("lead").textContent,
  learn: "Agents learn to leave the trap, in this page, while you watch." };

// Show the world in which one drives, or the agents that learn.
function turnTo(game, view, what) {
  const learning = what === "learn";
  document.getElementById("learn").hidden = !learning;
  element.hidden = learning;
  document.body.classList.toggle("learning", learning);
  for (const each of ["drive", "learn"]) document.getElementById(`to-${each}`).setAttribute("aria-pressed", each === what);
  document.getElementById("lead").textContent = LEADS[what];
  game.run(false);
  if (learning) view.show();
  else {
    view.watch?.run(false);
    game.fit();
  }
}

// The address may choose road, ghost, driver, pace, futures and view, or with what agents learn; what it asks for in
// vain is answered.
function readAddress(game, view) {
  const text = location.hash.slice(1), learning = text.startsWith("learn");
  turnTo(game, view, learning ? "learn" : "drive");
  if (learning) return view.open(text);
  const { wanted, faults } = askedFor(text, Object.keys(game.drivers), game.state);
  const lost = game.open(wanted);
  if (faults.length || lost) game.announce([...faults, lost].join(" "));
}

// The address says what is shown, so that it can be passed on.
function remember({ road, ghost, driver, view }) {
  const driving = driver === "you" ? "" : `&driver=${driver}`;
  history.replaceState(null, "", `#road=${road}&ghost=${ghost}${driving}${view === "3d" ? "&view=3d" : ""}`);
}

element.addEventListener("theme", ({ detail }) => { document.documentElement.dataset.theme = detail; });
// Within another page, such as a lesson's, it shows the road alone: lessons explain later what a driver thinks.
mount(element, data, { details: window === window.top, page: true, keys: document }).then(game => {
  const { compiled, networks, find } = game, view = new LearnView(game, () => turnTo(game, view, "drive"));
  document.getElementById("theme").addEventListener("click", () => game.toggleTheme());
  element.addEventListener("theme", ({ detail }) => view.watch?.theme(detail));
  document.getElementById("to-drive").addEventListener("click", () => {
    turnTo(game, view, "drive");
    remember(game.state);
  });
  document.getElementById("to-learn").addEventListener("click", () => {
    turnTo(game, view, "learn");
    history.replaceState(null, "", view.address);
  });
  window.addEventListener("keydown", event => { // the keys drive only where the road to drive on is shown
    if (element.hidden) event.stopPropagation();
  }, true);
  readAddress(game, view);
  if (!element.hidden) remember(game.state);
  element.addEventListener("shown", () => { if (!element.hidden) remember(game.state); });
  window.addEventListener("hashchange", () => readAddress(game, view));
  window.trap = { data, compiled, networks, game, find, view,
    learn: (settings, on) => learn({ data, compiled }, settings, on), ready: performance.now() }; // ms since the page was opened
});
