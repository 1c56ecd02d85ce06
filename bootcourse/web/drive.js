// One drive on one road: decisions, the states between which the picture interpolates, and what was earned.

class Drive {
  constructor(road, seed) {
    Object.assign(this, { road, seed, rewards: [], actions: [], accident: 0 });
    this.cars = road.place(seed);
    this.states = [this.cars.slice()];
  }

  get time() { return this.actions.length; } // s driven: a decision lasts a second
  get over() { return this.accident > 0 || this.actions.length >= this.road.scenario.decisions; }
  get end() { return (this.states.length - 1) * this.road.scenario.dt; } // an accident may come within a second
  get total() { return this.rewards.reduce((sum, reward) => sum + reward, 0); }

  decide(action) {
    const { reward, accident } = this.road.decide(this.cars, action);
    const size = this.cars.length, steps = this.road.scenario.steps;
    for (let step = 0; step < steps; step++) {
      const state = this.road.trace.slice(step * size, (step + 1) * size);
      this.states.push(state);
      if (accident && state.every((value, i) => value === this.cars[i])) break;
    }
    this.actions.push(action);
    this.rewards.push(reward);
    this.accident = accident;
  }

  // Let a driver drive to the end.
  finish(driver) {
    while (!this.over) this.decide(driver.decide(this.road, this.cars).action);
    return this;
  }

  // The cars at a time, between the simulation steps on a smooth curve through them.
  at(time) {
    const dt = this.road.scenario.dt, last = this.states.length - 1;
    const k = Math.min(Math.max(Math.floor(time / dt), 0), last), next = Math.min(k + 1, last);
    const part = k === last ? 0 : time / dt - k;
    const now = this.states[k], then = this.states[next], cars = now.slice();
    for (let i = 0; i < cars.length; i += COLUMNS) {
      for (const column of [X, Y]) {
        cars[i + column] = hermite(now[i + column], then[i + column],
          this.slope(k, i, column) * dt, this.slope(next, i, column) * dt, part);
      }
      for (const column of [HEADING, SPEED]) {
        cars[i + column] = now[i + column] + (then[i + column] - now[i + column]) * part;
      }
    }
    return cars;
  }

  // The velocity of a car in a state: the mean of what it was in the step before and what it is in the next.
  slope(k, i, column) {
    const state = this.states[k], before = this.states[k - 1], heading = state[i + HEADING];
    const ahead = state[i + SPEED] * (column === X ? Math.cos(heading) : Math.sin(heading));
    return before ? ((state[i + column] - before[i + column]) / this.road.scenario.dt + ahead) / 2 : ahead;
  }

  // The second from which the ego stays ahead of trap 1 until the end, or null.
  get outAfter() {
    const behind = this.states.findLastIndex(state => state[X] <= state[TRAP_1 * COLUMNS + X]);
    return behind === this.states.length - 1 ? null : (behind + 1) * this.road.scenario.dt;
  }
}

function hermite(from, to, slopeFrom, slopeTo, t) {
  const t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * slopeFrom + (3 * t2 - 2 * t3) * to + (t3 - t2) * slopeTo;
}
