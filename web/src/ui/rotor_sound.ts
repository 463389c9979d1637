// The sound of the rotors: each blade that passes is a beat, so a rotor of two blades at Ω sounds at Ω/π.

import type { FlightScene } from "../wire/messages.generated.ts";

const MOST = 16; // rotors that are heard; of more, every second, third, …
const LOUD = 0.14; // of all rotors at full thrust
const QUICK = 0.03; // s, in which tone and loudness follow
const STILL = 0.25; // s of the page's clock without a new picture of the flight: it is paused

interface Voice {
  rotor: number;
  most: number; // N
  fastest: number; // Hz, of its blades at that thrust
  tone: OscillatorNode;
  loud: GainNode;
}

/** The frequency at which the two blades of a rotor pass [Hz], by its thrust, and its speed [rad/s] at the largest. */
export function bladeFrequency(thrust: number, most: number, fastest: number): number {
  return (fastest * Math.sqrt(Math.max(thrust, 0) / most)) / Math.PI;
}

export class RotorSound {
  private readonly all: GainNode;
  private readonly voices: Voice[];
  private time = NaN;
  private heard = 0; // s, when the flight was last seen to go on

  constructor(
    scene: FlightScene,
    private readonly audio: AudioContext,
  ) {
    this.all = new GainNode(audio, { gain: 0 });
    const dull = new BiquadFilterNode(audio, { type: "lowpass", frequency: 1800 });
    this.all.connect(dull).connect(audio.destination);
    const wave = audio.createPeriodicWave([0, 0, 0, 0, 0, 0], [0, 1, 0.55, 0.3, 0.2, 0.1]);
    const { quadrotors } = scene.vehicle;
    const width = Math.max(...quadrotors.map(({ position }) => Math.abs(position[1])), 0.1);
    const rotors = quadrotors.flatMap((quadrotor) => quadrotor.rotors);
    const step = Math.ceil(rotors.length / MOST);
    const heard = rotors.map((rotor, i) => ({ ...rotor, i })).filter(({ i }) => i % step === 0);
    this.voices = heard.map(({ position, max_thrust: most, max_speed: fastest, i }) => {
      const tone = new OscillatorNode(audio, { type: "custom", periodicWave: wave, frequency: 1 });
      const loud = new GainNode(audio, { gain: 0 });
      const side = new StereoPannerNode(audio, { pan: Math.max(-0.7, Math.min(0.7, (-0.7 * position[1]) / width)) });
      tone.connect(loud).connect(side).connect(this.all);
      tone.start();
      return { rotor: i, most, fastest, tone, loud };
    });
  }

  update(thrusts: Float32Array, time: number): void {
    const now = this.audio.currentTime;
    if (time !== this.time) this.heard = now;
    this.time = time;
    this.all.gain.setTargetAtTime(now - this.heard > STILL ? 0 : LOUD, now, QUICK);
    for (const { rotor, most, fastest, tone, loud } of this.voices) {
      const thrust = thrusts[rotor] ?? 0;
      tone.frequency.setTargetAtTime(bladeFrequency(thrust, most, fastest), now, QUICK);
      loud.gain.setTargetAtTime(Math.max(thrust / most, 0) / Math.sqrt(this.voices.length), now, QUICK);
    }
  }

  silence(): void {
    this.all.gain.setTargetAtTime(0, this.audio.currentTime, QUICK);
  }

  stop(): void {
    for (const { tone } of this.voices) tone.stop();
    this.all.disconnect();
  }
}
