// The score of a flight through a corridor by hand, row by row. As `live.session.challenge` forms it of a whole log.

import type { SceneCorridor, StatusScore } from "../wire/messages.generated.ts";

/** As the page's manifest has it. */
export interface ChallengeManifest {
  every: number; // steps of a row of the log
  columns: Partial<Record<Scored, number[]>>; // of a sample
  rules: Record<"touch" | "effort" | "jerk" | "pressed" | "apart", number>;
  left: string;
}

type Scored = "position" | "velocity" | "push_force" | "contact_force";
type Row = Record<Scored, number[]>;

const norm = (vector: readonly number[]): number => Math.hypot(...vector);

export class CorridorRun {
  private readonly rows: Row[] = []; // the last three at most
  private count = 0;
  private start = 0; // s
  private time = 0; // s
  private touches = 0;
  private pressed = -Infinity; // s
  private effort = 0; // N s
  private jerks = 0; // m²/s⁴: of second differences of the velocity
  private fastest = 0; // m/s
  private left: number | null = null; // s
  private finished = false;

  constructor(
    private readonly corridor: SceneCorridor,
    private readonly challenge: ChallengeManifest,
    private readonly interval: number, // s between rows
  ) {}

  /** Takes the next sample of the log. */
  add(time: number, sample: ArrayLike<number>): void {
    const { columns } = this.challenge;
    const row = {} as Row;
    for (const [name, at] of Object.entries(columns)) row[name as Scored] = at.map((i) => sample[i]);
    if (this.finished || (this.count === 0 && norm(row.push_force) === 0)) return;
    if (this.count === 0) this.start = time;
    this.count += 1;
    this.time = time;
    this.rows.push(row);
    if (this.rows.length > 3) this.rows.shift();
    this.sum(row);
    if (this.left === null && this.outside(row.position)) this.left = time;
    this.finished = this.count > 1 && this.beyond(row.position);
  }

  /** The score so far; null until it can be formed. */
  get score(): StatusScore | null {
    if (this.count < 4) return null;
    const { touch, effort, jerk: weight } = this.challenge.rules;
    const time = this.time - this.start;
    const jerk = Math.log((time ** 3 / this.fastest ** 2) * (this.jerks / this.interval ** 3));
    const score = time + touch * this.touches + effort * this.effort + weight * jerk;
    const refused = this.left === null ? "" : this.challenge.left.replace("{time:.2f}", this.left.toFixed(2));
    return { start: this.start, finished: this.finished, refused, time, touches: this.touches, effort: this.effort, jerk, score };
  }

  private sum(row: Row): void {
    const { apart, pressed } = this.challenge.rules;
    const [a, b, c] = this.rows;
    const before = this.rows.at(-2);
    if (before) this.effort += 0.5 * this.interval * (norm(before.push_force) + norm(row.push_force));
    if (this.rows.length === 3) this.jerks += norm(a.velocity.map((v, i) => v - 2 * b.velocity[i] + c.velocity[i])) ** 2;
    this.fastest = Math.max(this.fastest, norm(row.velocity));
    if (norm(row.contact_force.slice(0, 2)) <= pressed) return;
    if (this.time - this.pressed > apart) this.touches += 1;
    this.pressed = this.time;
  }

  private beyond([x, y]: number[]): boolean {
    const [before, end] = this.corridor.centreline.slice(-2);
    return (x - end[0]) * (end[0] - before[0]) + (y - end[1]) * (end[1] - before[1]) > 0;
  }

  /** Whether a place before its end is beside the corridor or above its walls. */
  private outside([x, y, z]: number[]): boolean {
    const { centreline: line, width, height } = this.corridor;
    const offsets = line.slice(0, -1).map(([ax, ay], i) => {
      const [dx, dy] = [line[i + 1][0] - ax, line[i + 1][1] - ay];
      const along = (x - ax) * dx + (y - ay) * dy;
      const share = Math.min(Math.max(along / (dx * dx + dy * dy), 0), 1);
      return { along, beside: Math.hypot(x - ax - share * dx, y - ay - share * dy) };
    });
    const beside = Math.min(...offsets.map((one) => one.beside)) > 0.5 * width;
    return (beside && offsets[0].along >= 0) || z > height;
  }
}
