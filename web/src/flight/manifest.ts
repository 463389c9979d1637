// What a page is given of a mission: its module, and the manifest that Python wrote with it (`live.page_manifest`).

import { sha256 } from "@noble/hashes/sha2.js";
import { bytesToHex } from "@noble/hashes/utils.js";

import type { FlightScene, Phase, SceneParameter, StatusRefusals } from "../wire/messages.generated.ts";
import type { ChallengeManifest } from "./corridor_run.ts";

/** The tables of a mission. */
export interface Tables {
  [key: string]: TomlValue;
}
export type TomlValue = number | string | boolean | readonly TomlValue[] | Tables;

export type Span = readonly [at: number, size: number];

/** Of the module: where its numbers lie. */
export interface ModuleManifest {
  version: string;
  numbers: { key: string; value: number | string }[]; // a text where JSON has no number: inf, nan
  guards: string[][];
  context: { words: string[] }; // names of 64-bit words, in order
  sizes: Record<
    "flight" | "state" | "prepared" | "work" | "prepare_work" | "sample" | "ring_rows" | "ring_row",
    number
  >;
  functions: Record<string, readonly [given: number, returned: number]>;
  prepared: Record<Table | "flight", readonly [at: number, rows: number, columns: number]>;
  delayed: Span[];
  delays: number[]; // steps
  keys: readonly [number, number]; // of the random numbers
  steps: number;
  dt: number; // s
  hand: Span;
}

export const TABLES = ["pushes", "gusts", "walls", "legs"] as const;
export type Table = (typeof TABLES)[number];

/** A parameter of the scene, and the mission's keys that it stands for. */
export interface TunableParameter {
  shown: SceneParameter & { min: number; max: number };
  keys: string[];
  count: number; // of its list; 0 if it takes none
  alone: boolean; // whether it takes one number, which stands for all of a list
  zero: boolean; // whether 0 does so at least
  out_of_bounds: string;
  wrong_shape: string;
  such_as: string; // what follows if it is one number
}

export interface Rotor {
  rotor: number; // over the whole vehicle, from 0
  key: string; // of the time at which it stops
}

/** The numbers of a field of a message: how many, their bounds, and the texts of what breaks them. */
export interface FieldRule {
  count: number; // of a vector, whose numbers are named one by one; else 0
  min: number;
  max: number;
  wrong: string;
}

/** Of an ending: the phase that it leads to, and what is said of it. */
export interface EndingText {
  outcome: Phase;
  text: string;
}

export interface PageTexts {
  unknown: string;
  no_number: string;
  over: string;
  later: string;
  no_effect: string;
  other_laws: string;
  whole_rotors: string;
  failed_already: string;
  no_requests: string; // empty if the pilot takes requests
  touch: Record<string, string>; // by the number that the module gives
  refusals: Record<keyof StatusRefusals, string[]>; // likewise
  refused_at_end: Record<"over" | "stopped_early" | "error", StatusRefusals>;
  endings: { by_number: Record<string, EndingText>; not_finite: EndingText[] }; // by part of the state
  empty: string;
  name: string;
  only_server: string;
}

export interface PacingConstants {
  most_behind: number; // s
  window: number; // s
  batch: number; // steps
  pause: number; // s
  echo: number; // s
  fresh: number; // s
  silent: number; // s
  status_every: number; // frames
}

/** Of the flight: what a session needs beside the module. */
export interface PageManifest {
  scene: FlightScene;
  tables: Tables; // of the mission
  parameters: TunableParameter[];
  absent: Record<string, string>; // why a parameter is refused that this mission does not have
  rotors: Rotor[];
  never: number; // s: the time of a fault that has not happened
  hand: Record<string, Span>; // of each part of the hand in its numbers
  released: number[]; // the numbers of a hand that holds nothing
  engine: string;
  plant: Span;
  lost: number; // index of the number that is 0 until the flight crashes or diverges
  hover_time: number; // index, or −1 if no tare needs it
  guidance: Span[]; // the pilot's guidance and its memory, of which `refusals` is a function
  ending: Span[]; // what `ending` is a function of, and the time
  frame: [field: string, count: number][]; // what `frame` returns
  challenge: ChallengeManifest;
  phase_times: number[]; // s, and the phase before the lift
  touch_rule: number[];
  ramp: number; // s
  request_time: number; // s
  pacing: PacingConstants;
  texts: PageTexts;
  rules: Record<string, Record<string, FieldRule>>;
  save_name: string; // a regular expression
  files: { mission: string; hand: string; score: string };
}

export interface FlightManifest {
  format: number;
  version: string;
  module: ModuleManifest;
  page: PageManifest;
}

export const FORMAT = 1;

/** A mission in the page's index. */
export interface MissionEntry {
  name: string;
  title: string;
  sha256: string; // of the flight: its manifest and its module
  data?: string; // base64 of the compressed flight, in a page that is one file
  file?: string; // where it is, else
}

export interface FlightIndex {
  format: number;
  version: string;
  missions: MissionEntry[];
  only_server: string[];
  no_module: string; // the sentence for a browser without WebAssembly
  broken: string;
  other_version: string;
}

export class BrokenFlight extends Error {}

/** Takes a flight apart: size of the manifest (4 bytes, little endian), manifest, module. */
export function unpacked(
  bytes: Uint8Array<ArrayBuffer>,
  entry: MissionEntry,
  index: FlightIndex,
): [FlightManifest, Uint8Array<ArrayBuffer>] {
  if (bytesToHex(sha256(bytes)) !== entry.sha256) throw new BrokenFlight(index.broken);
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  const manifest = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + size))) as FlightManifest;
  if (manifest.format !== FORMAT || manifest.version !== index.version) throw new BrokenFlight(index.other_version);
  return [manifest, bytes.subarray(4 + size)];
}
