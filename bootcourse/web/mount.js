// A world in an element of a page: mount(element, data, options) -> Promise of its Game.

const unpacked = new WeakMap(); // data -> what is made of it once, for all worlds of a page

// The compiled road, the networks and the car, out of the data that build.py writes.
function prepared(data) {
  const prepare = async () => {
    const networks = Object.entries(data.networks).map(async ([name, packed]) => [name, await unpackNetwork(packed)]);
    const { corners, faces, parts } = data.scene;
    data.scene.car = { corners: new Int16Array((await unpack(corners)).buffer),
      faces: new Uint16Array((await unpack(faces)).buffer), colours: parts };
    const compiled = await WebAssembly.compile(await unpack(data.module));
    return { data, compiled, networks: Object.fromEntries(await Promise.all(networks)) };
  };
  if (!unpacked.has(data)) unpacked.set(data, prepare());
  return unpacked.get(data);
}

// options: road, ghost (ids of drivers, with commas between), driver, pace, futures and view, as in the page's address;
// scenario: as `scenario_data` in packing.py makes it; drivers: more drivers (see `guest` in drivers.js); details: show what the driver thinks; keys: the element whose keys
// it takes, by default its own; page: it is all that a page shows; theme: "light" or "dark", by default the system's;
// run: the clock starts at once; watch: nothing but the road, on which one drive follows the other.
async function mount(element, data, options = {}) {
  const root = element.shadowRoot ?? element.attachShadow({ mode: "open" });
  root.innerHTML = `<style>${STYLE}</style>${WORLD}`;
  element.toggleAttribute("data-page", Boolean(options.page));
  try {
    const drivers = await Promise.all((options.drivers ?? []).map(guest));
    return new Game(root, await prepared(data), { ...options, drivers });
  } catch (error) {
    const old = !globalThis.WebAssembly || !globalThis.DecompressionStream;
    const remedy = old ? "It needs a browser of 2023 or later." : "";
    root.getElementById("message").textContent = `The road could not start: ${error.message}. ${remedy}`;
    throw error;
  }
}
