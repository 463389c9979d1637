// The module of a mission: its memory, and calls of its functions.

import { type ModuleManifest, type Table, TABLES } from "./manifest.ts";

const ALIGNMENT = 64; // bytes
const WASM_PAGE = 65_536; // bytes
const WORD = 8; // bytes of a number and of a word of the context

type Call = (...values: (number | bigint)[]) => bigint;

/** The functions of a module that this page calls; addresses are bytes of its memory. */
interface Functions {
  memory: WebAssembly.Memory;
  __heap_base: WebAssembly.Global<"i32">;
  fly: Call;
  prepare: Call;
  ramp: Call;
  [name: string]: unknown;
}

/** Doubles in the module's memory. */
export interface Numbers {
  readonly address: number;
  readonly size: number;
}

export class FlightModule {
  private readonly functions: Functions;
  private top: number;
  private doubles: Float64Array;
  private halves: Int32Array;
  private readonly arguments: Numbers;
  private readonly results: Numbers;
  private readonly work: Numbers;
  private readonly kept: number; // first address that a flight may take

  constructor(
    module: WebAssembly.Module,
    readonly manifest: ModuleManifest,
  ) {
    this.functions = new WebAssembly.Instance(module).exports as unknown as Functions;
    this.top = this.functions.__heap_base.value;
    this.doubles = new Float64Array(this.functions.memory.buffer);
    this.halves = new Int32Array(this.functions.memory.buffer);
    const sizes = Object.values(manifest.functions);
    this.arguments = this.allocate(Math.max(...sizes.map(([given]) => given)));
    this.results = this.allocate(Math.max(...sizes.map(([, returned]) => returned)));
    this.work = this.allocate(manifest.sizes.prepare_work);
    this.kept = this.top;
  }

  /** Gives all memory back that was taken. */
  free(): void {
    this.top = this.kept;
  }

  /** Takes memory for numbers, which are 0. */
  allocate(size: number): Numbers {
    const address = Math.ceil(this.top / ALIGNMENT) * ALIGNMENT;
    this.top = address + WORD * Math.max(size, 1);
    const { memory } = this.functions;
    const missing = this.top - memory.buffer.byteLength;
    if (missing > 0) {
      memory.grow(Math.ceil(missing / WASM_PAGE));
      this.doubles = new Float64Array(memory.buffer);
      this.halves = new Int32Array(memory.buffer);
    }
    this.view({ address, size }).fill(0);
    return { address, size };
  }

  /** A view of numbers; it is valid until more memory is taken. */
  view({ address, size }: Numbers): Float64Array {
    return this.doubles.subarray(address / WORD, address / WORD + size);
  }

  /** Sets a 64-bit word to a whole number of at most 32 bits. */
  put({ address }: Numbers, index: number, value: number): void {
    this.halves[address / 4 + 2 * index] = value;
    this.halves[address / 4 + 2 * index + 1] = value < 0 ? -1 : 0;
  }

  /** The numbers of a flight at its start, and its tables, from the mission's; the guard that fails, or null. */
  prepare(numbers: Numbers, prepared: Numbers): string[] | null {
    const failed = Number(this.functions.prepare(numbers.address, prepared.address, this.work.address));
    return failed ? this.manifest.guards[failed - 1] : null;
  }

  fly(context: Numbers): void {
    this.functions.fly(context.address);
  }

  /** Writes the numbers of a ramp at step k; whether it goes on. */
  ramp(flight: Numbers, ramp: { before: Numbers; after: Numbers; active: Numbers }, k: number, span: Steps): boolean {
    const places = [flight, ramp.before, ramp.after, ramp.active].map(({ address }) => address);
    const { state, flight: count } = this.manifest.sizes;
    const numbers = [state, count, k, span.begin, span.steps].map(BigInt);
    return this.functions.ramp(...places, ...numbers) !== 0n;
  }

  /** The numbers that a function of values returns; valid until the next call. */
  values(name: string, given: ArrayLike<number>): Float64Array {
    this.view(this.arguments).set(given);
    (this.functions[name] as Call)(this.arguments.address, this.results.address);
    return this.view(this.results);
  }

  /** Where a table of the prepared numbers begins, and its rows. */
  table(prepared: Numbers, name: Table): { address: number; rows: number } {
    const [at, rows] = this.manifest.prepared[name];
    return { address: prepared.address + WORD * at, rows };
  }

  /** The part of the prepared numbers that the tables take. */
  tables(prepared: Numbers): Float64Array[] {
    return TABLES.map((name) => {
      const [at, rows, columns] = this.manifest.prepared[name];
      return this.view(prepared).subarray(at, at + rows * columns);
    });
  }
}

export interface Steps {
  begin: number;
  steps: number;
}
