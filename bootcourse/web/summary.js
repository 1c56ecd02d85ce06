// The picture at the end of a drive: how far ahead of trap 1 each driver was, and what it had earned, second by second.

function picture(drives, WIDE) {
  const LEFT = 44, RIGHT = 92, HIGH = WIDE < 400 ? 84 : 118, GAP = 30; // px
  const REACH = 60; // m shown on either side of trap 1
  const last = Math.max(...drives.map(({ drive }) => drive.time), 10);
  const across = time => LEFT + ((WIDE - LEFT - RIGHT) * time) / last;
  const ahead = ({ drive }) => drive.states.map((state, k) => (
    [k * drive.road.scenario.dt, Math.min(Math.max(state[X] - state[TRAP_1 * COLUMNS + X], -REACH), REACH)]));
  const earned = ({ drive }) => {
    let sum = 0;
    return [[0, 0], ...drive.rewards.map((reward, t) => [t + 1, (sum += reward)])];
  };
  const sums = drives.flatMap(each => earned(each).map(([, value]) => value));
  const low = Math.min(0, ...sums), high = Math.max(10, ...sums);
  const plots = [
    { top: 22, title: "metres ahead of trap 1", curve: ahead, low: -REACH, high: REACH, marks: [-REACH, 0, REACH], zero: "out of the trap" },
    { top: 22 + HIGH + GAP, title: "return", curve: earned, low, high, marks: [0, Math.round(high)], zero: "" },
  ];
  const parts = plots.map(({ top, title, curve, low, high, marks, zero }) => {
    const down = value => top + HIGH - (HIGH * (value - low)) / (high - low);
    const lines = drives.map(each => {
      const points = curve(each).map(([time, value]) => `${across(time).toFixed(1)},${down(value).toFixed(1)}`);
      const end = points.at(-1).split(",").map(Number);
      const cross = each.drive.accident ? `<path d="M${end[0] - 4} ${end[1] - 4}l8 8m0-8l-8 8" stroke="${each.colour}" stroke-width="2"/>` : "";
      return { svg: `<polyline points="${points.join(" ")}" fill="none" stroke="${each.colour}" stroke-width="${each.width}" stroke-linejoin="round"/>${cross}`, end, each };
    });
    const labels = spread(lines.map(({ end }) => end[1]), 14, top + HIGH).map((y, i) => (
      `<text x="${lines[i].end[0] + 8}" y="${y + 4}" style="fill:color-mix(in oklab, ${lines[i].each.colour} 65%, var(--ink))">${lines[i].each.label.replace(/^the (other )?| agent$/g, "")}</text>`));
    const ticks = marks.map(mark => `<line x1="${LEFT}" x2="${WIDE - RIGHT}" y1="${down(mark)}" y2="${down(mark)}" stroke="var(--line)"/>`
      + `<text x="${LEFT - 6}" y="${down(mark) + 4}" text-anchor="end">${mark === REACH ? "≥ " : ""}${String(mark).replace("-", "−")}</text>`);
    const words = zero ? `<text x="${LEFT + 6}" y="${down(0) - 5}">${zero}</text>` : "";
    return `<text x="${LEFT}" y="${top - 8}">${title}</text>${ticks.join("")}${words}${lines.map(line => line.svg).join("")}${labels.join("")}`;
  });
  const bottom = 22 + 2 * HIGH + GAP;
  const times = [0, last / 2, last].map(time => `<text x="${across(time)}" y="${bottom + 18}" text-anchor="middle">${Math.round(time)} s</text>`);
  const words = drives.map(({ drive, label }) => `${label}: ${title(drive)}, return ${points(drive.total)}`).join("; ");
  return `<svg viewBox="0 0 ${WIDE} ${bottom + 26}" role="img" aria-label="${words}">${parts.join("")}${times.join("")}</svg>`;
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
