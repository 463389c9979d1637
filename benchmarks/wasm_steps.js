// Time of a step of a module in this engine, median of some flights: for Node.js and for a page of a browser.
globalThis.stepTime = ({ base64, manifest, repeat }) => {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const { exports } = new WebAssembly.Instance(new WebAssembly.Module(bytes));
  const { sizes, context, prepared, steps } = manifest;
  const counts = {
    context: context.words.length,
    numbers: manifest.numbers.length,
    prepared: sizes.prepared,
    work: Math.max(sizes.work, sizes.prepare_work),
    ring: sizes.ring_rows * sizes.ring_row,
    delays: manifest.delays.length,
    keys: 2,
    log: sizes.sample,
    last: sizes.sample,
  };
  const at = {};
  let end = exports.__heap_base.value;
  for (const [name, count] of Object.entries(counts)) {
    at[name] = end;
    end += 64 * Math.ceil(count / 8 + 1);
  }
  exports.memory.grow(Math.max(0, Math.ceil((end - exports.memory.buffer.byteLength) / 65536)));
  const doubles = (name, count = counts[name]) => new Float64Array(exports.memory.buffer, at[name], count);
  const integers = (name) => new BigInt64Array(exports.memory.buffer, at[name], counts[name]);
  const fly = () => {
    doubles("numbers").set(manifest.numbers.map(({ value }) => Number(value)));
    if (exports.prepare(at.numbers, at.prepared, at.work) !== 0n) throw new Error("a guard fails");
    doubles("work").fill(0);
    const flight = doubles("prepared", sizes.flight);
    const row = manifest.delayed.flatMap(([first, count]) => [...flight.subarray(first, first + count)]);
    for (let i = 0; i < sizes.ring_rows; i++) doubles("ring").set(row, i * sizes.ring_row);
    integers("delays").set(manifest.delays.map(BigInt));
    doubles("keys").set(manifest.keys);
    const words = {
      ...{ flight: at.prepared, work: at.work, ring: at.ring, delays: at.delays, keys: at.keys, log: at.log },
      ...{ last: at.last, rings: sizes.ring_rows, stride: sizes.sample, steps, every: steps + 1, fresh: 1 },
      stop: steps + 1,
    };
    const tables = { pushes: "push_count", gusts: "gust_count", walls: "wall_count", legs: "leg_count" };
    for (const [name, count] of Object.entries(tables)) {
      words[name] = at.prepared + 8 * prepared[name][0];
      words[count] = prepared[name][1];
    }
    integers("context").set(context.words.map((word) => BigInt(words[word] ?? 0)));
    doubles("context")[context.words.indexOf("dt")] = manifest.dt;
    const began = performance.now();
    exports.fly(at.context);
    return (1e6 * (performance.now() - began)) / steps;
  };
  for (let i = 0; i < 3; i++) fly(); // until the engine has optimised it
  const times = Array.from({ length: repeat }, fly).sort((a, b) => a - b);
  return times[times.length >> 1];
};
