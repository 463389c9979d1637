// Written by tools/wire_types.py from src/tandemlift/apps/live/session/ and page_files.py: change it there.

export type Vector = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number]; // w, x, y, z: body to world
export type ParameterValue = number | boolean | string | readonly number[];

export type Phase =
  | "idle"
  | "lift"
  | "guided"
  | "land"
  | "hold"
  | "stopped"
  | "contact"
  | "limited"
  | "preparing"
  | "failed"
  | "diverged"
  | "crashed"
  | "over";

export type FrameFieldName =
  | "time"
  | "position"
  | "attitude"
  | "velocity"
  | "reference"
  | "reference_yaw"
  | "push"
  | "push_point"
  | "push_moment"
  | "pilot_push"
  | "disturbance"
  | "wind"
  | "phase"
  | "alarm"
  | "contact_part"
  | "contact_point"
  | "contact_normal"
  | "contact_force"
  | "held"
  | "hand_point"
  | "hand_target"
  | "seq"
  | "thrusts";

/** Fields of which a value between two frames means nothing. */
export const JUMPING_FIELDS: readonly FrameFieldName[] = ["phase", "alarm", "contact_part", "contact_point", "contact_normal", "held", "seq"];

/** Parameters that the picture and the plots show. */
export const THRESHOLD = "admittance.threshold";
export const STIFFNESS = "person.stiffness";
export const MAX_FORCE = "person.max_force";
/** Size of a message, at most [bytes]. */
export const MAX_SIZE = 65536;

/** Words that keys of a step of a lecture may have. */
export const STEP_WORDS = {
  spotlight: ["push", "moment", "speed", "x", "y", "height", "error", "disturbance", "thrust", "contact", "wind", "time"],
  camera: ["behind", "side", "above", "board"],
  ask: ["lift", "land"],
  ghost: ["keep", "end"],
} as const;

/** Bounds of numbers that the page sends. */
export const LIMITS = {
  force: { frequency: { min: 0, max: 10 }, duration: { min: 0, max: 1 } },
  kill: { rotor: { min: 0, max: 255 } },
  speed: { factor: { min: 0.1, max: 1 } },
  rewind: { time: { min: 0, max: 100000 } },
} as const;

/** A part of the vehicle as drawn. */
export interface SceneShape {
  kind: "box" | "sphere" | "cylinder" | "hull";
  size: readonly number[]; // edges of a box; radius of a sphere, and length of a cylinder; triangles' corners, m
  position: Vector; // of its centre; m, body axes
  axes: readonly number[]; // columns of its rotation to body axes (9); a cylinder lies along its z
  color: string; // #rrggbb
}

/** A rotor. */
export interface SceneRotor {
  position: Vector; // m, body axes
  spin: number; // 1 or -1: sign of its reaction torque about body z
  radius: number; // m
  max_thrust: number; // N
  max_speed: number; // at that thrust, rad/s
  blades: SceneShape; // as it stands still
  disc: SceneShape; // as it turns, transparent
}

/** A quadrotor. */
export interface SceneQuadrotor {
  position: Vector; // m, body axes
  guard: number; // radius of the sphere that touches walls; m
  rotors: SceneRotor[];
}

/** The payload as it can be held: a beam or a body along body y. */
export interface ScenePayload {
  position: Vector; // m, body axes
  length: number; // m
  width: number; // m
  height: number; // m
}

/** The whole vehicle. */
export interface SceneVehicle {
  quadrotors: SceneQuadrotor[];
  payload: ScenePayload;
  shapes: SceneShape[]; // all that does not turn
  mass: number; // kg
}

/** A wall. */
export interface SceneWall {
  center: Vector; // m, world axes
  size: Vector; // length, thickness, height, m
  heading: number; // of its length from world x, rad
}

/** A corridor. */
export interface SceneCorridor {
  centreline: [number, number][];
  width: number; // m
  height: number; // m
}

/** A spring with a damper. */
export interface SceneSpring {
  stiffness: number; // N/m
  damping: number; // N s/m
  max_force: number; // N
}

/** A parameter. */
export interface SceneParameter {
  key: string; // dotted key of the mission
  label: string;
  group: string;
  value: ParameterValue;
  initial?: ParameterValue; // the mission's value, which `restore` sets
  unit?: string;
  min?: number;
  max?: number;
  choices?: string[]; // in place of bounds
}

/** A mission that a page may choose. */
export interface SceneMission {
  name: string;
  title: string; // what it shows, in a line
}

/** Why a flight was stopped before its end. */
export interface SceneEnding {
  outcome: Phase; // `crashed`, `diverged`, or `failed` where the engine was lost
  text: string; // names outcome, time, quantity, value and limit
  time: number; // s
  place: Vector | null; // of the vehicle; null if that is not known
}

/** Something that went badly in the flight so far. */
export interface StatusFinding {
  kind: string; // as in docs/reference/outcomes.md
  time: number; // when it began; s
  text: string;
}

/** A setting that was changed in flight. */
export interface SceneChange {
  time: number; // s
  text: string; // key and value
}

/** A span of time. */
export interface SceneReplay {
  start: number; // s
  end: number; // s
  speed: number; // flight time over wall time
  ending: SceneEnding | null; // why it was stopped before its end; null unless it was
  findings?: StatusFinding[];
  changes?: SceneChange[];
}

/** Everything about a flight that does not change from frame to frame. */
export interface FlightScene {
  mission: string; // name of the mission
  controller: string; // its name
  engine: string; // where the body is simulated
  version: string; // of tandemlift
  step: number; // of the simulation; s
  rate: number; // frames a second, at most
  vehicle: SceneVehicle; // in body axes, from its centre of mass
  ground: boolean; // whether there is a floor to land on
  floor: number; // height of the floor, or of the level that is drawn in its place; m
  walls: SceneWall[]; // upright boxes
  corridor: SceneCorridor | null; // drawn on the floor
  threshold: Vector; // push on each axis below which nothing moves, N
  spring: SceneSpring; // of the virtual hand by which a page pulls
  phases: Phase[]; // names of the phases by their number
  alarms: string[]; // names of the alarms by their number; empty for no alarm
  fields: [FrameFieldName, number][]; // name and number of columns of each field of a frame
  parameters: SceneParameter[]; // what may be changed in flight
  missions?: SceneMission[]; // that a page may `fly`
  replay?: SceneReplay; // span of a saved flight
  authority?: readonly number[]; // of rotors in hover: across, up, down, N; about each axis, N m
}

/** Why a request would be refused right now, and what to do; each a sentence or two, empty if it would not. */
export interface StatusRefusals {
  lift: string;
  land: string;
  push: string; // why a push is not followed
}

/** The score so far of a flight through a corridor by hand, as `tandemlift score` computes it. */
export interface StatusScore {
  start: number; // of the first push; s
  finished: boolean; // whether the end of the corridor was reached; then nothing changes any more
  refused: string; // why it is not ranked; empty unless that is so
  time: number; // since the first push; s
  touches: number; // of walls
  effort: number; // N s
  jerk: number; // logarithm of the dimensionless jerk
  score: number; // s
}

/** The preparation of a flight. */
export interface PreparationStatus {
  step: string; // what is being done
  seconds: number; // since the preparation began; s
  failure: string; // why the mission cannot be flown; empty unless that is so
}

/** Turns of the pages at one flight. */
export interface TurnStatus {
  number: number; // of this page, from 1 on
  queue: readonly number[]; // numbers of the pages that take turns; the first has the hand
}

/** The state of a flight in words, and how it keeps up with the clock. */
export interface FlightStatus {
  phase: Phase; // of the flight; before it `preparing`; at its end `over`, `crashed`, `diverged`, `failed`
  alarm: string; // what has failed; empty if nothing has
  enabled: boolean; // whether the pilot follows pushes
  paused: boolean; // whether time stands still
  speed: number; // flight time over wall time, as asked for
  factor: number; // flight time over wall time, during the last second
  behind_ms: number; // how late the flight was at most since the last status, ms
  recorded_s: number; // length of the recording, s
  failed_rotors: readonly number[]; // rotors that have stopped for good, counted over the whole vehicle from 0
  tare_left_s: number; // for how long nobody may touch it, as its force sensors are tared, s
  refusals: StatusRefusals; // why a request would be refused right now, and what to do
  ending: SceneEnding | null; // why the flight was stopped before its end; null unless it was
  findings?: StatusFinding[]; // what went badly so far; a server forms it once a second
  score?: StatusScore; // in a corridor, once somebody pushed
  preparing?: PreparationStatus; // before the first step
}

/** The scene: on connecting, after a reset, and when the set of parameters changes. */
export interface SceneMessage extends FlightScene {
  type: "scene";
}

/** The status: on connecting and four times a second. */
export interface StatusMessage extends FlightStatus {
  type: "status";
  viewers: number; // pages that are connected
  holder: "you" | "other" | "none"; // who holds the beam
  last_grab: number; // `seq` of this page's last `grab` that came before the status; 0 if none did
  turns?: TurnStatus; // whose turn it is, at a server
}

/** To all: a parameter goes to a value within a duration. */
export interface ChangedMessage {
  type: "changed";
  key: string;
  value: ParameterValue;
  duration: number; // s
}

/** To the page that asked: why a message is refused. */
export interface RefusedMessage {
  type: "refused";
  what: string; // type of the message and its key, if it has one
  reason: string; // names the key, the value and what is allowed
}

/** To the page that asked: `save`, `tare` or `fly` is done. */
export interface DoneMessage {
  type: "done";
  what: "save" | "tare" | "fly";
  detail: string; // the folder, the time of the tare, or the mission
}

/** To the page that asked: the answer to `ping`. */
export interface PongMessage {
  type: "pong";
  t: number; // as it came
}

/** Hold the vehicle at a point or at its centre of mass, and pull it to a target by a spring. */
export interface GrabMessage {
  type: "grab";
  point: Vector; // where the cursor takes hold; m, body axes
  target: Vector; // where the point is to be; m, world axes
  at: "point" | "centre"; // whether the spring pulls at the point or at the centre of mass
}

/** Pull to another target; ignored unless this page holds the beam. */
export interface MoveMessage {
  type: "move";
  target: Vector; // m, world axes
}

/** Let go of the beam. */
export interface ReleaseMessage {
  type: "release";
}

/** Push with a force, as a keyboard or a gamepad does, shake or tap with it; a force of zero lets go. */
export interface ForceMessage {
  type: "force";
  force: Vector; // N, world axes
  point: Vector; // where it acts; m, body axes
  frequency?: number; // Hz, of a shake with this force as its peak; else 0
  duration?: number; // s, of a tap with this force; else 0
}

/** Change a parameter. */
export interface SetMessage {
  type: "set";
  key: string;
  value: ParameterValue;
}

/** Set a parameter back to the mission's value; without a key, all of them. */
export interface RestoreMessage {
  type: "restore";
  key?: string;
}

/** Ask the pilot to lift off, to land, or to stop all rotors. */
export interface AskMessage {
  type: "ask";
  what: "lift" | "land" | "stop";
}

/** Let the pilot follow pushes, or not. */
export interface EnableMessage {
  type: "enable";
  on: boolean;
}

/** Tare the force sensors from a second later on; only in hover, without a push. */
export interface TareMessage {
  type: "tare";
}

/** Stop a rotor for good. */
export interface KillMessage {
  type: "kill";
  rotor: number; // counted over the whole vehicle, from 0
}

/** Stop time, or let it go on. */
export interface PauseMessage {
  type: "pause";
  on: boolean;
}

/** Fly slower than real time. */
export interface SpeedMessage {
  type: "speed";
  factor: number; // flight time over wall time
}

/** Begin the flight again. */
export interface ResetMessage {
  type: "reset";
}

/** Fly again to a time with what was pushed and changed until then, and stand still there. */
export interface RewindMessage {
  type: "rewind";
  time: number; // s
}

/** Fly another mission: a built-in one, or that of a file, which may extend a built-in one only. */
export interface FlyMessage {
  type: "fly";
  mission: string; // name of the mission, or of the file
  toml?: string; // content of the file; the message must begin with `{"type":"fly",`
}

/** Keep the flight as it is as a ghost under the same hand, change places with the ghost, or end it. */
export interface CompareMessage {
  type: "compare";
  what: "keep" | "swap" | "end";
}

/** Save what was flown so far. */
export interface SaveMessage {
  type: "save";
  name: string; // 1 to 64 letters, digits, `.`, `_` or `-`; the first a letter or a digit
}

/** Ask for the hand, which the other pages then wait for; or give it, or the place in the queue, away. */
export interface TurnMessage {
  type: "turn";
  what: "ask" | "give";
}

/** Ask for a `pong`; a page that holds the beam says something every 2 s at least. */
export interface PingMessage {
  type: "ping";
  t: number; // ms, by the page's clock; it comes back
}

export type ServerMessage =
  | SceneMessage
  | StatusMessage
  | ChangedMessage
  | RefusedMessage
  | DoneMessage
  | PongMessage;

export type PageMessage =
  | GrabMessage
  | MoveMessage
  | ReleaseMessage
  | ForceMessage
  | SetMessage
  | RestoreMessage
  | AskMessage
  | EnableMessage
  | TareMessage
  | KillMessage
  | PauseMessage
  | SpeedMessage
  | ResetMessage
  | RewindMessage
  | FlyMessage
  | CompareMessage
  | SaveMessage
  | TurnMessage
  | PingMessage;
