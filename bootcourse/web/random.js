// The random numbers of a road: numpy's SeedSequence and PCG64, so that a road has the same number here and in Python.
// Source: numpy/random/bit_generator.pyx and numpy/random/src/pcg64 (O'Neill's PCG, XSL-RR output).

function seedWords(seed, count) {
  const pool = [0, 0, 0, 0], entropy = [];
  for (let rest = BigInt(seed); rest > 0n; rest >>= 32n) entropy.push(Number(rest & 0xffffffffn));
  let constant = 0x43b0d7e5;
  const hash = value => {
    value ^= constant;
    constant = Math.imul(constant, 0x931e8875);
    value = Math.imul(value, constant);
    return value ^ (value >>> 16);
  };
  const mix = (x, y) => {
    const mixed = Math.imul(0xca01f9dd, x) - Math.imul(0x4973f715, y);
    return mixed ^ (mixed >>> 16);
  };
  for (let i = 0; i < 4; i++) pool[i] = hash(entropy[i] ?? 0);
  for (let from = 0; from < 4; from++)
    for (let to = 0; to < 4; to++) if (from !== to) pool[to] = mix(pool[to], hash(pool[from]));
  for (let from = 4; from < entropy.length; from++)
    for (let to = 0; to < 4; to++) pool[to] = mix(pool[to], hash(entropy[from]));
  constant = 0x8b51f9dd;
  return Array.from({ length: count }, (_, i) => {
    let value = pool[i % 4] ^ constant;
    constant = Math.imul(constant, 0x58f38ded);
    value = Math.imul(value, constant);
    return (value ^ (value >>> 16)) >>> 0;
  });
}

// The first numbers in [0, 1) of `numpy.random.default_rng(seed).random(count)`.
function uniforms(seed, count) {
  const mask128 = (1n << 128n) - 1n, mask64 = (1n << 64n) - 1n;
  const multiplier = 0x2360ed051fc65da44385df649fccf645n;
  const words = seedWords(seed, 8).map(BigInt);
  const long = i => (words[2 * i + 1] << 32n) | words[2 * i];
  const increment = ((((long(2) << 64n) | long(3)) << 1n) | 1n) & mask128;
  const step = state => (state * multiplier + increment) & mask128;
  let state = step((increment + ((long(0) << 64n) | long(1))) & mask128);
  return Float64Array.from({ length: count }, () => {
    state = step(state);
    const folded = ((state >> 64n) ^ state) & mask64, turn = state >> 122n;
    const turned = ((folded >> turn) | (folded << (64n - turn))) & mask64;
    return Number(turned >> 11n) / 2 ** 53;
  });
}
