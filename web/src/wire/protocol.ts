// What goes over the socket: the scene, status and answers of the server, and what the page may ask for.
// Positions of the vehicle are in body axes from its centre of mass [m]; the beam lies along body y; z is up.

export type Vector = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number]; // w, x, y, z: body to world
export type Values = readonly number[];
export type Setting = number | boolean | string | Values;

/** The control whose value the picture and the plots show. */
export const THRESHOLD = "admittance.threshold";

/** A setting of three axes, which may be given as one number. */
export function perAxis(value: Setting): Vector {
  return (Array.isArray(value) ? value : [value, value, value]) as unknown as Vector;
}

export interface Rotor {
  position: Vector;
  spin: number;
  radius: number;
  max_thrust: number;
}

export interface Quadrotor {
  position: Vector;
  arm: number;
  rotors: Rotor[];
  joint?: Vector; // where it is fixed to the payload
  guard?: number; // radius of its guard
  feet?: { spread: number; depth: number };
}

export interface Payload {
  position: Vector;
  length: number;
  width: number;
  height: number;
}

export interface Wall {
  center: Vector;
  size: Vector;
  heading: number;
}

export interface Corridor {
  centreline: [number, number][];
  width: number;
  height: number;
}

export interface Control {
  key: string;
  label: string;
  group: string;
  unit?: string;
  value: Setting;
  initial?: Setting; // of the mission, if `value` may already differ from it
  min?: number | Values;
  max?: number | Values;
  choices?: (string | number | boolean)[];
  axes?: string[];
}

export interface Spring {
  stiffness: number;
  damping: number;
  max_force: number;
}

export interface Scene {
  mission: string;
  engine: string;
  version: string;
  step: number;
  rate: number;
  vehicle: { quadrotors: Quadrotor[]; payload: Payload; mass: number };
  ground: boolean;
  floor?: number; // height of the ground [m], 0 if not given
  walls: Wall[];
  corridor?: Corridor | null;
  threshold?: Vector | null;
  spring?: Spring | null;
  phases: string[];
  alarms: string[];
  fields: [string, number][];
  controls: Control[];
  replay?: { start: number; end: number; speed: number } | null;
}

/** What is done before the first step, and for how long; `failure`: why it cannot be flown. */
export interface Preparing {
  step: string;
  seconds: number;
  failure: string;
}

export interface Status {
  phase: string;
  alarm: string;
  paused: boolean;
  speed: number;
  factor: number | null; // null where a number is not known
  behind_ms: number | null;
  recorded_s: number | null;
  viewers: number;
  holder: "you" | "other" | "none";
  enabled?: boolean; // whether the pilot listens to the hand
  preparing?: Preparing; // until it flies
  dead?: number[]; // rotors that are stopped for good, counted over the whole vehicle from 0
}

export type Incoming =
  | ({ type: "scene" } & Scene)
  | ({ type: "status" } & Status)
  | { type: "changed"; key: string; value: Setting; duration: number }
  | { type: "refused"; what: string; reason: string }
  | { type: "done"; what: string; detail: string }
  | { type: "pong"; t: number };

export type Outgoing =
  | { type: "grab"; point: Vector; target: Vector; at: "point" | "centre" }
  | { type: "move"; target: Vector }
  | { type: "release" }
  | { type: "force"; force: Vector; point: Vector }
  | { type: "set"; key: string; value: Setting }
  | { type: "restore"; key?: string }
  | { type: "ask"; what: "lift" | "land" | "stop" }
  | { type: "enable"; on: boolean }
  | { type: "kill"; rotor: number }
  | { type: "pause"; on: boolean }
  | { type: "speed"; factor: number }
  | { type: "reset" }
  | { type: "save"; name: string }
  | { type: "ping"; t: number };
