// The page that shows a world and nothing else: its address, its theme, and `window.trap` for tests.

const element = document.getElementById("world"), data = JSON.parse(document.getElementById("data").textContent);

// The address may choose road, ghost, driver, pace, futures and view; what it asks for in vain is answered.
function readAddress(game) {
  const { wanted, faults } = askedFor(location.hash.slice(1), Object.keys(game.drivers), game.state);
  const lost = game.open(wanted);
  if (faults.length || lost) game.announce([...faults, lost].join(" "));
}

// The address says what is shown, so that it can be passed on.
function remember({ road, ghost, driver, view }) {
  const driving = driver === "you" ? "" : `&driver=${driver}`;
  history.replaceState(null, "", `#road=${road}&ghost=${ghost}${driving}${view === "3d" ? "&view=3d" : ""}`);
}

element.addEventListener("theme", ({ detail }) => { document.documentElement.dataset.theme = detail; });
mount(element, data, { details: true, page: true, keys: document }).then(game => {
  document.getElementById("theme").addEventListener("click", () => game.toggleTheme());
  readAddress(game);
  remember(game.state);
  element.addEventListener("shown", () => remember(game.state));
  window.addEventListener("hashchange", () => readAddress(game));
  const { compiled, networks, find } = game;
  window.trap = { data, compiled, networks, game, find, ready: performance.now() }; // ms since the page was opened
});
