// A video of the picture, recorded and downloaded by the browser.

const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
const RATE = 30; // frames/s
const BITS = 6_000_000; // per second

export class VideoRecorder {
  private recorder: MediaRecorder | null = null;

  get running(): boolean {
    return this.recorder !== null;
  }

  /** Begins to record a canvas; the reason if the browser cannot. */
  start(canvas: HTMLCanvasElement, name: string): string {
    const mimeType = "MediaRecorder" in window ? KINDS.find((kind) => MediaRecorder.isTypeSupported(kind)) : undefined;
    if (!mimeType) return "this browser cannot record a video";
    const parts: Blob[] = [];
    this.recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType, videoBitsPerSecond: BITS });
    this.recorder.ondataavailable = ({ data }) => parts.push(data);
    this.recorder.onstop = () => {
      const ending = mimeType.includes("mp4") ? "mp4" : "webm";
      download(new Blob(parts, { type: mimeType }), `${name}.${ending}`);
    };
    this.recorder.start(1000);
    return "";
  }

  stop(): void {
    this.recorder?.stop();
    this.recorder = null;
  }
}

function download(content: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
