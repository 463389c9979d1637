// The level of graphics: full, or light where a processor does the work of a graphics card.

export type Graphics = "full" | "light";
export type GraphicsChoice = "auto" | Graphics;

const SLOW = 25; // frames/s: below it, light graphics
const PATIENCE = 3; // s

/** What suits the machine, by the name of its renderer. */
export function suitableGraphics(): Graphics {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) return "light";
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = info ? context.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|softpipe|basic render/i.test(String(name)) ? "light" : "full";
}

/** Measures the pictures drawn per second, and detects a machine that is too slow. */
export class FrameRate {
  rate: number | null = 0; // pictures/s over the last second; null where it was at rest, and drew few on purpose
  private drawn = 0;
  private count = 0;
  private busy = false; // at any picture of this second
  private since = 0;
  private slow = 0; // s

  /** The browser was ready for a picture at `now` [ms]; true if it has been too slow for `PATIENCE` and not at rest. */
  tick(now: number, drawn: boolean, resting: boolean): boolean {
    this.count += 1;
    if (drawn) this.drawn += 1;
    this.busy ||= !resting; // between two frames of a slow flight it rests, too
    const passed = (now - this.since) / 1000;
    if (passed < 1) return false;
    if (passed < 2) {
      // a longer pause is a hidden page, not a slow one
      this.rate = this.busy ? this.drawn / passed : null;
      this.slow = this.count / passed < SLOW && !resting ? this.slow + passed : 0;
    }
    this.since = now;
    this.count = this.drawn = 0;
    this.busy = false;
    return this.slow >= PATIENCE;
  }
}
