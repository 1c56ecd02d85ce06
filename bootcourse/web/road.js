// The road: numba's compiled functions in WebAssembly, with the memory that they work on. Nothing of the road's physics
// stands in JavaScript: see bootcourse/road and bootcourse/rule.py.

// The names of columns, rows and actions stand before this script: build.py writes them from Python.

const WHOLE = 8n, REAL = 8n, SINGLE = 4n; // bytes of a number

class Road {
  constructor(compiled, scenario) {
    const memory = new WebAssembly.Memory({ initial: 4 });
    this.code = new WebAssembly.Instance(compiled, importsOf(memory, scenario.free)).exports;
    this.scenario = scenario;
    const { vehicles, lanes, steps } = scenario;
    let end = scenario.free; // the module's own constants lie below: wasm.py checks it
    const reserve = (Kind, size) => {
      const view = new Kind(memory.buffer, end, size);
      end += Math.ceil((size * Kind.BYTES_PER_ELEMENT) / 16) * 16;
      return view;
    };
    const record = Uint8Array.from(atob(scenario.record), letter => letter.charCodeAt(0));
    this.constants = reserve(Uint8Array, record.length);
    this.constants.set(record);
    this.start = reserve(Float64Array, scenario.uniforms);
    this.cars = reserve(Float64Array, vehicles * COLUMNS);
    this.order = reserve(BigInt64Array, vehicles);
    this.around = reserve(BigInt64Array, lanes * vehicles * 2);
    this.directions = reserve(Float64Array, vehicles * 2);
    this.outcome = reserve(Float64Array, 5);
    this.trace = reserve(Float64Array, steps * vehicles * COLUMNS);
    this.seen = reserve(Float32Array, scenario.observation);
    this.result = reserve(Float64Array, 4); // numba's place for a returned value and for an error
    this.inOrder = BigInt64Array.from({ length: vehicles }, (_, i) => BigInt(i));

    const cars = numbaArray(this.cars, REAL, vehicles, COLUMNS);
    const order = numbaArray(this.order, WHOLE, vehicles);
    const around = numbaArray(this.around, WHOLE, lanes, vehicles, 2);
    const outcome = numbaArray(this.outcome, REAL, 5);
    const c = this.constants.byteOffset;
    this.arguments = {
      place: [...numbaArray(this.start, REAL, scenario.uniforms), c, ...cars],
      observe: [...cars, c, ...numbaArray(this.seen, SINGLE, scenario.observation)],
      rule: [...cars, c, ...order, ...around, ...outcome],
      decide: Array.from({ length: ACTIONS }, (_, action) => [...cars, BigInt(action), c, ...order, ...around,
        ...numbaArray(this.directions, REAL, vehicles, 2), ...outcome,
        ...numbaArray(this.trace, REAL, steps, vehicles, COLUMNS)]),
    };
  }

  call(name, values) {
    const status = this.code[name](this.result.byteOffset, this.result.byteOffset + 16, ...values);
    if (status !== 0) throw new Error(`The compiled function ${name} failed with status ${status}.`);
  }

  // The cars at the start of a road, by its number: a Float64Array, vehicles x 10.
  place(seed) {
    this.start.set(uniforms(seed, this.scenario.uniforms));
    this.call("place", this.arguments.place);
    return this.cars.slice();
  }

  // One decision. Changes `cars` and returns { reward, accident }; `this.trace` holds the simulation steps.
  decide(cars, action) {
    this.cars.set(cars);
    this.order.set(this.inOrder);
    this.call("decide", this.arguments.decide[action]);
    cars.set(this.cars);
    return { reward: this.outcome[3], accident: this.outcome[4] };
  }

  // The observation of the ego, 26 numbers. The array is used again at the next call.
  observe(cars) {
    this.cars.set(cars);
    this.call("observe", this.arguments.observe);
    return this.seen;
  }

  // The rule's decision on these cars.
  rule(cars) {
    this.cars.set(cars);
    this.order.set(this.inOrder);
    this.call("rule", this.arguments.rule);
    const [action, speed, lane, distance, reason] = this.outcome;
    return { action, speed, lane, distance, reason };
  }
}

// An array as numba's functions take it: two unused pointers, the number of elements, their size, the address, the
// shape and the strides in bytes. Numbers of 64 bits are BigInts.
function numbaArray(view, itemBytes, ...shape) {
  const sizes = shape.map(BigInt), strides = [];
  let stride = itemBytes;
  for (let i = sizes.length - 1; i >= 0; i--) {
    strides.unshift(stride);
    stride *= sizes[i];
  }
  return [0, 0, stride / itemBytes, itemBytes, view.byteOffset, ...sizes, ...strides];
}
