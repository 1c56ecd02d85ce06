// What the address asks for, as in "#road=7&ghost=rule,sac&view=3d", and a sentence for each part that cannot be had.

const LARGEST_ROAD = 999999999;
const listed = (names, word = "or") => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} ${word} ${names.at(-1)}`);

// { wanted: { road: "7", ... } with what is valid, faults: [sentences] }. text: without its "#"; drivers: their names;
// now: { road: "10", ... }, what is used where the address is wrong.
function askedFor(text, drivers, now) {
  const choices = { ghost: ["none", ...drivers], driver: ["you", ...drivers], pace: ["0", "1", "2", "5"],
    futures: ["0", "1"], view: ["above", "3d"] };
  const wanted = {}, faults = [], fault = words => faults.push(words);
  for (const [name, value] of new URLSearchParams(text)) {
    if (name !== "road" && !choices[name]) {
      fault(`The address has “${name}”, which is unknown: it takes ${listed(["road", ...Object.keys(choices)])}.`);
    } else if (name === "road" ? isRoad(value) : isChoice(name, value, choices[name])) wanted[name] = value;
    else if (name === "road") fault(noRoad(value));
    else fault(`“${name}” cannot be “${value}”, so it is ${now[name]}: choose ${listed(choices[name])}.`);
  }
  return { wanted, faults };
}

const isChoice = (name, value, choices) => // of ghosts there may be several
  choices.includes(value) || (name === "ghost" && value.split(",").every(each => each !== "none" && choices.includes(each)));
const isRoad = value => /^\d{1,9}$/.test(String(value).trim());
const noRoad = value => `“${value}” is not a road: give a whole number from 0 to ${LARGEST_ROAD}.`;
