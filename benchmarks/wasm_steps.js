// The time of a step of a module in this engine, median of some flights [ns]: beside examples/fly_module.js.
globalThis.stepTime = ({ base64, manifest, repeat }) => {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const { steps } = manifest;
  const fly = () => (1e6 * globalThis.flyModule(bytes, manifest, { every: steps + 1 }).spent) / steps;
  for (let i = 0; i < 3; i++) fly(); // until the engine has optimised it
  const times = Array.from({ length: repeat }, fly).sort((a, b) => a - b);
  return times[times.length >> 1];
};
