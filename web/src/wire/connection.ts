// The socket to the server: decodes what it sends, numbers the page's messages, and reconnects.

import { Layout } from "./frames.ts";
import type { ServerMessage, PageMessage } from "./messages.generated.ts";
import type { Comparing, FlightListener, FlightSource } from "./source.ts";

const FIRST_WAIT = 500; // ms
const LONGEST_WAIT = 5000;

export class Connection implements FlightSource {
  private socket: WebSocket | null = null;
  private listener: FlightListener | null = null;
  private layout: Layout | null = null;
  private seq = 0;
  private wait = FIRST_WAIT;
  private timer = 0;

  constructor(private readonly address: string) {}

  start(listener: FlightListener): void {
    this.listener = listener;
    this.open();
  }

  send(message: PageMessage): number | null {
    if (this.socket?.readyState !== WebSocket.OPEN) return null;
    this.seq += 1;
    this.socket.send(JSON.stringify({ ...message, seq: this.seq }));
    return this.seq;
  }

  compare(what: Comparing): void {
    if (what !== "fly") this.send({ type: "compare", what });
  }

  retry(): void {
    window.clearTimeout(this.timer);
    this.wait = FIRST_WAIT;
    if (!this.socket) this.open();
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }: MessageEvent<ArrayBuffer | string>) => this.receive(data);
    socket.onclose = () => this.closed();
    this.socket = socket;
  }

  private closed(): void {
    this.socket = null;
    this.listener?.disconnected(performance.now() + this.wait);
    this.timer = window.setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  private receive(data: ArrayBuffer | string): void {
    if (typeof data === "string") {
      this.handle(JSON.parse(data) as ServerMessage);
      return;
    }
    const frame = this.layout?.decode(data);
    if (frame) this.listener?.frame(frame);
  }

  private handle(message: ServerMessage): void {
    const to = this.listener!;
    switch (message.type) {
      case "scene":
        this.layout = new Layout(message.fields);
        this.wait = FIRST_WAIT;
        to.connected();
        to.scene(message);
        break;
      case "status":
        // the server takes the beam from a page that is silent
        if (message.holder === "you") this.send({ type: "ping", t: performance.now() });
        to.status(message);
        break;
      case "changed":
        to.changed(message.key, message.value, message.duration);
        break;
      case "refused":
        to.refused(message.what, message.reason);
        break;
      case "done":
        to.done(message.what, message.detail);
        break;
      case "pong":
    }
  }
}

/** The address of the page's own server, with the token of the page's address. */
export function socketAddress(page: Location): string {
  const scheme = page.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${page.host}/ws${page.search}`;
}
