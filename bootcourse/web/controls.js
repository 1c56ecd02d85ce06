// Keys and fingers: what the player wants next. A tap counts for the next decision, a held key while it is held.

const KEYS = {
  ArrowUp: ["push", 1], ArrowDown: ["push", -1], ArrowLeft: ["side", -1], ArrowRight: ["side", 1],
  w: ["push", 1], s: ["push", -1], a: ["side", -1], d: ["side", 1],
};
const TOGETHER = 70; // ms: keys pressed this close together are one action, where the clock waits for it

class Controls {
  // keys: the element whose keys count while it, or what is in it, has the focus; signal: ends that. pressed(): the
  // player has chosen something. commands: { key: function }, for all other keys.
  constructor(pad, keys, signal, pressed, commands) {
    Object.assign(this, { pressed, held: new Map(), tapped: {}, waiting: null, pad: [] });
    for (const action of [6, 7, 8, 3, 4, 5, 0, 1, 2]) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = SIGNS[action];
      this.pad[action] = button;
      pad.append(button);
      const wish = { push: Math.floor(action / 3) - 1, side: (action % 3) - 1 };
      button.addEventListener("pointerdown", event => {
        event.preventDefault();
        button.setPointerCapture(event.pointerId);
        this.hold(`pad ${event.pointerId}`, wish);
      });
      for (const ending of ["pointerup", "pointercancel"]) {
        button.addEventListener(ending, event => this.release(`pad ${event.pointerId}`));
      }
      button.addEventListener("click", event => { // the keyboard's click: a pointer's was counted when it went down
        if (event.detail === 0) this.tap(wish);
      });
    }
    keys.addEventListener("keydown", event => {
      if (event.ctrlKey || event.altKey || event.metaKey || usesKeys(event.composedPath()[0], event.key)) return;
      const name = keyName(event);
      if (KEYS[name] || commands[name]) event.stopPropagation(); // a notebook has shortcuts of its own
      if (KEYS[name]) {
        event.preventDefault();
        const [axis, sign] = KEYS[name];
        if (!event.repeat) this.hold(name, { [axis]: sign });
      } else if (commands[name] && !event.repeat) {
        event.preventDefault();
        commands[name]();
      }
    }, { signal });
    keys.addEventListener("keyup", event => this.release(keyName(event)), { signal });
    keys.addEventListener("focusout", () => this.held.clear(), { signal }); // of a shadow root: the focus leaves it
    window.addEventListener("blur", () => this.held.clear(), { signal });
  }

  hold(source, wish) {
    this.held.set(source, wish);
    this.tap(wish);
  }

  release(source) { this.held.delete(source); }

  tap(wish) {
    Object.assign(this.tapped, wish);
    this.touched();
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => {
      this.waiting = null;
      this.pressed();
    }, TOGETHER);
  }

  // Whether a tap waits for its decision, and no other key can join it.
  get asked() { return Object.keys(this.tapped).length > 0 && this.waiting === null; }

  // The action of the next decision as it stands now; the last key of two that contradict each other counts.
  get coming() {
    const { push = 0, side = 0 } = Object.assign({}, ...this.held.values(), this.tapped);
    return 3 * (push + 1) + side + 1;
  }

  get idle() { return this.held.size === 0 && Object.keys(this.tapped).length === 0; }

  // Take the action, and forget what was only tapped.
  take() {
    const action = this.coming;
    this.tapped = {};
    return action;
  }

  forget() {
    this.held.clear();
    this.tapped = {};
  }

  mark(action) {
    this.pad.forEach((button, a) => button.classList.toggle("coming", a === action));
  }
}

const keyName = ({ key }) => (key.length === 1 ? key.toLowerCase() : key);

// Whether the part of the page that has the focus needs this key itself.
function usesKeys(target, key) {
  if (!target.matches) return false; // the document
  if (target.matches("select, input[type=number]")) return true;
  if (target.matches("input[type=range]")) return /^(Arrow|Page|Home|End)/.test(key);
  return target.matches("button, input") && (key === " " || key === "Enter");
}
