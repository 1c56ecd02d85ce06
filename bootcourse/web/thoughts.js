// What a driver thinks in the place of the car: π, the rule's π̃ and the KL between them, as a table with bars.

class Thoughts {
  constructor(table, names) {
    this.table = table;
    this.rows = names.map((name, action) => {
      const line = document.createElement("tr");
      line.innerHTML = `<th scope="row"><b aria-hidden="true">${SIGNS[action]}</b> ${name}</th>`
        + ["pi", "rule", "share"].map(kind => `<td class="${kind}"><i></i><span></span></td>`).join("");
      const cells = [...line.querySelectorAll("td")].map(cell => (
        { bar: cell.querySelector("i"), number: cell.querySelector("span") }));
      return { line, cells };
    });
    for (const action of [6, 7, 8, 3, 4, 5, 0, 1, 2]) table.tBodies[0].append(this.rows[action].line); // as on the pad
  }

  show({ policy, action }, rule, driver) {
    const shares = klShares(policy, rule), kl = shares.reduce((sum, share) => sum + share, 0);
    const dearest = Math.log(1 / Math.min(...rule)); // nats: the most that an action can cost
    this.table.style.setProperty("--mind", driver.colour);
    this.rows.forEach(({ line, cells }, a) => {
      const parts = [[policy[a], policy[a]], [rule[a], rule[a]], [Math.abs(shares[a]) / dearest, shares[a]]];
      parts.forEach(([length, value], k) => {
        cells[k].bar.style.transform = `scaleX(${Math.min(length, 1)})`;
        cells[k].number.textContent = Math.abs(value) < 0.005 ? "0" : value.toFixed(2).replace("-", "−");
      });
      line.classList.toggle("chosen", a === action);
    });
    this.table.querySelector("#kl").textContent = kl.toFixed(2);
  }
}

// The sliders for p, ξ and c. Calls `changed` with what was moved.
function makeSliders(find, settings, changed) {
  const STRENGTHS = [0, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1, 2, 5, 10, 20, 50, 100]; // ξ
  const inputs = Object.fromEntries(["p", "xi", "c"].map(name => [name, find(name)]));
  inputs.xi.max = STRENGTHS.length - 1;
  const read = { p: Number, xi: place => STRENGTHS[place], c: Number };
  const write = { p: value => value, xi: value => STRENGTHS.indexOf(value), c: value => value };
  for (const [name, input] of Object.entries(inputs)) {
    const label = find(`${name}-value`);
    input.value = write[name](settings[name]);
    const show = () => {
      label.textContent = String(settings[name]);
      input.setAttribute("aria-valuetext", String(settings[name]));
    };
    show();
    input.addEventListener("input", () => {
      settings[name] = read[name](input.value);
      show();
      changed(name);
    });
  }
}
