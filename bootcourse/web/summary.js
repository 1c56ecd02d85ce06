// The picture at the end of a drive: how far ahead of trap 1 each driver was, and what it had earned, second by second.

const REACH = 60; // m shown on either side of trap 1
const MARGIN = { left: 44, right: 92, top: 22, between: 30, bottom: 26 }; // px

// Two plots over one time axis, as SVG. drives: [{ drive, label, colour, width }]; wide: px.
function picture(drives, wide) {
  const high = wide < 400 ? 84 : 118, last = Math.max(...drives.map(({ drive }) => drive.time), 10);
  const across = time => MARGIN.left + ((wide - MARGIN.left - MARGIN.right) * time) / last;
  const sums = drives.flatMap(({ drive }) => earnings(drive).map(([, sum]) => sum));
  const most = Math.max(10, ...sums), second = MARGIN.top + high + MARGIN.between, bottom = second + high;
  const plots = plot(drives, { top: MARGIN.top, high, wide, across, title: "metres ahead of trap 1", curve: lead,
    range: [-REACH, REACH], marks: [[-REACH, `−${REACH}`], [0, "0"], [REACH, `≥ ${REACH}`]] })
    + plot(drives, { top: second, high, wide, across, title: "return", curve: earnings,
      range: [Math.min(0, ...sums), most], marks: [[0, "0"], [most, most.toFixed(0)]] });
  const times = [0, last / 2, last].map(time => (
    `<text x="${across(time)}" y="${bottom + 18}" text-anchor="middle">${Math.round(time)} s</text>`));
  const words = drives.map(({ drive, label }) => `${label}: ${title(drive)}, return ${points(drive.total)}`).join("; ");
  const frame = `viewBox="0 0 ${wide} ${bottom + MARGIN.bottom}" role="img" aria-label="${words}"`;
  return `<svg ${frame}>${plots}${times.join("")}</svg>`;
}

// [time, metres ahead of trap 1] at each simulation step, within REACH.
const lead = drive => drive.states.map((state, k) => (
  [k * drive.road.scenario.dt, Math.min(Math.max(state[X] - state[TRAP_1 * COLUMNS + X], -REACH), REACH)]));

// [time, sum of the rewards] at each decision; an accident may come within the last second.
function earnings(drive) {
  let sum = 0;
  return [[0, 0], ...drive.rewards.map((reward, t) => [Math.min(t + 1, drive.end), (sum += reward)])];
}

function plot(drives, { top, high, wide, across, title, curve, range: [low, highest], marks }) {
  const down = value => top + high - (high * (value - low)) / (highest - low);
  const grid = marks.map(([value, words]) => (
    `<path d="M${MARGIN.left} ${down(value)}H${wide - MARGIN.right}" stroke="var(--line)"/>`
    + `<text x="${MARGIN.left - 6}" y="${down(value) + 4}" text-anchor="end">${words}</text>`));
  const spots = drives.map(({ drive }) => curve(drive).map(([time, value]) => [across(time), down(value)]));
  const heights = spread(spots.map(each => each.at(-1)[1]), 14, top + high);
  const lines = drives.map(({ drive, label, colour, width }, i) => {
    const [x, y] = spots[i].at(-1), stroke = `fill="none" stroke="${colour}" stroke-width="${width}"`;
    const cross = drive.accident ? `<path d="M${x - 4} ${y - 4}l8 8m0-8l-8 8" ${stroke}/>` : "";
    const name = label.replace(/^the (other )?| agent$/g, "");
    const shade = `color-mix(in oklab, ${colour} 65%, var(--ink))`;
    return `<polyline points="${spots[i].join(" ")}" ${stroke} stroke-linejoin="round"/>${cross}`
      + `<text x="${x + 8}" y="${heights[i] + 4}" style="fill:${shade}">${name}</text>`;
  });
  return `<text x="${MARGIN.left}" y="${top - 8}">${title}</text>${grid.join("")}${lines.join("")}`;
}

// Heights for labels, in the same order, so that no two are closer than `least` and none is below `bottom`.
function spread(heights, least, bottom) {
  const order = heights.map((_, i) => i).sort((a, b) => heights[b] - heights[a]), placed = [...heights];
  let free = bottom;
  for (const i of order) {
    placed[i] = Math.min(placed[i], free);
    free = placed[i] - least;
  }
  return placed;
}
