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

// What is worth saying to a player at this moment, or "".
function remark(cars, justOut) {
  if (justOut) return "You are out. 15 m/s pays best. Press 5 for a faster clock.";
  if (cars[SPEED] < 3) return "Slow: below 1 m/s the drive ends.";
  if (cars[SPEED] > 16.5) return "Above 15 m/s every second pays less.";
  if (cars[Y] < -1.2 || cars[Y] > 9.2) return "You are at the edge of the road.";
  return "";
}

const HINTS = [
  "The way out begins behind you. Brake for two or three seconds, until the car on your left has drawn ahead, and "
    + "then steer into its lane.",
  "Steering lasts one second and the car keeps its heading: steer left once, right once. That moves you about a lane "
    + "to the left, straight again.",
  "Brake to about 7 m/s, wait until trap 2 is 12 m ahead, and change lane twice, to the far left. Then nobody is in "
    + "front of you: accelerate to 15 m/s, which pays best.",
  "Switch on the nine futures and follow the bold one, or put the rule at the wheel and watch it.",
];

// A hint for somebody who has not got out in this many attempts; "" before the third.
const hintAfter = failures => (failures < 3 ? "" : HINTS[Math.min(failures - 3, HINTS.length - 1)]);
