// What the compiled module imports: its memory, the end of its stack in it, and the functions of mathematics.
function importsOf(memory, stack) {
  const { sin, cos, tan, asin, atan, exp, log, pow } = Math;
  const __stack_pointer = new WebAssembly.Global({ value: "i32", mutable: true }, stack);
  const fmod = (a, b) => a % b;
  return { env: { __linear_memory: memory, __stack_pointer, sin, cos, tan, asin, atan, exp, pow, fmod, expf: exp, logf: log } };
}
