// The drive in words: for the end card, for hints, and for readers who do not see the road.

const LANE_NAMES = ["left", "middle", "right"];
const ENDS = { 2: "off the road", 3: "stopped on the road" };

const row = (cars, car) => cars.subarray(car * COLUMNS, (car + 1) * COLUMNS);
const seconds = time => `${Number(time.toFixed(1))} s`;
const capital = words => words[0].toUpperCase() + words.slice(1);
const points = value => value.toFixed(1).replace("-", "−");

function place(cars, car, name) {
  const ahead = row(cars, car)[X] - cars[X], metres = `${Math.abs(ahead).toFixed(0)} m`;
  return Math.abs(ahead) < 5 ? `beside ${name}` : `${metres} ${ahead > 0 ? "behind" : "ahead of"} ${name}`;
}

// "8.0 m/s, right lane, 16 m behind trap 1, beside trap 2."
function stateInWords(cars) {
  const lane = LANE_NAMES[cars[LANE]] ?? `number ${cars[LANE] + 1}`;
  const places = `${place(cars, TRAP_1, "trap 1")}, ${place(cars, TRAP_2, "trap 2")}`;
  return `${cars[SPEED].toFixed(1)} m/s, ${lane} lane, ${places}.`;
}

function accidentInWords({ accident, cars }) {
  if (accident !== COLLISION) return ENDS[accident];
  const trap = [TRAP_1, TRAP_2].find(car => row(cars, car)[CRASHED]);
  return `collision with ${trap ? `trap ${trap}` : "the traffic"}`;
}

function title(drive) {
  const out = drive.outAfter, end = drive.accident ? `${accidentInWords(drive)} after ${seconds(drive.end)}` : "";
  if (out === null) return end ? capital(end) : "Still in the trap";
  return `Out after ${seconds(out)}${end && `, ${end}`}`;
}

// One sentence about what getting out cost and what it earned, compared with following the traps (`idle`).
function verdict(drive, idle, who) {
  const they = capital(who), total = points(drive.total);
  if (drive.accident) return `${they} earned ${total}: an accident costs 10 and ends the drive.`;
  if (drive.outAfter === null) return `${they} earned ${total}. Following the traps earns ${points(idle.total)}.`;
  let sum = 0, lowest = 0, when = 0;
  drive.rewards.forEach((reward, t) => {
    sum += reward - idle.rewards[t];
    if (sum < lowest) [lowest, when] = [sum, t + 1];
  });
  const cost = when ? `lost ${points(-lowest)} in the first ${when} s` : "lost nothing at first";
  return `Compared with following, ${who} ${cost} and gained ${points(sum - lowest)} afterwards. That makes ${total}.`;
}

// What is worth saying to a player at this moment, or "", and whether it asks for an action.
function remark(cars, justOut, attempts) {
  const tries = attempts > 1 ? `, in ${attempts} attempts` : "", asks = true;
  if (cars[Y] < -1.2) return { words: "You are at the edge of the road: steer right (→).", asks };
  if (cars[Y] > 9.2) return { words: "You are at the edge of the road: steer left (←).", asks };
  if (justOut) return { words: `You are out${tries}. 15 m/s pays best. Press 5 for a faster clock.` };
  if (cars[SPEED] < 3) return { words: "Slow: below 1 m/s the drive ends.", asks };
  if (cars[SPEED] > 16.5) return { words: "Above 15 m/s every second pays less." };
  return { words: "" };
}

// The way out that the third hint describes; the tests drive by these numbers.
const WAY_OUT = { speed: 7, gap: 12, steer: 2, wait: 4, fast: 15, apart: 25 }; // m/s, m, presses, s, m/s, m

const HINTS = [
  "The way out begins behind you. Brake for three seconds, wait until trap 2, the car on your left, has drawn ahead, and "
    + "then cross to the left behind it.",
  "Steering lasts one second, and the car keeps its new heading until you steer back. To change lane, steer left twice, "
    + "wait until you are nearly there, and steer right as often.",
  `Brake to ${WAY_OUT.speed} m/s. When trap 2 is ${WAY_OUT.gap} m ahead, steer left ${WAY_OUT.steer} times, wait `
    + `about ${WAY_OUT.wait} s until you are nearly in the far left lane, and steer right ${WAY_OUT.steer} times. Then `
    + `accelerate to ${WAY_OUT.fast} m/s, which pays best, and brake when a car ahead is closer than ${WAY_OUT.apart} m.`,
  "Switch on the nine futures and follow the bold one, or put the rule at the wheel and watch it.",
];

// A hint for somebody who has not got out in this many attempts; "" before the third.
const hintAfter = failures => (failures < 3 ? "" : HINTS[Math.min(failures - 3, HINTS.length - 1)]);
