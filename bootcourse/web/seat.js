// Somebody at a wheel: a drive with its driver, and what this driver would do now. Some drivers answer later, because
// they decide elsewhere, in Python.

class Seat {
  constructor(road, number, driver) {
    Object.assign(this, { driver, drive: new Drive(road, number) });
    this.think();
  }

  // Ask the driver about the present state: { action, policy, q, futures }, of which only the action must be there.
  think() {
    this.thought = null;
    if (this.drive.over) return;
    const answer = this.driver.decide(this.drive.road, this.drive.cars, this.drive);
    if (answer instanceof Promise) this.coming = answer.then(thought => { if (this.coming) this.thought = thought; });
    else this.thought = answer;
  }

  get waiting() { return !this.thought && !this.drive.over; }

  decide() {
    if (this.drive.over) return;
    this.drive.decide(this.thought.action);
    this.think();
  }

  // Drive to the end. Whoever decides elsewhere is waited for.
  async finish() {
    while (!this.drive.over) {
      if (this.waiting) await this.coming;
      this.decide();
    }
  }
}
