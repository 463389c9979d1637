// The worker: opens a flight, flies it in real time, and answers the page.

import { bytes, NOT_LIVE } from "../wire/replay.ts";
import { FlownMission } from "./flown_mission.ts";
import { BrokenFlight, unpacked } from "./manifest.ts";
import type { FromWorker, OpenRequest, ToWorker } from "./protocol.ts";
import { RealTimeLoop } from "./real_time.ts";
import { Refusal } from "./refusal.ts";
import { Session } from "./session.ts";

const clock = (): number => performance.now() / 1000;

function post(message: FromWorker, moved: Transferable[] = []): void {
  self.postMessage(message, { transfer: moved });
}

let session: Session | null = null;
let loop: RealTimeLoop | null = null;

async function open(request: OpenRequest): Promise<void> {
  const [manifest, code] = unpacked(await content(request), request.entry, request.index);
  const flown = new FlownMission(await WebAssembly.compile(code), manifest);
  if (request.type === "along") {
    session?.accompany(flown);
    return;
  }
  session = new Session(flown, clock, post);
  const refused = session.take(request.settings);
  post({ type: "scene", ...session.scene });
  for (const answer of refused) post(answer);
  loop = new RealTimeLoop(session, manifest.page, clock, post);
  loop.start();
}

async function content({ entry, file }: OpenRequest): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([file ?? bytes(entry.data!)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

self.onmessage = ({ data }: MessageEvent<ToWorker>): void => {
  if ("entry" in data) {
    open(data).catch((error: unknown) => {
      const known = error instanceof BrokenFlight || error instanceof Refusal;
      const reason = known ? error.message : `${data.index.broken} (${String(error)})`;
      if (data.type === "along") post({ type: "refused", what: "compare", reason });
      else fail(reason);
    });
  } else if (data.type === "compare") session?.compare(data.what);
  else {
    const { seq, ...rest } = data;
    loop?.receive(rest, seq);
  }
};

/** Says why the flight cannot be flown. */
function fail(failure: string): void {
  const preparing = { step: "", seconds: 0, failure };
  post({ ...NOT_LIVE, phase: "failed", alarm: "", paused: false, speed: 1, factor: 0, ending: null, preparing });
}
