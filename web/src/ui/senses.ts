// What is heard and felt of a flight: rotors, touches of the walls, and pushes that pass the threshold.

import { thresholdAlong } from "../view/push.ts";
import { size } from "../math/vectors.ts";
import type { Frame } from "../wire/frames.ts";
import type { FlightScene, Vector } from "../wire/messages.generated.ts";
import { RotorSound } from "./rotor_sound.ts";

export type Sense = "rotors" | "touches" | "vibration";
export type Senses = Record<Sense, boolean>;

const PRESSED = 0.5; // N, of a wall: a touch
const APART = 500; // ms without one between two touches
const HARD = 20; // N: a touch as loud as it becomes
const [BUZZ, TICK] = [60, 15]; // ms, of a touch and of a push that passes the threshold
const THUD = 0.12; // s

export class SensesOfFlight {
  private context: AudioContext | null = null;
  private sound: RotorSound | null = null;
  private scene: FlightScene | null = null;
  private touched = -Infinity; // ms
  private passed = false;

  constructor(private readonly on: Senses) {
    // a browser lets a page sound once a person has done something
    window.addEventListener("pointerdown", () => void this.context?.resume());
    document.addEventListener("visibilitychange", () => {
      void (document.hidden ? this.context?.suspend() : this.context?.resume());
    });
  }

  begin(scene: FlightScene): void {
    this.scene = scene;
    this.sound?.stop();
    this.sound = null;
  }

  update(frame: Frame, threshold: Vector, now: number): void {
    this.hum(frame);
    const [x, y] = frame.vector("contact_force");
    const force = Math.hypot(x, y);
    if (force > PRESSED) {
      if (now - this.touched > APART) this.touch(force);
      this.touched = now;
    }
    const push = frame.vector("push");
    const passed = size(push) > thresholdAlong(push, threshold);
    if (passed && !this.passed && this.on.vibration) navigator.vibrate(TICK);
    this.passed = passed;
  }

  private hum(frame: Frame): void {
    if (!this.on.rotors) this.sound?.silence();
    else if (this.scene) {
      this.sound ??= new RotorSound(this.scene, this.audio);
      this.sound.update(frame.list("thrusts"), frame.scalar("time"));
    }
  }

  private touch(force: number): void {
    if (this.on.vibration) navigator.vibrate(BUZZ);
    if (this.on.touches) thud(this.audio, Math.min(force / HARD, 1));
  }

  private get audio(): AudioContext {
    this.context ??= new AudioContext();
    return this.context;
  }
}

/** A short dull noise, of a strength up to 1. */
function thud(audio: AudioContext, strength: number): void {
  const noise = audio.createBuffer(1, Math.ceil(THUD * audio.sampleRate), audio.sampleRate);
  const samples = noise.getChannelData(0);
  samples.forEach((_, i) => (samples[i] = (2 * Math.random() - 1) * Math.exp((-6 * i) / samples.length)));
  const source = new AudioBufferSourceNode(audio, { buffer: noise });
  const dull = new BiquadFilterNode(audio, { type: "lowpass", frequency: 300 + 900 * strength });
  source.connect(dull).connect(new GainNode(audio, { gain: 0.25 + 0.6 * strength })).connect(audio.destination);
  source.start();
}
