// The flight in a worker of the page, as a source for the rest of the page; the same messages as with a server.

import { Frame, Layout } from "../wire/frames.ts";
import type { PageMessage, SceneParameter } from "../wire/messages.generated.ts";
import { withValue } from "../wire/parameters.ts";
import type { Comparing, FlightListener, FlightSource, FlownScene } from "../wire/source.ts";
import { type Link, linkOf, type Setting } from "./link.ts";
import type { FlightIndex, MissionEntry } from "./manifest.ts";
import type { FromWorker, ToWorker } from "./protocol.ts";

export class OwnFlight implements FlightSource {
  private worker: Worker | null = null;
  private listener: FlightListener | null = null;
  private layout: Layout | null = null;
  private seq = 0;
  private parameters: SceneParameter[] = [];
  mission = "";
  /** Is told the mission that is flown. */
  opened: (mission: string) => void = () => undefined;

  constructor(
    private readonly index: FlightIndex,
    private readonly newWorker: () => Worker,
    private readonly begin: () => Link,
  ) {}

  /** What follows the page's address in a link to this mission with its settings. */
  get link(): string {
    return linkOf(this.mission, this.parameters);
  }

  get onlyServer(): readonly string[] {
    return this.index.only_server;
  }

  get missions(): readonly MissionEntry[] {
    return this.index.missions;
  }

  get companions(): readonly MissionEntry[] {
    return this.missions.filter(({ name }) => name !== this.mission);
  }

  start(listener: FlightListener): void {
    this.listener = listener;
    listener.connected();
    this.restart();
  }

  /** Flies what the page's address says. */
  restart(): void {
    const { mission, settings } = this.begin();
    const entry = this.entry(mission ?? "") ?? this.missions[0];
    this.open(entry.name, settings);
    if (mission !== null && entry.name !== mission) this.refuseMission(mission);
  }

  /** Flies another mission. */
  open(mission: string, settings: Setting[]): void {
    this.worker?.terminate();
    [this.layout, this.mission] = [null, mission];
    const worker = this.newWorker();
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if (worker === this.worker) this.receive(data);
    };
    this.worker = worker;
    void this.sendFlight("open", worker, mission, settings);
  }

  compare(what: Comparing, mission = ""): void {
    if (what === "fly") void this.sendFlight("along", this.worker!, mission, []);
    else this.post(this.worker!, { type: "compare", what });
  }

  send(message: PageMessage): number | null {
    if (message.type === "fly" && this.entry(message.mission)) this.open(message.mission, []);
    if (!this.layout) return null;
    this.seq += 1;
    this.post(this.worker!, { ...message, seq: this.seq });
    return this.seq;
  }

  private entry(mission: string): MissionEntry | undefined {
    return this.missions.find(({ name }) => name === mission);
  }

  private async sendFlight(type: "open" | "along", worker: Worker, name: string, settings: Setting[]): Promise<void> {
    const index = { ...this.index, missions: [] };
    const entry = this.entry(name)!;
    const file = entry.file === undefined ? null : await download(entry.file);
    if (worker === this.worker) this.post(worker, { type, index, entry, settings, file });
  }

  private post(worker: Worker, message: ToWorker): void {
    worker.postMessage(message);
  }

  private receive(message: FromWorker): void {
    const to = this.listener!;
    switch (message.type) {
      case "frame":
        if (this.layout) to.frame(new Frame(this.layout, message.values));
        break;
      case "scene":
        this.scene(message);
        break;
      case "status":
        if (message.holder === "you") this.send({ type: "ping", t: performance.now() });
        to.status(message);
        break;
      case "changed":
        this.parameters = withValue(this.parameters, message.key, message.value);
        to.changed(message.key, message.value, message.duration);
        break;
      case "refused":
        to.refused(message.what, message.reason);
        break;
      case "saved":
        offer(message.name, message.bytes);
        to.done("save", message.name);
        break;
      case "done":
      case "pong":
    }
  }

  private scene(scene: FlownScene): void {
    this.layout = new Layout(scene.fields);
    [this.mission, this.parameters] = [scene.mission, scene.parameters];
    this.opened(this.mission);
    this.listener!.scene(scene);
  }

  private refuseMission(mission: string): void {
    const known = this.missions.map(({ name }) => name).join(", ");
    this.listener!.refused("link", `mission = ${JSON.stringify(mission)}: must be one of ${known}`);
  }
}

/** The content of a file beside the page; nothing, which no flight is, if it is not there. */
async function download(file: string): Promise<ArrayBuffer> {
  try {
    const response = await fetch(file);
    return response.ok ? await response.arrayBuffer() : new ArrayBuffer(0);
  } catch {
    return new ArrayBuffer(0);
  }
}

/** Offers a file for download. */
function offer(name: string, bytes: Uint8Array<ArrayBuffer>): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type: "application/zip" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
