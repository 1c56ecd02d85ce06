// What the address asks for, as in "#road=7&ghost=rule&view=3d", and a sentence for each part that cannot be had.

const LARGEST_ROAD = 999999999;
const listed = names => `${names.slice(0, -1).join(", ")} or ${names.at(-1)}`;

// { wanted: { road: "7", ... } with what is valid, faults: [sentences] }. text: without its "#"; drivers: their names.
function askedFor(text, drivers) {
  const choices = { ghost: ["none", ...drivers], driver: ["you", ...drivers], pace: ["0", "1", "2", "5"],
    futures: ["0", "1"], view: ["above", "3d"] };
  const wanted = {}, faults = [];
  for (const [name, value] of new URLSearchParams(text)) {
    if (name === "road") {
      if (isRoad(value)) wanted.road = value;
      else faults.push(noRoad(value));
    } else if (!choices[name]) {
      faults.push(`The address has “${name}”, which is unknown: it takes ${listed(["road", ...Object.keys(choices)])}.`);
    } else if (!choices[name].includes(value)) {
      faults.push(`“${value}” is no ${name}: choose ${listed(choices[name])}.`);
    } else wanted[name] = value;
  }
  return { wanted, faults };
}

const isRoad = value => /^\d{1,9}$/.test(String(value).trim());
const noRoad = value => `“${value}” is not a road: give a whole number from 0 to ${LARGEST_ROAD}.`;
